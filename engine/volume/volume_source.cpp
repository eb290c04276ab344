#include "engine/volume/volume_source.h"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>
#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr int kEdge = ScalarBricks::kEdge;

/// The part of some values in a box, in bricks that begin with it.
ScalarBricks part(const ScalarBricks& values, const VoxelRange& box) {
  if (values.corner() != glm::ivec3(0)) {
    const auto mayHoldData = [&](glm::ivec3 voxel) {  // a brick of the part lies in up to eight
      const glm::ivec3 low = (box.first + voxel + values.corner()) / kEdge, high = glm::min(low + 1, values.cells() - 1);
      for (glm::ivec3 cell = low; cell.z <= high.z; ++cell.z)
        for (cell.y = low.y; cell.y <= high.y; ++cell.y)
          for (cell.x = low.x; cell.x <= high.x; ++cell.x)
            if (values.numberAt(cell)) return true;
      return false;
    };
    return ScalarBricks::make(
        box.extent(), [&](glm::ivec3 voxel) { return values.at(box.first + voxel); }, mayHoldData);
  }
  ScalarBricks result(box.extent());
  const glm::ivec3 first = box.first / kEdge, cells = result.cells();
  for (glm::ivec3 cell(0); cell.z < cells.z; ++cell.z)
    for (cell.y = 0; cell.y < cells.y; ++cell.y)
      for (cell.x = 0; cell.x < cells.x; ++cell.x)
        if (const std::optional<std::size_t> brick = values.numberAt(first + cell)) result.makeBrick(cell) = values.brick(*brick);
  return result;
}

Volume outlineInMemory(const Volume& volume) {
  Volume outline = outlineOf(volume);
  outline.classification = volume.classification;
  outline.classificationIsFixed = volume.classificationIsFixed;
  outline.content = volume.content;
  return outline;
}

}  // namespace

VolumeInMemory::VolumeInMemory(std::shared_ptr<const Volume> volume) : volume_(std::move(volume)), outline_(outlineInMemory(*volume_)) {}

SparseGrid<std::uint8_t> VolumeInMemory::bricks(int) const {
  const ScalarBricks& scalars = volume_->scalars;
  SparseGrid<std::uint8_t> cells((volume_->dimensions + kEdge - 1) / kEdge);
  for (std::size_t brick = 0; brick < scalars.count(); ++brick) {
    // The bricks in memory may begin before the box, and then lie in several of those that begin with it.
    const glm::ivec3 begin = glm::max(scalars.firstVoxel(brick), 0), end = glm::min(scalars.firstVoxel(brick) + kEdge, volume_->dimensions);
    const glm::ivec3 low = begin / kEdge, high = (end - 1) / kEdge;
    for (glm::ivec3 cell = low; cell.z <= high.z; ++cell.z)
      for (cell.y = low.y; cell.y <= high.y; ++cell.y)
        for (cell.x = low.x; cell.x <= high.x; ++cell.x) cells[cell] = 1;
  }
  return cells;
}

Volume VolumeInMemory::read(int level, const VoxelRange& box) const {
  FV_CHECK_EQ(level, 0);
  Volume volume = outline_;
  volume.dimensions = box.extent();
  volume.indexToWorld = glm::translate(volume.indexToWorld, glm::dvec3(box.first));
  forEachGrid([&](ScalarBricks& read, const ScalarBricks& all) { read = part(all, box); }, volume, *volume_);
  return volume;
}

std::shared_ptr<const Volume> known(const std::shared_ptr<const VolumeSource>& source) {
  return source->isInMemory() ? source->whole() : std::shared_ptr<const Volume>(source, &source->outline());
}

std::uint64_t brickVoxels(const VolumeSource& source) {
  std::uint64_t bricks = 0;
  source.bricks().forEach([&](glm::ivec3, std::uint8_t) { ++bricks; });
  return bricks * std::uint64_t(kEdge * kEdge * kEdge);
}

}  // namespace freevoxels
