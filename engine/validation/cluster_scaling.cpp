#include "engine/validation/cluster_scaling.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <ctime>
#include <limits>

#include "engine/core/error.h"
#include "engine/renderer.h"
#include "engine/validation/quality_scenes.h"
#include "engine/volume/procedural.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr std::array kRankCounts{1, 8, 16, 32, 64, 128};
constexpr int kComparedRanks = 8;
constexpr int kRuns = 2;

/// The clock of clusterScalings.
template <typename Work>
double millisecondsOf(const Device& device, const Work& work) {
  const auto now = [clock = device.isCpu() ? CLOCK_PROCESS_CPUTIME_ID : CLOCK_MONOTONIC] {
    timespec time{};
    clock_gettime(clock, &time);
    return 1e3 * double(time.tv_sec) + 1e-6 * double(time.tv_nsec);
  };
  const double start = now();
  work();
  return now() - start;
}

std::uint64_t differences(const FixedSums& a, const FixedSums& b) {
  FV_CHECK_EQ(a.values.size(), b.values.size());
  std::uint64_t count = 0;
  for (std::size_t i = 0; i < a.values.size(); ++i) count += a.values[i] != b.values[i] ? 1 : 0;
  return count;
}

class Measurement {
 public:
  Measurement(const Device& device, const QualityScene& scene)
      : device_(device), renderer_(device, scene.volume, scene.classification, {}), camera_(viewCamera(scene.volume, {})) {
    renderer_.render(camera_, settings_);  // makes what is made once for a volume
  }

  void undivided(Scaling& result) {
    result.atOnce = millisecondsOf(device_, [&] { renderer_.render(camera_, settings_); });
    whole_ = renderer_.renderShares(camera_, settings_, {0, 1});
    result.bytes = whole_.pixelCount() * std::uint64_t(whole_.channels) * sizeof(std::int64_t);
    for (const std::uint64_t drawn : renderer_.cutCounts().drawn) result.blocks += drawn;
  }

  Scaling::Ranks ranks(int count, Scaling& result) {
    Scaling::Ranks ranks{.count = count};
    FixedSums all;
    for (int rank = 0; rank < count; ++rank) {
      FixedSums sums;
      double least = std::numeric_limits<double>::max();
      for (int run = 0; run < kRuns; ++run) {  // the first one also lists the rank's blocks, which is done once for all frames
        least = std::min(least, millisecondsOf(device_, [&] { sums = renderer_.renderShares(camera_, settings_, {rank, count}); }));
      }
      ranks.slowest = std::max(ranks.slowest, least);
      ranks.mean += least / count;
      if (count != kComparedRanks) continue;
      if (rank == 0)
        all = std::move(sums);
      else
        all += sums;
    }
    if (count == kComparedRanks) result.differentSums = differences(all, whole_);
    return ranks;
  }

 private:
  const Device& device_;
  Renderer renderer_;
  Camera camera_;
  FrameSettings settings_{.size = {1024, 1024}, .method = SplatSettings{.cullThreshold = 0.0f}};
  FixedSums whole_;
};

Scaling measure(const Device& device, const std::string& name, const QualitySubject& subject, int resolution) {
  const QualityScene scene = makeQualityScene(subject, resolution, makeProcedural(subject.procedural, resolution));
  Scaling result{.volume = fmt::format("{} {}^3", name, resolution)};
  Measurement measurement(device, scene);
  measurement.undivided(result);
  for (const int count : kRankCounts) {
    Scaling::Ranks ranks = measurement.ranks(count, result);
    const double alone = result.ranks.empty() ? ranks.slowest : result.ranks.front().slowest;
    for (const Network& network : networks())
      ranks.speedUps.push_back(alone / (ranks.slowest + 1e3 * reductionSeconds(network, count, result.bytes)));
    result.ranks.push_back(ranks);
  }
  return result;
}

std::string mebibytes(std::uint64_t bytes) {
  return fmt::format("{:.1f}", double(bytes) / 1048576.0);
}

ReportTable speedUpTable(const Scaling& scaling) {
  ReportTable table{.caption = fmt::format("{}: {} splats, {} MiB of sums a rank, {:.1f} ms drawn at once", scaling.volume, scaling.blocks,
                                           mebibytes(scaling.bytes), scaling.atOnce),
                    .columns = {"ranks", "slowest ms", "mean ms", "ideal ms"},
                    .rows = {}};
  for (const Network& network : networks()) table.columns.insert(table.columns.end(), {"speed-up, " + network.name, "efficiency"});
  for (const Scaling::Ranks& ranks : scaling.ranks) {
    std::vector<std::string>& row = table.rows.emplace_back();
    row = {fmt::format("{}", ranks.count), fmt::format("{:.1f}", ranks.slowest), fmt::format("{:.1f}", ranks.mean),
           fmt::format("{:.1f}", scaling.ranks.front().slowest / ranks.count)};
    for (const double speedUp : ranks.speedUps) {
      row.push_back(fmt::format("{:.1f}", speedUp));
      row.push_back(fmt::format("{:.2f}", speedUp / ranks.count));
    }
  }
  return table;
}

/// What most of the time beyond the ideal of the largest number of ranks goes to, for the slower network.
std::string limitText(const Scaling& scaling) {
  const Scaling::Ranks& ranks = scaling.ranks.back();
  const double ideal = scaling.ranks.front().slowest / ranks.count;
  const double reduction = 1e3 * reductionSeconds(networks().front(), ranks.count, scaling.bytes);
  const std::array<std::pair<double, const char*>, 3> losses{{
      {reduction, "adding up the sums over the network"},
      {ranks.slowest - ranks.mean, "unequal shares"},
      {ranks.mean - ideal, "work that every rank repeats"},
  }};
  const auto [most, name] = *std::ranges::max_element(losses);
  return fmt::format("{}: {} ranks are limited most by {} ({:.1f} ms beside the ideal {:.1f} ms).", scaling.volume, ranks.count, name,
                     most, ideal);
}

ReportPlot speedUpPlot(const std::vector<Scaling>& scalings) {
  ReportPlot plot{.caption = "Speed-up of a frame that is divided among ranks", .xLabel = "ranks", .yLabel = "speed-up", .series = {}};
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

std::vector<Scaling> clusterScalings(const Device& device, int resolution) {
  return {measure(device, "opaque head", {"head", QualityColor::Skin, false}, resolution),
          measure(device, "cloud", {"cloud", QualityColor::Cloud, false}, resolution),
          measure(device, "box of smoke", {"plume", QualityColor::Cloud, false}, resolution)};
}

ReportSection clusterSection(const std::vector<Scaling>& scalings) {
  ReportSection section{
      .title = "A frame divided among ranks (figure 8 of the paper)",
      .text = "What each of the ranks would draw, drawn one after the other on this device; adding up their sums is modelled for two "
              "networks, and not overlapped with drawing."};
  for (const Scaling& scaling : scalings) {
    section.text += fmt::format(" {}", limitText(scaling));
    section.checks.push_back({.name = fmt::format("sums of {} ranks that differ from those of one, {}", kComparedRanks, scaling.volume),
                              .figure = double(scaling.differentSums),
                              .tolerance = 0.0,
                              .unit = "sums",
                              .where = {}});
    section.tables.push_back(speedUpTable(scaling));
  }
  section.plots.push_back(speedUpPlot(scalings));
  return section;
}

}  // namespace freevoxels
