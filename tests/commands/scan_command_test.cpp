// Scans as a user draws them.

#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"
#include "tests/commands/viewer_fixture.h"
#include "tests/volume/scan_fixture.h"
#include "tests/volume/tiff_fixture.h"
#include "tests/volume/zarr_fixture.h"

namespace freevoxels::test {

namespace {

constexpr int kEdge = 64;

ScanPlace placeOf(const std::string& axes) {
  return placeAlong(axes, {13, 9, 10}, {2.0, 3.0, 2.5});
}

/// How much of a quarter of the image is seen: 0 top left, 1 top right, 2 bottom left, 3 bottom right.
std::array<double, 4> quartersOf(const Image& image) {
  std::array<double, 4> quarters{};
  for (int y = 0; y < kEdge; ++y)
    for (int x = 0; x < kEdge; ++x)
      quarters[std::size_t(2 * (2 * y / kEdge) + 2 * x / kEdge)] += double(image.pixels[std::size_t(y * kEdge + x)].a);
  return quarters;
}

class ScanCommand : public CommandTest {
 protected:
  Image draw(const std::string& volume, const std::string& options = "") const {
    expectSuccess(run("render @" + volume + " @a.exr --quiet --unlit --size 64 --density-scale 0.0002 " + options));
    return readExr(folder / "a.exr");
  }

  /// Whoever looks at the face sees an L, upright.
  void expectLetter(const std::string& volume) const {
    SCOPED_TRACE(volume);
    const auto [topLeft, topRight, bottomLeft, bottomRight] = quartersOf(draw(volume, "--orbit 0,0"));
    EXPECT_GT(topLeft, 50.0);
    EXPECT_GT(topLeft, 4.0 * topRight);
    EXPECT_GT(bottomLeft, topLeft);
    EXPECT_GT(bottomRight, 2.0 * topRight);
  }
};

/// Two channels, left half red and right half green, of 16 x 16 x 8 voxels and of half as many along x and y.
ZarrFiles cellsOf() {
  ZarrFiles files;
  ZarrFixture array{.shape = {2, 8, 16, 16}, .chunk = {1, 8, 16, 16}};
  array.valueAt = [&](ZarrPlace v) { return (v[0] == 0) == (v[3] < array.shape[3] / 2) ? 1000 : 0; };
  array.addSecond(files, "0");
  array.shape = {2, 8, 8, 8};
  array.addSecond(files, "1");
  const nlohmann::json omero{{"channels", {omeroChannel("left", "FF0000", true, 0, 1000), omeroChannel("right", "00FF00", true, 0, 1000)}}};
  addImage(files, {{"multiscales", multiscalesOf(2)}, {"omero", omero}});
  return files;
}

}  // namespace

TEST_F(ScanCommand, ChannelsOfOmeZarrAreDrawnInTheirColours) {
  writeBytes(folder / "cells.ome.zarr.zip", zipOf(cellsOf(), true));
  const auto drawn = [&](const std::string& options) {
    expectSuccess(run("render @cells.ome.zarr.zip @a.exr --quiet --unlit --size 64 --orbit 0,0 " + options));
    return readExr(folder / "a.exr");
  };
  const Image image = drawn("");
  // Azimuth 0 looks at a patient's face: +x is on the right.
  const glm::vec4 left = image.pixels[32 * kEdge + 20], right = image.pixels[32 * kEdge + 44];
  EXPECT_GT(left.r, 0.1f);
  EXPECT_NEAR(left.g, 0.0f, 1e-3f);
  EXPECT_GT(right.g, 0.1f);
  EXPECT_NEAR(right.r, 0.0f, 1e-3f);
  const glm::vec4 middle = drawn("--channel right").pixels[32 * kEdge + 32];  // of what is seen
  EXPECT_GT(middle.g, 0.1f);
  EXPECT_NEAR(middle.r, 0.0f, 1e-3f);
  expectCleanRefusal("render @cells.ome.zarr.zip @b.png --size 16 --transfer-function {\"opacity\":[[0,0],[1,1]],\"color\":[[0,1,1,1]]}",
                     ExitCode::Usage, "--grid");
  expectCleanRefusal("render @cells.ome.zarr.zip @b.png --size 16 --grid middle", ExitCode::Input, "0 'left', 1 'right'");
  const nlohmann::json json = nlohmann::json::parse(run("info @cells.ome.zarr.zip --json --pyramid-level 1").out);
  EXPECT_EQ(json["scan"]["levels"], nlohmann::json({{16, 16, 8}, {8, 8, 8}}));
  EXPECT_EQ(json["scan"]["level"], 1);
  EXPECT_EQ(json["scan"]["channels"][1]["name"], "right");
  EXPECT_EQ(json["grids"].size(), 2u);
  const std::string info = run("info @cells.ome.zarr.zip").out;
  for (const char* part : {"channels    0 left, 1 right", "space       millimetres along the axes of the file"})
    EXPECT_NE(info.find(part), std::string::npos) << part << " in\n" << info;
}

TEST_F(ScanCommand, LayersOfChannelsHaveTheColoursOfTheFile) {
  writeBytes(folder / "cells.zip", zipOf(cellsOf(), false));
  expectSuccess(run("render @cells.zip @b.exr --quiet --unlit --size 32"));
  const Image whole = readExr(folder / "b.exr");
  for (const char* channels : {"--channel left --channel right ", ""}) {
    expectSuccess(run(std::string("render @cells.zip @a.exr --quiet --unlit --size 32 --aov channels ") + channels));
    const Image layers = readExr(folder / "a.exr");
    for (std::size_t i = 0; i < whole.pixels.size(); ++i)
      for (int c = 0; c < 3; ++c) ASSERT_NEAR(layers.pixels[i][c], whole.pixels[i][c], 0.01f) << i;  // some rays are interpolated
  }
  writeBytes(folder / "one.nrrd", nrrdOf(placeOf("LPS")));
  expectCleanRefusal("render @one.nrrd @c.exr --size 16 --unlit --aov channels", ExitCode::Usage, "--channel");
}

TEST_F(ScanCommand, PhotographsAreDrawnInTheirColours) {
  std::string pixels;
  for (int i = 0; i < 16 * 16; ++i) pixels += i % 16 < 8 ? std::string("\xc8\x14\x14", 3) : std::string("\x14\xb4\x14", 3);
  TiffFixture stack{.pages = 8, .samples = 3, .photometric = 2, .size = {16, 16}, .hasBytes = true};
  std::string file = stack.bytes();
  for (int page = 0; page < stack.pages; ++page) {
    const std::string values = stack.valuesOf(page);
    file.replace(file.find(values), values.size(), pixels);
  }
  writeBytes(folder / "body_1.tif", file);
  writeBytes(folder / "body_2.tif", file);
  const std::string options = " --quiet --unlit --size 64 --orbit 0,0 ";
  expectSuccess(run("render @body_1.tif @a.exr --save-scene @a.json" + options));
  const Image image = readExr(folder / "a.exr");
  const glm::vec4 left = image.pixels[32 * kEdge + 20], right = image.pixels[32 * kEdge + 44];
  EXPECT_GT(left.r, 20.0f * left.g);
  EXPECT_GT(right.g, 20.0f * right.r);
  expectSuccess(run("bake @body_1.tif @a.fvx --quiet"));
  expectSuccess(run("render @a.fvx @b.exr" + options));
  expectSuccess(run("render --scene @a.json @c.exr" + options));
  expectSuccess(run("render @body_#.tif @film_#.exr --no-fixed-view" + options));
  EXPECT_EQ(readExr(folder / "c.exr").pixels, image.pixels);
  EXPECT_EQ(readExr(folder / "film_2.exr").pixels, image.pixels);
  const Image baked = readExr(folder / "b.exr");
  for (std::size_t i = 0; i < image.pixels.size(); ++i) ASSERT_NEAR(baked.pixels[i].r, image.pixels[i].r, 0.02f) << i;
  const glm::vec4 grey = [&] {
    expectSuccess(run("render @body_1.tif @d.exr --albedo 0.5,0.5,0.5" + options));
    return readExr(folder / "d.exr").pixels[32 * kEdge + 20];
  }();
  EXPECT_EQ(grey.r, grey.g);
  expectCleanRefusal("render @body_1.tif @e.png --size 16 --albedo-grid Cd", ExitCode::Usage, "albedo-grid");
  EXPECT_NE(run("info @body_1.tif").out.find("0 red, 1 green, 2 blue; they are colours"), std::string::npos);
}

TEST_F(ScanCommand, ConvertedVolumesAreTheSameImages) {
  writeBytes(folder / "a.nii", niftiOf(placeOf("PSR")));
  const Image image = draw("a.nii");
  for (const char* name : {"b.nrrd", "b.nii.gz", "b.vdb"}) {
    SCOPED_TRACE(name);
    const ProgramResult result = run(std::string("convert @a.nii @") + name);
    EXPECT_EQ(result.exitCode, 0) << result.err;
    EXPECT_NE(result.out.find(name), std::string::npos);
    const Image again = draw(name, "--up 0,0,1");
    double worst = 0.0;
    for (std::size_t i = 0; i < image.pixels.size(); ++i) worst = std::max(worst, double(std::abs(again.pixels[i].a - image.pixels[i].a)));
    EXPECT_LT(worst, 2e-3);
  }
  expectCleanRefusal("convert @a.nii @c.obj", ExitCode::Usage, ".nrrd");
  expectCleanRefusal("convert @a.nii @a.nii", ExitCode::Usage, "replaced");
  expectCleanRefusal("convert @a.nii", ExitCode::Usage, "OUT");
}

TEST_F(ScanCommand, ChannelsBecomeGridsOfOpenVdb) {
  writeBytes(folder / "cells.zip", zipOf(cellsOf(), true));
  expectSuccess(run("convert @cells.zip @cells.vdb --quiet"));
  const nlohmann::json json = nlohmann::json::parse(run("info @cells.vdb --json").out);
  EXPECT_EQ(json["grids"][0]["name"], "left");
  EXPECT_EQ(json["grids"][1]["name"], "right");
  EXPECT_EQ(json["grids"][1]["range"][1], 1000.0);
  expectCleanRefusal("convert @cells.zip @c.nrrd", ExitCode::Usage, "--grid");
  expectSuccess(run("convert @cells.zip @right.nrrd --quiet --grid right --pyramid-level 1"));
  EXPECT_EQ(nlohmann::json::parse(run("info @right.nrrd --json").out)["grids"][0]["dimensions"], nlohmann::json({8, 8, 8}));
}

TEST_F(ScanCommand, BakedScalarsAndProceduralVolumesAreConverted) {
  expectSuccess(run("convert procedural:head @head.nrrd --quiet --resolution 16"));
  expectSuccess(run("bake procedural:head @head.fvx --quiet --resolution 16 --keep-scalars"));
  expectSuccess(run("convert @head.fvx @again.nrrd --quiet"));
  EXPECT_EQ(readBytes(folder / "again.nrrd"), readBytes(folder / "head.nrrd"));
  expectSuccess(run("bake procedural:head @fixed.fvx --quiet --resolution 16"));
  expectCleanRefusal("convert @fixed.fvx @b.nrrd", ExitCode::Input, "--keep-scalars");
}

TEST_F(ScanCommand, TheFaceIsSeenUprightInEveryFormat) {
  writeBytes(folder / "a.nrrd", nrrdOf(placeOf("RAS")));
  writeBytes(folder / "a.nii", niftiOf(placeOf("PSR")));
  writeBytes(folder / "a.mha", metaHeader(placeOf("LIP"), "MET_USHORT", "LOCAL") + bytesOf<std::uint16_t>(letterOf(placeOf("LIP"))));
  writeBytes(folder / "a.vtk", vtkOf(placeOf("LPS")));
  writeDicom(folder / "ct", placeOf("RPI"));
  for (const char* volume : {"a.nrrd", "a.nii", "a.mha", "a.vtk", "ct"}) expectLetter(volume);
}

TEST_F(ScanCommand, AzimuthNinetySeesTheLeftSide) {
  writeBytes(folder / "a.nrrd", nrrdOf(placeOf("LPS")));
  const auto [topLeft, topRight, bottomLeft, bottomRight] = quartersOf(draw("a.nrrd", "--orbit 90,0"));
  EXPECT_NEAR(topLeft, topRight, 0.1 * topLeft + 1.0);  // the letter, from its foot
  EXPECT_GT(bottomLeft, topLeft);
  EXPECT_GT(bottomRight, topRight);
}

TEST_F(ScanCommand, InfoPrintsWhatTheHeaderSays) {
  writeDicom(folder / "ct", placeOf("LPS"));
  const ProgramResult text = run("info @ct");
  for (const char* part : {"DICOM series of 10 slices", "uint16", "x 1 + -1024", "2 3 2.5", "13x9x10", "3..1000", "(LPS)"})
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in\n" << text.out;
  const nlohmann::json json = nlohmann::json::parse(run("info @ct --json").out);
  EXPECT_EQ(json["scan"]["rescale"], nlohmann::json({1.0, -1024.0}));
  EXPECT_EQ(json["scan"]["spacing"], nlohmann::json({2.0, 3.0, 2.5}));
  EXPECT_EQ(json["grids"][0]["range"], nlohmann::json({3.0, 1000.0}));
}

TEST_F(ScanCommand, BakedAndNumberedScansAreTheSameImages) {
  writeBytes(folder / "a_1.nrrd", nrrdOf(placeOf("RAS")));
  writeBytes(folder / "a_2.nrrd", nrrdOf(placeOf("LPS")));
  const Image whole = draw("a_2.nrrd");
  expectSuccess(run("bake @a_2.nrrd @a.fvx --quiet --density-scale 0.0002"));
  expectSuccess(run("render @a.fvx @b.exr --quiet --unlit --size 64"));
  EXPECT_EQ(readExr(folder / "b.exr").size, whole.size);
  writeBytes(folder / "a.bin", bytesOf<std::uint16_t>(letterOf(placeOf("LPS"))));
  expectSuccess(run("bake @a.bin @raw.fvx --quiet --density-scale 0.0002 --raw 13x9x10,u16 --spacing 2,3,2.5"));
  expectSuccess(run("render @raw.fvx @c.exr --quiet --unlit --size 64"));
  const glm::vec4 there = readExr(folder / "c.exr").pixels[40 * kEdge + 20], expected = whole.pixels[40 * kEdge + 20];
  EXPECT_NEAR(there.a, expected.a, 0.02f);
  expectSuccess(run("render @a_#.nrrd @film_#.exr --quiet --unlit --size 64 --density-scale 0.0002 --no-fixed-view"));
  EXPECT_EQ(readExr(folder / "film_2.exr").pixels, whole.pixels);
}

class ViewerOfScans : public Viewer {};

TEST_F(ViewerOfScans, AFolderOfSlicesIsOpenedAsAVolume) {
  std::filesystem::create_directories(folder / "slices");
  for (int i = 0; i < 3; ++i) writeBytes(folder / fmt::format("slices/{}.tif", i), TiffFixture{.firstPage = i}.bytes());
  const auto session = use("procedural:cloud --resolution 16");
  session->hands("windowsize @ 900 600");
  session->open("slices");
  session->hands("type --delay 1 .");
  session->hands("key Return mousemove 700 300");
  session->saveAll('e', "b.json", "slices/b.json");
  const nlohmann::json scene = nlohmann::json::parse(readBytes(folder / "slices/b.json"));
  EXPECT_EQ(scene.at("input").at("volume"), ".");
  expectQuietEnd(*session);
}

}  // namespace freevoxels::test
