// Baked volumes as a user makes and draws them.

#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"
#include "tests/image_measures.h"

namespace freevoxels::test {

namespace {

const std::filesystem::path kData = FREEVOXELS_DATA_DIR;
constexpr double kSameImage = 60.0;     // dB
constexpr double kSameFromAfar = 55.0;  // of levels of the file in place of levels of the voxels, in dB

class BakeCommand : public CommandTest {
 protected:
  Image image(const std::string& name) const { return readExr(folder / name); }
};

TEST_F(BakeCommand, KeptScalarsDrawTheSameImageToTheBit) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 64 --keep-scalars --quiet"));
  for (const std::string look : {"", " --unlit --draw splats"}) {
    const std::string options = " --size 40x30 --quiet --float" + look;
    expectSuccess(run("render procedural:cloud @original.exr --resolution 64" + options));
    expectSuccess(run("render @a.fvx @baked.exr" + options));
    EXPECT_EQ(largestPixelDifference(image("baked.exr"), image("original.exr")), 0.0) << options;
  }
}

TEST_F(BakeCommand, APartOfABakedVolumeIsThatOfItsVolume) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 64 --keep-scalars --quiet"));
  for (const std::string part : {"--clip-box 3,20,11,50,99,40", "--clip-box 3,20,11,50,99,40 --clip-plane 0,0,0,1,1,0"}) {
    const std::string options = " --size 40x30 --density-scale 20 --quiet --float " + part;
    expectSuccess(run("render procedural:cloud @original.exr --resolution 64" + options));
    expectSuccess(run("render @a.fvx @baked.exr" + options));
    EXPECT_EQ(largestPixelDifference(image("baked.exr"), image("original.exr")), 0.0) << part;
  }
  expectCleanRefusal("render @a.fvx @none.exr --clip-box 64,0,0,70,9,9", ExitCode::Usage, "--clip-box");
}

TEST_F(BakeCommand, VoxelsWithTheValueOfNoDataAreLeftOut) {
  const std::string options = " --size 40x30 --quiet --float", without = " --no-data 1";
  expectSuccess(run("generate head @head.vdb --resolution 24 --quiet"));
  expectSuccess(run("bake @head.vdb @a.fvx --keep-scalars --quiet" + without));
  expectSuccess(run("render @head.vdb @original.exr" + options + without));
  expectSuccess(run("render @head.vdb @whole.exr" + options));
  expectSuccess(run("render @a.fvx @baked.exr" + options));
  EXPECT_EQ(largestPixelDifference(image("baked.exr"), image("original.exr")), 0.0);
  EXPECT_GT(largestPixelDifference(image("baked.exr"), image("whole.exr")), 0.01);
}

TEST_F(BakeCommand, SixteenBitsDrawTheSameImageTo60Decibels) {
  struct Case {
    std::string volume, classification;
  };
  for (const Case& look : {Case{"procedural:cloud", "--density-scale 30"}, Case{"procedural:fire", "--emission 3"},
                           Case{"procedural:head", R"(--transfer-function {"opacity":[[0,0],[0.3,0.02],[1,0.6]]})"}}) {
    expectSuccess(run("bake " + look.volume + " @a.fvx --resolution 64 --quiet " + look.classification));
    expectSuccess(run("render " + look.volume + " @original.exr --resolution 64 --size 48 --quiet --float " + look.classification));
    expectSuccess(run("render @a.fvx @baked.exr --size 48 --quiet --float"));
    EXPECT_GE(psnr(image("baked.exr"), image("original.exr")), kSameImage) << look.volume;
  }
}

TEST_F(BakeCommand, AFixedClassificationCannotBeChangedAndAKeptOneCan) {
  expectSuccess(run("bake procedural:cloud @fixed.fvx --resolution 32 --quiet"));
  expectSuccess(run("bake procedural:cloud @kept.fvx --resolution 32 --keep-scalars --quiet"));
  for (const std::string option : {"--density-scale 9", "--albedo 1,0,0", R"(--transfer-function {"opacity":[[0,0],[1,1]]})",
                                   "--classification pre"})
    expectCleanRefusal("render @fixed.fvx @a.png --size 16 " + option, ExitCode::Usage, "--keep-scalars");
  const std::string function = R"( --size 24 --unlit --quiet --float --transfer-function {"opacity":[[0,0],[1,0.3]],"range":[0,1]})";
  expectSuccess(run("render procedural:cloud @original.exr --resolution 32" + function));
  expectSuccess(run("render @kept.fvx @kept.exr" + function));
  EXPECT_EQ(largestPixelDifference(image("kept.exr"), image("original.exr")), 0.0);
  for (const std::string option : {"--grid density", "--temperature-grid heat", "--albedo-grid color"})
    expectCleanRefusal("render @kept.fvx @a.png --size 16 " + option, ExitCode::Usage, option.substr(0, option.find(' ')));
}

TEST_F(BakeCommand, EveryCommandTakesABakedVolume) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 32 --quiet"));
  expectSuccess(run("turntable @a.fvx @turn_#.png --frames 2 --size 24 --quiet"));
  expectSuccess(run("oracle @a.fvx @truth.exr --size 16 --quiet --unlit"));
  expectSuccess(run("render @a.fvx @a.png --size 24 --quiet --save-scene @scene.json"));
  expectSuccess(run("render --scene @scene.json @again.png --quiet"));
  EXPECT_EQ(readBytes(folder / "a.png"), readBytes(folder / "again.png"));
  expectRefusal(run("bake @a.fvx @b.fvx"), ExitCode::Usage, "--keep-scalars");
}

TEST_F(BakeCommand, InfoPrintsAndChecksAFile) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 40x24x32 --density-scale 7 --quiet"));
  const ProgramResult text = run("info @a.fvx --check");
  expectSuccess(text);
  for (const char* part : {"format 1.4", "40x24x32", "float16", "fixed", "chunk index", "all checksums are right"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in " << text.out;
  const nlohmann::json json = nlohmann::json::parse(run("info @a.fvx --json").out);
  EXPECT_EQ(json["description"]["classification"]["density_scale"], 7.0);
  EXPECT_EQ(json["provenance"]["options"]["resolution"], "40x24x32");
  std::string bytes = readBytes(folder / "a.fvx");
  bytes[bytes.size() - 4096] = char(bytes[bytes.size() - 4096] ^ 1);
  writeBytes(folder / "a.fvx", bytes);
  expectRefusal(run("info @a.fvx --check"), ExitCode::Input, "damaged");
  expectRefusal(run("render @a.fvx @a.png --size 16 --quiet"), ExitCode::Input, "damaged");
  expectRefusal(run("info procedural:cloud --check"), ExitCode::Usage, "--check");
}

TEST_F(BakeCommand, ACoarserLevelIsDrawnWhereItShowsTheSameAndNotWhereMemoryIsShort) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 128 --quiet"));
  const std::string options = " --size 40 --unlit --float --quiet --lod 4";
  expectSuccess(run("render procedural:cloud @original.exr --resolution 128" + options));
  expectSuccess(run("render @a.fvx @far.exr --timings @t.json" + options));
  EXPECT_LT(nlohmann::json::parse(readBytes(folder / "t.json"))["voxels"], 128 * 128 * 128 / 7);
  EXPECT_GE(psnr(image("far.exr"), image("original.exr")), kSameFromAfar);
  expectRefusal(run("render @a.fvx @near.exr --size 64 --unlit --quiet --memory-limit 4"), ExitCode::OutOfMemory, "--memory-limit");
}

/// A part of the volume, close up, so that its voxels are needed.
TEST_F(BakeCommand, WhatDoesNotFitIsDrawnCubeByCubeAsTheWholeVolumeIs) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 192 --quiet"));
  const std::string render = "render @a.fvx --size 40 --camera-position 3,1,2 --look-at 0,0,0 --fov 2 --float ";
  expectSuccess(run(render + "@whole.exr --quiet"));
  ASSERT_GT(largestPixelDifference(image("whole.exr"), Image{.size = {40, 40}, .pixels = std::vector<glm::vec4>(1600)}), 0.1);
  std::vector<Image> inCubes;
  for (const int limit : {48, 64, 256}) {
    const ProgramResult result = run(render + fmt::format("@limited.exr --verbose --memory-limit {}", limit));
    expectSuccess(result);
    EXPECT_GE(psnr(image("limited.exr"), image("whole.exr")), 60.0) << limit;
    if (result.err.find("cube by cube: the volume does not fit") != std::string::npos) inCubes.push_back(image("limited.exr"));
  }
  ASSERT_GE(inCubes.size(), 2u);
  for (const Image& image : inCubes) EXPECT_EQ(image.pixels, inCubes.front().pixels);

  expectRefusal(run(render + "@table.exr --light-attenuation table --quiet --memory-limit 48"), ExitCode::OutOfMemory,
                "shadows from the table need");
}

TEST_F(BakeCommand, SharesOfWhatDoesNotFitAddUpToTheSameBitsHoweverManyThereAre) {
  expectSuccess(run("bake procedural:cloud @a.fvx --resolution 192 --quiet"));
  const std::string render = "render @a.fvx --size 40 --camera-position 3,1,2 --look-at 0,0,0 --fov 2 --quiet --memory-limit ";
  expectSuccess(run(render + "48 @frame.exr --float"));
  expectSuccess(run(render + "48 @shares.exr --share 0/1 --float"));
  EXPECT_GE(psnr(image("shares.exr"), image("frame.exr")), 60.0);
  for (const std::string part : {"0", "1", "2"})
    expectSuccess(run(render + (part == "1" ? "64" : "48") + " @part" + part + ".exr --sums --share " + part + "/3"));
  expectSuccess(run("merge @part0.exr @part1.exr @part2.exr @merged.exr --float --quiet"));
  EXPECT_EQ(largestPixelDifference(image("merged.exr"), image("shares.exr")), 0.0);
}

TEST_F(BakeCommand, BadOutputsAreRefused) {
  expectCleanRefusal("bake procedural:cloud @a.vdb", ExitCode::Usage, ".fvx");
  expectCleanRefusal("bake procedural:cloud @missing/a.fvx", ExitCode::Output, "missing");
  expectCleanRefusal("bake procedural:cloud", ExitCode::Usage, "OUT.fvx");
}

TEST_F(BakeCommand, AnInterruptedBakeLeavesNothing) {
  for (const int signal : {SIGINT, SIGKILL}) {
    runAndInterrupt(words("bake procedural:cloud @a.fvx --resolution 400 --quiet"), signal, 400);
    EXPECT_EQ(folder.fileCount(), 0u) << "signal " << signal;
  }
}

TEST_F(BakeCommand, RealFogVolumesDrawTheSameImageTo60Decibels) {
  if (!std::filesystem::is_directory(kData)) GTEST_SKIP() << "there are no real volumes in " << kData;
  for (const std::string name : {"wdas_cloud_sixteenth", "smoke1", "dragon_with_xform"}) {
    const std::string file = (kData / (name + ".vdb")).string();
    if (!std::filesystem::exists(file)) continue;
    SCOPED_TRACE(name);
    expectSuccess(run("bake " + file + " @a.fvx --quiet"));
    expectSuccess(run("render " + file + " @original.exr --size 64 --unlit --quiet --float"));
    expectSuccess(run("render @a.fvx @baked.exr --size 64 --unlit --quiet --float"));
    EXPECT_GE(psnr(image("baked.exr"), image("original.exr")), kSameImage);
  }
}

}  // namespace

}  // namespace freevoxels::test
