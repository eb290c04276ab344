#include "engine/attenuation/island_shadows.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace freevoxels {

namespace {

struct Interval {
  double begin, end;
};

/// Where a line is in a box; nothing if it is not.
std::optional<Interval> within(glm::dvec3 origin, glm::dvec3 direction, glm::dvec3 low, glm::dvec3 high) {
  Interval result{-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < low[axis] || origin[axis] > high[axis]) return {};
      continue;
    }
    const double a = (low[axis] - origin[axis]) / direction[axis], b = (high[axis] - origin[axis]) / direction[axis];
    result = {std::max(result.begin, std::min(a, b)), std::min(result.end, std::max(a, b))};
  }
  return result.begin < result.end ? std::optional(result) : std::nullopt;
}

// What is interpolated of the outermost voxels ends a voxel beyond their centres.

glm::dvec3 lowOf(const VoxelRange& box) {
  return glm::dvec3(box.first) - 1.0;
}

glm::dvec3 highOf(const VoxelRange& box) {
  return glm::dvec3(box.end);
}

}  // namespace

IslandShadows::Line IslandShadows::lineOf(const IslandRays& island, const FaceRays& fan, std::uint64_t ray) const {
  const glm::dvec2 offset =
      fan.spacing * glm::dvec2(double(ray % std::uint64_t(fan.rayCount.x)), double(ray / std::uint64_t(fan.rayCount.x)));
  const glm::dvec2 slope = fan.slope + offset * fan.convergence;
  Line line;
  line.direction[fan.axis] = fan.direction;
  line.origin[fan.axis] = fan.farthest + island.box.first[fan.axis];
  for (int side = 0; side < 2; ++side) {
    const int axis = (fan.axis + 1 + side) % 3;
    line.direction[axis] = slope[side] * fan.direction;
    line.origin[axis] = fan.origin[side] + offset[side] + island.box.first[axis];
  }
  if (!source_.atInfinity) line.origin = source_.place;  // where all of these rays meet
  return line;
}

/// False if no ray to the island meets the other one before it.
bool IslandShadows::mayShadow(const IslandRays& other, const IslandRays& island) const {
  const glm::dvec3 middle = 0.5 * (lowOf(island.box) + highOf(island.box)), half = 0.5 * (highOf(island.box) - lowOf(island.box));
  const glm::dvec3 toLight = source_.atInfinity ? source_.place : source_.place - middle;
  const auto met = within(middle, toLight, lowOf(other.box) - half, highOf(other.box) + half);
  return met && met->end > 0.0 && (source_.atInfinity || met->begin < 1.0);
}

/// The optical depth of the whole of another island along a line.
double IslandShadows::depthAlong(const IslandRays& other, const Line& line) const {
  const auto face = std::size_t(fanIndex(line.direction));
  const FaceRays& fan = other.fans[face];
  if (fan.planeCount == 0) return 0.0;
  const glm::dvec3 local = line.origin - glm::dvec3(other.box.first);
  const glm::dvec3 place = local + line.direction * ((fan.farthest - local[fan.axis]) / line.direction[fan.axis]);
  const glm::dvec2 ray = (glm::dvec2(place[(fan.axis + 1) % 3], place[(fan.axis + 2) % 3]) - fan.origin) / fan.spacing;
  const glm::dvec2 low = glm::floor(ray), w = ray - low;
  const auto at = [&](double i, double j) {
    const bool isRay = i >= 0.0 && j >= 0.0 && i < double(fan.rayCount.x) && j < double(fan.rayCount.y);
    return isRay ? double(other.depths[face][std::size_t(i) + std::size_t(fan.rayCount.x) * std::size_t(j)]) : 0.0;
  };
  return std::lerp(std::lerp(at(low.x, low.y), at(low.x + 1.0, low.y), w.x),
                   std::lerp(at(low.x, low.y + 1.0), at(low.x + 1.0, low.y + 1.0), w.x), w.y);
}

std::vector<float> IslandShadows::before(std::size_t island, int face) const {
  const IslandRays& own = islands_[island];
  const FaceRays& fan = own.fans[std::size_t(face)];
  std::vector<const IslandRays*> others;
  for (const IslandRays& other : islands_)
    if (&other != &own && mayShadow(other, own)) others.push_back(&other);
  if (others.empty()) return {};
  std::vector<float> depths(fan.rays(), 0.0f);
  tbb::parallel_for(0, fan.rayCount.y, [&](int row) {
    for (int column = 0; column < fan.rayCount.x; ++column) {
      const std::uint64_t ray = std::uint64_t(column) + std::uint64_t(fan.rayCount.x) * std::uint64_t(row);
      const Line line = lineOf(own, fan, ray);
      const std::optional<Interval> inside = within(line.origin, line.direction, lowOf(own.box), highOf(own.box));
      if (!inside) continue;
      double depth = 0.0;
      for (const IslandRays* const other : others) {
        const std::optional<Interval> met = within(line.origin, line.direction, lowOf(other->box), highOf(other->box));
        const bool isBefore = met && met->begin + met->end < inside->begin + inside->end && (source_.atInfinity || met->end > 0.0);
        if (isBefore) depth += depthAlong(*other, line);
      }
      depths[ray] = float(depth);
    }
  });
  return std::ranges::any_of(depths, [](float depth) { return depth > 0.0f; }) ? depths : std::vector<float>();
}

}  // namespace freevoxels
