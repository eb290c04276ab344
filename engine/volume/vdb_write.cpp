#include <algorithm>
#include <memory>
#include <set>
#include <stdexcept>

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

FloatGrid::Ptr makeGrid(const Volume& volume, const ScalarBricks& scalars, const std::string& name) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator("FreeVoxels");
  grid->setTransform(transformOf(volume));
  fillTree(grid->tree(), volume, scalars);
  return grid;
}

}  // namespace

void writeVdb(const std::filesystem::path& file, const Volume& volume, const std::string& gridName) {
  initialiseOpenVdb();
  openvdb::GridCPtrVec grids{makeGrid(volume, volume.scalars, gridName)};
  if (volume.temperature) grids.push_back(makeGrid(volume, volume.temperature->values, "temperature"));
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    openvdb::io::File(temporary.string()).write(grids);
    checkComplete(temporary);
  });
}

}  // namespace freevoxels
