// freevoxels info, generate --list and devices.

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/core/printable.h"
#include "engine/volume/procedural.h"
#include "tests/commands/program_runner.h"
#include "tests/storage/fvx_editor.h"

namespace freevoxels::test {

namespace {

using InfoCommand = CommandTest;
using DevicesCommand = CommandTest;

/// A terminal's title, colours by C0 and by C1, and a change of the direction of writing.
constexpr const char* kEscapes = "\x1b]0;title\x07\x1b[31m\xc2\x9b" "31m\xe2\x80\xae";

void expectPrintable(const std::string& text) {
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) EXPECT_EQ(line, printable(line));
}

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
  EXPECT_EQ(grid.at("host_bytes"), 27 * (8 * 8 * 8 * 4 + 3 * 4));
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

TEST_F(InfoCommand, TextOfABakedVolumeIsPrintable) {
  using fvx::SectionKind;
  const std::string name = "c" + std::string(kEscapes) + ".fvx", harmful = "\xc2\x9b" "31m \x7f \xe2\x80\xae";
  for (const int resolution : {20, 70}) {
    expectSuccess(run(fmt::format("bake procedural:cloud @c.fvx --resolution {} --quiet", resolution)));
    FvxEditor edited(readBytes(folder / "c.fvx"));
    nlohmann::json description = nlohmann::json::parse(edited.text(SectionKind::Description));
    description["source"] = kEscapes;
    edited.setText(SectionKind::Description, description.dump());
    edited.setText(SectionKind::Provenance, "{\"made\":\n\r\"" + harmful + "\"}");
    edited.save(folder / name);
    for (const char* options : {"", " --check"}) {
      const ProgramResult table = run("info @" + name + options);
      expectSuccess(table);
      expectPrintable(table.out);
      for (const char* shown : {"c\\x1b]0;title", "volume: \\x1b]0;title", "\\x0a\\x0d", "\\xc2\\x9b" "31m \\x7f"})
        EXPECT_NE(table.out.find(shown), std::string::npos) << shown << " in " << table.out;
    }
    const ProgramResult json = run("info @" + name + " --json");
    expectSuccess(json);
    expectPrintable(json.out);
    EXPECT_EQ(nlohmann::json::parse(json.out).at("provenance").at("made"), harmful);
    // Control characters as they are, which JSON does not have.
    edited.setText(SectionKind::Provenance, "{\"" + std::string(kEscapes) + "\": \"\n\"}");
    edited.save(folder / name);
    const ProgramResult raw = run("info @" + name + " --check"), rawJson = run("info @" + name + " --json");
    expectSuccess(raw);
    expectPrintable(raw.out);
    EXPECT_NE(raw.out.find("provenance: {\"\\x1b]0;title"), std::string::npos) << raw.out;
    expectSuccess(rawJson);
    expectPrintable(rawJson.out);
    EXPECT_EQ(nlohmann::json::parse(rawJson.out).at("provenance"), edited.text(SectionKind::Provenance));
  }
}

TEST_F(InfoCommand, NamesOfFilesArePrintableOnATerminal) {
  if (!terminalsAvailable()) GTEST_SKIP() << "no pseudo-terminals";
  const std::string name = "c" + std::string(kEscapes) + ".vdb";
  expectSuccess(run("generate cloud @" + name + " --resolution 24 --quiet"));
  const std::string eraseLine = "\r\x1b[K";
  for (const char* format : {"bake @{} @c.fvx", "render @{} @c.png --size 16", "info @{}"}) {
    ProgramResult result = runFreevoxelsOnTerminal(words(fmt::format(fmt::runtime(format), name)));
    EXPECT_EQ(result.exitCode, 0) << result.err;
    for (std::size_t at = 0; (at = result.err.find(eraseLine, at)) != std::string::npos;) result.err.replace(at, eraseLine.size(), "\n");
    std::erase(result.err, '\r');  // the terminal's own
    expectPrintable(result.err);
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
