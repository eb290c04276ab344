// Scans as a user draws them.

#include <nlohmann/json.hpp>

#include "engine/image/image.h"
#include "tests/commands/program_runner.h"
#include "tests/volume/scan_fixture.h"

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

}  // namespace

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
  for (const char* part : {"DICOM series of 10 slices", "uint16", "x 1 + -1024", "2 3 2.5", "13x9x10", "3..1000"})
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
  expectSuccess(run("render @a_#.nrrd @film_#.exr --quiet --unlit --size 64 --density-scale 0.0002 --no-fixed-view"));
  EXPECT_EQ(readExr(folder / "film_2.exr").pixels, whole.pixels);
}

}  // namespace freevoxels::test
