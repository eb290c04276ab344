// freevoxels-bench: how long each stage takes, as a table and as JSON.

#include <CLI/CLI.hpp>
#include <fstream>
#include <nlohmann/json.hpp>

#include "apps/bench/bench_stages.h"
#include "apps/freevoxels/device_options.h"
#include "apps/freevoxels/program.h"
#include "apps/freevoxels/text_table.h"
#include "engine/core/atomic_file.h"
#include "engine/core/error.h"

namespace {

using namespace freevoxels;
using bench::Result;

std::vector<Result> measureAll(const Device& device, const std::vector<std::string>& inputs, bool quick) {
  const int runs = quick ? 2 : 5;
  std::vector<Result> results;
  for (int resolution : quick ? std::vector{64, 128} : std::vector{64, 128, 256})
    results.push_back(bench::sweeps(device, DirectionSet::Directions26, resolution, runs));
  for (int resolution : {64, 128})
    results.push_back(bench::sweeps(device, DirectionSet::Directions98, resolution, runs));
  for (int resolution : quick ? std::vector{64, 128} : std::vector{64, 128, 256})
    results.push_back(bench::octree(device, AttenuationCode::Depth8, resolution, runs));
  results.push_back(bench::octree(device, AttenuationCode::Linear8, 128, runs));
  for (Result& result : bench::zoom(device, 128, runs)) results.push_back(std::move(result));
  for (const QualityColor color : {QualityColor::Skin, QualityColor::Bone})
    for (Result& result : bench::culling(device, color, quick ? 128 : 256, runs))
      results.push_back(std::move(result));
  for (Result& result : bench::lights(device, 128, runs)) results.push_back(std::move(result));
  results.push_back(bench::compaction(device, quick ? 128 : 256, runs));
  for (double pixels : {3.0, 5.0, 9.0}) results.push_back(bench::splats(device, pixels, runs));
  for (const Result& result : bench::flight(device, quick ? 64 : 128, quick ? 1 : 2))
    results.push_back(result);
  if (!quick)  // a twentieth of more than 512³ voxels
    results.push_back(
        bench::wholeRender(device, {.input = "procedural:plume", .grid = {}, .resolution = 640}, 1));
  for (const std::string& input : inputs)
    results.push_back(
        bench::wholeRender(device, {.input = input, .grid = {}, .resolution = {}}, runs));
  return results;
}

std::vector<std::string> tableLines(const std::vector<Result>& results) {
  using Align = TextTable::Align;
  TextTable table{.columns = {Align::Left, Align::Right, Align::Right, Align::Right},
                  .rows = {{"stage", "ms", "x copy", "million/s"}}};
  for (const Result& result : results)
    table.rows.push_back({result.name, fmt::format("{:.1f}", result.milliseconds),
                          result.copyMilliseconds > 0.0
                              ? fmt::format("{:.1f}", result.milliseconds / result.copyMilliseconds)
                              : "",
                          result.perSecond > 0.0 ? fmt::format("{:.2f}", result.perSecond * 1e-6) : ""});
  return table.lines();
}

nlohmann::ordered_json toJson(const Device& device, const std::vector<Result>& results) {
  nlohmann::ordered_json json{{"device", device.description().name}, {"driver", device.description().driver}};
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

}  // namespace

int main(int argc, char** argv) {
  CLI::App app(
      "Measures every stage on one device: the least of several runs, and as a ratio to copying the same "
      "bytes "
      "with two threads of this machine in the same run.",
      "freevoxels-bench");
  DeviceOptions device;
  std::vector<std::string> inputs{"procedural:cloud"};
  std::string json;
  bool quick = false;
  app.add_option("IN", inputs, "Volumes to render whole: files, or procedural:NAME")->capture_default_str();
  app.add_option("--json", json, "Also write the figures to this file");
  app.add_flag("--quick", quick, "Smaller volumes and fewer runs");
  device.add(app);
  app.callback([&] {
    if (!json.empty()) checkWritable(json);
    device.withDevice([&](const Device& opened) {
      const std::vector<Result> results = measureAll(opened, inputs, quick);
      fmt::print("{}\n", opened.description().name);
      for (const std::string& line : tableLines(results)) fmt::print("{}\n", line);
      if (json.empty()) return;
      writeAtomically(json, [&](const std::filesystem::path& file) {
        std::ofstream stream(file);
        stream << toJson(opened, results).dump(2) << '\n';
        stream.flush();
        if (!stream) fail(ExitCode::Output, "cannot write '{}': is the disk full?", json);
      });
    });
  });
  return runProgram(app, argc, argv);
}
