#include "apps/bench/cluster.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <limits>

#include "apps/freevoxels/text_table.h"
#include "engine/renderer.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels::bench {

namespace {

constexpr std::array kRankCounts{1, 8, 16, 32, 64, 128};

template <typename Work>
double millisecondsOf(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// Of the last frame.
double stageMilliseconds(const Renderer& renderer, std::string_view name) {
  for (const StageTime& stage : renderer.timings())
    if (stage.name == name) return stage.milliseconds;
  return 0.0;
}

/// Runs of which the least time counts: the slowest of many ranks would otherwise be the one that other programs disturbed.
constexpr int kRuns = 2;

/// A rank makes the list of its blocks once for all frames.
double millisecondsOfRank(Renderer& renderer, const Camera& camera, const FrameSettings& settings, const SharePart& part) {
  double least = std::numeric_limits<double>::max();
  for (int run = 0; run < kRuns; ++run) {
    const double all = millisecondsOf([&] { renderer.renderShares(camera, settings, part); });
    least = std::min(least, all - stageMilliseconds(renderer, kChoosingShares));
  }
  return least;
}

Scaling measure(const Device& device, const std::string& name, const QualitySubject& subject, int resolution) {
  const QualityScene scene = makeQualityScene(subject, resolution, makeProcedural(subject.procedural, resolution));
  Renderer renderer(device, scene.volume, scene.classification, {});
  const Camera camera = framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, 1.0, {});
  const FrameSettings settings{.size = {1024, 1024}, .cullThreshold = 0.0f};
  Scaling result{.volume = fmt::format("{} {}^3", name, resolution)};
  renderer.render(camera, settings);  // what is made once for a volume
  result.atOnce = millisecondsOf([&] { renderer.render(camera, settings); });
  const FixedSums sums = renderer.renderShares(camera, settings, {0, kShares});
  result.bytes = sums.pixelCount() * std::uint64_t(sums.channels) * sizeof(std::int64_t);
  for (const std::uint64_t drawn : renderer.cutCounts().drawn) result.blocks += drawn;

  for (const int count : kRankCounts) {
    Scaling::Ranks ranks{.count = count};
    for (int rank = 0; rank < count; ++rank) {
      const double time = millisecondsOfRank(renderer, camera, settings, {rank, count});
      if (time > ranks.slowest) ranks.undivided = stageMilliseconds(renderer, "copy to host");
      ranks.slowest = std::max(ranks.slowest, time);
      ranks.mean += time / count;
    }
    for (const Network& network : networks()) {
      const double alone = result.ranks.empty() ? ranks.slowest : result.ranks.front().slowest;
      ranks.speedUps.push_back(alone / (ranks.slowest + 1e3 * reductionSeconds(network, count, result.bytes)));
    }
    result.ranks.push_back(ranks);
  }
  return result;
}

}  // namespace

const std::vector<Network>& networks() {
  static const std::vector<Network> known{{"10 Gb/s", 20e-6, 10e9 / 8.0}, {"100 Gb/s", 2e-6, 100e9 / 8.0}};
  return known;
}

double reductionSeconds(const Network& network, int ranks, std::uint64_t bytes) {
  if (ranks == 1) return 0.0;
  const double steps = std::ceil(std::log2(double(ranks)));
  return 2.0 * steps * network.latency + 2.0 * (ranks - 1.0) / ranks * double(bytes) / network.bandwidth;
}

std::vector<Scaling> cluster(const Device& device, int resolution) {
  return {measure(device, "opaque head", {"head", QualityColor::Skin, false}, resolution),
          measure(device, "cloud", {"cloud", QualityColor::Cloud, false}, resolution),
          measure(device, "box of smoke", {"plume", QualityColor::Cloud, false}, resolution)};
}

std::vector<std::string> tableLines(const std::vector<Scaling>& scalings) {
  using enum TextTable::Align;
  TextTable table{.columns = {Left, Right, Right, Right, Right},
                  .rows = {{"frame divided among ranks", "ranks", "slowest ms", "mean ms", "copy ms"}}};
  for (const Network& network : networks()) {
    table.columns.insert(table.columns.end(), {Right, Right});
    table.rows.front().push_back("speed-up, " + network.name);
    table.rows.front().emplace_back("efficiency");
  }
  for (const Scaling& scaling : scalings) {
    table.rows.push_back({fmt::format("{}: {} splats, {:.1f} MiB of sums a rank, {:.1f} ms drawn at once", scaling.volume,
                                      scaling.blocks, double(scaling.bytes) / 1048576.0, scaling.atOnce)});
    table.rows.back().resize(table.columns.size());
    for (const Scaling::Ranks& ranks : scaling.ranks) {
      std::vector<std::string> row{"", fmt::format("{}", ranks.count), fmt::format("{:.1f}", ranks.slowest),
                                   fmt::format("{:.1f}", ranks.mean), fmt::format("{:.1f}", ranks.undivided)};
      for (const double speedUp : ranks.speedUps) {
        row.push_back(fmt::format("{:.1f}", speedUp));
        row.push_back(fmt::format("{:.2f}", speedUp / ranks.count));
      }
      table.rows.push_back(row);
    }
  }
  return table.lines();
}

ReportPlot speedUpPlot(const std::vector<Scaling>& scalings) {
  ReportPlot plot{.caption = "Speed-up of a frame that is divided among ranks", .xLabel = "ranks", .yLabel = "speed-up"};
  plot.series.push_back({.name = "ideal", .points = {}});
  for (const int count : kRankCounts) plot.series.front().points.emplace_back(count, count);
  for (const Scaling& scaling : scalings)
    for (std::size_t network = 0; network < networks().size(); ++network) {
      ReportPlot::Series series{.name = scaling.volume + ", " + networks()[network].name, .points = {}};
      for (const Scaling::Ranks& ranks : scaling.ranks) series.points.emplace_back(ranks.count, ranks.speedUps[network]);
      plot.series.push_back(series);
    }
  return plot;
}

}  // namespace freevoxels::bench
