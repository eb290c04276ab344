// Grids at the ends of OpenVDB's coordinates, whose next voxel or whose extent no int holds.

#include <gtest/gtest.h>

#include <limits>

#include "engine/volume/vdb_parts.h"
#include "tests/volume/vdb_fixture.h"

namespace freevoxels {
namespace {

using openvdb::Coord;
using openvdb::FloatGrid;
using test::expectRefusal;
using test::kPlenty;
using test::required;

constexpr int kLeast = std::numeric_limits<int>::min(), kMost = std::numeric_limits<int>::max();

class VdbCoordinates : public test::Vdb {
 protected:
  /// Writes the voxels of a box, each with a value of its own.
  template <typename Grid, typename ValueAt>
  typename Grid::Ptr makeBox(const std::string& name, Coord first, Coord size, const ValueAt& valueAt) const {
    const auto grid = test::named<Grid>(Grid::create(), name);
    for (int z = 0; z < size.z(); ++z)
      for (int y = 0; y < size.y(); ++y)
        for (int x = 0; x < size.x(); ++x) grid->tree().setValueOn(first + Coord(x, y, z), valueAt(x, y, z));
    return grid;
  }
  static float valueAt(int x, int y, int z) { return 0.1f + 0.01f * float(x + 2 * y + 5 * z); }
};

/// Where boxes of this size begin at the ends of the coordinates, and beside them.
std::vector<Coord> corners(const Coord& size) {
  std::vector<Coord> corners;
  for (int corner = 0; corner < 8; ++corner)
    for (const int inside : {0, 3}) {
      Coord first;
      for (int axis = 0; axis < 3; ++axis) first[axis] = (corner >> axis & 1) != 0 ? kMost - (size[axis] - 1) - inside : kLeast + inside;
      corners.push_back(first);
    }
  return corners;
}

TEST_F(VdbCoordinates, BoxesAtTheEndsAreReadAndDescribedAsElsewhere) {
  for (const Coord size : {Coord(1), Coord(5, 9, 18), Coord(8, 16, 2)})
    for (const Coord& first : corners(size)) {
      SCOPED_TRACE(testing::Message() << first << " " << size);
      const auto colour = [](int x, int y, int z) { return openvdb::Vec3s(0.5f, valueAt(x, y, z), 2.0f); };
      write({makeBox<FloatGrid>("density", first, size, valueAt), makeBox<FloatGrid>("temperature", first, size, valueAt),
             makeBox<openvdb::Vec3SGrid>("Cd", first, size, colour)});
      const Volume volume = readVdb(file, "density", kPlenty, {.temperature = required("temperature"), .albedo = required("Cd")});
      EXPECT_EQ(volume.dimensions, glm::ivec3(size.x(), size.y(), size.z()));
      EXPECT_EQ(volume.indexOrigin, glm::ivec3(first.x(), first.y(), first.z()));
      EXPECT_EQ(volume.activeVoxels, volume.voxelCount());
      EXPECT_EQ(volume.albedo->clippedVoxels, volume.voxelCount());
      const GridInfo info = describeVdb(file).front();
      EXPECT_EQ(info.dimensions, glm::i64vec3(size.x(), size.y(), size.z()));
      EXPECT_EQ(info.unusable, "");
      EXPECT_EQ(info.storedBlocks.at(0), volume.voxelCount());
      for (int z = 0; z < size.z(); ++z)
        for (int y = 0; y < size.y(); ++y)
          for (int x = 0; x < size.x(); ++x) {
            ASSERT_EQ(volume.scalar(x, y, z), valueAt(x, y, z));
            ASSERT_EQ(volume.temperature->values.at({x, y, z}), valueAt(x, y, z));
            ASSERT_EQ(volume.albedo->values[1].at({x, y, z}), std::min(valueAt(x, y, z), 1.0f));
          }
      const std::unique_ptr<const VdbParts> parts = VdbParts::open(file, {.grid = "density"}, 0);
      if (parts == nullptr) continue;  // this OpenVDB cannot leave values in the file
      EXPECT_EQ(denseScalars(parts->sample()), denseScalars(volume));
      EXPECT_EQ(parts->outline().activeVoxels, volume.activeVoxels);
    }
}

TEST_F(VdbCoordinates, TilesAndLevelSetsAtTheEnds) {
  for (const bool atEnd : {false, true}) {
    const auto tileCorner = [&](int edge) { return Coord(atEnd ? kMost - (edge - 1) : kLeast); };
    const FloatGrid::Ptr tiles = test::named<FloatGrid>(FloatGrid::create(), "density");
    tiles->tree().addTile(1, tileCorner(8), 0.5f, true);
    write({tiles});
    EXPECT_EQ(read().dimensions, glm::ivec3(8));
    EXPECT_EQ(read().activeVoxels, 512u);
    EXPECT_EQ(describeVdb(file).front().storedBlocks.at(0), 512u);
    tiles->tree().addTile(2, tileCorner(128), 0.5f, true);
    write({tiles});
    EXPECT_EQ(read().activeVoxels, 128u * 128u * 128u);
    EXPECT_EQ(describeVdb(file).front().storedBlocks.at(0), 128u * 128u * 128u);
    const std::unique_ptr<const VdbParts> parts = VdbParts::open(file, {}, 0);
    EXPECT_TRUE(parts == nullptr || parts->outline().activeVoxels == 128u * 128u * 128u);

    const FloatGrid::Ptr surface = makeBox<FloatGrid>("surface", atEnd ? Coord(kMost - 8) : Coord(kLeast), Coord(9), [](int x, int y, int z) {
      return float(std::max({std::abs(x - 4), std::abs(y - 4), std::abs(z - 4)}) - 3);
    });
    surface->setGridClass(openvdb::GRID_LEVEL_SET);
    write({surface});
    const Volume volume = read();
    EXPECT_GE(volume.dimensions.x, 9);
    EXPECT_LE(volume.dimensions.x, 9 + 4) << "a margin is not beyond the coordinates";
    EXPECT_EQ(describeVdb(file).front().renderDimensions, volume.dimensions);
  }
}

TEST_F(VdbCoordinates, AnExtentOfMoreThanAnIntIsDescribedAndRefused) {
  const auto expectTooLarge = [&](const Coord& low, const Coord& high) {
    SCOPED_TRACE(testing::Message() << low << " " << high);
    const FloatGrid::Ptr grid = test::named<FloatGrid>(FloatGrid::create(), "density");
    grid->tree().setValueOn(low, 1.0f);
    grid->tree().setValueOn(high, 1.0f);
    write({grid});
    const GridInfo info = describeVdb(file).front();
    EXPECT_EQ(info.activeVoxels, 2u);
    EXPECT_FALSE(info.unusable.empty());
    const auto along = [&](int axis) { return std::int64_t(high[axis]) - low[axis] + 1; };
    EXPECT_EQ(info.dimensions, glm::i64vec3(along(0), along(1), along(2)));
    for (const std::uint64_t most : {kPlenty, std::numeric_limits<std::uint64_t>::max()})
      expectRefusal([&] { readVdb(file, "", most); }, ErrorKind::OutOfMemory, {"is too large", fmt::format("{}", along(0))});
    EXPECT_EQ(VdbParts::open(file, {}, 0), nullptr);
    expectRefusal([&] { readVdb(file, "", kPlenty, {.temperature = required("density")}); }, ErrorKind::OutOfMemory, {"is too large"});
  };
  expectTooLarge(Coord(kLeast), Coord(kMost));
  expectTooLarge(Coord(kLeast, 0, 0), Coord(kMost, 0, 0));
  expectTooLarge(Coord(-1, 0, 0), Coord(kMost, 0, 0));
  expectTooLarge(Coord(0), Coord(kMost, 0, 0));
  expectTooLarge(Coord(-7, 5, 0), Coord((1 << 30) + 5, 9, 0));
}

TEST_F(VdbCoordinates, TilesFarFromTheBoxCostNoTime) {
  const FloatGrid::Ptr density = makeBox<FloatGrid>("density", Coord(-3), Coord(20), valueAt);
  const auto colours = test::named<openvdb::Vec3SGrid>(openvdb::Vec3SGrid::create(openvdb::Vec3s(0.1f)), "Cd");
  constexpr int kTile = 4096;
  for (int x = -8; x < 8; ++x)
    for (int y = -8; y < 8; ++y)
      for (int z = -8; z < 8; ++z) colours->tree().addTile(3, Coord(kTile * x, kTile * y, kTile * z), openvdb::Vec3s(0.25f), true);
  write({density, colours});
  const Volume volume = readVdb(file, "density", kPlenty, {.albedo = required("Cd")});
  EXPECT_EQ(volume.albedo->values[2].at({19, 0, 7}), 0.25f);
}

}  // namespace
}  // namespace freevoxels
