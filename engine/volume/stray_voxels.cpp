#include "engine/volume/stray_voxels.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "engine/core/parameter.h"

namespace freevoxels {

namespace {

constexpr double kFewest = 0.001 / 3.0;  // of the voxels, that are left out at each end of an axis
constexpr int kMuchShorter = 16;

/// Voxels with data of each brick.
std::vector<std::uint64_t> countsOf(const ScalarBricks& scalars) {
  std::vector<std::uint64_t> counts;
  for (std::size_t number = 0; number < scalars.count(); ++number)
    counts.push_back(std::uint64_t(std::ranges::count_if(scalars.brick(number), [](float value) { return value != kInactiveVoxel; })));
  return counts;
}

/// The places along an axis of the bricks between which all but few voxels are.
std::pair<int, int> usualAlong(const ScalarBricks& scalars, const std::vector<std::uint64_t>& counts, double all, int axis) {
  std::vector<std::pair<int, std::uint64_t>> places;
  for (std::size_t brick = 0; brick < counts.size(); ++brick) places.emplace_back(scalars.firstVoxel(brick)[axis], counts[brick]);
  std::ranges::sort(places);
  const auto firstOf = [&](auto begin, auto end) {
    double before = 0.0;
    for (; begin != end && before + double(begin->second) <= kFewest * all; ++begin) before += double(begin->second);
    return begin->first;
  };
  return {firstOf(places.begin(), places.end()), firstOf(places.rbegin(), places.rend())};
}

}  // namespace

std::optional<StrayVoxels> strayVoxels(const Volume& volume) {
  const ScalarBricks& scalars = volume.scalars;
  const std::vector<std::uint64_t> counts = countsOf(scalars);
  if (volume.activeVoxels == 0) return {};
  StrayVoxels stray;
  for (int axis = 0; axis < 3; ++axis) {
    const auto [first, last] = usualAlong(scalars, counts, double(volume.activeVoxels), axis);
    stray.others.first[axis] = std::max(first, 0);
    stray.others.last[axis] = std::min(last + ScalarBricks::kEdge, volume.dimensions[axis]) - 1;
  }
  const glm::ivec3 n = volume.dimensions, extent = stray.others.last - stray.others.first + 1;
  if (std::max({n.x, n.y, n.z}) / kMuchShorter < std::max({extent.x, extent.y, extent.z})) return {};
  for (std::size_t brick = 0; brick < counts.size(); ++brick) {
    const glm::ivec3 place = scalars.firstVoxel(brick);
    const bool isUsual = glm::all(glm::greaterThanEqual(place + ScalarBricks::kEdge, stray.others.first + 1)) &&
                         glm::all(glm::lessThanEqual(place, stray.others.last));
    if (!isUsual) stray.count += counts[brick];
  }
  return stray;
}

void warnOfStrayVoxels(Volume& volume) {
  const std::optional<StrayVoxels> stray = strayVoxels(volume);
  if (!stray || stray->count == 0) return;
  const glm::ivec3 low = stray->others.first, high = stray->others.last, n = volume.dimensions;
  volume.warnings.push_back(
      fmt::format("{} of the {} voxels of {} lie far from all others, in a box of {}x{}x{} voxels, so that an image of all shows the "
                  "others small: {} leaves "
                  "them out",
                  stray->count, volume.activeVoxels, volume.source, n.x, n.y, n.z,
                  Parameter("clip-box", fmt::format("{},{},{},{},{},{}", low.x, low.y, low.z, high.x, high.y, high.z))));
}

}  // namespace freevoxels
