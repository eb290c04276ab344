#include <ImfChannelList.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <gtest/gtest.h>
#include <sys/resource.h>

#include "engine/core/error.h"
#include "engine/image/image.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels {
namespace {

using test::readBytes;
using test::TemporaryFolder;
using test::writeBytes;

Image makeImage(glm::ivec2 size) {
  Image image{.size = size};
  for (int i = 0; i < size.x * size.y; ++i) {
    const float value = float(i) / float(size.x * size.y);
    image.pixels.emplace_back(0.5f * value, 0.25f, 1.0f - value, 0.9f);
    image.depth.push_back(7.0f + value);
    image.channels["N.X"].push_back(value);
  }
  return image;
}

constexpr glm::ivec2 kWhole(40, 30);
constexpr PixelRectangle kPart{{7, 11}, {13, 9}};

TEST(Crop, HasThePixelsOfTheWhole) {
  const Image whole = makeImage(kWhole), part = cropped(whole, kPart);
  EXPECT_EQ(part.size, kPart.size);
  EXPECT_EQ(part.wholeSize, kWhole);
  EXPECT_EQ(part.offset, kPart.corner);
  for (int y = 0; y < part.size.y; ++y)
    for (int x = 0; x < part.size.x; ++x) {
      const auto i = std::size_t(y * part.size.x + x), j = std::size_t((y + kPart.corner.y) * kWhole.x + x + kPart.corner.x);
      EXPECT_EQ(part.pixels[i], whole.pixels[j]);
      EXPECT_EQ(part.depth[i], whole.depth[j]);
      EXPECT_EQ(part.channels.at("N.X")[i], whole.channels.at("N.X")[j]);
    }
}

/// Its background is what is behind it in the whole, too.
TEST(Crop, LooksAsThePartOfTheWholeDoes) {
  const Image whole = makeImage(kWhole), part = cropped(whole, kPart);
  const DisplayLook look{.background = Background{glm::vec3(1.0f), glm::vec3(0.0f)}};
  const std::vector<std::uint8_t> all = srgbTexels(whole, look), some = srgbTexels(part, look);
  for (int y = 0; y < part.size.y; ++y) {
    const auto* const row = all.data() + 4 * ((y + kPart.corner.y) * kWhole.x + kPart.corner.x);
    EXPECT_TRUE(std::equal(row, row + 4 * part.size.x, some.data() + 4 * y * part.size.x)) << y;
  }
}

TEST(Crop, IsTheDataWindowOfAnExr) {
  const TemporaryFolder folder;
  const Image part = cropped(makeImage(kWhole), kPart);
  writeExr(folder / "a.exr", part, {.fullFloat = true});
  const Imf::InputFile file((folder / "a.exr").c_str());
  EXPECT_EQ(file.header().displayWindow(), Imath::Box2i({0, 0}, {39, 29}));
  EXPECT_EQ(file.header().dataWindow(), Imath::Box2i({7, 11}, {19, 19}));
  EXPECT_TRUE(file.header().channels().findChannel("N.X"));
  const Image back = readExr(folder / "a.exr");
  EXPECT_EQ(back.pixels, part.pixels);
  EXPECT_EQ(back.depth, part.depth);
}

/// The file claims more pixels than it has, which are the first rows only.
void expectRefusedInLittleMemory(int lastPixel, const char* sentence) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const TemporaryFolder folder;
  writeExr(folder / "a.exr", makeImage({64, 64}), {});
  std::string bytes = readBytes(folder / "a.exr");
  for (const char* window : {"dataWindow", "displayWindow"}) {
    const std::size_t at = bytes.find(window) + std::string(window).size() + 1 + std::string("box2i").size() + 1 + 4 + 8;
    const std::int32_t last[] = {lastPixel, lastPixel};
    bytes.replace(at, sizeof(last), reinterpret_cast<const char*>(last), sizeof(last));
  }
  writeBytes(folder / "a.exr", bytes);
  const auto read = [&] {
    const rlimit limit{std::size_t(1) << 31, std::size_t(1) << 31};
    if (setrlimit(RLIMIT_AS, &limit) != 0) _exit(98);
    try {
      readExr(folder / "a.exr");
    } catch (const Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      _exit(int(error.kind()));
    }
    _exit(0);
  };
  EXPECT_EXIT(read(), testing::ExitedWithCode(int(ErrorKind::Input)), sentence);
}

TEST(ExrDeathTest, AShortFileThatClaimsToBeLargeTakesLittleMemory) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer needs the address space";
#endif
  expectRefusedInLittleMemory(16383, "cannot hold");
  expectRefusedInLittleMemory(599, "not a complete OpenEXR image");  // which it could hold
}

}  // namespace
}  // namespace freevoxels
