// freevoxels render of films whose frames differ in what they have: sizes, fill, temperatures, grids.

#include <fmt/format.h>

#include <cmath>

#include "engine/image/image.h"
#include "engine/volume/openvdb_trees.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {
namespace {

constexpr const char* kSmall = " --size 48x40 --float";

openvdb::FloatGrid::Ptr box(const char* name, int edge, float value, openvdb::Coord first = openvdb::Coord(0)) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName(name);
  grid->denseFill({first, first + openvdb::Coord(edge - 1)}, value, true);
  return grid;
}

/// A ball of smoke that is denser in the middle.
openvdb::FloatGrid::Ptr ball(const char* name, int radius, float most) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto accessor = grid->getAccessor();
  for (int z = -radius; z <= radius; ++z)
    for (int y = -radius; y <= radius; ++y)
      for (int x = -radius; x <= radius; ++x)
        if (const float distance = std::sqrt(float(x * x + y * y + z * z)) / float(radius); distance < 1.0f)
          accessor.setValueOn({x, y, z}, most * (1.0f - distance));
  return grid;
}

class FilmCommand : public CommandTest {
 protected:
  void SetUp() override { openvdb::initialize(); }
  void write(int frame, const openvdb::GridCPtrVec& grids) const {
    openvdb::io::File((folder / fmt::format("f_{:04}.vdb", frame)).string()).write(grids);
  }
  ProgramResult draw(const std::string& options = "") const {
    return run("render @f_####.vdb @i_####.exr" + std::string(kSmall) + options);
  }
  Image image(int frame) const { return readExr(folder / fmt::format("i_{:04}.exr", frame)); }
  std::string attribute(int frame, const std::string& name) const {
    return exrAttribute(readBytes(folder / fmt::format("i_{:04}.exr", frame)), "freevoxels:" + name);
  }

  /// The largest alpha on the image's border, and in all of it.
  static std::pair<float, float> alphas(const Image& image) {
    float border = 0.0f, all = 0.0f;
    for (int y = 0; y < image.size.y; ++y)
      for (int x = 0; x < image.size.x; ++x) {
        const float alpha = image.pixels[std::size_t(y * image.size.x + x)].a;
        all = std::max(all, alpha);
        if (x == 0 || y == 0 || x == image.size.x - 1 || y == image.size.y - 1) border = std::max(border, alpha);
      }
    return {border, all};
  }
  static float brightest(const Image& image) {
    float most = 0.0f;
    for (const glm::vec4& pixel : image.pixels) most = std::max({most, pixel.r, pixel.g, pixel.b});
    return most;
  }
};

TEST_F(FilmCommand, SmokeThatGrowsIsFramedAsAWhole) {
  write(1, {box("density", 4, 0.2f)});  // a full block, as a source's first frame is: alone it would look like a scan
  for (const int frame : {2, 3, 4}) write(frame, {ball("density", 5 * frame, 0.1f * float(frame))});
  const ProgramResult result = draw();
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("those of the whole film, in which f_0004.vdb holds most"), std::string::npos) << result.err;
  for (const int frame : {1, 2, 3, 4}) {
    EXPECT_EQ(attribute(frame, "camera-position"), attribute(4, "camera-position")) << frame;
    EXPECT_EQ(attribute(frame, "density-scale"), attribute(4, "density-scale")) << frame;
    EXPECT_EQ(attribute(frame, "transfer-function"), "") << "smoke is no scan";
    const auto [border, all] = alphas(image(frame));
    EXPECT_EQ(border, 0.0f) << "frame " << frame << " is cut";
    EXPECT_GT(all, 0.01f) << frame;
  }
  // What was drawn so is drawn so again by the command that the image records.
  expectSuccess(runFreevoxels(recordedCommand(readBytes(folder / "i_0002.exr"), folder / "again.exr")));
  EXPECT_TRUE(readBytes(folder / "again.exr") == readBytes(folder / "i_0002.exr"));
  const Image whole = image(3);

  // The first frame's view is to be asked for, and cuts the others.
  const ProgramResult fixed = draw(" --fixed-view");
  EXPECT_EQ(fixed.exitCode, 0) << fixed.err;
  EXPECT_EQ(fixed.err.find("whole film"), std::string::npos) << fixed.err;
  EXPECT_EQ(attribute(4, "camera-position"), attribute(1, "camera-position"));
  EXPECT_GT(alphas(image(4)).first, 0.01f);
  const ProgramResult own = draw(" --no-fixed-view");
  EXPECT_EQ(own.exitCode, 0) << own.err;
  EXPECT_NE(attribute(4, "camera-position"), attribute(2, "camera-position"));
  EXPECT_NE(image(3).pixels, whole.pixels);
}

/// More frames than are read beforehand, in one of which a voxel is far away.
TEST_F(FilmCommand, AStrayVoxelDoesNotMakeAllFramesSmall) {
  for (int frame = 1; frame <= 15; ++frame) {
    const openvdb::FloatGrid::Ptr grid = ball("density", 4 + frame, 0.5f);
    if (frame == 4 || frame == 15) grid->tree().setValueOn(openvdb::Coord(400, 0, 0), 1e-6f);
    write(frame, {grid});
  }
  const ProgramResult result = draw();
  EXPECT_EQ(result.exitCode, 0) << result.err;
  for (int frame = 1; frame <= 15; ++frame) EXPECT_EQ(alphas(image(frame)).first, 0.0f) << "frame " << frame << " is cut";
  const Image last = image(15);
  const auto isSeen = [](const glm::vec4& pixel) { return pixel.a > 0.01f; };
  EXPECT_GT(double(std::ranges::count_if(last.pixels, isSeen)), 0.12 * double(last.pixels.size()));
}

TEST_F(FilmCommand, AGridThatNoFrameHasIsRefused) {
  write(1, {box("density", 8, 0.3f), box("temperature", 4, 1500.0f)});
  write(2, {box("temperature", 9, 1500.0f)});
  const ProgramResult result = draw(" --grid densty");
  EXPECT_EQ(result.exitCode, int(ExitCode::Input)) << result.err;
  EXPECT_NE(result.err.find("no frame has a grid 'densty'"), std::string::npos) << result.err;
  EXPECT_EQ(draw(" --grid density").exitCode, 0);
}

/// In kelvin or not, temperatures of smoke alone are warm, too; but a film in which something burns burns on.
TEST_F(FilmCommand, AFilmDoesNotGoOutInAFrameWithoutFlames) {
  for (const int frame : {1, 2, 3}) {
    openvdb::FloatGrid::Ptr flames = box("flame", 4, 1.0f);
    if (frame == 2) flames->clear();
    write(frame, {box("density", 12, 0.05f), box("temperature", 6, 1.0f, openvdb::Coord(3)), flames});
  }
  EXPECT_EQ(draw(" --unlit --albedo 0,0,0").exitCode, 0);
  for (const int frame : {1, 2, 3}) EXPECT_GT(brightest(image(frame)), 0.05f) << frame;
}

TEST_F(FilmCommand, AFireThatBeginsColdShinesLater) {
  const auto hot = [&](int edge, float kelvin) { return box("temperature", edge, kelvin, openvdb::Coord(3)); };
  write(1, {box("density", 12, 0.3f), hot(2, 300.0f)});
  write(2, {box("density", 14, 0.3f), hot(3, 900.0f)});  // weak
  write(3, {box("density", 16, 0.3f), hot(6, 1800.0f)});
  write(4, {box("density", 16, 0.3f)});  // burnt out: no grid of temperatures
  const ProgramResult result = draw(" --unlit --albedo 0,0,0");
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("f_0003.vdb shines most"), std::string::npos) << result.err;
  EXPECT_EQ(brightest(image(1)), 0.0f);
  EXPECT_GT(brightest(image(3)), 0.1f);
  EXPECT_LT(brightest(image(3)), 50.0f);
  EXPECT_LT(brightest(image(2)), 0.1f * brightest(image(3))) << "all frames have one scale";
  EXPECT_EQ(brightest(image(4)), 0.0f);
  EXPECT_EQ(attribute(3, "emission"), attribute(2, "emission"));
  // Without emission nothing shines.
  EXPECT_EQ(draw(" --unlit --albedo 0,0,0 --no-emission").exitCode, 0);
  EXPECT_EQ(brightest(image(3)), 0.0f);
}

TEST_F(FilmCommand, AFrameWithoutDensityNeverDrawsTemperaturesAsDensity) {
  write(1, {box("temperature", 20, 300.0f)});
  write(2, {box("density", 10, 0.3f), box("temperature", 6, 1500.0f)});
  write(3, {box("temperature", 6, 1500.0f)});
  const ProgramResult result = draw();
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(alphas(image(1)).second, 0.0f) << "cold air";
  EXPECT_GT(alphas(image(2)).second, 0.1f);
  EXPECT_EQ(alphas(image(3)).second, 0.0f) << "a flame hides nothing";
  EXPECT_GT(brightest(image(3)), 0.05f);
}

TEST_F(FilmCommand, AskingForAGridThatNoFrameHasIsAnError) {
  write(1, {box("density", 8, 0.3f)});
  write(2, {box("density", 9, 0.3f)});
  const ProgramResult result = draw(" --emission");
  EXPECT_EQ(result.exitCode, int(ExitCode::Input)) << result.err;
  EXPECT_NE(result.err.find("no frame that was looked at has temperatures"), std::string::npos) << result.err;
}

TEST_F(FilmCommand, FramesInFoldersAndBelowZeroAreDrawn) {
  for (const char* name : {"shot/-001", "shot/0000", "shot/0000.5"}) {
    std::filesystem::create_directories(folder / name);
    openvdb::io::File((folder / name / "smoke.vdb").string()).write(openvdb::GridCPtrVec{ball("density", 6, 0.5f)});
  }
  const ProgramResult result = run("render @shot/%04d/smoke.vdb --out-dir @out --format exr" + std::string(kSmall));
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_EQ(result.out, fmt::format("{0}/out/smoke_-0001.exr\n{0}/out/smoke_0000.exr\n{0}/out/smoke_0000.5.exr\n", folder.path().string()));
}

}  // namespace
}  // namespace freevoxels::test
