#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cerrno>
#include <fstream>
#include <functional>
#include <memory>
#include <set>
#include <span>
#include <sstream>
#include <stdexcept>
#include <system_error>
#include <vector>

#include "engine/core/atomic_file.h"
#include "engine/core/error.h"
#include "engine/core/spool.h"
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
  for (std::size_t brick = 0; brick < scalars.count(); ++brick) {
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

/// Without voxels.
FloatGrid::Ptr makeGrid(const Volume& volume, const std::string& name) {
  const FloatGrid::Ptr grid = FloatGrid::create(0.0f);
  grid->setName(name);
  if (volume.isFog) grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->setCreator("FreeVoxels");
  grid->setTransform(transformOf(volume));
  return grid;
}

FloatGrid::Ptr makeGrid(const Volume& volume, const ScalarBricks& scalars, const std::string& name) {
  const FloatGrid::Ptr grid = makeGrid(volume, name);
  fillTree(grid->tree(), volume, scalars);
  return grid;
}

/// The tree of a grid without the values of its leaves, and these as the file has them.
struct SpooledGrid {
  FloatGrid::Ptr grid;
  Spool leaves;  ///< in the order of the tree
};

/// Writes grids whose leaves are not in memory, and no metadata for delayed loading, which OpenVDB would compress every leaf for.
class SpooledArchive : public openvdb::io::Archive {
 public:
  /// Computes a field cube by cube, in the order of the tree. The field's bricks are the leaves of the tree.
  template <typename ValueAt>
  void fill(SpooledGrid& spooled, const ProceduralField& field, const ValueAt& valueAt, const std::function<void(double)>& done) const {
    using Upper = openvdb::FloatTree::RootNodeType::ChildNodeType;
    static_assert(Leaf::DIM == ScalarBricks::kEdge);
    constexpr int kCube = int(Upper::ChildNodeType::DIM);
    const glm::ivec3 n = field.dimensions();
    FV_CHECK_LE(std::max({n.x, n.y, n.z}), int(Upper::DIM));
    for (glm::ivec3 first(0); first.x < n.x; first.x += kCube)
      for (first.y = 0; first.y < n.y; first.y += kCube) {
        const glm::dvec2 cubes((n.x + kCube - 1) / kCube, (n.y + kCube - 1) / kCube);
        done((first.x * cubes.y + first.y) / (kCube * cubes.x * cubes.y));
        for (first.z = 0; first.z < n.z; first.z += kCube) {
          openvdb::FloatTree cube = makeCube(field, valueAt, first, glm::min(first + kCube, n));
          spoolLeaves(cube, spooled);
          spooled.grid->tree().merge(cube, openvdb::MERGE_ACTIVE_STATES);
        }
      }
  }

  void write(const std::filesystem::path& file, std::span<const std::unique_ptr<SpooledGrid>> grids) const {
    errno = 0;
    std::ofstream os;
    os.exceptions(std::ios::failbit | std::ios::badbit);
    try {
      os.open(file, std::ios::binary);
      writeHeader(os, true);
      openvdb::MetaMap().writeMeta(os);
      const auto count = openvdb::Int32(grids.size());
      os.write(reinterpret_cast<const char*>(&count), sizeof(count));
      for (const auto& spooled : grids) writeSpooled(os, *spooled);
      os.close();
    } catch (const std::ios_base::failure&) {  // which does not say why
      throw std::system_error(errno != 0 ? errno : EIO, std::generic_category());
    }
  }

 private:
  template <typename ValueAt>
  static openvdb::FloatTree makeCube(const ProceduralField& field, const ValueAt& valueAt, glm::ivec3 begin, glm::ivec3 end) {
    const glm::ivec3 leaves = (end - begin + int(Leaf::DIM) - 1) / int(Leaf::DIM);
    std::vector<std::unique_ptr<Leaf>> made(std::size_t(leaves.x) * std::size_t(leaves.y) * std::size_t(leaves.z));
    tbb::parallel_for(std::size_t(0), made.size(), [&](std::size_t i) {
      const int number = int(i);
      const glm::ivec3 cell(number % leaves.x, number / leaves.x % leaves.y, number / leaves.x / leaves.y);
      const glm::ivec3 first = begin + int(Leaf::DIM) * cell, last = glm::min(first + int(Leaf::DIM), end);
      if (!field.mayHoldData(first)) return;
      auto leaf = std::make_unique<Leaf>(Coord(first.x, first.y, first.z), 0.0f);
      for (glm::ivec3 v = first; v.z < last.z; ++v.z)
        for (v.y = first.y; v.y < last.y; ++v.y)
          for (v.x = first.x; v.x < last.x; ++v.x)
            if (const float value = valueAt(v); value != kInactiveVoxel) leaf->setValueOn(Coord(v.x, v.y, v.z), value);
      if (!leaf->isEmpty()) made[i] = std::move(leaf);
    });
    openvdb::FloatTree cube(0.0f);
    for (std::unique_ptr<Leaf>& leaf : made)
      if (leaf) cube.addLeaf(leaf.release());
    cube.prune();
    return cube;
  }

  /// Takes the values out of the leaves.
  void spoolLeaves(openvdb::FloatTree& cube, SpooledGrid& spooled) const {
    std::ostringstream tags;
    setGridCompression(tags, *spooled.grid);
    const float background = cube.background();
    std::vector<Leaf*> leaves;
    cube.getNodes(leaves);
    std::vector<std::string> stored(leaves.size());
    tbb::parallel_for(std::size_t(0), leaves.size(), [&](std::size_t i) {
      std::ostringstream os;
      openvdb::io::setDataCompression(os, openvdb::io::getDataCompression(tags));
      openvdb::io::setGridClass(os, spooled.grid->getGridClass());
      openvdb::io::setGridBackgroundValuePtr(os, &background);
      leaves[i]->writeBuffers(os);
      stored[i] = std::move(os).str();
      Leaf::Buffer none(openvdb::PartialCreate(), background);
      leaves[i]->swap(none);
    });
    for (const std::string& leaf : stored) spooled.leaves.append(std::as_bytes(std::span(leaf)));
  }

  void writeSpooled(std::ostream& os, SpooledGrid& spooled) const {
    FloatGrid& grid = *spooled.grid;
    openvdb::io::GridDescriptor descriptor(grid.getName(), grid.type());
    descriptor.writeHeader(os);
    const std::streampos places = os.tellp();
    descriptor.writeStreamPos(os);  // which are known at the end
    descriptor.setGridPos(os.tellp());
    setGridCompression(os, grid);
    grid.addStatsMetadata();
    grid.writeMeta(os);
    grid.writeTransform(os);
    grid.writeTopology(os);
    descriptor.setBlockPos(os.tellp());
    spooled.leaves.readAll([&](std::span<const std::byte> bytes) {
      os.write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    });
    descriptor.setEndPos(os.tellp());
    os.seekp(places);
    descriptor.writeStreamPos(os);
    descriptor.seekToEnd(os);
  }
};

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

void writeVdb(const std::filesystem::path& file, const std::vector<NamedScalars>& grids) {
  initialiseOpenVdb();
  openvdb::GridCPtrVec made;
  for (const NamedScalars& one : grids) made.push_back(makeGrid(*one.volume, one.volume->scalars, one.name));
  writeGrids(file, made);
}

void writeVdb(const std::filesystem::path& file, const ProceduralField& field, const std::string& gridName, const Progress& progress) {
  initialiseOpenVdb();
  const Volume outline{.dimensions = field.dimensions(), .indexToWorld = field.indexToWorld(), .isFog = field.isFog()};
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  const SpooledArchive archive;
  writeAtomically(file, [&](const std::filesystem::path& temporary) {
    std::vector<std::unique_ptr<SpooledGrid>> grids;
    const auto add = [&](const std::string& name, const auto& valueAt) {
      const double before = double(grids.size()), all = field.hasTemperatures() ? 2.0 : 1.0;
      grids.push_back(std::unique_ptr<SpooledGrid>(new SpooledGrid{.grid = makeGrid(outline, name), .leaves = Spool(folder)}));
      archive.fill(*grids.back(), field, valueAt, [&](double done) {
        if (progress) progress("computing voxels", (before + done) / all);
      });
    };
    add(gridName, [&](glm::ivec3 voxel) { return field.density(voxel); });
    if (field.hasTemperatures()) add("temperature", [&](glm::ivec3 voxel) { return field.temperature(voxel); });
    if (progress) progress("writing the file", 1.0);
    archive.write(temporary, grids);
  });
}

}  // namespace freevoxels
