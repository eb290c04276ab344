// freevoxels render --share I/N --sums and freevoxels merge: a distributed render without MPI.

#include <array>
#include <cstring>
#include <limits>

#include "engine/image/fixed_sums.h"
#include "engine/image/image.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

class MergeCommandTest : public CommandTest {
 protected:
  static constexpr const char* kScene =
      "procedural:cloud --resolution 24 --size 64x48 --light direction=1,1,0.5 --ambient 0.1 --lod 2 --quiet ";

  void renderPart(const std::string& file, const std::string& share, const std::string& more = "") const {
    expectSuccess(run("render " + std::string(kScene) + "@" + file + " --share " + share + " --sums " + more));
  }
};

}  // namespace

TEST_F(MergeCommandTest, PartsOfAnyNumberGiveTheBitsOfTheWhole) {
  expectSuccess(run("render " + std::string(kScene) + "@whole.png @whole.exr --float --aov depth --share 0/1"));
  for (const int count : {2, 3}) {
    std::string parts;
    for (int index = 0; index < count; ++index) {
      const std::string file = "part_" + std::to_string(count) + "_" + std::to_string(index) + ".exr";
      renderPart(file, std::to_string(index) + "/" + std::to_string(count), "--aov depth");
      parts = "@" + file + " " + parts;
    }
    expectSuccess(run("merge " + parts + "@merged.png @merged.exr --float"));
    EXPECT_EQ(readBytes(folder / "merged.png"), readBytes(folder / "whole.png")) << count;
    const Image merged = readExr(folder / "merged.exr"), whole = readExr(folder / "whole.exr");
    EXPECT_EQ(merged.pixels, whole.pixels) << count;
    EXPECT_EQ(merged.depth, whole.depth) << count;
  }
  // Parts of different counts merge: 1/2 stands for 2/4 and 3/4.
  renderPart("quarter_0.exr", "0/4", "--aov depth");
  renderPart("quarter_1.exr", "1/4", "--aov depth");
  expectSuccess(run("merge @quarter_0.exr @part_2_1.exr @quarter_1.exr @mixed.png --quiet"));
  EXPECT_EQ(readBytes(folder / "mixed.png"), readBytes(folder / "whole.png"));
}

TEST_F(MergeCommandTest, MissingAndDoubledSharesAreNamed) {
  for (const char* index : {"0", "1", "2"}) renderPart(std::string("p") + index + ".exr", std::string(index) + "/3");
  renderPart("again.exr", "1/3");
  expectCleanRefusal("merge @p0.exr @p2.exr @a.png", ExitCode::Input, "share 1/3 is missing");
  expectCleanRefusal("merge @p0.exr @p1.exr @p2.exr @again.exr @a.png", ExitCode::Input, "have the same shares, 1/3");
}

TEST_F(MergeCommandTest, PartsOfOtherImagesAreRefused) {
  renderPart("p0.exr", "0/256");
  const auto expectDifference = [&](const std::string& more, const std::string& mention) {
    renderPart("other.exr", "1/256", more);
    expectCleanRefusal("merge @p0.exr @other.exr @a.png", ExitCode::Input, mention);
  };
  expectDifference("--orbit 10,20", "--camera-position");
  expectDifference("--albedo 0.5,0.5,0.5", "--albedo");
  expectDifference("--resolution 20", "volumes");
  expectDifference("--composite additive", "--attenuation");  // which gathered parts have not
  renderPart("p1.exr", "1/256");
  std::string bytes = readBytes(folder / "p1.exr");
  const std::string version = exrAttribute(bytes, "freevoxels:version");
  ASSERT_NE(version, "");
  const std::string name = std::string("freevoxels:version") + '\0' + "string" + '\0';
  bytes[bytes.find(name) + name.size() + 4] ^= 1;
  writeBytes(folder / "p1.exr", bytes);
  expectCleanRefusal("merge @p0.exr @p1.exr @a.png", ExitCode::Input, "the version of freevoxels");
}

TEST_F(MergeCommandTest, NamesThatAreNoPartsOrNoImagesAreRefused) {
  renderPart("p0.exr", "0/2");
  renderPart("p1.exr", "1/2");
  expectSuccess(run("render " + std::string(kScene) + "@image.exr"));
  expectCleanRefusal("merge @p0.exr @p1.exr", ExitCode::Usage, "OUT is required");
  expectCleanRefusal("merge @image.exr @p1.exr @a.png", ExitCode::Usage, "image.exr");
  expectCleanRefusal("merge @p0.exr @a.png @p1.exr", ExitCode::Usage, "name all parts before the images");
  expectCleanRefusal("merge @p0.exr @p1.exr @a.tif", ExitCode::Usage, "a.tif");
  const std::string bytes = readBytes(folder / "p1.exr");
  writeBytes(folder / "p1.exr", bytes.substr(0, bytes.size() - 100));
  expectCleanRefusal("merge @p0.exr @p1.exr @a.png", ExitCode::Input, "p1.exr");
}

/// The bytes of a file with another value of an attribute.
template <typename Value>
std::string withAttribute(std::string bytes, const std::string& name, const std::string& type, const Value& value) {
  const std::string start = name + '\0' + type + '\0';
  const std::size_t at = bytes.find(start);
  EXPECT_NE(at, std::string::npos) << name;
  std::memcpy(&bytes[at + start.size() + 4], &value, sizeof(value));
  return bytes;
}

TEST_F(MergeCommandTest, HeadersThatClaimMoreThanTheirFileHoldsAreRefusedAtOnce) {
  using Window = std::array<std::int32_t, 4>;
  constexpr std::uint64_t kLittle = std::uint64_t(300) << 20;
  for (const char* draw : {"--draw splats", "--draw gather"}) {
    renderPart("whole.exr", "0/1", draw);
    const std::string bytes = readBytes(folder / "whole.exr");
    const Window large{0, 0, 16383, 16383};
    const std::string both = withAttribute(withAttribute(bytes, "dataWindow", "box2i", large), "displayWindow", "box2i", large);
    for (const std::string& changed : {both, withAttribute(bytes, "displayWindow", "box2i", large),
                                       withAttribute(bytes, "freevoxels:digits.energy", "int", std::numeric_limits<std::int32_t>::min())}) {
      writeBytes(folder / "changed.exr", changed);
      expectCleanRefusal("merge @changed.exr @a.png", ExitCode::Input, "changed.exr");
      EXPECT_LT(run("merge @changed.exr @a.png").peakBytes, kLittle);
      EXPECT_LT(run("compare @changed.exr @changed.exr").peakBytes, kLittle);
    }
    expectSuccess(run("merge @whole.exr @a.png"));
  }
}

TEST_F(MergeCommandTest, SumsThatOverflowAreRefused) {
  renderPart("p0.exr", "0/2");
  SumsFile part = readSums(folder / "p0.exr");
  part.sums.values.front() = std::numeric_limits<std::int64_t>::max();
  writeSums(folder / "p0.exr", part.sums, part.header);
  part.header.metadata["freevoxels:share"] = "1/2";
  writeSums(folder / "p1.exr", part.sums, part.header);
  expectCleanRefusal("merge @p0.exr @p1.exr @a.png", ExitCode::Input, "too large to be added");
}

TEST_F(MergeCommandTest, TextOfHeadersIsPrintable) {
  renderPart("p0.exr", "0/2");
  const SumsFile part = readSums(folder / "p0.exr");
  for (const char* name : {"freevoxels:share", "freevoxels:size", "freevoxels:version", "freevoxels:\x1b[31m", "freevoxels:albedo"}) {
    SumsFile changed = part;
    changed.header.metadata["freevoxels:share"] = "1/2";
    changed.header.metadata[name] = "\x1b]0;title\x07" + std::string(10'000, 'x');
    writeSums(folder / "p1.exr", changed.sums, changed.header);
    const ProgramResult result = run("merge @p0.exr @p1.exr @a.png");
    EXPECT_NE(result.exitCode, 0) << name;
    EXPECT_EQ(result.err.find('\x1b'), std::string::npos) << result.err;
    EXPECT_LT(result.err.size(), 2000u);
  }
}

TEST_F(MergeCommandTest, WhatCannotBeSharedIsRefused) {
  const std::string render = "render " + std::string(kScene);
  expectCleanRefusal(render + "@a.exr --share 2/2 --sums", ExitCode::Usage, "--share takes I/N");
  expectCleanRefusal(render + "@a.exr --share 0/257 --sums", ExitCode::Usage, "256");
  expectCleanRefusal(render + "@a.exr --share 0 --sums", ExitCode::Usage, "--share takes I/N");
  expectCleanRefusal(render + "@a.png --share 0/2 --sums", ExitCode::Usage, "--sums");
  expectCleanRefusal(render + "@a.exr @b.exr --share 0/2 --sums", ExitCode::Usage, "--sums");
  expectCleanRefusal(render + "@a.exr --share 0/2 --sums --composite sorted", ExitCode::Usage, "sorted");
  expectCleanRefusal(render + "@a.exr --share 0/2 --sums --float", ExitCode::Usage, "--float");
  expectCleanRefusal(render + "@a.exr --share 0/2 --color-parts 2", ExitCode::Usage, "--color-parts");
  expectCleanRefusal(render + "@a.exr --color-parts 257", ExitCode::Usage, "--color-parts");
}

/// One part: the whole in a single colour. Several: the same opacity, and colours that differ.
TEST_F(MergeCommandTest, ColoredPartsKeepLuminanceAndOpacity) {
  const auto draw = [&](const std::string& file, const std::string& options) {
    expectSuccess(run("render " + std::string(kScene) + "@" + file + " --float " + options));
    return readExr(folder / file);
  };
  const auto luminance = [](glm::vec4 pixel) { return 0.2126f * pixel.r + 0.7152f * pixel.g + 0.0722f * pixel.b; };
  const Image whole = draw("whole.exr", "--share 0/1"), one = draw("one.exr", "--color-parts 1"), five = draw("five.exr", "--color-parts 5");
  const glm::vec3 color = glm::vec3(one.pixels[64 * 24 + 32]) / luminance(whole.pixels[64 * 24 + 32]);
  std::size_t otherColors = 0;
  for (std::size_t i = 0; i < whole.pixels.size(); ++i) {
    EXPECT_EQ(one.pixels[i].a, whole.pixels[i].a);
    EXPECT_EQ(five.pixels[i].a, whole.pixels[i].a);
    const glm::vec3 expected = color * luminance(whole.pixels[i]);
    EXPECT_LT(glm::length(glm::vec3(one.pixels[i]) - expected), 1e-5f) << i;
    if (glm::length(glm::vec3(five.pixels[i]) - expected) > 0.05f) ++otherColors;
  }
  EXPECT_GT(otherColors, whole.pixels.size() / 10);
}

}  // namespace freevoxels::test
