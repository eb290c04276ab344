// freevoxels info, generate --list and devices.

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/volume/procedural.h"
#include "tests/commands/program_runner.h"

namespace freevoxels::test {

namespace {

using InfoCommand = CommandTest;
using DevicesCommand = CommandTest;

}  // namespace

TEST_F(InfoCommand, ShowsWhatGenerateWrote) {
  const ProgramResult generated = run("generate cube @cube.vdb --resolution 20");
  expectSuccess(generated);
  EXPECT_EQ(generated.out, (folder / "cube.vdb").string() + "\n");
  EXPECT_EQ(generated.err, "");

  const ProgramResult json = run("info @cube.vdb --json");
  expectSuccess(json);
  const auto grid = nlohmann::json::parse(json.out).at("grids").at(0);
  EXPECT_EQ(grid.at("name"), "density");
  EXPECT_EQ(grid.at("type"), "float");
  EXPECT_EQ(grid.at("class"), "fog volume");
  EXPECT_GT(grid.at("active_voxels"), 0);
  EXPECT_NEAR(grid.at("voxel_size").at(0), 1.0 / 20.0, 1e-9);
  // A cube that fills its box: levels of 20, 10, 5, 3, 2 and 1 blocks along an edge, each above the voxels
  // with a bound of half a byte beside its code, in whole bytes for a level.
  const int voxels = 20 * 20 * 20, above = 10 * 10 * 10 + 5 * 5 * 5 + 3 * 3 * 3 + 2 * 2 * 2 + 1;
  EXPECT_EQ(grid.at("active_voxels"), voxels);
  EXPECT_EQ(grid.at("table_bytes"), 26 * (voxels + above + (above + 3) / 2));
  // 27 bricks of 8³ floats, and a number for each.
  EXPECT_EQ(grid.at("host_bytes"), 27 * (8 * 8 * 8 * 4 + 4));
  EXPECT_GT(grid.at("stored_bytes"), grid.at("table_bytes"));
  EXPECT_GT(grid.at("device_bytes"), grid.at("stored_bytes"));
  const auto bytes = [&](const char* name) { return grid.at(name).get<std::uint64_t>(); };
  EXPECT_EQ(26 * bytes("table_98_bytes"), 98 * bytes("table_bytes"));
  EXPECT_GT(bytes("device_98_bytes"), bytes("device_bytes"));

  const ProgramResult table = run("info @cube.vdb");
  expectSuccess(table);
  for (const char* word : {"density", "float", "fog volume", "TABLE 26", "TABLE 98"})
    EXPECT_NE(table.out.find(word), std::string::npos) << table.out;
}

TEST_F(InfoCommand, SaysTheSameOfAProceduralVolumeAsOfItsFile) {
  for (const ProceduralKind& kind : proceduralKinds()) {
    SCOPED_TRACE(kind.name);
    const std::string name(kind.name);
    expectSuccess(run("generate " + name + " @" + name + ".vdb --resolution 24 --quiet"));
    const auto file = nlohmann::json::parse(run("info --json @" + name + ".vdb").out).at("grids").at(0);
    const auto made =
        nlohmann::json::parse(run("info --json --resolution 24 procedural:" + name).out).at("grids").at(0);
    for (const char* key : {"name", "type", "class", "active_voxels", "range"})
      EXPECT_EQ(file.at(key), made.at(key));
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_NEAR(file.at("voxel_size").at(axis), made.at("voxel_size").at(axis), 1e-9);
      EXPECT_EQ(file.at("dimensions").at(axis), made.at("dimensions").at(axis));
    }
  }
}

TEST_F(InfoCommand, GenerateListsEveryKind) {
  const ProgramResult result = run("generate --list");
  expectSuccess(result);
  for (const ProceduralKind& kind : proceduralKinds())
    EXPECT_NE(result.out.find(fmt::format("\n{} ", kind.name)), std::string::npos) << kind.name;
}

TEST_F(DevicesCommand, ListsDevicesThatCanBeChosen) {
  const ProgramResult table = run("devices");
  expectSuccess(table);
  EXPECT_NE(table.out.find("UUID"), std::string::npos);

  const auto devices = nlohmann::json::parse(run("devices --json").out);
  ASSERT_FALSE(devices.empty());
  int usable = 0;
  for (const auto& device : devices) {
    EXPECT_NE(table.out.find(device.at("name").get<std::string>()), std::string::npos);
    EXPECT_NE(table.out.find(device.at("uuid").get<std::string>()), std::string::npos);
    EXPECT_EQ(device.at("uuid").get<std::string>().size(), 36u);
    if (!device.at("usable")) continue;
    ++usable;
    for (const std::string& selector : {device.at("index").dump(), device.at("name").get<std::string>(),
                                        device.at("uuid").get<std::string>()})
      expectSuccess(runFreevoxels({"render", "procedural:cube", (folder / "a.png").string(), "--resolution",
                                   "8", "--size", "16x16", "--quiet", "--device", selector}));
  }
  EXPECT_GT(usable, 0);
}

}  // namespace freevoxels::test
