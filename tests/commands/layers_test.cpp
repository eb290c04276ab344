// Images with layers, and volumes of labels and channels, as users draw them.

#include "engine/image/image.h"
#include "engine/image/metrics.h"
#include "engine/volume/openvdb_trees.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

/// Two dyes that overlap, and a grid of labels, in one file.
void writeDyes(const std::filesystem::path& file) {
  openvdb::initialize();
  openvdb::GridPtrVec grids;
  for (const auto& [name, middle] : {std::pair("dapi", openvdb::Vec3d(8, 9, 7)), {"gfp", openvdb::Vec3d(13, 9, 9)}}) {
    const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
    grid->setName(name);
    for (openvdb::CoordBBox::Iterator<true> v(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(20, 18, 16))); v; ++v)
      if (const float value = float(60.0 - ((*v).asVec3d() - middle).lengthSqr()); value > 0.0f) grid->tree().setValueOn(*v, value);
    grids.push_back(grid);
  }
  openvdb::io::File(file.string()).write(grids);
}

}  // namespace

using LayersTest = CommandTest;

TEST_F(LayersTest, WhatHasNoLayersIsRefused) {
  writeDyes(folder / "dyes.vdb");
  const std::string render = "render @dyes.vdb @a.exr --size 16 --channel 0 --channel 1 ";
  expectCleanRefusal(render + "--aov channels", ExitCode::Usage, "--scattering 1");
  expectCleanRefusal(render + "--aov lights --unlit", ExitCode::Usage, "--aov lights");
  expectCleanRefusal(render + "--aov lights --share 1/2 --sums", ExitCode::Usage, "--aov lights");
  expectCleanRefusal("render procedural:cloud @a.exr --size 16 --resolution 8 --aov channels", ExitCode::Usage, "--channel");
  expectCleanRefusal("render procedural:cloud @a.exr --size 16 --channel 0", ExitCode::Usage, "--channel");
  expectCleanRefusal("render @dyes.vdb @a.exr --channel 0 --transfer-function {}", ExitCode::Usage, "--transfer-function");
  expectCleanRefusal("render @dyes.vdb @a.exr --channel other", ExitCode::Input, "dyes.vdb");
}

TEST_F(LayersTest, LabelsAndChannelsAreBakedAsTheyAreDrawn) {
  writeDyes(folder / "dyes.vdb");
  for (const std::string look : {"--grid dapi --labels all", "--channel dapi:blue --channel gfp", "--channel 0:blue:emission",
                                 "--channel dapi:blue --channel gfp:red:emission"}) {
    SCOPED_TRACE(look);
    expectSuccess(run("bake @dyes.vdb @a.fvx --quiet " + look));
    for (const std::string& file : {"dyes.vdb " + look, std::string("a.fvx")})
      expectSuccess(run("render @" + file + " @" + file.substr(0, 1) + ".exr --size 40x32 --quiet --unlit"));
    EXPECT_GT(compareImages(readExr(folder / "a.exr"), readExr(folder / "d.exr")).psnr, 40.0);
    std::filesystem::remove(folder / "a.fvx");
  }
}

}  // namespace freevoxels::test
