#include "engine/volume/vdb_channels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>

#include "engine/core/error.h"
#include "engine/volume/vdb_bricks.h"

namespace freevoxels {

namespace {

const VdbFile::Entry& chooseTemperature(VdbFile& file, const std::string& name) {
  if (!name.empty()) return file.choose(name);
  for (const char* usual : kTemperatureNames)
    if (std::ranges::find(file.entries(), usual, &VdbFile::Entry::baseName) != file.entries().end())
      return file.choose(usual);
  std::string names;
  for (const VdbFile::Entry& entry : file.entries())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  fail(ErrorKind::Input,
       "'{}' has no grid named 'temperature', 'heat' or 'flame'; choose one with {}: {}",
       file.path().string(), Parameter("temperature-grid"), names);
}

/// A colour clamped to 0..1, and whether it was outside of that range.
struct Clipped {
  glm::vec3 color;
  bool changed;
};

Clipped clip(const openvdb::Vec3s& value) {
  const glm::vec3 given(value.x(), value.y(), value.z());
  glm::vec3 color;
  for (int c = 0; c < 3; ++c) color[c] = given[c] > 0.0f ? std::min(given[c], 1.0f) : 0.0f;  // 0 for NaN
  return {color, color != given};
}

using Bricks = std::array<ScalarBricks::Brick*, 3>;

/// The three bricks of a leaf, or null if it is beyond the box and so has no density.
std::optional<Bricks> bricksAt(AlbedoGrid& grid, glm::ivec3 origin, const openvdb::Coord& corner) {
  const glm::ivec3 cell = brickCell(origin, corner);
  if (glm::any(glm::lessThan(cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(cell, grid.values[0].cells()))) return std::nullopt;
  Bricks bricks;
  for (std::size_t c = 0; c < 3; ++c) bricks[c] = &grid.values[c].makeBrick(cell);
  return bricks;
}

void set(const Bricks& bricks, std::size_t place, const Clipped& value) {
  for (std::size_t c = 0; c < 3; ++c) (*bricks[c])[place] = value.color[int(c)];
}

AlbedoGrid toAlbedo(const openvdb::Vec3SGrid& grid, const std::string& name, const Volume& volume) {
  using Leaf = openvdb::Vec3STree::LeafNodeType;
  const glm::ivec3 origin = volume.indexOrigin;
  AlbedoGrid result{.name = name, .values = {}};
  result.values.fill(emptyBricks(volume.dimensions, origin));
  const glm::ivec3 last = origin + (volume.dimensions - 1);
  const openvdb::CoordBBox whole(openvdb::Coord(origin.x, origin.y, origin.z), openvdb::Coord(last.x, last.y, last.z));
  auto tile = grid.tree().cbeginValueOn();
  tile.setMaxDepth(openvdb::Vec3STree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const Clipped value = clip(*tile);
    if (value.changed) result.clippedVoxels += tile.getVoxelCount();
    openvdb::CoordBBox seen = tile.getBoundingBox();
    seen.intersect(whole);  // empty for most tiles of a file that has many large ones
    if (seen.empty()) continue;
    forEachLeafIn(seen, [&](const openvdb::Coord& corner) {
      if (const auto bricks = bricksAt(result, origin, corner))
        for (std::size_t i = 0; i < Leaf::SIZE; ++i) set(*bricks, i, value);
    });
  }
  for (auto leaf = grid.tree().cbeginLeaf(); leaf; ++leaf) {
    const auto bricks = bricksAt(result, origin, leaf->origin());
    if (!bricks) continue;
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Coord at = Leaf::offsetToLocalCoord(voxel.pos());
      const Clipped value = clip(*voxel);
      if (value.changed) ++result.clippedVoxels;
      set(*bricks, ScalarBricks::indexInBrick({at.x(), at.y(), at.z()}), value);
    }
  }
  return result;
}

TemperatureGrid toTemperature(const openvdb::FloatGrid& grid, const std::string& name, const Volume& volume) {
  std::vector<const VdbLeaf*> leaves;
  grid.tree().getNodes(leaves);
  TemperatureGrid result{.name = name,
                         .values = bricksOf(grid.tree(), std::move(leaves), volume.dimensions,
                                            volume.indexOrigin, FogToDensity{})};
  summariseValues(result);
  return result;
}

}  // namespace

VdbChannels::VdbChannels(VdbFile& file, const VdbFile::Entry& density, const MoreGrids& more) : file_(file) {
  if (more.temperature) {
    temperature_ = &chooseTemperature(file, *more.temperature);
    if (!isScalar(*temperature_))
      fail(ErrorKind::Input,
           "grid '{}' of '{}' holds no temperatures: its values are of type {}; choose a float grid with "
           "{}",
           temperature_->name, file.path().string(), temperature_->valueType, Parameter("temperature-grid"));
    checkLattice(*temperature_, density);
  }
  if (more.albedo) {
    albedo_ = &file.choose(*more.albedo);
    if (!isColor(*albedo_))
      fail(ErrorKind::Input,
           "grid '{}' of '{}' holds no colours: its values are of type {}; choose a vec3s grid with "
           "{}",
           albedo_->name, file.path().string(), albedo_->valueType, Parameter("albedo-grid"));
    checkLattice(*albedo_, density);
  }
}

void VdbChannels::checkLattice(const VdbFile::Entry& entry, const VdbFile::Entry& density) const {
  if (file_.readMetadata(entry)->transform() == file_.readMetadata(density)->transform()) return;
  fail(ErrorKind::Input,
       "grid '{}' of '{}' has another transform than '{}': resample it to that grid's voxels first",
       entry.name, file_.path().string(), density.name);
}

void VdbChannels::read() {
  if (temperature_) temperatures_ = asFloatGrid(file_.read(*temperature_));
  if (!albedo_) return;
  const openvdb::GridBase::ConstPtr grid = file_.read(*albedo_);
  albedos_ = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(grid);
  if (!albedos_)
    albedos_ =
        std::make_shared<const openvdb::Vec3SGrid>(*openvdb::gridConstPtrCast<openvdb::Vec3DGrid>(grid));
}

openvdb::CoordBBox VdbChannels::bounds() const {
  return temperatures_ ? temperatures_->evalActiveVoxelBoundingBox() : openvdb::CoordBBox();
}

void VdbChannels::addTo(Volume& volume) const {
  if (temperatures_) {
    volume.temperature = toTemperature(*temperatures_, temperature_->name, volume);
    coverBricks(volume, volume.temperature->values);
  }
  if (albedos_) volume.albedo = toAlbedo(*albedos_, albedo_->name, volume);
}

}  // namespace freevoxels
