#include "engine/volume/scattering_medium.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <utility>
#include <vector>

namespace freevoxels {

namespace {

/// Extinction and colour by scalar: from a table if there is a transfer function. Scalars beyond the volume's range, which means of coarse
/// levels may be, have the values of its end.
class MediumTable {
 public:
  MediumTable(const Volume& volume, const Classification& classification)
      : scale_(std::min(classification.densityScale, double(std::numeric_limits<float>::max()))),
        albedo_(classification.albedo),
        low_(volume.minimum) {
    if (!classification.transferFunction) return;
    if (volume.maximum > volume.minimum) perScalar_ = double(kIntervals) / (double(volume.maximum) - low_);
    for (int i = 0; i <= kIntervals; ++i)
      values_.push_back(classify(classification, float(std::lerp(low_, double(volume.maximum), double(i) / kIntervals))));
  }
  double extinctionAt(float scalar) const {
    if (scalar == kInactiveVoxel) return 0.0;
    return values_.empty() ? std::min(std::max(double(scalar), 0.0) * scale_, kMaxExtinction) : entry(scalar).extinction;
  }
  glm::dvec3 colorAt(float scalar) const { return values_.empty() ? albedo_ : entry(scalar).color; }

 private:
  static constexpr int kIntervals = 4096;
  const ClassifiedVoxel& entry(float scalar) const {
    return values_[std::size_t(std::clamp((double(scalar) - low_) * perScalar_, 0.0, double(kIntervals)) + 0.5)];
  }

  double scale_;
  glm::dvec3 albedo_;
  double low_, perScalar_ = 0.0;  ///< a float does not hold the extent of any range, or its inverse
  std::vector<ClassifiedVoxel> values_;
};

/// The smallest edge, a multiple of `unit`, of which there are at most `most` cells.
int edgeFor(glm::ivec3 dimensions, std::uint64_t most, int unit) {
  const auto cells = [&](int edge) {
    const CellGrid grid(dimensions, edge);
    return double(grid.cells.x) * double(grid.cells.y) * double(grid.cells.z);
  };
  // There are at least as many cells as fit into the box.
  const double least = std::cbrt(double(dimensions.x) * double(dimensions.y) * double(dimensions.z) / double(most));
  int edge = unit * std::max(int(least / unit), 1);
  while (cells(edge) > double(most)) edge += unit;
  return edge;
}

/// The size and the place of an index space along the axes of the world that holds all volumes, with voxels as small as their smallest.
std::pair<glm::ivec3, glm::dmat4> cellSpaceOf(std::span<const PlacedMedium> volumes) {
  constexpr double kMost = 1 << 20;  // along an axis
  glm::dvec3 low(std::numeric_limits<double>::max()), high(std::numeric_limits<double>::lowest());
  double voxel = std::numeric_limits<double>::max();
  for (const PlacedMedium& placed : volumes) {
    const Volume& volume = *placed.volume;
    voxel = std::min(voxel, volume.voxelSize());
    for (int corner = 0; corner < 8; ++corner) {
      const glm::dvec3 side(corner & 1, corner >> 1 & 1, corner >> 2);
      const glm::dvec3 place(volume.indexToWorld * glm::dvec4(side * glm::dvec3(volume.dimensions) - 0.5, 1.0));
      low = glm::min(low, place);
      high = glm::max(high, place);
    }
  }
  const glm::dvec3 extent = high - low;
  const double edge = std::max(voxel, std::max({extent.x, extent.y, extent.z}) / kMost);
  glm::dmat4 toWorld(edge);
  toWorld[3] = glm::dvec4(low + 0.5 * edge, 1.0);
  return {glm::max(glm::ivec3(glm::ceil(extent / edge - 1e-9)), glm::ivec3(1)), toWorld};
}

template <typename Visit>
void forEachCell(const CellGrid& grid, const Visit& visit) {
  std::size_t i = 0;
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < grid.cells.z; ++cell.z)
    for (cell.y = 0; cell.y < grid.cells.y; ++cell.y)
      for (cell.x = 0; cell.x < grid.cells.x; ++cell.x) visit(cell, i++);
}

/// The share of a cell in the box and behind the plane of `clip`: exact for a box, and for a plane across an axis.
double shareOf(const CellGrid& grid, glm::ivec3 cell, const RayClip& clip) {
  const double edge = grid.edge;
  const glm::dvec3 low = glm::dvec3(cell * grid.edge) - 0.5;
  const glm::dvec3 inBox = glm::clamp(glm::min(clip.high, low + edge) - glm::max(clip.low, low), 0.0, edge) / edge;
  const double width = edge * (std::abs(clip.normal.x) + std::abs(clip.normal.y) + std::abs(clip.normal.z));
  const double behind = clip.distance - glm::dot(clip.normal, low + 0.5 * edge);
  return inBox.x * inBox.y * inBox.z * (width > 0.0 ? std::clamp(0.5 + behind / width, 0.0, 1.0) : 1.0);
}

bool isGreyColor(const glm::dvec3& color) {
  return color.r == color.g && color.g == color.b;
}

}  // namespace

CellGrid ScatteringMedium::directGridOf(glm::ivec3 dimensions) {
  return {dimensions, edgeFor(dimensions, kMaxDirectCells, 1)};
}

CellGrid ScatteringMedium::gridOf(glm::ivec3 dimensions) {
  return {dimensions, edgeFor(dimensions, kMaxScatteringCells, directGridOf(dimensions).edge)};
}

ScatteringMedium::ScatteringMedium(glm::ivec3 dimensions, const glm::dmat4& indexToWorld)
    : indexToWorld_(indexToWorld),
      grid_(gridOf(dimensions)),
      directGrid_(directGridOf(dimensions)),
      cells_(grid_.count()),
      direct_(directGrid_.count(), 0.0) {}

ScatteringMedium::ScatteringMedium(const Volume& volume, const Classification& classification)
    : ScatteringMedium(volume.dimensions, volume.indexToWorld) {
  add(volume, glm::ivec3(0), classification);
}

void ScatteringMedium::add(const Volume& part, glm::ivec3 first, const Classification& classification) {
  const MediumTable table(part, classification);
  const glm::ivec3 end = first + part.dimensions;
  const auto volumeOf = [](int edge) { return double(edge) * edge * edge; };
  const double share = 1.0 / volumeOf(grid_.edge), directShare = 1.0 / volumeOf(directGrid_.edge);
  const bool hasGrid = part.albedo.has_value() && !classification.transferFunction;
  const bool emits = classification.emission && part.temperature;
  const auto extinctionOf = [&](float scalar) { return table.extinctionAt(scalar); };
  const std::vector<double> extinctionOfCode = part.scalars.mapValues<double>(extinctionOf);
  tbb::parallel_for(first.z / grid_.edge, (end.z + grid_.edge - 1) / grid_.edge, [&](int plane) {
    std::vector<float> scalars(std::size_t(part.dimensions.x)), temperatures(scalars.size());
    std::vector<double> extinctions(scalars.size());
    for (int z = std::max(plane * grid_.edge, first.z); z < std::min((plane + 1) * grid_.edge, end.z); ++z)
      for (int y = first.y; y < end.y; ++y) {
        part.scalars.mapRow(y - first.y, z - first.z, std::span<double>(extinctions), extinctionOf,
                            std::span<const double>(extinctionOfCode));
        if (!emits && std::ranges::all_of(extinctions, [](double extinction) { return extinction == 0.0; })) continue;
        part.scalars.copyRow(y - first.y, z - first.z, scalars);
        if (emits) part.temperature->values.copyRow(y - first.y, z - first.z, temperatures);
        Cell* const row = &cells_[grid_.index({0, y / grid_.edge, plane})];
        double* const directRow = &direct_[directGrid_.index({0, y / directGrid_.edge, z / directGrid_.edge})];
        for (int x = first.x; x < end.x; ++x) {
          const float scalar = scalars[std::size_t(x - first.x)];
          Cell& cell = row[x / grid_.edge];
          if (emits)
            cell.emission +=
                share * emittedLight(*classification.emission, part, glm::ivec3(x, y, z) - first, temperatures[std::size_t(x - first.x)]);
          const double extinction = extinctions[std::size_t(x - first.x)];
          if (extinction == 0.0) continue;
          const glm::dvec3 albedo =
              hasGrid ? glm::dvec3(albedoOf(classification, *part.albedo, glm::ivec3(x, y, z) - first)) : table.colorAt(scalar);
          cell.extinction += share * extinction;
          cell.scattering += share * extinction * albedo;
          directRow[x / directGrid_.edge] += directShare * extinction;
        }
      }
  });
}

ScatteringMedium::ScatteringMedium(std::span<const PlacedMedium> volumes) : ScatteringMedium(cellSpaceOf(volumes)) {
  for (const PlacedMedium& placed : volumes) addPlaced(placed);
}

/// Averages the voxels at points of each direct cell, at most a voxel apart where kMaxPoints allows.
void ScatteringMedium::addPlaced(const PlacedMedium& placed) {
  constexpr int kMaxPoints = 4;  // along the edge of a direct cell
  const Volume& volume = *placed.volume;
  const Classification& classification = *placed.classification;
  const MediumTable table(volume, classification);
  const bool hasGrid = volume.albedo.has_value() && !classification.transferFunction;
  const bool emits = classification.emission && volume.temperature;
  const glm::dmat4 toVolume = glm::inverse(volume.indexToWorld) * indexToWorld_;
  const double cellEdge = directGrid_.edge * glm::length(glm::dvec3(indexToWorld_[0]));
  const int points = std::clamp(int(std::ceil(cellEdge / volume.voxelSize())), 1, kMaxPoints), ratio = grid_.edge / directGrid_.edge;
  const double directShare = 1.0 / (double(points) * points * points), share = directShare / (double(ratio) * ratio * ratio);
  const auto addPoint = [&](glm::ivec3 voxel, Cell& cell, double& direct) {
    if (emits) cell.emission += share * emittedLight(*classification.emission, volume, voxel, volume.temperature->values.at(voxel));
    const double extinction = table.extinctionAt(volume.scalars.at(voxel));
    if (extinction == 0.0) return;
    const glm::dvec3 albedo =
        hasGrid ? glm::dvec3(albedoOf(classification, *volume.albedo, voxel)) : table.colorAt(volume.scalars.at(voxel));
    cell.extinction += share * extinction;
    cell.scattering += share * extinction * albedo;
    direct += directShare * extinction;
  };
  tbb::parallel_for(0, grid_.cells.z, [&](int plane) {
    glm::ivec3 direct;
    for (direct.z = plane * ratio; direct.z < std::min((plane + 1) * ratio, directGrid_.cells.z); ++direct.z)
      for (direct.y = 0; direct.y < directGrid_.cells.y; ++direct.y)
        for (direct.x = 0; direct.x < directGrid_.cells.x; ++direct.x)
          for (int i = 0; i < points * points * points; ++i) {
            const glm::dvec3 part = (glm::dvec3(i % points, i / points % points, i / (points * points)) + 0.5) / double(points);
            const glm::dvec3 place((toVolume * glm::dvec4((glm::dvec3(direct) + part) * double(directGrid_.edge) - 0.5, 1.0)));
            const glm::dvec3 nearest = glm::floor(place + 0.5);
            if (glm::any(glm::lessThan(nearest, glm::dvec3(0.0))) ||
                glm::any(glm::greaterThanEqual(nearest, glm::dvec3(volume.dimensions))))
              continue;
            addPoint(glm::ivec3(nearest), cells_[grid_.index(direct / ratio)], direct_[directGrid_.index(direct)]);
          }
  });
}

ScatteringMedium ScatteringMedium::coarser() const {
  ScatteringMedium result(glm::ivec3(1), indexToWorld_);
  result.directGrid_ = grid_;
  result.grid_.cells = (grid_.cells + 1) / 2;
  result.grid_.edge = 2 * grid_.edge;
  result.cells_.assign(result.grid_.count(), {});
  result.direct_.clear();
  forEachCell(grid_, [&](glm::ivec3 cell, std::size_t i) {
    const Cell& own = cells_[i];
    Cell& sum = result.cells_[result.grid_.index(cell / 2)];
    sum.extinction += own.extinction / 8.0;
    sum.scattering += own.scattering / 8.0;
    sum.emission += own.emission / 8.0;
    result.direct_.push_back(own.extinction);
  });
  return result;
}

ScatteringMedium ScatteringMedium::clipped(const RayClip& clip) const {
  ScatteringMedium result = *this;
  forEachCell(grid_, [&](glm::ivec3 cell, std::size_t i) {
    const double share = shareOf(grid_, cell, clip);
    result.cells_[i].extinction *= share;
    result.cells_[i].scattering *= share;
    result.cells_[i].emission *= share;
  });
  forEachCell(directGrid_, [&](glm::ivec3 cell, std::size_t i) { result.direct_[i] *= shareOf(directGrid_, cell, clip); });
  return result;
}

std::vector<double> ScatteringMedium::surfaceShares() const {
  const auto extinctionAt = [&](glm::ivec3 cell) {
    const bool within = glm::all(glm::greaterThanEqual(cell, glm::ivec3(0))) && glm::all(glm::lessThan(cell, grid_.cells));
    return within ? cells_[grid_.index(cell)].extinction : 0.0;
  };
  std::vector<double> shares;
  forEachCell(grid_, [&](glm::ivec3 cell, std::size_t i) {
    glm::dvec3 gradient;
    for (int axis = 0; axis < 3; ++axis) {
      glm::ivec3 step(0);
      step[axis] = 1;
      gradient[axis] = 0.5 * (extinctionAt(cell + step) - extinctionAt(cell - step));
    }
    const double own = cells_[i].extinction;
    shares.push_back(own > 0.0 ? surfaceShare(glm::length(gradient) / own) : 0.0);
  });
  return shares;
}

glm::dvec3 ScatteringMedium::meanAlbedo() const {
  double extinction = 0.0;
  glm::dvec3 scattering(0.0);
  for (const Cell& cell : cells_) {
    extinction += cell.extinction;
    scattering += cell.scattering;
  }
  return extinction > 0.0 ? scattering / extinction : glm::dvec3(0.0);
}

glm::dvec3 deltaScaleOf(const Lighting& lighting, const ScatteringMedium& medium) {
  const double forward = splitPhase(lighting).forward;
  return forward > 0.0 ? 1.0 - forward * medium.meanAlbedo() : glm::dvec3(1.0);
}

bool ScatteringMedium::emits() const {
  return std::ranges::any_of(cells_, [](const Cell& cell) { return cell.emission != glm::dvec3(0.0); });
}

bool ScatteringMedium::isGrey() const {
  return std::ranges::all_of(cells_, [](const Cell& cell) { return isGreyColor(cell.scattering) && isGreyColor(cell.emission); });
}

}  // namespace freevoxels
