#include "engine/lighting/scattering_solver.h"

#include <algorithm>
#include <cmath>

#include "embedded/scattering_texels.h"
#include "engine/core/error.h"
#include "engine/lighting/scattering_grid.h"

namespace freevoxels {

namespace {

constexpr int kMostSets = 60;

/// GMRES with a restart after shader::kMaxBasis vectors.
class Gmres {
 public:
  Gmres(ScatteringGrid& grid, const Progress& progress) : grid_(grid), progress_(progress) {}

  /// Iterates until the residual's norm is at most `tolerance` times that of `reference`, or of the first residual if that is 0. Returns
  /// the norm of the first residual.
  double solve(double reference, double tolerance) {
    double first = -1.0;
    while (sets_ < kMostSets) {
      const double norm = restart();
      if (first < 0.0) first = norm;
      if (reference <= 0.0) reference = norm;
      residual_ = reference > 0.0 ? norm / reference : 0.0;
      if (!(residual_ > tolerance)) break;
      if (cycle(norm, tolerance * reference)) {
        residual_ = last_ / reference;
        break;
      }
    }
    return first;
  }
  int sets() const { return sets_; }
  double residual() const { return residual_; }

 private:
  static constexpr int kBasis = shader::kMaxBasis;
  static constexpr int kFirst = ScatteringGrid::kBasis;

  /// Makes the normalised residual the first vector of the basis, and returns its norm.
  double restart() {
    grid_.sweepResidual(kFirst, progress_);
    ++sets_;
    const double norm = std::sqrt(grid_.dots(kFirst, kFirst, 1).front());
    if (norm > 0.0) grid_.combine({.to = kFirst, .from = kFirst, .scale = 1.0 / norm});
    return norm;
  }

  /// Extends the basis until the residual is small or the basis full, and adds the best combination to the solution. Returns whether the
  /// residual is small.
  bool cycle(double norm, double enough) {
    std::array<std::array<double, kBasis + 1>, kBasis> columns{};  // of the triangular matrix
    std::array<double, kBasis + 1> right{norm};
    std::array<double, kBasis> cosines{}, sines{};
    int count = 0;
    last_ = norm;
    while (count < kBasis && last_ > enough && sets_ < kMostSets) {
      grid_.sweepDifference(kFirst + count, kFirst + count + 1, progress_);
      ++sets_;
      const std::vector<double> dots = grid_.dots(kFirst + count + 1, kFirst, count + 2);
      std::array<double, kBasis + 1>& column = columns[std::size_t(count)];
      std::vector<double> factors;
      double rest = dots.back();
      for (int i = 0; i <= count; ++i) {
        column[std::size_t(i)] = dots[std::size_t(i)];
        factors.push_back(-dots[std::size_t(i)]);
        rest -= dots[std::size_t(i)] * dots[std::size_t(i)];
      }
      const double length = std::sqrt(std::max(rest, 0.0));
      const double next = rotate(column, cosines, sines, right, count, length);
      ++count;
      last_ = std::abs(next);
      if (length <= 1e-6 * std::sqrt(dots.back())) break;  // the basis holds the solution
      if (count < kBasis)
        grid_.combine({.to = kFirst + count, .from = kFirst + count, .first = kFirst, .factors = factors, .scale = 1.0 / length});
    }
    addToSolution(columns, right, count);
    return last_ <= enough;
  }

  /// Applies the rotations to a new column of the Hessenberg matrix whose last element is `length`, and returns the new residual.
  static double rotate(std::array<double, kBasis + 1>& column, std::array<double, kBasis>& cosines, std::array<double, kBasis>& sines,
                       std::array<double, kBasis + 1>& right, int count, double length) {
    for (std::size_t i = 0; i < std::size_t(count); ++i) {
      const double upper = column[i];
      column[i] = cosines[i] * upper + sines[i] * column[i + 1];
      column[i + 1] = cosines[i] * column[i + 1] - sines[i] * upper;
    }
    const auto last = std::size_t(count);
    const double size = std::hypot(column[last], length);
    cosines[last] = size > 0.0 ? column[last] / size : 1.0;
    sines[last] = size > 0.0 ? length / size : 0.0;
    column[last] = size;
    right[last + 1] = -sines[last] * right[last];
    right[last] *= cosines[last];
    return right[last + 1];
  }

  void addToSolution(const std::array<std::array<double, kBasis + 1>, kBasis>& columns, std::array<double, kBasis + 1> right, int count) {
    std::vector<double> factors(std::size_t(count), 0.0);
    for (std::size_t i = std::size_t(count); i-- > 0;) {
      for (std::size_t j = i + 1; j < std::size_t(count); ++j) right[i] -= columns[j][i] * factors[j];
      factors[i] = columns[i][i] != 0.0 ? right[i] / columns[i][i] : 0.0;
    }
    grid_.combine({.to = ScatteringGrid::kSolution, .from = ScatteringGrid::kSolution, .first = kFirst, .factors = factors});
  }

  ScatteringGrid& grid_;
  const Progress& progress_;
  int sets_ = 0;
  double residual_ = 0.0, last_ = 0.0;
};

/// The same light for all that a solution depends on.
bool isSameLight(const Lighting& a, const Lighting& b) {
  return a.lights == b.lights && a.ambient == b.ambient && a.environment == b.environment && a.tint == b.tint && a.phaseG == b.phaseG &&
         a.scattering == b.scattering && a.surface == b.surface;
}

/// Coarser grids are made while there are more cells than this.
constexpr std::size_t kFewCells = 512;
/// Of solutions on coarser cells, which differ by more than that.
constexpr double kCoarseTolerance = 5e-3;

}  // namespace

bool hasScatteredLight(const Lighting& lighting, bool emits) {
  return lighting.hasIndirectLight() || emits;
}

std::uint64_t scatteringBytes(glm::ivec3 dimensions, bool hasPhase) {
  return ScatteringGrid::bytes(ScatteringMedium::gridOf(dimensions).count(), 3, hasPhase) * 8 / 7;
}

ScatteringSolver::ScatteringSolver(const Device& device, ScatteringMedium medium) : device_(device) {
  media_.push_back(std::move(medium));
  while (media_.back().grid().count() > kFewCells) media_.push_back(media_.back().coarser());
}

void ScatteringSolver::solve(const Lighting& lighting, std::vector<StageTime>& times, const Progress& progress) {
  if (solved_ && isSameLight(*solved_, lighting)) return;
  solved_.reset();
  const StageTimer timer(times, "scattering");
  facts_ = {.cells = medium().grid().cells, .edge = medium().grid().edge};
  double reference = 0.0;
  std::unique_ptr<ScatteringGrid> coarse;
  for (std::size_t level = lighting.scattering == kAllOrders ? media_.size() : 1; level-- > 0;) {
    auto grid = std::make_unique<ScatteringGrid>(device_, media_[level], lighting);
    if (lighting.scattering != kAllOrders) {
      facts_.sets = grid->sweepOrders(lighting.scattering, progress);
      facts_.work = facts_.sets;
    } else {
      if (coarse) grid->startFrom(*coarse);
      Gmres gmres(*grid, progress);
      // The norm of a vector grows with the root of the number of cells.
      const double scale = coarse ? std::sqrt(double(grid->cells()) / double(coarse->cells())) : 0.0;
      const double first = gmres.solve(scale * reference, level > 0 ? kCoarseTolerance : kScatteringTolerance);
      reference = coarse ? scale * reference : first;
      facts_.sets = gmres.sets();
      facts_.work += gmres.sets() * double(grid->cells()) / double(medium().grid().count());
      facts_.residual = gmres.residual();
    }
    coarse = std::move(grid);
  }
  texelBuffer_ = coarse->makeTexels();
  texels_ = TexelView(device_, texelBuffer_);
  solved_ = lighting;
  brightest_ = download().brightest();
  deltaScale_ = deltaScaleOf(lighting, medium());
  ++version_;
}

shader::ScatteredGrid ScatteringSolver::onDevice(const glm::dmat4& toMedium) const {
  FV_CHECK_EQ(solved_.has_value(), true);
  const PhaseSplit split = splitPhase(*solved_);
  const double perVoxel = 1.0 / double(medium().grid().edge);
  const glm::dmat3 linear(toMedium);
  return {.texels = addressWords(texelBuffer_.address()),
          .cells = medium().grid().cells,
          .toCells = perVoxel * linear,
          .firstCell = perVoxel * (glm::dvec3(toMedium[3]) - linear * glm::dvec3(0.5) + 0.5) - 0.5,
          .share = float(1.0 - split.forward),
          .flux = float(3.0 * split.g),
          .moments = split.g != 0.0 ? 4 : 1};
}

ScatteredField ScatteringSolver::download() const {
  const shader::ScatteredGrid grid = onDevice();
  std::vector<glm::vec4> texels(medium().grid().count() * std::size_t(grid.moments));
  freevoxels::download(device_, texelBuffer_, std::as_writable_bytes(std::span(texels)));
  ScatteredField field{
      .cells = grid.cells, .edge = medium().grid().edge, .share = double(grid.share), .flux = double(grid.flux), .mean = {}};
  for (std::size_t i = 0; i < texels.size(); i += std::size_t(grid.moments)) {
    field.mean.emplace_back(texels[i]);
    if (grid.moments > 1) field.fluxes.push_back({glm::dvec3(texels[i + 1]), glm::dvec3(texels[i + 2]), glm::dvec3(texels[i + 3])});
  }
  return field;
}

}  // namespace freevoxels
