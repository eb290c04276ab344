#include "engine/volume/vdb_volume.h"

#include <cmath>

#include "engine/core/error.h"
#include "engine/volume/scan.h"

namespace freevoxels {

namespace {

glm::dmat4 indexToWorldOf(const openvdb::math::Transform& transform, glm::ivec3 indexOrigin) {
  const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  glm::dmat4 indexToWorld;  // OpenVDB multiplies row vectors from the left, so its rows are glm's columns
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) indexToWorld[i][j] = matrix(i, j);
  indexToWorld[3] = indexToWorld * glm::dvec4(glm::dvec3(indexOrigin), 1.0);
  return indexToWorld;
}

}  // namespace

double voxelsIn(glm::i64vec3 extent) {
  return double(extent.x) * double(extent.y) * double(extent.z);
}

std::string whyUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  return fmt::format("grid '{}' of '{}' cannot be rendered: {}", entry.name, file.path().string(), why);
}

void checkUsable(VdbFile& file, const VdbFile::Entry& entry) {
  for (const std::string& why :
       {whyTypeUnusable(entry.treeType, entry.valueType), whyTransformUnusable(file.readMetadata(entry)->transform())})
    if (!why.empty()) throw Error(ErrorKind::Input, whyUnusable(file, entry, why));
}

Volume boxVolume(const openvdb::math::Transform& transform, const openvdb::CoordBBox& bounds, const std::string& source) {
  Volume volume{
      .source = source, .dimensions = glm::ivec3(extentOf(bounds)), .indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()}};
  volume.indexToWorld = indexToWorldOf(transform, volume.indexOrigin);
  normaliseWorld(volume);
  return volume;
}

void limitOverflow(ScalarBricks& scalars, std::uint64_t& overflown) {
  constexpr float kMaxHalf = 65504.0f;
  for (ScalarBricks::Brick& brick : scalars.editable())
    for (float& scalar : brick)
      if (std::isinf(scalar)) {
        scalar = std::copysign(kMaxHalf, scalar);
        ++overflown;
      }
}

void finishVolume(VdbFile& file, const VdbFile::Entry& entry, const openvdb::GridBase& grid, Volume& volume) {
  volume.warnings.insert(volume.warnings.begin(), file.warnings().begin(), file.warnings().end());
  volume.isSolid = volume.isSolid || isLevelSet(grid);
  volume.isFog = !volume.isSolid && isFog(grid);
  if (isLevelSet(grid) && grid.getGridClass() != openvdb::GRID_LEVEL_SET)
    volume.remarks.emplace_back("its values are distances from a surface, as those of a level set");
  if (isLevelSet(grid) && isInverted(grid))
    volume.remarks.emplace_back("distances of the level set are negative outside, and count the other way round");
  orientScan(volume);
  if (!file.isFromBlender(entry)) return;
  volume.upReason = "Blender wrote the file";
  volume.up = {0.0, 0.0, 1.0};
}

}  // namespace freevoxels
