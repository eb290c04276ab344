#include "engine/reference/reference_scattering.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "engine/reference/reference_light.h"
#include "engine/scene/sphere_quadrature.h"

namespace freevoxels {

namespace {

constexpr int kMaxIterations = 2000;

/// Mean radiance of a cell, and its flux.
struct Moments {
  glm::dvec3 mean{0.0};
  std::array<glm::dvec3, 3> flux{glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0)};

  glm::dvec3 along(const glm::dvec3& way) const { return way.x * flux[0] + way.y * flux[1] + way.z * flux[2]; }
  void add(const glm::dvec3& light, const glm::dvec3& way) {
    mean += light;
    for (int axis = 0; axis < 3; ++axis) flux[std::size_t(axis)] += way[axis] * light;
  }
};

bool isInside(glm::ivec3 cell, glm::ivec3 cells) {
  return glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) && glm::all(glm::lessThan(cell, cells));
}

class Transport {
 public:
  Transport(const ScatteringMedium& medium, const Lighting& lighting)
      : medium_(medium),
        grid_(medium.grid()),
        split_(splitPhase(lighting)),
        depthScale_(lighting.tint * deltaScaleOf(lighting, medium)),
        directExtinction_(medium.directExtinction()),
        directions_(sphereQuadrature(medium.indexToWorld())),
        direct_(grid_.count()),
        light_(grid_.count()),
        sky_(surroundingRadiances(lighting, directions_, medium.indexToWorld())) {
    const std::vector<double> surfaces = medium.surfaceShares();
    for (std::size_t i = 0; i < grid_.count(); ++i) {
      const ScatteringMedium::Cell& cell = medium.cells()[i];
      extinction_.push_back(lighting.tint * (cell.extinction - split_.forward * cell.scattering));
      scattering_.push_back(lighting.tint * (1.0 - split_.forward) * (1.0 - lighting.surface * surfaces[i]) * cell.scattering);
    }
    for (const Light& light : lighting.lights) addDirect(light);
  }

  /// Replaces the light by what it becomes by being scattered once more. Returns its largest change over its largest value.
  double iterate(bool withScattering) {
    std::vector<glm::dvec3> swept(grid_.count());
    std::vector<std::vector<glm::dvec3>> byDirection(directions_.size());
    tbb::parallel_for(std::size_t(0), directions_.size(), [&](std::size_t i) { byDirection[i] = sweep(i, withScattering); });
    double change = 0.0, largest = 1e-300;
    for (std::size_t cell = 0; cell < grid_.count(); ++cell) {
      Moments sum;
      for (std::size_t i = 0; i < directions_.size(); ++i) sum.add(directions_[i].weight * byDirection[i][cell], directions_[i].unit);
      for (int c = 0; c < 3; ++c) {
        change = std::max(change, std::abs(sum.mean[c] - light_[cell].mean[c]));
        largest = std::max(largest, sum.mean[c]);
      }
      light_[cell] = sum;
    }
    return change / largest;
  }

  ScatteredField field() const {
    ScatteredField result{.cells = grid_.cells, .edge = grid_.edge, .share = 1.0 - split_.forward, .flux = 3.0 * split_.g, .mean = {}};
    for (const Moments& moments : light_) {
      result.mean.push_back(moments.mean);
      if (split_.g != 0.0) result.fluxes.push_back(moments.flux);
    }
    return result;
  }
  const std::vector<Moments>& direct() const { return direct_; }

 private:
  double directExtinctionAt(glm::ivec3 cell) const {
    const CellGrid& grid = medium_.directGrid();
    return isInside(cell, grid.cells) ? double(directExtinction_[grid.index(cell)]) : 0.0;
  }

  /// Interpolated bilinearly on a plane of cells.
  double onPlane(glm::dvec3 position, int axis) const {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    glm::ivec3 low(glm::floor(position));
    low[axis] = int(std::lround(position[axis]));
    const double partA = position[a] - low[a], partB = position[b] - low[b];
    double sum = 0.0;
    for (int corner = 0; corner < 4; ++corner) {
      glm::ivec3 cell = low;
      cell[a] += corner & 1;
      cell[b] += corner >> 1;
      sum += ((corner & 1) != 0 ? partA : 1.0 - partA) * (corner >> 1 != 0 ? partB : 1.0 - partB) * directExtinctionAt(cell);
    }
    return sum;
  }

  /// The radiance / (4 pi) that reaches the centre of a direct cell, and the direction in which it travels.
  std::pair<glm::dvec3, glm::dvec3> reaching(glm::ivec3 cell, const Light& light) const {
    const CellGrid& grid = medium_.directGrid();
    const glm::dmat3 toWorld = glm::dmat3(medium_.indexToWorld()) * double(grid.edge);
    const RaySource source = lightSource(light, medium_.indexToWorld());
    const glm::dvec3 toLight = source.atInfinity ? source.place : (source.place + 0.5) / double(grid.edge) - 0.5 - glm::dvec3(cell);
    const glm::dvec3 size = glm::abs(toLight);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const double planes = source.atInfinity ? std::numeric_limits<double>::infinity() : size[axis];
    const glm::dvec3 step = toLight / std::max(size[axis], 1e-6);
    double sum = directExtinctionAt(cell) * std::min(0.5, planes);
    for (int k = 1; k < planes + 1.0; ++k) {
      const glm::dvec3 at = glm::dvec3(cell) + double(k) * step;
      if (glm::any(glm::lessThan(at, glm::dvec3(-1.0))) || glm::any(glm::greaterThan(at, glm::dvec3(grid.cells)))) break;
      sum += std::clamp(planes - k + 0.5, 0.0, 1.0) * onPlane(at, axis);
    }
    const glm::dvec3 way = toWorld * toLight;
    const double edge = std::cbrt(std::abs(glm::determinant(toWorld)));
    const double distance2 = source.atInfinity ? 1.0 : std::max(glm::dot(way, way), kNearestLight2 * edge * edge);
    const glm::dvec3 through = glm::exp(-glm::length(toWorld * step) * sum * depthScale_);
    return {light.intensity / (4.0 * std::numbers::pi * distance2) * light.color * through, -way / std::max(glm::length(way), 1e-15)};
  }

  void addDirect(const Light& light) {
    const int ratio = grid_.edge / medium_.directGrid().edge;
    tbb::parallel_for(0, grid_.cells.z, [&](int z) {
      for (int y = 0; y < grid_.cells.y; ++y)
        for (int x = 0; x < grid_.cells.x; ++x) {
          Moments sum;
          double weight = 0.0;
          for (int part = 0; part < ratio * ratio * ratio; ++part) {
            const glm::ivec3 cell = ratio * glm::ivec3(x, y, z) + glm::ivec3(part % ratio, part / ratio % ratio, part / ratio / ratio);
            const double own = directExtinctionAt(cell);
            if (own <= 0.0) continue;
            const auto [radiance, way] = reaching(cell, light);
            sum.add(own * radiance, way);
            weight += own;
          }
          if (weight <= 0.0) continue;
          Moments& to = direct_[grid_.index({x, y, z})];
          to.mean += sum.mean / weight;
          for (std::size_t axis = 0; axis < 3; ++axis) to.flux[axis] += sum.flux[axis] / weight;
        }
    });
  }

  /// What a cell sends out along a direction, per world unit.
  glm::dvec3 sourceOf(std::size_t cell, const glm::dvec3& way, bool withScattering) const {
    glm::dvec3 sum = medium_.cells()[cell].emission;
    if (!withScattering) return sum;
    const glm::dvec3 mean = direct_[cell].mean + light_[cell].mean;
    return sum + scattering_[cell] * (mean + 3.0 * split_.g * (direct_[cell].along(way) + light_[cell].along(way)));
  }

  /// Radiance at the cells along a direction.
  std::vector<glm::dvec3> sweep(std::size_t number, bool withScattering) const {
    const QuadratureDirection& direction = directions_[number];
    const double length = direction.length * grid_.edge;
    std::vector<glm::dvec3> radiance(grid_.count());
    const auto along = [&](int axis, int i) { return direction.step[axis] < 0 ? grid_.cells[axis] - 1 - i : i; };
    for (int k = 0; k < grid_.cells.z; ++k)
      for (int j = 0; j < grid_.cells.y; ++j)
        for (int i = 0; i < grid_.cells.x; ++i) {
          const glm::ivec3 cell(along(0, i), along(1, j), along(2, k)), before = cell - direction.step;
          const std::size_t at = grid_.index(cell);
          glm::dvec3 arriving = sky_[number], extinction = extinction_[at], source = sourceOf(at, direction.unit, withScattering);
          if (isInside(before, grid_.cells)) {
            const std::size_t from = grid_.index(before);
            arriving = radiance[from];
            extinction += extinction_[from];
            source += sourceOf(from, direction.unit, withScattering);
          }
          for (int c = 0; c < 3; ++c) {
            const double depth = 0.5 * length * extinction[c];
            const double mean = depth < 1e-9 ? 1.0 : -std::expm1(-depth) / depth;
            radiance[at][c] = arriving[c] * std::exp(-depth) + 0.5 * length * mean * source[c];
          }
        }
    return radiance;
  }

  const ScatteringMedium& medium_;
  const CellGrid grid_;
  const PhaseSplit split_;
  const glm::dvec3 depthScale_;
  const std::vector<float> directExtinction_;
  const std::vector<QuadratureDirection> directions_;
  std::vector<glm::dvec3> extinction_, scattering_;
  std::vector<Moments> direct_, light_;
  const std::vector<glm::dvec3> sky_;
};

}  // namespace

ScatteredField referenceScattering(const ScatteringMedium& medium, const Lighting& lighting, double tolerance, const Progress& progress) {
  Transport transport(medium, lighting);
  const bool all = lighting.scattering == kAllOrders;
  const int most = all ? kMaxIterations : lighting.scattering;
  for (int i = 0; i < most; ++i) {
    if (progress) progress("scattering", double(i) / most);
    // Of a given number of orders, the last is scattered where it is seen, and the first does not pass the medium before.
    if (transport.iterate(all || i > 0) < tolerance && all) break;
  }
  return transport.field();
}

std::vector<glm::dvec3> referenceDirectLight(const ScatteringMedium& medium, const Lighting& lighting) {
  const Transport transport(medium, lighting);
  std::vector<glm::dvec3> result;
  for (const Moments& moments : transport.direct()) result.push_back(moments.mean);
  return result;
}

}  // namespace freevoxels
