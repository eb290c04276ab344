// freevoxels-bench: how long each stage takes, as a table and as JSON.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "apps/bench/baked_stages.h"
#include "apps/bench/bench_stages.h"
#include "apps/bench/native_march.h"
#include "apps/bench/real_ranks.h"
#include "apps/common/device_options.h"
#include "apps/common/program.h"
#include "apps/common/text_table.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/json_file.h"
#include "engine/octree/volume_limits.h"
#include "engine/validation/cluster_scaling.h"

namespace {

using namespace freevoxels;
using bench::Result;

struct Extent {
  std::vector<std::string> inputs{"procedural:cloud"};
  bool quick = false;

  int runs() const { return quick ? 2 : 5; }
  std::vector<int> resolutions() const { return quick ? std::vector{64, 128} : std::vector{64, 128, 256}; }
};
using Results = std::vector<Result>;

Results sweeps(const Device& device, const Extent& extent) {
  Results results;
  for (int resolution : extent.resolutions())
    results.push_back(bench::sweeps(device, DirectionSet::Directions26, resolution, extent.runs()));
  for (int resolution : {64, 128})
    results.push_back(bench::sweeps(device, DirectionSet::Directions98, resolution, extent.runs()));
  return results;
}

Results octree(const Device& device, const Extent& extent) {
  Results results;
  for (const std::string_view name : {bench::kStripes, std::string_view("cloud")})
    for (int resolution : extent.resolutions())
      results.push_back(bench::octree(device, name, AttenuationCode::Depth8, resolution, extent.runs()));
  results.push_back(bench::octree(device, bench::kStripes, AttenuationCode::Linear8, 128, extent.runs()));
  return results;
}

Results zoom(const Device& device, const Extent& extent) {
  return bench::zoom(device, 128, extent.runs());
}

Results culling(const Device& device, const Extent& extent) {
  Results results;
  for (const QualityColor color : {QualityColor::Skin, QualityColor::Bone})
    std::ranges::move(bench::culling(device, color, extent.quick ? 128 : 256, extent.runs()),
                      std::back_inserter(results));
  return results;
}

Results frames(const Device& device, const Extent& extent) {
  Results results;
  for (const std::string_view name : {"head", "cloud"})
    std::ranges::move(bench::frames(device, name, extent.quick ? 128 : 256, extent.runs()),
                      std::back_inserter(results));
  return results;
}

Results turntable(const Device& device, const Extent& extent) {
  Results results;
  for (const std::string_view name : {"head", "cloud"})
    for (const int lights : {0, 1})
      results.push_back(bench::turntable(device, name, 128, {1280, 800}, lights, extent.quick ? 1 : 2));
  return results;
}

Results lights(const Device& device, const Extent& extent) {
  Results results = bench::lights(device, 128, extent.runs());
  const double one = results.emplace_back(bench::turntable(device, "cloud", 128, {1024, 1024}, 1, 1)).milliseconds;
  Result& sixteen = results.emplace_back(bench::turntable(device, "cloud", 128, {1024, 1024}, 16, 1));
  sixteen.name += fmt::format(": {:.2f} of one light", sixteen.milliseconds / one);
  return results;
}

Results list(const Device& device, const Extent& extent) {
  return {bench::compaction(device, extent.quick ? 128 : 256, extent.runs())};
}

Results splats(const Device& device, const Extent& extent) {
  Results results;
  for (double pixels : {3.0, 5.0, 9.0}) results.push_back(bench::splats(device, pixels, extent.runs()));
  return results;
}

Results flight(const Device& device, const Extent& extent) {
  return bench::flight(device, extent.quick ? 64 : 128, extent.quick ? 1 : 2);
}

Results whole(const Device& device, const Extent& extent) {
  Results results;
  if (!extent.quick) {  // a twentieth of more than 512³ voxels, and all of 512³
    results.push_back(
        bench::wholeRender(device, {.volume = "procedural:plume", .grid = {}, .resolution = glm::ivec3(640)}, false, 1));
    results.push_back(bench::wholeScan(device, 512, false, 1));
  }
  for (const bool lit : {false, true}) {
    results.push_back(bench::wholeScan(device, extent.quick ? 128 : 256, lit, extent.runs()));
    for (const std::string& input : extent.inputs)
      results.push_back(
          bench::wholeRender(device, {.volume = input, .grid = {}, .resolution = {}}, lit, extent.runs()));
  }
  return results;
}

Results baked(const Device& device, const Extent& extent) {
  std::vector<std::string> inputs = extent.inputs;
  if (std::ranges::count(inputs, "procedural:head") == 0) inputs.emplace_back("procedural:head");
  Results results;
  for (const std::string& input : inputs) std::ranges::move(bench::baked(device, input, extent.quick ? 96 : 256, extent.runs()), std::back_inserter(results));
  results.push_back(bench::coldPreview(device, extent.quick ? glm::ivec3(256) : glm::ivec3(512, 512, 256), extent.runs()));
  return results;
}

struct Stage {
  std::string name;
  Results (*measure)(const Device& device, const Extent& extent);
};
Results edits(const Device& device, const Extent& extent) {
  return bench::edits(device, extent.quick ? 128 : 256, extent.runs());
}

const std::vector<Stage> kStages{{"sweeps", sweeps},       {"octree", octree}, {"zoom", zoom},  {"culling", culling}, {"frames", frames},
                                 {"turntable", turntable}, {"lights", lights}, {"list", list},  {"splats", splats},   {"flight", flight},
                                 {"whole", whole},         {"edits", edits},   {"baked", baked}};

std::vector<std::string> stageNames() {
  std::vector<std::string> names;
  for (const Stage& stage : kStages) names.push_back(stage.name);
  return names;
}

Results measure(const Device& device, const Extent& extent, const std::vector<std::string>& wanted) {
  Results results;
  for (const Stage& stage : kStages)
    if (std::ranges::count(wanted, stage.name) > 0)
      std::ranges::move(stage.measure(device, extent), std::back_inserter(results));
  return results;
}

Results marches(const Device& device, const Extent& extent) {
  Results results;
  for (const std::string_view name : {"head", "cloud"})
    std::ranges::move(bench::nativeMarch(device, name, extent.quick ? 128 : 256, extent.runs()), std::back_inserter(results));
  return results;
}

/// With three decimals below 10 ms, as most stages of a GPU take less than a millisecond.
std::string timeText(double milliseconds) {
  return fmt::format("{:.{}f}", milliseconds, milliseconds < 10.0 ? 3 : 1);
}

/// The name of a stage without what was measured, which follows a colon.
std::string stageOf(const std::string& name) {
  return name.substr(0, name.find(':'));
}

/// Milliseconds by stageOf(), of a file that --json wrote.
using Before = std::map<std::string, double>;

Before readBefore(const std::string& file) {
  Before before;
  const nlohmann::json figures = readJson("file of figures", file);
  try {
    for (const nlohmann::json& stage : figures.at("stages"))
      before.emplace(stageOf(stage.at("stage").get<std::string>()), stage.at("milliseconds").get<double>());
  } catch (const nlohmann::json::exception&) {
    fail(ErrorKind::Input, "'{}' is not what freevoxels-bench --json writes: name such a file", file);
  }
  return before;
}

std::vector<std::string> tableLines(const Results& results, const Before& before) {
  using Align = TextTable::Align;
  TextTable table{.columns = {Align::Left, Align::Right, Align::Right, Align::Right},
                  .rows = {{"stage", "ms", "x copy", "million/s"}}};
  if (!before.empty()) {
    table.columns.push_back(Align::Right);
    table.rows.front().emplace_back("x before");
  }
  for (const Result& result : results) {
    table.rows.push_back({result.name, timeText(result.milliseconds),
                          result.copyMilliseconds > 0.0
                              ? fmt::format("{:.1f}", result.milliseconds / result.copyMilliseconds)
                              : "",
                          result.perSecond > 0.0 ? fmt::format("{:.2f}", result.perSecond * 1e-6) : ""});
    if (before.empty()) continue;
    const auto found = before.find(stageOf(result.name));
    table.rows.back().push_back(found == before.end() ? "" : fmt::format("{:.2f}", result.milliseconds / found->second));
  }
  return table.lines();
}

nlohmann::ordered_json toJson(const Device& device, const Results& results) {
  nlohmann::ordered_json json{
      {"device", device.description().name}, {"driver", device.description().driver}, {"version", programVersion()}};
  for (const Result& result : results) {
    nlohmann::ordered_json stage{{"stage", result.name}, {"milliseconds", result.milliseconds}};
    if (result.copyMilliseconds > 0.0) {
      stage["copy_milliseconds"] = result.copyMilliseconds;
      stage["ratio_to_copy"] = result.milliseconds / result.copyMilliseconds;
    }
    if (result.perSecond > 0.0) stage["items_per_second"] = result.perSecond;
    json["stages"].push_back(stage);
  }
  return json;
}

/// What real ranks take beside the modelled ones.
void printRealRanks(int resolution) {
  const std::string volume = "cloud";
  const std::optional<double> one = bench::frameOfRealRanks(1, volume, resolution);
  const std::optional<double> two = one ? bench::frameOfRealRanks(2, volume, resolution) : std::nullopt;
  if (!two)
    fmt::print("real ranks: not run, as mpirun or freevoxels-mpi is not there or failed\n");
  else
    fmt::print("real ranks, {} {}^3, one thread each: {:.1f} ms a frame by 1, {:.1f} ms by 2: speed-up {:.2f}\n", volume, resolution, *one,
               *two, *one / *two);
}

std::vector<std::string> tableLines(const ReportTable& table) {
  TextTable text{.columns = std::vector(table.columns.size(), TextTable::Align::Right), .rows = {table.columns}};
  std::ranges::copy(table.rows, std::back_inserter(text.rows));
  return text.lines();
}

/// Frames that are divided among ranks, instead of the stages.
void measureCluster(const Device& device, bool quick, const std::string& json) {
  const ReportSection section = clusterSection(clusterScalings(device, quick ? 128 : 512));
  for (const ReportTable& table : section.tables) {
    fmt::print("{}\n", table.caption);
    for (const std::string& line : tableLines(table)) fmt::print("{}\n", line);
  }
  fmt::print("{}\n", section.text);
  printRealRanks(quick ? 128 : 256);
  if (!json.empty())
    writeJson(json, {.facts = {{"device", device.description().name}, {"version", programVersion()}}, .sections = {section}});
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Measures every stage on one device: the least time of several runs, and its ratio to copying the same number of bytes "
      "in the device's memory in the same run.",
      "freevoxels-bench");
  DeviceOptions device;
  Extent extent;
  std::vector<std::string> wanted = stageNames();
  std::string json, compared;
  bool cluster = false, march = false;
  app.add_option("IN", extent.inputs, "Volumes for whole renders: files, or procedural:NAME")
      ->capture_default_str();
  app.add_option("--json", json, "Write the figures as JSON to this file as well; draw_report.py plots those of --cluster");
  app.add_option("--compare", compared, "Compare the times with those of a file that --json wrote: apps/bench/before.json has some")
      ->type_name("FILE.json");
  app.add_option("--stages", wanted, "Only these stages, separated by commas [all]")
      ->delimiter(',')
      ->check(CLI::IsMember(stageNames()));
  app.add_flag("--cluster", cluster,
               "Instead of the stages, how a frame scales that is divided among 8 to 128 ranks, each drawn on this device");
  app.add_flag("--march", march,
               "Instead of the stages, unlit frames beside a march of every ray by code of the host's own: the limit of this machine")
      ->excludes("--cluster");
  app.add_flag("--quick", extent.quick, "Smaller volumes and fewer runs");
  device.add(app);
  app.callback([&] {
    if (!json.empty()) checkWritable(json);
    const Before before = compared.empty() ? Before() : readBefore(compared);
    for (const std::string& input : extent.inputs)
      if (const InputDescription volume{.volume = input}; volume.kind() == VolumeKind::OpenVdb)
        listVdb(input);  // refuses a file that is missing or no volume before minutes of work
      else if (volume.kind() == VolumeKind::Scan)
        readScanHeader(input, volume.scanRequest(kMaxNumberedVoxels));
    device.withDevice([&](const Device& opened) {
      if (cluster) return measureCluster(opened, extent.quick, json);
      const Results results = march ? marches(opened, extent) : measure(opened, extent, wanted);
      fmt::print("{}\n", opened.description().name);
      for (const std::string& line : tableLines(results, before)) fmt::print("{}\n", line);
      if (json.empty()) return;
      writeAtomically(json, [&](const std::filesystem::path& file) {
        std::ofstream stream(file);
        stream << toJson(opened, results).dump(2) << '\n';
        stream.flush();
        if (!stream) fail(ErrorKind::Output, "cannot write '{}': is the disk full?", json);
      });
    });
  });
  return runProgram(app, argc, argv);
}
