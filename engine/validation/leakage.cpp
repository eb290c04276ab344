#include "engine/validation/leakage.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "engine/validation/equal_voxels.h"
#include "engine/validation/max_error.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

/// Number of voxels along the edges of a layer: footprints reach less than two voxels.
constexpr int kLayerEdge = 7;
/// The two places: the middle of a voxel, and the point between four.
constexpr std::array<glm::dvec2, 2> kPlaces{{{3.0, 3.0}, {3.5, 3.5}}};
constexpr std::array<const char*, 2> kPlaceNames{"middle of a voxel", "between four voxels"};

constexpr int kPixelsPerVoxel = 4;  ///< so that no footprint is widened

constexpr double kProductTolerance = 1e-4;
constexpr double kRippleTolerance = 3e-3;  ///< for a full layer of footprints (footprint.h)

/// Transmittances of a stack.
struct Stack {
  double opacity = 0.0;
  int layers = 0;
  double exact = 0.0;                       ///< (1 - opacity)^layers, Eq. 8
  std::array<double, 2> normalisedDepth{};  ///< optical depth at both places
  std::array<double, 2> sorted{};
  std::array<double, 2> product{};  ///< the prediction of Eq. 9 for `sorted`

  double normalised(std::size_t place) const { return std::exp(-normalisedDepth[place]); }
  std::string text() const { return fmt::format("{} layers of {}", layers, opacity); }
};

/// The product of Eq. 9: every splat of every layer attenuates independently.
double productOfSplats(double opacity, int layers, glm::dvec2 at) {
  double layer = 1.0;
  for (int y = 0; y < kLayerEdge; ++y)
    for (int x = 0; x < kLayerEdge; ++x)
      layer *= 1.0 - opacity * footprintAt(glm::distance(glm::dvec2(x, y), at));
  return std::pow(layer, layers);
}

/// All stacks side by side in one volume whose density is its extinction: opacities along x, numbers of
/// layers along y.
Volume volumeOf(const LayerStacks& stacks) {
  const glm::ivec3 size(kLayerEdge * int(stacks.opacities.size()), kLayerEdge * int(stacks.layers.size()),
                        stacks.layers.back());
  return makeVolume(size, glm::dmat4(1.0), [&](int x, int y, int z) {
    const double opacity = stacks.opacities[std::size_t(x / kLayerEdge)];
    return z < stacks.layers[std::size_t(y / kLayerEdge)] ? extinctionOf(opacity) : 0.0;
  });
}

/// A view from above; pixel centres are at multiples of 1 / kPixelsPerVoxel from voxel (0, 0).
struct ViewFromAbove {
  glm::ivec2 size;
  Camera camera;

  explicit ViewFromAbove(const Volume& volume) : size(kPixelsPerVoxel * glm::ivec2(volume.dimensions)) {
    const glm::dvec2 middle = 0.5 * glm::dvec2(size - 1) / double(kPixelsPerVoxel);
    camera = lookingDown(middle.x, middle.y, double(volume.dimensions.y));
  }
  std::size_t pixelAt(glm::dvec2 position) const {
    const glm::ivec2 pixel(position * double(kPixelsPerVoxel));
    return std::size_t(pixel.x) + std::size_t(size.x) * std::size_t(size.y - 1 - pixel.y);
  }
};

std::vector<Stack> drawStacks(const StageMaker& make, const LayerStacks& stacks) {
  const Volume volume = volumeOf(stacks);
  const ViewFromAbove view(volume);
  const auto outputs = make(volume, physical(1.0, glm::vec3(1.0f)), {});
  const std::vector<SplatSums> sums = outputs->sums(view.camera, {.size = view.size, .method = SplatSettings{}});
  const Image sorted = outputs->image(view.camera, {.size = view.size, .method = SplatSettings{.composite = Composite::Sorted}});
  std::vector<Stack> drawn;
  for (std::size_t x = 0; x < stacks.opacities.size(); ++x)
    for (std::size_t y = 0; y < stacks.layers.size(); ++y) {
      const double opacity = stacks.opacities[x];
      const int layers = stacks.layers[y];
      Stack stack{.opacity = opacity, .layers = layers, .exact = std::pow(1.0 - opacity, layers)};
      for (std::size_t i = 0; i < kPlaces.size(); ++i) {
        const std::size_t pixel = view.pixelAt(double(kLayerEdge) * glm::dvec2(x, y) + kPlaces[i]);
        stack.normalisedDepth[i] = sums.at(pixel).depth;
        stack.sorted[i] = 1.0 - double(sorted.pixels.at(pixel).a);
        stack.product[i] = productOfSplats(opacity, layers, kPlaces[i]);
      }
      drawn.push_back(stack);
    }
  return drawn;
}

void addChecks(const std::vector<Stack>& stacks, ReportSection& section) {
  MaxError sorted, normalised;
  for (const Stack& stack : stacks)
    for (std::size_t i = 0; i < kPlaces.size(); ++i) {
      const auto where = [&] { return fmt::format("{}, {}", stack.text(), kPlaceNames[i]); };
      sorted.take(std::abs(stack.sorted[i] - stack.product[i]), where);
      const double depth = extinctionOf(stack.opacity) * stack.layers;
      normalised.take(std::abs(stack.normalisedDepth[i] / depth - 1.0), where);
    }
  section.checks.push_back(
      sorted.atMost(kProductTolerance, "sorted blending leaks as the product of Eq. 9 says"));
  section.checks.push_back(normalised.atMost(
      kRippleTolerance, "normalised FreeVoxels have the layers' optical depth (Eq. 8)", "relative"));
}

ReportTable transmittanceTable(const std::vector<Stack>& stacks) {
  ReportTable table{.caption = "Transmittance of stacks of equal layers",
                    .columns = {"opacity of a layer", "layers", "exact", "FreeVoxels, middle",
                                "FreeVoxels, between", "sorted, middle", "sorted, between"},
                    .rows = {}};
  const auto cell = [](double transmittance) { return fmt::format("{:.3g}", transmittance); };
  for (const Stack& stack : stacks)
    table.rows.push_back({fmt::format("{}", stack.opacity), fmt::format("{}", stack.layers),
                          cell(stack.exact), cell(stack.normalised(0)), cell(stack.normalised(1)),
                          cell(stack.sorted[0]), cell(stack.sorted[1])});
  return table;
}

/// The excess transmittance between four voxels.
void addSortedLeak(const std::vector<Stack>& stacks, ReportPlot& plot) {
  for (const Stack& stack : stacks) {
    const std::string name = fmt::format("sorted, alpha {}", stack.opacity);
    if (plot.series.empty() || plot.series.back().name != name)
      plot.series.push_back({.name = name, .points = {}});
    plot.series.back().points.emplace_back(stack.layers, stack.sorted[1] - stack.exact);
  }
}

/// For each number of layers, at the opacity where it is largest.
void addNormalisedLeak(const std::vector<Stack>& stacks, ReportPlot& plot) {
  std::map<int, double> leaks;
  for (const Stack& stack : stacks) {
    double& leak = leaks[stack.layers];
    leak = std::max(leak, stack.normalised(1) - stack.exact);
  }
  ReportPlot::Series series{.name = "FreeVoxels, any alpha", .points = {}};
  for (const auto& [layers, leak] : leaks) series.points.emplace_back(layers, leak);
  plot.series.push_back(std::move(series));
}

}  // namespace

ReportSection leakageOfLayers(const StageMaker& make, const LayerStacks& stacks) {
  const std::vector<Stack> drawn = drawStacks(make, stacks);
  ReportSection section{
      .title = "Subr et al. 2007, Eq. 8 and 9: leakage against layers and opacity",
      .text =
          "Stacks of k layers of opacity alpha let (1 - alpha)^k of the light behind them through (Eq. 8). "
          "Blended back to front, each splat attenuates by itself, so that the product of Eq. 9 over all "
          "splats that overlap a pixel comes through: too much, and more of it between voxels."};
  addChecks(drawn, section);
  section.tables.push_back(transmittanceTable(drawn));
  ReportPlot plot{
      .caption = "Light that leaks through, between four voxels: transmittance less (1 - alpha)^k",
      .xLabel = "layers k",
      .yLabel = "leaked transmittance",
      .series = {}};
  addSortedLeak(drawn, plot);
  addNormalisedLeak(drawn, plot);
  section.plots.push_back(std::move(plot));
  return section;
}

}  // namespace freevoxels
