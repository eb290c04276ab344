#include "engine/scene/source_rays.h"

#include <algorithm>
#include <cmath>

namespace freevoxels {

namespace {

/// Distance in voxels that rays extend beyond the outermost voxels, for the interpolation there.
constexpr double kMargin = 1.5;
/// Distance between rays in voxels. At half a voxel an interpolated depth is as good as one summed up for the
/// voxel alone (within 0.5 dB of the image); at a whole voxel images of thin shells lose 3 dB.
constexpr double kFinestSpacing = 0.5;
/// Largest number of rays of a face for every line of voxels along its axis.
constexpr double kMaxRaysPerLine = 6.0;

struct Interval {
  double low, high;
};

/// Chooses the rays that cross `covered`, the part of the farthest plane that the volume projects to. They
/// are placed symmetrically about the middle of the volume, so that a mirrored volume has mirrored rays.
void placeRays(FaceRays& fan, const std::array<Interval, 2>& covered, glm::ivec3 dimensions) {
  const auto length = [&](int side) {
    return covered[std::size_t(side)].high - covered[std::size_t(side)].low;
  };
  const glm::ivec2 across(dimensions[(fan.axis + 1) % 3], dimensions[(fan.axis + 2) % 3]);
  const double mostRays = kMaxRaysPerLine * (across.x + 4.0) * (across.y + 4.0);
  fan.spacing = std::max(kFinestSpacing, std::sqrt(length(0) * length(1) / mostRays));
  for (int side = 0; side < 2; ++side) {
    const auto [low, high] = covered[std::size_t(side)];
    // If rays are half a voxel apart, every second ray passes through the voxels of the farthest plane; along
    // an axis, through those of all planes.
    const double middle = 0.5 * (across[side] - 1);
    fan.origin[side] = middle + fan.spacing * (std::floor((low - middle) / fan.spacing) - 1.0);
    fan.rayCount[side] = int(std::ceil((high - fan.origin[side]) / fan.spacing)) + 2;
  }
}

FaceRays parallelFan(glm::ivec3 dimensions, glm::dvec3 fromSource) {
  const int index = fanIndex(fromSource), axis = index / 2;
  FaceRays fan{.axis = axis, .direction = index % 2 == 0 ? -1 : 1, .planeCount = dimensions[axis]};
  const int last = dimensions[axis] - 1;
  fan.firstPlane = fan.direction > 0 ? 0 : last;
  fan.farthest = fan.direction > 0 ? last : 0;
  std::array<Interval, 2> covered;
  for (int side = 0; side < 2; ++side) {
    const int other = (axis + 1 + side) % 3;
    fan.slope[side] = fromSource[other] / fromSource[axis];
    const double drift = fan.slope[side] * (fan.firstPlane - fan.farthest);
    covered[std::size_t(side)] = {std::min(0.0, -drift) - kMargin,
                                  dimensions[other] - 1 + std::max(0.0, -drift) + kMargin};
  }
  placeRays(fan, covered, dimensions);
  return fan;
}

/// The rays of one face; none if no voxel of the volume lies on it.
FaceRays fanFrom(glm::dvec3 source, glm::ivec3 dimensions, int axis, int direction) {
  FaceRays fan{.axis = axis, .direction = direction};
  const double last = dimensions[axis] - 1;
  const double first = direction > 0 ? std::max(std::floor(source[axis]) + 1.0, 0.0)
                                     : std::min(std::ceil(source[axis]) - 1.0, last);
  fan.farthest = direction > 0 ? last : 0.0;
  const double nearest = std::abs(first - source[axis]), radius = std::abs(fan.farthest - source[axis]);
  if ((fan.farthest - first) * direction < 0.0) return fan;
  std::array<Interval, 2> covered;
  for (int side = 0; side < 2; ++side) {
    const int other = (axis + 1 + side) % 3;
    // The offset from the source on the farthest plane is largest for the nearest plane, or, on the source's
    // own side, for the farthest. It never exceeds the diagonal of the cube around the source.
    const double low = -kMargin - source[other], high = dimensions[other] - 1 + kMargin - source[other];
    const double lowest = low * (low < 0.0 ? radius / nearest : 1.0);
    const double highest = high * (high > 0.0 ? radius / nearest : 1.0);
    covered[std::size_t(side)] = {source[other] + std::max(lowest, -radius - kMargin),
                                  source[other] + std::min(highest, radius + kMargin)};
    if (covered[std::size_t(side)].low >= covered[std::size_t(side)].high) return fan;
  }
  placeRays(fan, covered, dimensions);
  fan.firstPlane = int(first);
  fan.planeCount = int(std::abs(fan.farthest - first)) + 1;
  fan.convergence = 1.0 / (fan.farthest - source[axis]);
  const glm::dvec2 across(source[(axis + 1) % 3], source[(axis + 2) % 3]);
  fan.slope = (fan.origin - across) * fan.convergence;
  return fan;
}

}  // namespace

bool isInside(const RaySource& source, glm::ivec3 dimensions) {
  return !source.atInfinity && glm::all(glm::greaterThanEqual(source.place, glm::dvec3(-0.5))) &&
         glm::all(glm::lessThanEqual(source.place, glm::dvec3(dimensions) - 0.5));
}

int majorAxis(glm::dvec3 direction) {
  const glm::dvec3 size = glm::abs(direction);
  return size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
}

int fanIndex(glm::dvec3 fromSource) {
  const int axis = majorAxis(fromSource);
  return 2 * axis + (fromSource[axis] > 0.0 ? 1 : 0);
}

std::array<FaceRays, 6> faceRays(glm::ivec3 dimensions, const RaySource& source) {
  std::array<FaceRays, 6> fans;
  if (source.atInfinity) {
    fans[std::size_t(fanIndex(-source.place))] = parallelFan(dimensions, -source.place);
    return fans;
  }
  for (int axis = 0; axis < 3; ++axis)
    for (int direction : {-1, 1})
      fans[std::size_t(2 * axis + (direction > 0 ? 1 : 0))] = fanFrom(source.place, dimensions, axis, direction);
  return fans;
}

}  // namespace freevoxels
