#include "engine/volume/voxel_classifier.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/error.h"
#include "engine/volume/packed_light.h"

namespace freevoxels {

namespace {

constexpr std::size_t kIntervals = 1 << 14;
constexpr float kNoData = -1.0f;  // the position of a voxel without data

}  // namespace

TransferIntegral::TransferIntegral(const TransferFunction& function, float minimum, float maximum)
    : lowest_(minimum), sums_(1, glm::dvec4(0.0)), extinctions_(1, 0.0) {
  const double extent = double(maximum) - double(minimum);
  perScalar_ = extent > 0.0 ? double(kIntervals) / extent : 0.0;
  const Classification classification{.transferFunction = function};
  for (std::size_t i = 0; i < kIntervals; ++i) {
    const ClassifiedVoxel middle =
        classify(classification, float(lowest_ + (double(i) + 0.5) / double(kIntervals) * extent));
    sums_.push_back(sums_.back() + middle.extinction * glm::dvec4(middle.color, 1.0));
    extinctions_.push_back(sums_.back().a);
  }
}

double TransferIntegral::place(double scalar) const {
  return std::clamp((scalar - lowest_) * perScalar_, 0.0, double(kIntervals));
}

glm::dvec4 TransferIntegral::upTo(double place) const {
  const std::size_t i = std::min(std::size_t(place), kIntervals - 1);
  return sums_[i] + (place - double(i)) * (sums_[i + 1] - sums_[i]);
}

double TransferIntegral::extinctionUpTo(double place) const {
  const std::size_t i = std::min(std::size_t(place), kIntervals - 1);
  return extinctions_[i] + (place - double(i)) * (extinctions_[i + 1] - extinctions_[i]);
}

glm::dvec4 TransferIntegral::meanAt(double from, double to) const {
  if (std::abs(to - from) > kMinChange) return glm::max((upTo(to) - upTo(from)) / (to - from), 0.0);
  const std::size_t i = std::min(std::size_t(from), kIntervals - 1);
  return sums_[i + 1] - sums_[i];
}

bool TransferIntegral::holdsAnythingAt(double low, double high) const {
  const std::size_t first = std::min(std::size_t(low), kIntervals - 1);
  const std::size_t last = std::min(std::size_t(high), kIntervals - 1);
  return extinctions_[last + 1] > extinctions_[first];
}

VoxelClassifier::VoxelClassifier(const Classification& classification, const Volume& volume)
    : classification_(classification), volume_(volume) {
  if (!classification.transferFunction) return;
  integral_.emplace(*classification.transferFunction, volume.minimum, volume.maximum);
  placeOfCode_ = volume.scalars.mapValues<float>([this](float scalar) { return placeOf(scalar); });
}

/// Classifies by positions of TransferIntegral: of the voxel, and half-way to its neighbours. The colour is
/// the mean over the range of all of them, weighted by extinction.
ClassifiedVoxel VoxelClassifier::meanOver(float place, const std::array<float, 6>& halfWay) const {
  const auto [low, high] = std::ranges::minmax(halfWay);
  const float first = std::min(place, low), last = std::max(place, high);
  if (!integral_->holdsAnythingAt(first, last)) return {};
  const double own = integral_->extinctionUpTo(place);
  const double there = integral_->meanAt(place, place).a;
  double extinction = 0.0;
  for (const float other : halfWay) {
    const double change = double(other) - double(place);
    extinction += std::abs(change) > TransferIntegral::kMinChange ? (integral_->extinctionUpTo(other) - own) / change : there;
  }
  const glm::dvec4 range = integral_->meanAt(first, last);
  return {std::clamp(extinction / 6.0, 0.0, kMaxExtinction), range.a > 0.0 ? glm::dvec3(range) / range.a : glm::dvec3(0.0)};
}

ClassifiedVoxel VoxelClassifier::at(glm::ivec3 voxel) const {
  const float scalar = volume_.scalars.at(voxel);
  ClassifiedVoxel result;
  if (integral_ && scalar != kInactiveVoxel) {
    std::array<float, 6> neighbours;
    for (int i = 0; i < 6; ++i) {
      glm::ivec3 neighbour = voxel;
      neighbour[i / 2] += i % 2 == 0 ? -1 : 1;
      const bool inside = neighbour[i / 2] >= 0 && neighbour[i / 2] < volume_.dimensions[i / 2];
      neighbours[std::size_t(i)] = inside ? placeOf(volume_.scalars.at(neighbour)) : kNoData;
    }
    result = withNeighbours(scalar, placeOf(scalar), neighbours);
  } else if (!integral_) {
    result = classify(classification_, scalar);
    if (volume_.albedo) result.color = albedoOf(classification_, *volume_.albedo, voxel);
  }
  if (classification_.emission && volume_.temperature)
    result.emission = emittedLight(*classification_.emission, volume_, voxel, volume_.temperature->values.at(voxel));
  return result;
}

/// A neighbour without data counts as equal to the voxel. In a uniform neighbourhood the result is exactly
/// the function's value.
ClassifiedVoxel VoxelClassifier::withNeighbours(float scalar, float place, const std::array<float, 6>& neighbours) const {
  std::array<float, 6> halfWay;
  bool even = true;
  for (std::size_t i = 0; i < 6; ++i) {
    halfWay[i] = neighbours[i] == kNoData ? place : 0.5f * (place + neighbours[i]);
    even = even && halfWay[i] == place;
  }
  if (even && !integral_->holdsAnythingAt(place, place)) return {};
  ClassifiedVoxel result = even ? classify(classification_, scalar) : meanOver(place, halfWay);
  result.color = unpackColor(packColor(result.color));
  return result;
}

float VoxelClassifier::placeOf(float scalar) const {
  return scalar == kInactiveVoxel ? kNoData : float(integral_->place(scalar));
}

void VoxelClassifier::classifyBrick(std::size_t brick, std::span<float> extinction, std::span<std::uint32_t> colors) const {
  FV_CHECK_EQ(integral_.has_value(), true);
  constexpr int n = ScalarBricks::kEdge, m = n + 2;
  constexpr std::array<int, 3> kStrides{1, m, m * m};
  const ScalarBricks& scalars = volume_.scalars;
  std::ranges::fill(extinction, 0.0f);
  std::ranges::fill(colors, 0u);
  // Positions of the brick's voxels and of one layer of voxels around it.
  std::array<float, std::size_t(m) * m * m> around;
  around.fill(kNoData);
  const auto copy = [&](std::size_t number, glm::ivec3 begin, glm::ivec3 end, glm::ivec3 to) {
    ScalarBricks::Brick places;
    scalars.mapBrick(
        number, std::span<float>(places), [this](float scalar) { return placeOf(scalar); }, std::span<const float>(placeOfCode_));
    for (int z = begin.z; z < end.z; ++z)
      for (int y = begin.y; y < end.y; ++y)
        for (int x = begin.x; x < end.x; ++x)
          around[std::size_t(x + to.x + m * (y + to.y + m * (z + to.z)))] = places[ScalarBricks::indexInBrick({x, y, z})];
  };
  copy(brick, glm::ivec3(0), glm::ivec3(n), glm::ivec3(1));
  for (int axis = 0; axis < 3; ++axis)
    for (const bool up : {false, true}) {
      glm::ivec3 cell = scalars.cell(brick), begin(0), end(n), to(1);
      cell[axis] += up ? 1 : -1;
      if (cell[axis] < 0 || cell[axis] >= scalars.cells()[axis]) continue;
      (up ? end : begin)[axis] = up ? 1 : n - 1;
      to[axis] = up ? n + 1 : 1 - n;
      if (const auto beside = scalars.numberAt(cell)) copy(*beside, begin, end, to);
    }
  // Most bricks have no extinction at all.
  float low = std::numeric_limits<float>::max(), high = kNoData;
  for (const float place : around) {
    low = std::min(low, place == kNoData ? low : place);
    high = std::max(high, place);
  }
  if (low > high || !integral_->holdsAnythingAt(low, high)) return;
  const ScalarBricks::Brick middle = scalars.brick(brick);
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x) {
        const float* const own = &around[std::size_t(x + 1 + m * (y + 1 + m * (z + 1)))];
        if (*own == kNoData) continue;
        std::array<float, 6> neighbours;
        for (std::size_t i = 0; i < 6; ++i) neighbours[i] = own[i % 2 == 0 ? -kStrides[i / 2] : kStrides[i / 2]];
        const std::size_t voxel = ScalarBricks::indexInBrick({x, y, z});
        const ClassifiedVoxel result = withNeighbours(middle[voxel], *own, neighbours);
        extinction[voxel] = float(result.extinction);
        if (result.extinction > 0.0) colors[voxel] = packColor(result.color);
      }
}

}  // namespace freevoxels
