#include <tbb/parallel_for.h>

#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_grids.h"

namespace freevoxels {

namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using Leaf = openvdb::FloatTree::LeafNodeType;

/// The leaf at `corner` (a multiple of its size, in the file's index space), or null if none of its voxels is
/// active.
std::unique_ptr<Leaf> makeLeaf(const Volume& volume, const ScalarBricks& scalars, const Coord& corner) {
  const glm::ivec3 first = glm::ivec3(corner.x(), corner.y(), corner.z()) - volume.indexOrigin;
  const glm::ivec3 begin = glm::max(first, glm::ivec3(0));
  const glm::ivec3 end = glm::min(first + int(Leaf::DIM), volume.dimensions);
  std::unique_ptr<Leaf> leaf;
  for (int z = begin.z; z < end.z; ++z)
    for (int y = begin.y; y < end.y; ++y)
      for (int x = begin.x; x < end.x; ++x) {
        const float value = scalars.at({x, y, z});
        if (value == kInactiveVoxel) continue;
        if (!leaf) leaf = std::make_unique<Leaf>(corner, 0.0f);
        leaf->setValueOn(corner + Coord(x - first.x, y - first.y, z - first.z), value);
      }
  return leaf;
}

/// The corners of all leaves that bricks overlap.
std::set<Coord> leafCorners(const Volume& volume, const ScalarBricks& scalars) {
  const int mask = ~(int(Leaf::DIM) - 1);
  std::set<Coord> corners;
  for (std::size_t brick = 0; brick < scalars.bricks().size(); ++brick) {
    const glm::ivec3 first = scalars.firstVoxel(brick) + volume.indexOrigin;
    for (int corner = 0; corner < 8; ++corner) {
      const glm::ivec3 end =
          first + (ScalarBricks::kEdge - 1) * glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
      corners.insert(Coord(end.x & mask, end.y & mask, end.z & mask));
    }
  }
  return corners;
}

void fillTree(openvdb::FloatTree& tree, const Volume& volume, const ScalarBricks& scalars) {
  for (const Coord& corner : leafCorners(volume, scalars))
    if (auto leaf = makeLeaf(volume, scalars, corner)) tree.addLeaf(leaf.release());
  tree.prune();  // uniform leaves become tiles
}

openvdb::math::Transform::Ptr transformOf(const Volume& volume) {
  glm::dmat4 fileIndexToWorld = volume.indexToWorld;
  fileIndexToWorld[3] = volume.indexToWorld * glm::dvec4(-glm::dvec3(volume.indexOrigin), 1.0);
  openvdb::Mat4d matrix;  // OpenVDB's rows are glm's columns
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) matrix(i, j) = fileIndexToWorld[i][j];
  return openvdb::math::Transform::createLinearTransform(matrix);
}

/// OpenVDB does not notice a full disk: checks that the file is as long as its own header says.
void checkComplete(const std::filesystem::path& file) {
  try {
    readVdbHeader(file);
  } catch (const Error&) {
    throw std::runtime_error("not all of it could be written");
  }
}

/// Of a field, layer by layer. The field's bricks are the leaves of the tree.
template <typename ValueAt>
void fillTree(openvdb::FloatTree& tree, const ProceduralField& field, const ValueAt& valueAt) {
  static_assert(Leaf::DIM == ScalarBricks::kEdge);
  const glm::ivec3 n = field.dimensions(), leaves = (n + int(Leaf::DIM) - 1) / int(Leaf::DIM);
  std::vector<std::unique_ptr<Leaf>> layer(std::size_t(leaves.x) * std::size_t(leaves.y));
  for (int z = 0; z < leaves.z; ++z) {
    tbb::parallel_for(std::size_t(0), layer.size(), [&](std::size_t i) {
      const glm::ivec3 first = int(Leaf::DIM) * glm::ivec3(int(i) % leaves.x, int(i) / leaves.x, z), end = glm::min(first + int(Leaf::DIM), n);
      if (!field.mayHoldData(first)) return;
      auto leaf = std::make_unique<Leaf>(Coord(first.x, first.y, first.z), 0.0f);
      for (glm::ivec3 v = first; v.z < end.z; ++v.z)
        for (v.y = first.y; v.y < end.y; ++v.y)
          for (v.x = first.x; v.x < end.x; ++v.x)
            if (const float value = valueAt(v); value != kInactiveVoxel) leaf->setValueOn(Coord(v.x, v.y, v.z), value);
      if (!leaf->isEmpty()) layer[i] = std::move(leaf);
    });
    for (std::unique_ptr<Leaf>& leaf : layer)
      if (leaf) tree.addLeaf(leaf.release());
  }
  tree.prune();
}

/// Without voxels.
FloatGrid::Ptr makeGrid(const Volume& volume, const std::string& name) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator("FreeVoxels");
  grid->setTransform(transformOf(volume));
  return grid;
}

FloatGrid::Ptr makeGrid(const Volume& volume, const ScalarBricks& scalars, const std::string& name) {
  const FloatGrid::Ptr grid = makeGrid(volume, name);
  fillTree(grid->tree(), volume, scalars);
  return grid;
}

void writeGrids(const std::filesystem::path& file, const openvdb::GridCPtrVec& grids) {
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    openvdb::io::File(temporary.string()).write(grids);
    checkComplete(temporary);
  });
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const Volume& volume, const std::string& gridName) {
  initialiseOpenVdb();
  openvdb::GridCPtrVec grids{makeGrid(volume, volume.scalars, gridName)};
  if (volume.temperature) grids.push_back(makeGrid(volume, volume.temperature->values, "temperature"));
  writeGrids(file, grids);
}

void writeVdb(const std::filesystem::path& file, const ProceduralField& field, const std::string& gridName) {
  initialiseOpenVdb();
  const Volume outline{.dimensions = field.dimensions(), .indexToWorld = field.indexToWorld()};
  const FloatGrid::Ptr densities = makeGrid(outline, gridName);
  fillTree(densities->tree(), field, [&](glm::ivec3 voxel) { return field.density(voxel); });
  openvdb::GridCPtrVec grids{densities};
  if (field.hasTemperatures()) {
    const FloatGrid::Ptr temperatures = makeGrid(outline, "temperature");
    fillTree(temperatures->tree(), field, [&](glm::ivec3 voxel) { return field.temperature(voxel); });
    grids.push_back(temperatures);
  }
  writeGrids(file, grids);
}

}  // namespace freevoxels
