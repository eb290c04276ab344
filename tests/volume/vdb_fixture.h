#pragma once
// A .vdb file to write and to read, and grids to put into it.

#include <gtest/gtest.h>

#include <string>

#include "engine/volume/openvdb_trees.h"
#include "engine/volume/procedural.h"
#include "engine/volume/vdb.h"
#include "tests/refusal.h"
#include "tests/temporary_folder.h"

namespace freevoxels::test {

inline constexpr std::uint64_t kPlenty = 1u << 28;

class Vdb : public testing::Test {
 protected:
  void SetUp() override { openvdb::initialize(); }

  void write(const openvdb::GridPtrVec& grids) const { openvdb::io::File(file.string()).write(grids); }
  Volume read(const std::string& name = "") const { return readVdb(file, name, kPlenty); }
  void expectReadRefused(std::initializer_list<std::string> parts, const std::string& name = "") const {
    expectRefusal([&] { read(name); }, ErrorKind::Input, parts);
  }

  const TemporaryFolder folder;
  const std::filesystem::path file = folder / "test.vdb";
};

inline GridRequest required(const std::string& name) {
  return {.name = name, .isRequired = true};
}

inline openvdb::FloatGrid::Ptr makeGrid(const std::string& name, const openvdb::CoordBBox& box, float value) {
  const openvdb::FloatGrid::Ptr grid = openvdb::FloatGrid::create(0.0f);
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  grid->denseFill(box, value, true);
  return grid;
}

inline openvdb::FloatGrid::Ptr makeGrid(const std::string& name, float value = 0.5f) {
  return makeGrid(name, {openvdb::Coord(0), openvdb::Coord(1, 2, 3)}, value);
}

template <typename Grid>
typename Grid::Ptr named(typename Grid::Ptr grid, const std::string& name) {
  grid->setName(name);
  return grid;
}

/// Active voxels of every value, negative and zero included, and inactive ones between them.
inline Volume patchyVolume(glm::ivec3 dimensions, const glm::dmat4& indexToWorld) {
  Volume volume = makeVolume(dimensions, indexToWorld, [](int x, int y, int z) {
    const int number = (x * 7 + y * 13 + z * 29) % 11;
    return number == 0 ? kInactiveVoxel : 0.25f * float(number - 3);
  });
  // So that the box of the active voxels is the whole box.
  volume.scalars.set(glm::ivec3(0), 1.0f);
  volume.scalars.set(dimensions - 1, 1.0f);
  summariseValues(volume);
  return volume;
}

}  // namespace freevoxels::test
