// Inputs that cannot be drawn are refused in one sentence, and nothing is written.

#include "engine/volume/openvdb_trees.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

/// Without the remark about the CPU, where there is no GPU.
constexpr const char* kSmallAndQuiet = " --size 32x32 --quiet";

void writeGrids(const std::filesystem::path& file, const openvdb::GridCPtrVec& grids) {
  openvdb::io::File(file.string()).write(grids);
}

class BadInput : public CommandTest {
 protected:
  static void SetUpTestSuite() { openvdb::initialize(); }

  void makeCube(const std::string& name) {
    expectSuccess(
        runFreevoxels({"generate", "cube", (folder / name).string(), "--resolution", "16", "--quiet"}));
  }
  void expectBadTransferFunction(const std::string& json, const std::string& mention) {
    SCOPED_TRACE(json);
    writeBytes(folder / "t.json", json);
    expectCleanRefusal(std::string("render procedural:cube @a.png --resolution 8 --transfer-function @t.json") + kSmallAndQuiet,
                       ExitCode::Input, mention);
  }
};

}  // namespace

TEST_F(BadInput, MissingFile) {
  expectCleanRefusal(std::string("render @none.vdb @a.exr @a.png") + kSmallAndQuiet, ExitCode::Input, "none.vdb");
  expectCleanRefusal("info @none.vdb", ExitCode::Input, "none.vdb");
}

TEST_F(BadInput, MissingFileNamesTheNearestOne) {
  makeCube("smoke_0001.vdb");
  expectCleanRefusal(std::string("render @smoke_001.vdb @a.png") + kSmallAndQuiet, ExitCode::Input, "did you mean 'smoke_0001.vdb'?");
}

TEST_F(BadInput, ScanThatIsNone) {
  writeBytes(folder / "head.NRRD", "NRRD0004\ntype: short\n");
  writeBytes(folder / "brain.nii.gz", "\x1f\x8b 123456789");
  writeBytes(folder / "map.mrc", "map");
  expectCleanRefusal(std::string("render @head.NRRD @a.png") + kSmallAndQuiet, ExitCode::Input, "head.NRRD");
  expectCleanRefusal("info @brain.nii.gz", ExitCode::Input, "brain.nii.gz");
  expectCleanRefusal("info @map.mrc", ExitCode::Input, "convert it to NRRD");
  expectCleanRefusal("info @none.nrrd", ExitCode::Input, "there is no such file");
  makeCube("cube.vdb");
  expectCleanRefusal(std::string("render @cube.vdb @a.png --spacing 1,1,2") + kSmallAndQuiet, ExitCode::Usage, "--spacing is for scans");
  expectCleanRefusal(std::string("render @none.nrrd @a.png --spacing 1,0,2") + kSmallAndQuiet, ExitCode::Usage, "above 0");
}

TEST_F(BadInput, FolderWithoutSlices) {
  std::filesystem::create_directory(folder / "volumes.vdb");
  expectCleanRefusal(std::string("render @volumes.vdb @a.png") + kSmallAndQuiet, ExitCode::Input, "a folder without DICOM files");
}

TEST_F(BadInput, TextFileNamedVdb) {
  writeBytes(folder / "text.vdb", "Dear diary, today I wrote a long line of text into a file named .vdb.\n");
  expectCleanRefusal(std::string("render @text.vdb @a.exr") + kSmallAndQuiet, ExitCode::Input, "text.vdb");
  expectCleanRefusal("info @text.vdb", ExitCode::Input, "text.vdb");
}

TEST_F(BadInput, EmptyFile) {
  writeBytes(folder / "empty.vdb", "");
  expectCleanRefusal(std::string("render @empty.vdb @a.exr") + kSmallAndQuiet, ExitCode::Input, "empty.vdb");
}

TEST_F(BadInput, FileCutShortAnywhere) {
  makeCube("whole.vdb");
  const std::string whole = readBytes(folder / "whole.vdb");
  ASSERT_GT(whole.size(), 1000u);
  for (const std::size_t size : {std::size_t(4), std::size_t(40), whole.size() / 2, whole.size() - 1}) {
    SCOPED_TRACE(size);
    writeBytes(folder / "cut.vdb", whole.substr(0, size));
    expectCleanRefusal(std::string("render @cut.vdb @a.exr") + kSmallAndQuiet, ExitCode::Input, "cut.vdb");
  }
}

TEST_F(BadInput, UnknownGrid) {
  makeCube("cube.vdb");
  expectCleanRefusal(std::string("render @cube.vdb @a.png --grid smoke") + kSmallAndQuiet, ExitCode::Input, "smoke");
  expectCleanRefusal(std::string("render @cube.vdb @a.png --grid density[7]") + kSmallAndQuiet, ExitCode::Input, "density[7]");
}

TEST_F(BadInput, EmptyGrid) {
  const auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  writeGrids(folder / "nothing.vdb", {grid});
  expectCleanRefusal(std::string("render @nothing.vdb @a.png") + kSmallAndQuiet, ExitCode::Input, "nothing.vdb");
  expectSuccess(run("info @nothing.vdb"));
}

TEST_F(BadInput, FrustumTransform) {
  const auto grid = openvdb::FloatGrid::create();
  grid->setName("density");
  grid->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(3)), 1.0f);
  grid->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(4)), 0.5, 1.0));
  writeGrids(folder / "frustum.vdb", {grid});
  expectCleanRefusal(std::string("render @frustum.vdb @a.png") + kSmallAndQuiet, ExitCode::Input, "frustum");
}

TEST_F(BadInput, SeveralGridsAndNoChoice) {
  openvdb::GridCPtrVec grids;
  for (const char* name : {"ash", "dust"}) {
    const auto grid = openvdb::FloatGrid::create();
    grid->setName(name);
    grid->fill(openvdb::CoordBBox(openvdb::Coord(0), openvdb::Coord(3)), 1.0f);
    grids.push_back(grid);
  }
  writeGrids(folder / "two.vdb", grids);
  expectCleanRefusal(std::string("render @two.vdb @a.png") + kSmallAndQuiet, ExitCode::Input, "dust");
  expectSuccess(run(std::string("render @two.vdb @a.png --grid dust") + kSmallAndQuiet));
}

TEST_F(BadInput, BadTransferFunction) {
  expectCleanRefusal(std::string("render procedural:cube @a.png --transfer-function @none.json") + kSmallAndQuiet, ExitCode::Input,
                     "none.json");
  expectBadTransferFunction("not json", "t.json");
  expectBadTransferFunction(R"({"opacity":[[0,0],[1,1]],"color":[[0,1,1,1]],"shine":1})", "shine");
  expectBadTransferFunction(R"({"opacity":[[1,0],[0,1]],"color":[[0,1,1,1]]})", "opacity");
  expectBadTransferFunction(R"({"opacity":"much","color":[[0,1,1,1]]})", "opacity");
  expectBadTransferFunction(R"({"opacity":[[0,0],[1,1]],"color":[[0,1,1]]})", "color");
  expectBadTransferFunction(R"({"opacity":[[0,0],[1,1]],"color":[[0,1,1,1]],"unit_distance":0})",
                            "unit_distance");
}

TEST_F(BadInput, JsonThatIsNestedTooDeep) {
  const std::string lists = std::string(100'000, '[') + std::string(100'000, ']'), mention = "nested more than 64 deep";
  const std::string render = std::string("render procedural:cube @a.png --resolution 8") + kSmallAndQuiet;
  for (const std::string& scene : {lists, "{\"light\":{\"ambient\":" + lists + "}}", "{\"classification\":{\"transfer-function\":" + lists + "}}"}) {
    writeBytes(folder / "s.json", scene);
    expectCleanRefusal(render + " --scene @s.json", ExitCode::Input, mention);
    expectCleanRefusal(render + " --transfer-function @s.json", ExitCode::Input, mention);
  }
  const std::string shorter = "{\"opacity\":" + std::string(500, '[') + std::string(500, ']') + "}";
  expectCleanRefusal(render + " --transfer-function " + shorter, ExitCode::Input, mention);
  expectCleanRefusal(render + " --save-scene @saved.json --transfer-function " + shorter, ExitCode::Input, mention);
}

TEST_F(BadInput, BadLights) {
  const auto expectBadLight = [this](const std::string& options, const std::string& mention) {
    SCOPED_TRACE(options);
    for (const char* command : {"render", "oracle"})
      expectCleanRefusal(fmt::format("{} procedural:cube @a.png --resolution 8 {}{}", command, options, kSmallAndQuiet), ExitCode::Usage,
                         mention);
  };
  expectBadLight("--light color=1,1,1", "neither a direction nor a position");
  expectBadLight("--light direction=1,0,0,position=1,2,3", "a direction and a position");
  expectBadLight("--light direction=0,0,0", "points nowhere");
  expectBadLight("--light direction=1,nan,0", "direction");
  expectBadLight("--light direction=1,0,0,intensity=-1", "intensity");
  expectBadLight("--light direction=1,0,0,color=1,-1,0", "color");
  expectBadLight("--light direction=1,0,0,shine=3", "shine");
  expectBadLight("--light direction=1,0,0,direction=0,1,0", "twice");
  expectBadLight("--light 1,0,0", "direction=X,Y,Z");
  expectBadLight("--ambient 1,2", "--ambient");
  expectBadLight("--ambient -1", "--ambient");
  expectBadLight("--phase-g 1 --light direction=1,0,0", "--phase-g");
  expectBadLight("--scattering 0", "--scattering");
  expectBadLight("--scattering 101", "--scattering");
  expectBadLight("--scattering many", "--scattering");
  for (const char* option : {"--light-attenuation exact --ambient 1", "--shading gradient --ambient 1", "--surface-share 0.5 --shading scatter"})
    expectCleanRefusal(fmt::format("render procedural:cube @a.png {}{}", option, kSmallAndQuiet), ExitCode::Usage,
                       std::string(option).substr(0, std::string(option).find(' ')));
}

TEST_F(BadInput, VolumeThatNoDeviceHolds) {
  expectCleanRefusal(std::string("render procedural:cube @a.png --resolution 2048") + kSmallAndQuiet, ExitCode::OutOfMemory,
                     "--resolution");
}

TEST_F(BadInput, UnknownDevice) {
  expectCleanRefusal(std::string("render procedural:cube @a.png --resolution 8 --device 99") + kSmallAndQuiet, ExitCode::Device, "99");
  expectCleanRefusal(std::string("render procedural:cube @a.png --resolution 8 --device Voodoo2") + kSmallAndQuiet, ExitCode::Device,
                     "Voodoo2");
}

}  // namespace freevoxels::test
