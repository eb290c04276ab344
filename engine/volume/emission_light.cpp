#include "engine/volume/emission_light.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freevoxels {

namespace {

constexpr int kMaxCells = 48;             // along the longest edge
constexpr std::size_t kMaxSources = 128;

/// A source has this squared radius, in squared edges of its cube, so that it is not brighter than the middle
/// of a sphere of the same volume and emission.
const double kCore2 = std::pow(3.0 / (4.0 * std::numbers::pi), 2.0 / 3.0) / 3.0;

struct Source {
  glm::dvec3 place{0.0};  // cells
  glm::dvec3 power{0.0};
  double core2 = 0.0;     // squared world length
};

double luminance(const glm::dvec3& color) { return glm::dot(color, glm::dvec3(0.2126, 0.7152, 0.0722)); }

/// Joins the cells to sources: one for each cube of 1, 2, 4, ... cells along an edge, the smallest that gives
/// at most kMaxSources sources.
std::vector<Source> sourcesOf(const EmissionCells& cells) {
  for (int group = 1;; group *= 2) {
    const glm::ivec3 groups = (cells.size() + group - 1) / group;
    std::vector<Source> sums(std::size_t(groups.x) * std::size_t(groups.y) * std::size_t(groups.z));
    glm::ivec3 cell;
    for (cell.z = 0; cell.z < cells.size().z; ++cell.z)
      for (cell.y = 0; cell.y < cells.size().y; ++cell.y)
        for (cell.x = 0; cell.x < cells.size().x; ++cell.x) {
          const glm::dvec3& power = cells.at(cell).power;
          if (power == glm::dvec3(0.0)) continue;
          const glm::ivec3 at = cell / group;
          Source& sum = sums[std::size_t(at.x) + std::size_t(groups.x) * (std::size_t(at.y) + std::size_t(groups.y) * std::size_t(at.z))];
          sum.power += power;
          sum.place += luminance(power) * glm::dvec3(cell);
        }
    std::erase_if(sums, [](const Source& source) { return source.power == glm::dvec3(0.0); });
    if (sums.size() > kMaxSources && groups != glm::ivec3(1)) continue;
    for (Source& source : sums) {
      source.place /= luminance(source.power);
      source.core2 = kCore2 * group * group * cells.cellEdge() * cells.cellEdge();
    }
    return sums;
  }
}

/// The optical depth between the centres of two cells that are `length` world units apart.
double depthBetween(const EmissionCells& cells, const glm::dvec3& from, const glm::dvec3& to, double length) {
  const int steps = std::max(1, int(std::ceil(glm::length(to - from))));
  double sum = 0.0;
  for (int i = 0; i < steps; ++i) {
    const glm::dvec3 place = glm::mix(from, to, (i + 0.5) / steps);
    sum += cells.at(glm::clamp(glm::ivec3(glm::round(place)), glm::ivec3(0), cells.size() - 1)).extinction;
  }
  return sum * length / steps;
}

}  // namespace

EmissionCells::EmissionCells(glm::ivec3 dimensions, const glm::dmat4& indexToWorld)
    : indexToWorld_(indexToWorld),
      edge_((std::max({dimensions.x, dimensions.y, dimensions.z}) + kMaxCells - 1) / kMaxCells),
      size_((dimensions + edge_ - 1) / edge_),
      values_(std::size_t(size_.x) * std::size_t(size_.y) * std::size_t(size_.z)) {}

double EmissionCells::cellEdge() const {
  return std::cbrt(std::abs(glm::determinant(glm::dmat3(cellsToWorld()))));
}

glm::dmat4 EmissionCells::cellsToWorld() const {
  return indexToWorld_ * glm::dmat4(glm::dvec4(edge_, 0, 0, 0), glm::dvec4(0, edge_, 0, 0), glm::dvec4(0, 0, edge_, 0),
                                    glm::dvec4(glm::dvec3(0.5 * (edge_ - 1)), 1));
}

void EmissionCells::add(const Volume& part, glm::ivec3 first, const Classification& classification) {
  const glm::ivec3 end = first + part.dimensions;
  const double share = 1.0 / (double(edge_) * edge_ * edge_);
  const double voxel = std::abs(glm::determinant(glm::dmat3(indexToWorld_)));
  tbb::parallel_for(first.z / edge_, (end.z + edge_ - 1) / edge_, [&](int plane) {
    std::vector<float> scalars(std::size_t(part.dimensions.x)), temperatures(scalars.size());
    for (int z = std::max(plane * edge_, first.z); z < std::min((plane + 1) * edge_, end.z); ++z)
      for (int y = first.y; y < end.y; ++y) {
        part.scalars.copyRow(y - first.y, z - first.z, scalars);
        part.temperature->values.copyRow(y - first.y, z - first.z, temperatures);
        Cell* const row = &values_[index({0, y / edge_, plane})];
        for (int x = first.x; x < end.x; ++x) {
          Cell& cell = row[x / edge_];
          cell.extinction += share * classify(classification, scalars[std::size_t(x - first.x)]).extinction;
          cell.power += voxel * emittedLight(*classification.emission, temperatures[std::size_t(x - first.x)]);
        }
      }
  });
}

EmissionLight::EmissionLight(const Volume& volume, const Classification& classification)
    : EmissionLight([&] {
        EmissionCells cells(volume.dimensions, volume.indexToWorld);
        if (brightestLight(classification, volume) > 0.0) cells.add(volume, glm::ivec3(0), classification);
        return cells;
      }()) {}

EmissionLight::EmissionLight(const EmissionCells& cells) : cells_(cells.size()) {
  const glm::dmat4 cellsToWorld = cells.cellsToWorld();
  worldToCells_ = glm::inverse(cellsToWorld);
  const std::vector<Source> sources = sourcesOf(cells);
  if (sources.empty()) return;
  radiance_.resize(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z));
  const glm::dmat3 linear(cellsToWorld);
  tbb::parallel_for(0, cells_.z, [&](int z) {
    for (int y = 0; y < cells_.y; ++y)
      for (int x = 0; x < cells_.x; ++x) {
        const glm::dvec3 here(x, y, z);
        glm::dvec3 sum(0.0);
        for (const Source& source : sources) {
          const double length = glm::length(linear * (source.place - here));
          const double through = std::exp(-depthBetween(cells, here, source.place, length));
          sum += source.power * (through / (length * length + source.core2));
        }
        radiance_[cells.index({x, y, z})] = sum / (4.0 * std::numbers::pi);
      }
  });
  for (const glm::vec3& radiance : radiance_)
    brightest_ = std::max({brightest_, double(radiance.r), double(radiance.g), double(radiance.b)});
}

glm::dvec3 EmissionLight::at(const glm::dvec3& world) const {
  if (radiance_.empty()) return glm::dvec3(0.0);
  const glm::dvec3 place = glm::clamp(glm::dvec3(worldToCells_ * glm::dvec4(world, 1.0)), glm::dvec3(0.0), glm::dvec3(cells_ - 1));
  const glm::ivec3 low(place);
  const glm::dvec3 part = place - glm::dvec3(low);
  glm::dvec3 sum(0.0);
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 upper(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 shares = glm::mix(1.0 - part, part, glm::dvec3(upper));
    const glm::ivec3 cell = glm::min(low + upper, cells_ - 1);
    sum += shares.x * shares.y * shares.z *
           glm::dvec3(radiance_[std::size_t(cell.x) + std::size_t(cells_.x) * (std::size_t(cell.y) + std::size_t(cells_.y) * std::size_t(cell.z))]);
  }
  return sum;
}

}  // namespace freevoxels
