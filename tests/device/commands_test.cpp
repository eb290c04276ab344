// Recordings: reuse of their objects, slices, abandonment; and what a frame keeps of them.

#include "engine/vulkan/commands.h"

#include <vector>

#include "engine/renderer.h"
#include "engine/volume/subject.h"
#include "tests/device/device_fixture.h"
#include "tests/device/test_volumes.h"

namespace freevoxels {
namespace {

struct Abandoned {};

class CommandsTest : public DeviceTest {
 protected:
  static std::vector<std::uint32_t> wordsOf(const Buffer& buffer) {
    std::vector<std::uint32_t> words(buffer.bytes() / sizeof(std::uint32_t));
    download(device(), buffer, std::as_writable_bytes(std::span(words)));
    return words;
  }
  static Buffer filled(std::uint32_t word) {
    const std::vector<std::uint32_t> words(1000, word);
    Buffer buffer(device(), words.size() * sizeof(word), MemoryUse::Device, "test");
    upload(device(), buffer, std::as_bytes(std::span(words)));
    return buffer;
  }
};

TEST_F(CommandsTest, RecordingsOneAfterTheOtherShareACommandBuffer) {
  VkCommandBuffer first = VK_NULL_HANDLE;
  for (int i = 0; i < 20; ++i) {
    Commands commands(device());
    if (i == 0) first = commands.handle();
    EXPECT_EQ(commands.handle(), first) << i;
    commands.beginPass("nothing");
    commands.submitAndWait();
    EXPECT_EQ(commands.times().size(), 1u);
  }
}

TEST_F(CommandsTest, PassesAreSubmittedInSlicesOfAboutTheirCost) {
  const Buffer a = filled(1), b = filled(2);
  const auto slicesOfTenPasses = [&](double cost) {
    Commands commands(device());
    for (int i = 0; i < 10; ++i) {
      device().queue().setCost("sliced", cost);
      commands.beginPass("sliced");
      commands.copy(i % 2 == 0 ? a : b, i % 2 == 0 ? b : a, {.size = a.bytes()});
    }
    const std::size_t slices = commands.slices();
    commands.submitAndWait();
    EXPECT_EQ(commands.times().size(), 1u) << "the time between slices is no pass's";
    return slices;
  };
  EXPECT_EQ(slicesOfTenPasses(1e-3 * kSliceMilliseconds), 1u);
  EXPECT_EQ(slicesOfTenPasses(0.5 * kSliceMilliseconds), 5u);
  EXPECT_EQ(slicesOfTenPasses(2.0 * kSliceMilliseconds), 10u);
  EXPECT_EQ(wordsOf(a), std::vector<std::uint32_t>(1000, 1));
}

TEST_F(CommandsTest, CostsAreLearnedFromTheLastTime) {
  device().queue().setCost("learned", 1000.0);
  Commands commands(device());
  commands.beginPass("learned");
  commands.submitAndWait();
  EXPECT_LT(device().queue().costOf("learned", 1000.0), 100.0);
  EXPECT_EQ(device().queue().costOf("never measured", 7.0), 7.0);
}

TEST_F(CommandsTest, AnExceptionOfTheProgressAbandonsTheSlicesThatFollow) {
  const Buffer target = filled(5), other = filled(6);
  device().queue().setCost("abandoned", 2.0 * kSliceMilliseconds);
  Commands commands(device());
  commands.beginPass("abandoned");
  commands.copy(other, target, {.size = 400});
  commands.beginPass("abandoned");
  commands.clear(target);
  ASSERT_EQ(commands.slices(), 2u);
  int calls = 0;
  EXPECT_THROW(commands.submitAndWait([&](std::string_view, double) {
    if (++calls == 2) throw Abandoned();
  }),
               Abandoned);
  std::vector<std::uint32_t> expected(1000, 5);
  std::fill_n(expected.begin(), 100, 6);
  EXPECT_EQ(wordsOf(target), expected) << "the first slice, and not the second one";
}

/// Frames of a volume in every kind of drawing.
class FrameTest : public CommandsTest {
 protected:
  static std::vector<FrameSettings> kindsOfFrames() {
    const Lighting lit{.lights = {{.place = {0.3, 1.0, 0.2}}}, .ambient = glm::dvec3(0.2)};
    std::vector<FrameSettings> kinds;
    kinds.push_back({.size = {70, 50}});
    kinds.push_back({.size = {70, 50}, .depth = true, .lighting = lit});
    kinds.push_back({.size = {70, 50}, .method = SplatSettings{}});
    kinds.push_back({.size = {70, 50}, .method = SplatSettings{}, .depth = true, .lighting = lit});
    return kinds;
  }
  /// Every pass and every few workgroups get a slice of their own in the next frame.
  static void slice(const Renderer& renderer) {
    for (const StageTime& time : renderer.timings())
      if (time.onDevice) device().queue().setCost(time.name, 0.5 * kSliceMilliseconds);
  }

  Volume volume_ = randomVolume({20, 17, 23}, cubeTransform({20, 17, 23}), 0.4, 1.0);
  Camera camera_ = framingCamera(volume_, 35.0, 20.0, 1.4, {});
};

TEST_F(FrameTest, SlicesDoNotChangeAnImage) {
  for (const FrameSettings& settings : kindsOfFrames()) {
    Renderer renderer(device(), volume_, {.densityScale = 6.0}, {});
    const Image whole = renderer.render(camera_, settings);
    slice(renderer);
    Renderer sliced(device(), volume_, {.densityScale = 6.0}, {});
    int calls = 0;
    const Image image = sliced.render(camera_, settings, [&](std::string_view, double) { ++calls; });
    EXPECT_GT(calls, 5);
    EXPECT_EQ(image.pixels, whole.pixels);
    EXPECT_EQ(image.depth, whole.depth);
  }
}

/// At whichever slice it is abandoned.
TEST_F(FrameTest, AFrameAfterAnAbandonedOneIsTheSame) {
  for (const FrameSettings& settings : kindsOfFrames()) {
    Renderer renderer(device(), volume_, {.densityScale = 6.0}, {});
    const Image expected = renderer.render(camera_, settings);
    for (int last = 1; last < 60; last += 1 + last / 4) {
      Renderer abandoned(device(), volume_, {.densityScale = 6.0}, {});
      slice(renderer);
      int calls = 0;
      bool given = false;
      try {
        abandoned.render(camera_, settings, [&](std::string_view, double) {
          if (++calls == last) throw Abandoned();
        });
      } catch (const Abandoned&) {
        given = true;
      }
      ASSERT_EQ(abandoned.render(camera_, settings).pixels, expected.pixels) << last;
      if (!given) break;
    }
  }
}

TEST_F(FrameTest, AnImageOnTheDeviceIsTheImageOfTheHost) {
  for (const FrameSettings& settings : kindsOfFrames()) {
    Renderer renderer(device(), volume_, {.densityScale = 6.0}, {});
    const Image expected = renderer.render(camera_, settings);
    const Image image = downloadImage(device(), *renderer.renderOnDevice(camera_, settings));
    EXPECT_EQ(image.pixels, expected.pixels);
    EXPECT_EQ(image.depth, expected.depth);
  }
}

TEST_F(FrameTest, TargetsAreDrawnIntoAgainWhenNobodyHoldsThem) {
  for (FrameSettings settings : kindsOfFrames()) {
    Renderer renderer(device(), volume_, {.densityScale = 6.0}, {});
    std::shared_ptr<const FrameTargets> held = renderer.renderOnDevice(camera_, settings);
    const FrameTargets* const first = held.get();
    const Image image = downloadImage(device(), *held);
    const auto other = renderer.renderOnDevice(framingCamera(volume_, 90.0, 0.0, 1.4, {}), settings);
    EXPECT_NE(other.get(), first);
    EXPECT_EQ(downloadImage(device(), *held).pixels, image.pixels) << "it is held";
    held = nullptr;
    const std::uint64_t bytes = device().availableBytes();
    EXPECT_EQ(renderer.renderOnDevice(camera_, settings).get(), first);
    EXPECT_EQ(device().availableBytes(), bytes) << "a frame like the one before allocates nothing";
    settings.size = {40, 30};
    EXPECT_EQ(renderer.renderOnDevice(camera_, settings)->colorEnergy.size(), settings.size);
  }
}

}  // namespace
}  // namespace freevoxels
