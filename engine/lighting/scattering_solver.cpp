#include "engine/lighting/scattering_solver.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <memory>

#include "engine/core/error.h"
#include "engine/lighting/scattering_grid.h"

namespace freevoxels {

namespace {

/// Limit of the sets of sweeps on one grid; the solution that is reached by then is used.
constexpr int kMaxSets = 60;

/// min |b - A x| of a growing Hessenberg matrix A, of which Givens rotations make a triangular one (Saad and Schultz 1986, Section 3.2).
class LeastSquares {
 public:
  static constexpr int kMaxColumns = shader::kMaxBasis;
  using Column = std::array<double, kMaxColumns + 1>;

  /// b is `norm` in its first element, and 0 in all others.
  explicit LeastSquares(double norm) : right_{norm} {}
  int columns() const { return count_; }

  /// Adds a column, whose element below the diagonal is `length`. Returns the norm of the residual.
  double add(Column column, double length) {
    const auto last = std::size_t(count_++);
    for (std::size_t i = 0; i < last; ++i) {
      const double upper = column[i];
      column[i] = cosines_[i] * upper + sines_[i] * column[i + 1];
      column[i + 1] = cosines_[i] * column[i + 1] - sines_[i] * upper;
    }
    const double size = std::hypot(column[last], length);
    cosines_[last] = size > 0.0 ? column[last] / size : 1.0;
    sines_[last] = size > 0.0 ? length / size : 0.0;
    column[last] = size;
    columns_[last] = column;
    right_[last + 1] = -sines_[last] * right_[last];
    right_[last] *= cosines_[last];
    return std::abs(right_[last + 1]);
  }

  /// x, by back substitution.
  std::vector<double> solve() const {
    Column right = right_;
    std::vector<double> factors(std::size_t(count_), 0.0);
    for (std::size_t i = factors.size(); i-- > 0;) {
      for (std::size_t j = i + 1; j < factors.size(); ++j) right[i] -= columns_[j][i] * factors[j];
      factors[i] = columns_[i][i] != 0.0 ? right[i] / columns_[i][i] : 0.0;
    }
    return factors;
  }

 private:
  std::array<Column, kMaxColumns> columns_{};   ///< of the triangular matrix
  Column right_;                                ///< b, rotated
  std::array<double, kMaxColumns> cosines_{}, sines_{};
  int count_ = 0;
};

/// GMRES with a restart after shader::kMaxBasis vectors.
class Gmres {
 public:
  Gmres(ScatteringGrid& grid, const Progress& progress) : grid_(grid), progress_(progress) {}

  /// Iterates until the residual's norm is at most `tolerance` times that of `reference`, or of the first residual if that is 0. Returns
  /// the norm of the first residual.
  double solve(double reference, double tolerance) {
    double first = -1.0;
    while (sets_ < kMaxSets) {
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
  static constexpr int kFirst = ScatteringGrid::kBasis;
  /// What is left of a vector, relative to it, below which the basis holds the solution.
  static constexpr double kBreakdown = 1e-6;

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
    LeastSquares squares(norm);
    last_ = norm;
    while (squares.columns() < LeastSquares::kMaxColumns && last_ > enough && sets_ < kMaxSets) {
      const int count = squares.columns();
      grid_.sweepDifference(kFirst + count, kFirst + count + 1, progress_);
      ++sets_;
      // Classical Gram-Schmidt. The norm of what is left follows from Pythagoras, which saves a pass over the vectors; what orthogonality
      // is lost by that is far below kScatteringTolerance.
      const std::vector<double> dots = grid_.dots(kFirst + count + 1, kFirst, count + 2);
      LeastSquares::Column column{};
      std::vector<double> factors;
      double rest = dots.back();
      for (int i = 0; i <= count; ++i) {
        column[std::size_t(i)] = dots[std::size_t(i)];
        factors.push_back(-dots[std::size_t(i)]);
        rest -= dots[std::size_t(i)] * dots[std::size_t(i)];
      }
      const double length = std::sqrt(std::max(rest, 0.0));
      last_ = squares.add(column, length);
      if (length <= kBreakdown * std::sqrt(dots.back())) break;
      if (count + 1 < LeastSquares::kMaxColumns)
        grid_.combine({.to = kFirst + count + 1, .from = kFirst + count + 1, .first = kFirst, .factors = factors, .scale = 1.0 / length});
    }
    grid_.combine({.to = ScatteringGrid::kSolution, .from = ScatteringGrid::kSolution, .first = kFirst, .factors = squares.solve()});
    return last_ <= enough;
  }

  ScatteringGrid& grid_;
  const Progress& progress_;
  int sets_ = 0;
  double residual_ = 0.0, last_ = 0.0;
};

/// Whether a solution for one light is that for the other.
bool isSameLight(const Lighting& a, const Lighting& b) {
  Lighting other = b;
  other.attenuation = a.attenuation;  // which says how direct light is found alone
  return a == other;
}

/// The coarsest grid has at most so many cells.
constexpr std::size_t kFewCells = 512;
/// Residual at which coarser grids stop. They only provide a start, and discretisation changes their solution by more than this.
constexpr double kCoarseTolerance = 5e-3;
/// The same of all grids of a draft, whose cells are coarser than the medium's.
constexpr double kDraftTolerance = 5e-2;

}  // namespace

bool hasScatteredLight(const Lighting& lighting, bool emits) {
  return lighting.hasIndirectLight() || emits;
}

std::uint64_t scatteringBytes(const Device& device, const Volume& outline, const Lighting& lighting) {
  return ScatteringGrid::bytes(device, outline.dimensions, outline.indexToWorld, lighting);
}

ScatteringSolver::ScatteringSolver(const Device& device, ScatteringMedium medium) : device_(device) {
  media_.push_back(std::move(medium));
  while (media_.back().grid().count() > kFewCells) media_.push_back(media_.back().coarser());
}

ScatteringSolver ScatteringSolver::clipped(const RayClip& clip, int coarseness) const {
  ScatteringSolver part(device_, media_[std::min(std::size_t(coarseness), media_.size() - 1)].clipped(clip));
  part.isDraft_ = true;
  return part;
}

std::unique_ptr<ScatteringGrid> ScatteringSolver::solveOrders(const Lighting& lighting, const Progress& progress) {
  auto grid = std::make_unique<ScatteringGrid>(device_, medium(), lighting);
  facts_.sets = grid->sweepOrders(lighting.scattering, progress);
  facts_.work = facts_.sets;
  return grid;
}

/// Solves on the coarsest grid, and on each finer one from that solution.
std::unique_ptr<ScatteringGrid> ScatteringSolver::solveAllOrders(const Lighting& lighting, const Progress& progress) {
  double reference = 0.0;
  std::unique_ptr<ScatteringGrid> coarse;
  for (std::size_t level = media_.size(); level-- > level_;) {
    auto grid = std::make_unique<ScatteringGrid>(device_, media_[level], lighting);
    if (coarse) grid->startFrom(*coarse);
    Gmres gmres(*grid, progress);
    // The norm of a vector grows with the root of the number of cells.
    const double scale = coarse ? std::sqrt(double(grid->cells()) / double(coarse->cells())) : 0.0;
    const double tolerance = isDraft_ || level_ > 0 ? kDraftTolerance : level > level_ ? kCoarseTolerance : kScatteringTolerance;
    const double first = gmres.solve(scale * reference, tolerance);
    reference = coarse ? scale * reference : first;
    facts_.sets = gmres.sets();
    facts_.work += gmres.sets() * double(grid->cells()) / double(medium().grid().count());
    facts_.residual = gmres.residual();
    coarse = std::move(grid);
  }
  return coarse;
}

void ScatteringSolver::solve(const Lighting& lighting, int coarseness, std::vector<StageTime>& times, const Progress& progress) {
  const std::size_t level = std::min(std::size_t(coarseness), media_.size() - 1);
  if (solved_ && level == level_ && isSameLight(*solved_, lighting)) return;
  solved_.reset();
  level_ = level;
  const StageTimer timer(times, "scattering");
  facts_ = {.cells = medium().grid().cells, .edge = medium().grid().edge};
  const bool isSolved = lighting.scattering == kAllOrders;
  texelBuffer_ = (isSolved ? solveAllOrders(lighting, progress) : solveOrders(lighting, progress))->makeTexels();
  texels_ = TexelView(device_, texelBuffer_);
  solved_ = lighting;
  brightest_ = download().brightest();
  deltaScale_ = deltaScaleOf(lighting, medium());
  static std::atomic<std::uint64_t> versions = 0;
  version_ = ++versions;
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
