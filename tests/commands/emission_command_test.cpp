// Emission and grids of albedos from the command line.

#include "engine/image/image.h"
#include "engine/volume/openvdb_trees.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {
namespace {

constexpr const char* kSmallFire = " --size 40x40 --quiet";

class EmissionCommand : public CommandTest {
 protected:
  void SetUp() override {
    openvdb::initialize();
    const auto density = openvdb::FloatGrid::create(0.0f), heat = openvdb::FloatGrid::create(0.0f);
    density->denseFill({openvdb::Coord(0), openvdb::Coord(7)}, 0.5f, true);
    heat->denseFill({openvdb::Coord(2), openvdb::Coord(12, 5, 5)}, 0.5f, true);
    const auto far = heat->deepCopy();
    const auto colors = openvdb::Vec3SGrid::create(openvdb::Vec3s(0.0f));
    colors->denseFill({openvdb::Coord(0), openvdb::Coord(7)}, openvdb::Vec3s(1.5f, 0.5f, 0.0f), true);
    density->setName("density");
    heat->setName("heat");
    far->setName("far");
    far->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    colors->setName("Cd");
    openvdb::io::File((folder / "fire.vdb").string()).write(openvdb::GridCPtrVec{density, heat, far, colors});
  }
};

TEST_F(EmissionCommand, TheHeaderRepeatsTheImage) {
  expectSuccess(run(std::string("render @fire.vdb @a.exr @a.png --emission --float") + kSmallFire));
  const std::string made = readBytes(folder / "a.exr");
  const std::string command = exrAttribute(made, "freevoxels:command");
  for (const char* part : {"--temperature-grid heat", "--temperature-scale 2000", "--emission ",
                           "--temperature-offset 1000", "--albedo 0.5,0.5,0.5"})
    EXPECT_NE(command.find(part), std::string::npos) << part << " in " << command;
  Arguments arguments = recordedCommand(made, folder / "b.exr");
  arguments.emplace_back("--quiet");
  expectSuccess(runFreevoxels(arguments));
  EXPECT_EQ(readImage(folder / "b.exr").pixels, readImage(folder / "a.exr").pixels);
  float brightest = 0.0f;
  for (const glm::vec4& pixel : readImage(folder / "a.exr").pixels) brightest = std::max(brightest, pixel.r - pixel.a);
  EXPECT_GT(brightest, 0.3f);  // a flame beside the smoke has no alpha
  // Naming the grid is enough, and the oracle sees it too.
  expectSuccess(run(std::string("render @fire.vdb @c.exr --temperature-grid heat --float") + kSmallFire));
  EXPECT_EQ(readImage(folder / "c.exr").pixels, readImage(folder / "a.exr").pixels);
  expectSuccess(run(std::string("oracle @fire.vdb @d.exr --temperature-grid heat") + kSmallFire));
}

TEST_F(EmissionCommand, ColoursAreAlbedosAndClippedWithOneWarning) {
  const ProgramResult result = run(std::string("render @fire.vdb @a.exr --albedo-grid Cd --no-emission --unlit --size 40x40"));
  EXPECT_EQ(result.exitCode, 0) << result.err;
  EXPECT_NE(result.err.find("512 voxels of grid 'Cd'"), std::string::npos) << result.err;
  const glm::vec4 middle = readImage(folder / "a.exr").pixels[20 * 40 + 20];
  EXPECT_NEAR(middle.r / middle.a, 1.0f, 2e-3f);
  EXPECT_NEAR(middle.g / middle.a, 0.5f, 2e-3f);
  EXPECT_EQ(middle.b, 0.0f);
}

TEST_F(EmissionCommand, WhatCannotBeIsRefused) {
  const auto refuse = [&](const std::string& options, ExitCode code, const std::string& mention) {
    SCOPED_TRACE(options);
    expectCleanRefusal("render @fire.vdb @a.png " + options + kSmallFire, code, mention);
  };
  refuse("--temperature-grid none", ExitCode::Input, "none");
  refuse("--temperature-grid Cd", ExitCode::Input, "--temperature-grid");
  refuse("--albedo-grid heat", ExitCode::Input, "--albedo-grid");
  refuse("--albedo-grid missing", ExitCode::Input, "missing");
  refuse("--emission=-1", ExitCode::Usage, "--emission");
  refuse("--emission nan", ExitCode::Usage, "--emission");
  refuse("--emission --temperature-scale -3", ExitCode::Usage, "--temperature-scale");
  refuse("--emission --temperature-offset inf", ExitCode::Usage, "--temperature-offset");
  refuse("--no-emission --temperature-scale 3", ExitCode::Usage, "--no-emission");
  refuse("--no-emission --emission 3", ExitCode::Usage, "--emission");
  refuse("--albedo-grid Cd --transfer-function @fire.vdb", ExitCode::Usage, "--transfer-function");
  expectCleanRefusal(std::string("render procedural:cube @a.png --resolution 8 --emission 1") + kSmallFire, ExitCode::Usage,
                     "procedural:fire");
  expectCleanRefusal(std::string("render procedural:fire @a.png --temperature-grid t") + kSmallFire, ExitCode::Usage, "--temperature-grid");
}

TEST_F(EmissionCommand, InfoSaysWhatGridsAreFor) {
  const ProgramResult result = run("info @fire.vdb --json");
  EXPECT_EQ(result.exitCode, 0);
  for (const char* part : {"\"temperature\"", "\"albedo\""})
    EXPECT_NE(result.out.find(part), std::string::npos) << part;
}

}  // namespace
}  // namespace freevoxels::test
