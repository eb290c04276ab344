// freevoxels render, done well.

#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "engine/volume/openvdb_trees.h"
#include "engine/volume/procedural.h"
#include "tests/commands/render_fixture.h"

namespace freevoxels::test {

TEST_F(RenderCommand, WritesEveryOutputAndPrintsItsPath) {
  const ProgramResult result = run(std::string("render procedural:cloud @a.exr @b.png @c.EXR") + kSmall);
  expectSuccess(result);
  std::string expected;
  for (const char* name : {"a.exr", "b.png", "c.EXR"}) expected += (folder / name).string() + "\n";
  EXPECT_EQ(result.out, expected);
  EXPECT_EQ(folder.fileCount(), 3u);
  EXPECT_EQ(readBytes(folder / "a.exr"), readBytes(folder / "c.EXR"));

  const Image image = readExr(folder / "a.exr");
  ASSERT_EQ(image.size, glm::ivec2(64, 48));
  EXPECT_GT(image.pixels[64 * 24 + 32].a, 0.3f);  // the volume is in the middle
  EXPECT_EQ(image.pixels[0], glm::vec4(0.0f));    // and leaves the corners free
}

TEST_F(RenderCommand, WithoutAnOutputItIsTheVolumesNameInTheCurrentFolder) {
  const std::filesystem::path before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  const ProgramResult result = run(std::string("render procedural:cloud") + kSmall), turn = run(std::string("turntable procedural:cube --frames 2") + kSmall);
  std::filesystem::current_path(before);
  expectSuccess(result);
  EXPECT_EQ(result.out, "cloud.png\n");
  expectSuccess(turn);
  EXPECT_EQ(turn.out, "cube_0000.png\ncube_0001.png\n");
  EXPECT_EQ(folder.fileCount(), 3u);
}

TEST_F(RenderCommand, OutputsMayBeOptions) {
  expectSuccess(run(std::string("render procedural:cloud -o @a.exr --output @b.png") + kSmall));
  EXPECT_EQ(folder.fileCount(), 2u);
}

TEST_F(RenderCommand, ColoursMayBeNamesOrSrgb) {
  const std::string numbers = render("--unlit --albedo 1,0.2158605,0", "numbers.exr");
  const Image named = readExr(folder / "numbers.exr");
  render("--unlit --albedo #ff8000", "srgb.exr");
  render("--unlit --albedo orange", "orange.exr");
  const Image srgb = readExr(folder / "srgb.exr"), orange = readExr(folder / "orange.exr");
  const std::size_t middle = 32 + 64 * 24;
  EXPECT_GT(named.pixels[middle].g, 0.1f);
  EXPECT_NEAR(srgb.pixels[middle].g, named.pixels[middle].g, 2e-3);
  EXPECT_NEAR(orange.pixels[middle].g / orange.pixels[middle].r, 0.3762621, 2e-3);
}

TEST_F(RenderCommand, OneNumberIsASquare) {
  expectSuccess(run("render procedural:cube @a.exr --resolution 8 --size 20"));
  EXPECT_EQ(readExr(folder / "a.exr").size, glm::ivec2(20));
}

TEST_F(RenderCommand, WarnsWhereNothingIsSeen) {
  const ProgramResult away = run("render procedural:cube @a.png --resolution 8 --size 20 --camera-position 9,9,9 --look-at 20,20,20");
  expectSuccess(away);
  EXPECT_NE(away.err.find("warning: nothing is seen: the camera looks past"), std::string::npos) << away.err;
  const ProgramResult clear = run("render procedural:cube @b.png --resolution 8 --size 20 --density-scale 0");
  expectSuccess(clear);
  EXPECT_NE(clear.err.find("warning: nothing is seen: all voxels are transparent"), std::string::npos) << clear.err;
}

TEST_F(RenderCommand, EveryProceduralVolumeShows) {
  for (const ProceduralKind& kind : proceduralKinds()) {
    SCOPED_TRACE(kind.name);
    expectSuccess(run("render procedural:" + std::string(kind.name) + " @a.exr" + kSmall));
    const Image image = readExr(folder / "a.exr");
    const auto visible = std::ranges::count_if(image.pixels, [](glm::vec4 pixel) { return pixel.a > 0.1f; });
    EXPECT_GT(visible, 64 * 48 / 20);
  }
}

/// From the upper left of the first view, and no more than one option says it.
TEST_F(RenderCommand, WithoutLightOptionsThereIsAKeyLightAndAmbientLight) {
  const auto shells = [&](const std::string& options, const std::string& file) {
    expectSuccess(run("render procedural:shells @" + file + kSmall + options));
    return readBytes(folder / file);
  };
  const std::string lit = shells("--orbit 0,0", "a.exr");
  EXPECT_EQ(exrAttribute(lit, "freevoxels:ambient"), "0.12,0.12,0.12");
  EXPECT_EQ(exrAttribute(lit, "freevoxels:scattering"), "all");
  const Image image = readExr(folder / "a.exr");
  float upperLeft = 0.0f, lowerRight = 0.0f;  // of opaque pixels
  int pixels[2] = {0, 0};
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) {
      const glm::vec4 pixel = image.pixels[std::size_t(x + 64 * y)];
      if (pixel.a < 0.95f || (x < 32) != (y < 24)) continue;
      (x < 32 ? upperLeft : lowerRight) += pixel.g;
      ++pixels[x < 32 ? 0 : 1];
    }
  EXPECT_GT(upperLeft / float(pixels[0]), 1.2f * lowerRight / float(pixels[1]));
  const std::string light = exrAttribute(lit, "freevoxels:light");
  EXPECT_NE(exrAttribute(shells("--orbit 90,0", "b.exr"), "freevoxels:light"), light);
  expectSuccess(run("render procedural:shells @b.exr --orbit 0,0 --ambient 0.12 --light " + light + kSmall));
  EXPECT_EQ(readExr(folder / "b.exr").pixels, image.pixels);
  const std::string unlit = shells("--unlit", "b.exr");
  EXPECT_EQ(exrAttribute(unlit, "freevoxels:unlit"), "yes");
  EXPECT_EQ(exrAttribute(unlit, "freevoxels:light"), "");
}

TEST_F(RenderCommand, TheSameCommandGivesTheSameBytes) {
  const std::string first = render("--aov depth", "a.exr");
  EXPECT_EQ(first, render("--aov depth", "b.exr"));
  EXPECT_EQ(render("", "a.png"), render("", "b.png"));
}

/// Under validation all goes through staging buffers, as on a GPU; without, lavapipe's memory is mapped.
TEST_F(RenderCommand, GivesTheSameBytesWithoutValidation) {
  const std::string options = " --light direction=1,1,0.5 --ambient 0.2 --lod 4";
  const std::string validated = render(options);
  Arguments arguments{"-u", "FREEVOXELS_VALIDATION", FREEVOXELS_PROGRAM};
  std::ranges::copy(words("render procedural:cloud @b.exr" + std::string(kSmall) + options),
                    std::back_inserter(arguments));
  expectSuccess(runProgramFile("/usr/bin/env", arguments));
  EXPECT_EQ(readBytes(folder / "b.exr"), validated);
}

TEST_F(RenderCommand, AFileLooksAsTheVolumeItWasGeneratedFrom) {
  expectSuccess(run("generate cube @cube.vdb --resolution 24 --quiet"));
  const std::string camera =
      " --size 64x48 --density-scale 5 --camera-position 1,2,3 --look-at 0,0,0 --float";
  expectSuccess(run("render @cube.vdb @file.exr" + camera));
  expectSuccess(run("render procedural:cube @made.exr --resolution 24" + camera));
  const Image file = readExr(folder / "file.exr"), made = readExr(folder / "made.exr");
  for (std::size_t i = 0; i < file.pixels.size(); ++i)
    for (int c = 0; c < 4; ++c) ASSERT_NEAR(file.pixels[i][c], made.pixels[i][c], 1e-4f) << "pixel " << i;
}

TEST_F(RenderCommand, DefaultsAreWhatTheHelpSays) {
  const std::string standard = render("");
  EXPECT_EQ(standard, render("--orbit 35,25 --fov 35 --up 0,1,0 --albedo 0.9,0.9,0.9"));
  EXPECT_EQ(standard, render("--composite normalised --directions 26 --code depth8 "
                             "--path-length-correction"));
  EXPECT_EQ(standard, render("--fov 60 --fov 35"));  // the last counts
  EXPECT_NE(standard, render("--orbit 36,25"));
  EXPECT_NE(standard, render("--attenuation nearest"));
  EXPECT_NE(standard, render("--directions 98"));
  EXPECT_NE(standard, render("--code linear8"));
  EXPECT_NE(standard, render("--no-path-length-correction"));
}

TEST_F(RenderCommand, PaperIsEightOptionsAndYieldsToEach) {
  const std::string eight =
      "--composite additive --attenuation nearest --directions 26 --code linear8 --no-path-length-correction "
      "--no-gradient --lod 0 --no-culling";
  EXPECT_EQ(render("--paper"), render(eight));
  EXPECT_EQ(render("--paper --composite normalised"), render(eight.substr(eight.find("--attenuation"))));
  EXPECT_EQ(exrAttribute(render("--paper --lod 2.5"), "freevoxels:lod"), "2.5");
  EXPECT_EQ(exrAttribute(render("--paper --culling"), "freevoxels:culling"), "yes");
  EXPECT_EQ(exrAttribute(render("--paper --directions 98"), "freevoxels:directions"), "98");
  EXPECT_EQ(exrAttribute(render("--paper --path-length-correction"), "freevoxels:path-length-correction"),
            "yes");
}

/// It leaks, so that it is another image, and has no use for the table.
TEST_F(RenderCommand, SortedIsAnotherImageWithoutTheTable) {
  const auto pixels = [&](const std::string& options) {
    render(options + " --unlit --float --aov depth");
    return readExr(folder / "a.exr");
  };
  const Image sorted = pixels("--composite sorted"), normalised = pixels("--draw splats");
  EXPECT_NE(sorted.pixels, normalised.pixels);
  for (std::size_t i = 0; i < sorted.pixels.size(); ++i)
    ASSERT_LE(sorted.pixels[i].a, normalised.pixels[i].a + 0.01f) << "pixel " << i;
  const Image paper = pixels("--paper --composite sorted");
  EXPECT_EQ(sorted.pixels, paper.pixels);
  EXPECT_EQ(sorted.depth, paper.depth);
  EXPECT_EQ(exrAttribute(render("--composite sorted"), "freevoxels:composite"), "sorted");
}

TEST_F(RenderCommand, LevelOfDetailDrawsFewerBlocks) {
  const auto drawn = [&](const std::string& options) {
    render(options + " --draw splats --timings " + (folder / "t.json").string());
    std::ifstream file(folder / "t.json");
    return nlohmann::json::parse(file).at("blocks").at("drawn").get<std::vector<std::uint64_t>>();
  };
  const auto voxels = drawn("--lod 0"), blocks = drawn("--lod 64");
  EXPECT_EQ(voxels.size(), 1u);
  ASSERT_GT(blocks.size(), 1u);
  EXPECT_LT(blocks.back(), voxels[0]);
  EXPECT_NE(render("--draw splats --lod 64"), render("--draw splats --lod 64 --hierarchy-filter arithmetic"));
  EXPECT_EQ(exrAttribute(render("--hierarchy-filter arithmetic"), "freevoxels:hierarchy-filter"),
            "arithmetic");
}

TEST_F(RenderCommand, CameraOptionsMoveTheCamera) {
  const std::string standard = render("");
  for (const char* options : {"--camera-position 0,0,3", "--look-at 0.2,0,0", "--fov 60", "--orthographic 1",
                              "--up 1,0,0", "--orbit 0,90", "--camera-position -.5,-1e1,+3 --look-at 0,0,.1"})
    EXPECT_NE(standard, render(options)) << options;
}

TEST_F(RenderCommand, TransferFunctionColoursTheImage) {
  writeBytes(folder / "red.json", R"({"opacity":[[0,0],[1,0.5]],"color":[[0,1,0,0],[1,1,0,0]]})");
  render("--transfer-function " + (folder / "red.json").string());
  float red = 0.0f, green = 0.0f;
  for (const glm::vec4 pixel : readExr(folder / "a.exr").pixels) {
    red = std::max(red, pixel.r);
    green = std::max(green, pixel.g);
  }
  EXPECT_GT(red, 0.3f);
  EXPECT_EQ(green, 0.0f);
}

TEST_F(RenderCommand, ScansGetATransferFunctionThatTheExrRepeats) {
  const std::string volume = "render procedural:marschner-lobb @";
  const ProgramResult first = run(volume + "a.exr" + kSmall);
  expectSuccess(first);
  EXPECT_NE(first.err.find("marschner-lobb looks like a scan"), std::string::npos) << first.err;
  const std::string function = exrAttribute(readBytes(folder / "a.exr"), "freevoxels:transfer-function");
  ASSERT_TRUE(function.starts_with("{")) << function;
  writeBytes(folder / "t.json", function);
  const ProgramResult again = run(volume + "b.exr --transfer-function @t.json" + kSmall);
  expectSuccess(again);
  EXPECT_EQ(again.err.find("looks like a scan"), std::string::npos) << again.err;
  EXPECT_EQ(readExr(folder / "a.exr").pixels, readExr(folder / "b.exr").pixels);

  const ProgramResult fog = run(volume + "b.exr --density-scale 2" + kSmall);
  expectSuccess(fog);
  EXPECT_EQ(fog.err.find("looks like a scan"), std::string::npos) << fog.err;
  EXPECT_EQ(exrAttribute(readBytes(folder / "b.exr"), "freevoxels:transfer-function"), "");
}

TEST_F(RenderCommand, ALevelSetIsAnOpaqueSurface) {
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(1.0f, {}, 0.05f);
  openvdb::io::File((folder / "sphere.vdb").string()).write(openvdb::GridCPtrVec{sphere});
  const ProgramResult result = run("render @sphere.vdb @a.exr --size 64x48");
  expectSuccess(result);
  EXPECT_EQ(result.err.find("looks like a scan"), std::string::npos) << result.err;
  EXPECT_NEAR(std::stod(exrAttribute(readBytes(folder / "a.exr"), "freevoxels:density-scale")), 60.0, 1e-4);
  EXPECT_GT(readExr(folder / "a.exr").pixels[64 * 24 + 32].a, 0.999f);
}

TEST_F(RenderCommand, WarnsOnceOfBadValues) {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  grid->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(7)), 1.0f);
  grid->tree().setValueOn(openvdb::Coord(1, 2, 3), std::numeric_limits<float>::quiet_NaN());
  for (int i = 0; i < 3; ++i) grid->tree().setValueOn(openvdb::Coord(i, 5, 5), -0.5f);
  openvdb::io::File((folder / "bad.vdb").string()).write(openvdb::GridCPtrVec{grid});

  const auto warnings = [](const std::string& text) {
    std::size_t count = 0;
    for (std::size_t at = 0; (at = text.find("freevoxels: warning: ", at)) != std::string::npos; ++at)
      ++count;
    return count;
  };
  const ProgramResult physical = run("render @bad.vdb @a.png --size 32x32 --density-scale 1");
  expectSuccess(physical);
  EXPECT_EQ(warnings(physical.err), 2u) << physical.err;
  EXPECT_NE(physical.err.find("warning: 1 voxel"), std::string::npos) << physical.err;
  EXPECT_NE(physical.err.find("warning: 3 voxels"), std::string::npos) << physical.err;

  writeBytes(folder / "t.json", R"({"opacity":[[0,0],[1,0.5]],"color":[[0,1,1,1]]})");
  const ProgramResult mapped = run("render @bad.vdb @a.png --size 32x32 --transfer-function @t.json");
  expectSuccess(mapped);
  EXPECT_EQ(warnings(mapped.err), 1u) << mapped.err;  // negative scalars are data there
}

TEST_F(RenderCommand, LightBeyondTheRangeOfNumbersMakesBlackPixelsAndAWarning) {
  const ProgramResult result = run(
      "render procedural:fire @a.exr --float --resolution 12 --size 24 --albedo 1,1,1 --emission 1e38 --orthographic 1e6 --draw splats "
      "--light position=1e-10,0.5,1e38,intensity=1e-30");
  expectSuccess(result);
  EXPECT_NE(result.err.find("beyond the range of numbers"), std::string::npos) << result.err;
  for (const glm::vec4& pixel : readExr(folder / "a.exr").pixels) EXPECT_TRUE(std::isfinite(pixel.r + pixel.g + pixel.b + pixel.a));
}

TEST_F(RenderCommand, AClippedVolumeIsTheVolumeWithoutTheRest) {
  // The cut is within a brick of 8 voxels.
  expectSuccess(run("render procedural:cube @half.exr --resolution 16 --density-scale 3 --unlit --camera-position 0,0,3 --look-at "
                    "0,0,0 --size 64 --clip-box 0,0,0,6,15,99 --save-scene @half.json --quiet"));
  const Image half = readExr(folder / "half.exr");
  const auto alpha = [&](int x) { return half.pixels[std::size_t(32 * 64 + x)].a; };
  EXPECT_GT(alpha(28), 0.5f);
  EXPECT_LT(alpha(36), 0.01f) << "the right half is gone";
  expectSuccess(run("render --scene @half.json @again.exr --quiet"));
  EXPECT_TRUE(readBytes(folder / "half.exr") == readBytes(folder / "again.exr"));
  for (const char* box : {"0,0,0,1,2", "5,0,0,4,9,9", "99,0,0,100,9,9", "-1,0,0,5,5,5", "a,0,0,1,1,1"})
    expectCleanRefusal(std::string("render procedural:cube @none.exr --resolution 16 --clip-box ") + box, ExitCode::Usage, "--clip-box");
}

TEST_F(RenderCommand, APlaneClipsWhatIsInFrontOfIt) {
  const std::string view = "render procedural:cube --resolution 16 --density-scale 3 --unlit --camera-position 0,0,3 --look-at 0,0,0 "
                           "--size 64 --quiet ";
  // Behind the plane x + y = 0 is what is left of and below a diagonal of the image.
  expectSuccess(run(view + "@half.exr --clip-plane 0,0,0,2,2,0 --save-scene @half.json"));
  const Image half = readExr(folder / "half.exr");
  const auto alpha = [&](int x, int y) { return half.pixels[std::size_t(y * 64 + x)].a; };
  EXPECT_GT(alpha(26, 38), 0.5f);
  EXPECT_GT(alpha(38, 38), 0.0f) << "on the diagonal";
  EXPECT_LT(alpha(38, 26), 0.01f);
  expectSuccess(run("render --scene @half.json @again.exr --quiet"));
  EXPECT_TRUE(readBytes(folder / "half.exr") == readBytes(folder / "again.exr"));
  for (const char* plane : {"0,0,0,1,0", "0,0,0,0,0,0", "-9,0,0,1,0,0", "0,0,nan,1,0,0"})
    expectCleanRefusal(view + "@none.exr --clip-plane " + plane, ExitCode::Usage, "--clip-plane");
}

}  // namespace freevoxels::test
