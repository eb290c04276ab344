// What a progress function may call, which runs in the middle of a frame.

#include <fmt/format.h>
#include <freevoxels/freevoxels.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <functional>
#include <optional>
#include <thread>
#include <utility>

namespace freevoxels {
namespace {

/// Frames that are long enough to be reported.
constexpr const char* kSlowSplats = R"({"draw": "splats", "size": [900, 900]})";
constexpr const char* kSlowGather = R"({"draw": "gather", "lod": 0, "size": [1600, 1600]})";
constexpr const char* kQuickFrame = R"({"size": [40, 32]})";

const v1::Volume& oddCloud() {
  static const v1::Volume volume = v1::Volume::open("procedural:cloud", R"({"resolution": 61})");
  return volume;
}

/// Calls `work` once, and counts that it did.
class Once {
 public:
  explicit Once(std::function<void()> work) : work_(std::move(work)) {}
  v1::Progress progress() {
    return [this](std::string_view, double) {
      if (calls_++ == 0) work_();
    };
  }
  bool wasCalled() const { return calls_ > 0; }

 private:
  std::function<void()> work_;
  std::atomic<int> calls_ = 0;
};

void expectUsageError(const std::string& part, const std::function<void()>& work) {
  try {
    work();
    ADD_FAILURE() << "no error, but expected: " << part;
  } catch (const v1::Error& error) {
    EXPECT_EQ(error.kind(), v1::ErrorKind::Usage) << error.what();
    EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
  }
}

TEST(Progress, TimingsAreThoseOfTheLastCompleteFrame) {
  v1::Renderer renderer(oddCloud()), other(oddCloud());
  const auto expectTimings = [&](bool any) {
    Once once([&] {
      EXPECT_EQ(!renderer.timings().empty(), any);
      EXPECT_TRUE(other.timings().empty());
    });
    renderer.render(kSlowSplats, {.progress = once.progress()});
    EXPECT_TRUE(once.wasCalled());
    EXPECT_FALSE(renderer.timings().empty());
  };
  expectTimings(false);
  expectTimings(true);
}

TEST(Progress, AnotherRendererDrawsInTheMiddleOfAFrame) {
  constexpr const char* kOtherSplats = R"({"size": [300, 200], "draw": "splats", "directions": 98})";
  const v1::Context context;
  for (const auto& [outer, inner] : {std::pair(kSlowSplats, kQuickFrame), {kSlowGather, kOtherSplats}}) {
    v1::Renderer first(context, oddCloud()), second(context, oddCloud());
    std::optional<v1::Image> image;
    Once once([&, inner = inner] { image = second.render(inner, {.depth = true}); });
    const v1::Image whole = first.render(outer, {.depth = true, .progress = once.progress()});
    ASSERT_TRUE(image) << outer;
    const v1::Image alone = v1::Renderer(context, oddCloud()).render(inner, {.depth = true});
    EXPECT_TRUE(image->pixels == alone.pixels && image->depth == alone.depth) << inner;
    EXPECT_TRUE(whole.pixels == v1::Renderer(context, oddCloud()).render(outer, {.depth = true}).pixels) << outer;
  }
}

TEST(Progress, RenderersMayBeMadeAndVolumesOpenedThere) {
  v1::Renderer renderer(oddCloud());
  v1::Image image;
  Once once([&] { image = v1::Renderer(v1::Volume::open("procedural:head", R"({"resolution": 24})"), kQuickFrame).render(); });
  renderer.render(kSlowSplats, {.progress = once.progress()});
  EXPECT_EQ(image.width, 40);
}

TEST(Progress, TheRendererItselfRefusesAnotherFrame) {
  v1::Renderer renderer(oddCloud()), second(oddCloud());
  const std::string sentence = "a renderer cannot draw a frame in the progress function of another of its frames";
  Once direct([&] { expectUsageError(sentence, [&] { renderer.render(kQuickFrame); }); });
  renderer.render(kSlowSplats, {.progress = direct.progress()});
  EXPECT_TRUE(direct.wasCalled());
  Once inner([&] { expectUsageError(sentence, [&] { renderer.render(kQuickFrame); }); });
  Once around([&] { second.render(kSlowSplats, {.progress = inner.progress()}); });
  renderer.render(kSlowSplats, {.progress = around.progress()});
  EXPECT_TRUE(inner.wasCalled());
  EXPECT_EQ(renderer.render(kQuickFrame).width, 40);
}

TEST(Progress, FramesAreSubmittedThereAndWaitedForAfterwards) {
  v1::Renderer renderer(oddCloud()), second(oddCloud());
  std::optional<v1::Frame> own, others;
  Once once([&] {
    own.emplace(renderer.submit(kQuickFrame));
    others.emplace(second.submit(kQuickFrame));
    for (const v1::Frame* frame : {&*own, &*others}) {
      expectUsageError("cannot be waited for in a progress function", [&] { frame->wait(); });
      expectUsageError("cannot be waited for in a progress function", [&] { frame->image(); });
    }
  });
  renderer.render(kSlowSplats, {.progress = once.progress()});
  ASSERT_TRUE(own && others);
  EXPECT_TRUE(own->image().pixels == others->image().pixels);
}

TEST(Progress, OfASubmittedFrameMayDoTheSame) {
  v1::Renderer renderer(oddCloud()), second(oddCloud());
  const v1::Frame complete = second.submit(kQuickFrame);
  complete.wait();
  std::optional<v1::Frame> frame;
  std::atomic<bool> isSet = false;
  Once once([&] {
    while (!isSet) std::this_thread::yield();
    EXPECT_TRUE(renderer.timings().empty());
    EXPECT_TRUE(second.render(kQuickFrame).pixels == complete.image().pixels);
    expectUsageError("cannot be waited for in a progress function", [&] { frame->wait(); });
    expectUsageError("a renderer cannot draw", [&] { renderer.render(kQuickFrame); });
  });
  frame.emplace(renderer.submit(kSlowSplats, {.progress = once.progress()}));
  isSet = true;
  frame->wait();
  EXPECT_TRUE(once.wasCalled());
}

TEST(Progress, ARendererWithFramesThatWaitMayBeDestroyedThere) {
  v1::Renderer renderer(oddCloud());
  std::optional<v1::Frame> waiting;
  Once once([&] {
    v1::Renderer second(oddCloud());
    waiting.emplace(second.submit(kQuickFrame));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));  // so that its thread waits for the turn
  });
  renderer.render(kSlowSplats, {.progress = once.progress()});
  ASSERT_TRUE(waiting);
  EXPECT_THROW(waiting->wait(), v1::Error);
}

TEST(Progress, ThreadsThatWouldWaitForEachOthersDeviceAreTold) {
  const v1::Context contexts[]{v1::Context(), v1::Context()};
  std::atomic<int> inside = 0, refused = 0, drawn = 0;
  const auto draw = [&](const v1::Context& own, const v1::Context& other) {
    v1::Renderer renderer(own, oddCloud()), inner(other, oddCloud());
    Once once([&] {
      ++inside;
      while (inside < 2) std::this_thread::yield();
      try {
        inner.render(kQuickFrame);
        ++drawn;
      } catch (const v1::Error& error) {
        EXPECT_EQ(error.kind(), v1::ErrorKind::Usage) << error.what();
        ++refused;
      }
    });
    renderer.render(kSlowSplats, {.progress = once.progress()});
  };
  {
    const std::jthread one([&] { draw(contexts[0], contexts[1]); }), another([&] { draw(contexts[1], contexts[0]); });
  }
  EXPECT_EQ(refused, 1);
  EXPECT_EQ(drawn, 1);
}

TEST(Progress, OtherThreadsDrawAfterwards) {
  v1::Renderer renderer(oddCloud()), second(oddCloud());
  v1::Image image;
  std::jthread thread;
  Once once([&] { thread = std::jthread([&] { image = second.render(kQuickFrame); }); });
  renderer.render(kSlowSplats, {.progress = once.progress()});
  thread.join();
  EXPECT_EQ(image.width, 40);
}

}  // namespace
}  // namespace freevoxels
