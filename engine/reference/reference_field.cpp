#include "engine/reference/reference_field.h"

#include <tbb/parallel_for.h>

#include <algorithm>

namespace freevoxels {

namespace {

using Brick = ReferenceField::Brick;

bool isInside(glm::ivec3 voxel, glm::ivec3 dimensions) {
  return glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) && glm::all(glm::lessThan(voxel, dimensions));
}

/// A brick of the values at all corners, or null if all are 0.
template <typename ValueAt>
std::unique_ptr<Brick> makeBrick(glm::ivec3 dimensions, glm::ivec3 position, const ValueAt& valueAt) {
  constexpr int n = ReferenceField::kBrickCorners;
  const glm::ivec3 first = position * ReferenceField::kBrickCells - 1;
  Brick brick{};
  bool anything = false;
  std::size_t corner = 0;
  for (int z = 0; z < n; ++z)
    for (int y = 0; y < n; ++y)
      for (int x = 0; x < n; ++x, ++corner) {
        const glm::ivec3 voxel = first + glm::ivec3(x, y, z);
        if (!isInside(voxel, dimensions)) continue;
        brick[corner] = valueAt(voxel);
        anything |= brick[corner] != glm::vec4(0.0f);
      }
  return anything ? std::make_unique<Brick>(brick) : nullptr;
}

/// Whether any scalar between those of a cell's corners has extinction.
bool mayHold(const TransferIntegral& integral, const glm::vec4* corner) {
  constexpr int n = ReferenceField::kBrickCorners;
  double low = 1e300, high = -1e300;
  for (int i = 0; i < 8; ++i) {
    const glm::vec4& value = corner[(i & 1) + n * ((i >> 1 & 1) + n * (i >> 2))];
    if (value.a == 0.0f) continue;
    low = std::min(low, double(value.r));
    high = std::max(high, double(value.r));
  }
  return low <= high && integral.isOccupied(low, high);
}

}  // namespace

bool ReferenceField::isFilled(const Brick& brick, glm::ivec3 cell) const {
  constexpr int n = kBrickCorners;
  const glm::vec4* const corner = brick.data() + cell.x + n * (cell.y + n * cell.z);
  if (integral_) return mayHold(*integral_, corner);
  float sum = 0.0f;
  for (int edge = 0; edge < 4; ++edge) {
    const glm::vec4* const start = corner + n * ((edge & 1) + n * (edge >> 1));
    sum += start[0].a + start[1].a;
  }
  return sum > 0.0f;
}

ReferenceField::ReferenceField(const Volume& volume, const Classification& classification,
                               const Progress& progress)
    : dimensions_(volume.dimensions),
      brickCount_((volume.dimensions + kBrickCells) / kBrickCells),  // for dimensions + 1 cells
      bricks_(std::size_t(brickCount_.x) * std::size_t(brickCount_.y) * std::size_t(brickCount_.z)) {
  if (!classification.transferFunction && !volume.albedo) evenColor_ = classification.albedo;
  if (brightestLight(classification, volume) > 0.0) emission_.resize(bricks_.size());
  if (classification.isPost(volume))
    integral_.emplace(*classification.transferFunction, volume.minimum, volume.maximum);
  const VoxelClassifier classifier(classification, volume);
  const auto medium = [&](glm::ivec3 voxel) {
    if (integral_) {
      const float scalar = volume.scalars.at(voxel);
      return scalar == kInactiveVoxel ? glm::vec4(0.0f) : glm::vec4(scalar, 0.0f, 0.0f, 1.0f);
    }
    const ClassifiedVoxel material = classifier.at(voxel);
    return material.extinction > 0.0 ? glm::vec4(material.extinction * material.color, material.extinction)
                                     : glm::vec4(0.0f);
  };
  const auto emission = [&](glm::ivec3 voxel) {
    return glm::vec4(classifier.at(voxel).emission, 0.0);
  };
  const std::size_t layer = std::size_t(brickCount_.x) * std::size_t(brickCount_.y);
  for (int z = 0; z < brickCount_.z; ++z) {
    tbb::parallel_for(std::size_t(0), layer, [&](std::size_t i) {
      const glm::ivec3 position(int(i % std::size_t(brickCount_.x)), int(i / std::size_t(brickCount_.x)), z);
      bricks_[std::size_t(z) * layer + i] = makeBrick(dimensions_, position, medium);
      if (!emission_.empty()) emission_[std::size_t(z) * layer + i] = makeBrick(dimensions_, position, emission);
    });
    if (progress) progress("classifying", double(z + 1) / brickCount_.z);
  }
}

}  // namespace freevoxels
