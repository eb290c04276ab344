#include "engine/volume/vdb_channels.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <utility>

#include "engine/core/error.h"
#include "engine/volume/classification.h"
#include "engine/volume/vdb_bricks.h"
#include "engine/volume/vdb_lattice.h"

namespace freevoxels {

bool isSameLattice(const openvdb::math::Transform& a, const openvdb::math::Transform& b, const openvdb::CoordBBox& box) {
  constexpr double kFarthest = 1e-2;  // voxels
  if (a == b || box.empty()) return true;
  for (int corner = 0; corner < 8; ++corner) {
    const openvdb::Vec3d index(box.min()[0] + (corner & 1) * double(box.dim()[0]), box.min()[1] + (corner >> 1 & 1) * double(box.dim()[1]),
                               box.min()[2] + (corner >> 2) * double(box.dim()[2]));
    const openvdb::Vec3d there = b.worldToIndex(a.indexToWorld(index)) - index;
    if (!(there.length() < kFarthest)) return false;
  }
  return true;
}

namespace {

std::string namesOf(const VdbFile& file) {
  std::string names;
  for (const VdbFile::Entry& entry : file.entries())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry.name);
  return names;
}

/// Whether a grid can hold albedos. Staggered vectors are velocities.
bool canBeAlbedo(VdbFile& file, const VdbFile::Entry& entry) {
  return isColor(entry) && file.readMetadata(entry)->getGridClass() != openvdb::GRID_STAGGERED;
}

/// The grid that is asked for, or null if it may be missing and is.
const VdbFile::Entry* find(VdbFile& file, GridRole role, const GridRequest& request, bool mayBeMissing,
                           const std::function<bool(const VdbFile::Entry&)>& suits) {
  if (!request.name.empty() && mayBeMissing && !file.has(request.name)) return nullptr;
  return request.name.empty() ? file.findByRole(role, suits) : &file.choose(request.name);
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

/// Without the grids that nobody asks for, where what is drawn as density is something else: a pressure does not burn.
MoreGrids suitable(MoreGrids more, const VdbFile::Entry* density) {
  const GridRole role = density ? roleOfName(density->baseName).role : GridRole::Density;
  if (role == GridRole::Density || role == GridRole::Unknown) return more;
  if (more.temperature && !more.temperature->isRequired) more.temperature.reset();
  if (more.albedo && !more.albedo->isRequired) more.albedo.reset();
  return more;
}

}  // namespace

VdbChannels::VdbChannels(VdbFile& file, const VdbFile::Entry* density, const MoreGrids& wanted) : file_(file) {
  const MoreGrids more = suitable(wanted, density);
  if (more.temperature) {
    temperature_ = find(file, GridRole::Temperature, *more.temperature, more.mayBeMissing, isScalar);
    isTemperatureChosen_ = !more.temperature->isRequired;
    isTemperatureFound_ = more.temperature->name.empty();
    if (temperature_ == density) temperature_ = more.temperature->isRequired ? temperature_ : nullptr;
    if (!temperature_ && more.temperature->isRequired && !more.mayBeMissing)
      fail(ErrorKind::Input, "'{}' has no grid named 'temperature', 'heat', 'flame' or the like; choose one with {}: {}",
           file.path().string(), Parameter("temperature-grid"), namesOf(file));
    if (temperature_ && !isScalar(*temperature_))
      fail(ErrorKind::Input,
           "grid '{}' of '{}' holds no temperatures: its values are of type {}; choose a float grid with "
           "{}",
           temperature_->name, file.path().string(), temperature_->valueType, Parameter("temperature-grid"));
  }
  if (more.albedo) {
    isAlbedoChosen_ = !more.albedo->isRequired;
    albedo_ =
        find(file, GridRole::Color, *more.albedo, more.mayBeMissing, [&](const VdbFile::Entry& entry) { return canBeAlbedo(file, entry); });
    if (albedo_ && !isColor(*albedo_))
      fail(ErrorKind::Input,
           "grid '{}' of '{}' holds no colours: its values are of type {}; choose a vec3s grid with "
           "{}",
           albedo_->name, file.path().string(), albedo_->valueType, Parameter("albedo-grid"));
  }
  const auto isComponent = [](const VdbFile::Entry& entry) { return roleOfName(entry.baseName).role == GridRole::ColorComponent; };
  if (const auto component = std::ranges::find_if(file.entries(), isComponent);
      more.albedo && !albedo_ && component != file.entries().end())
    remarks_.push_back(fmt::format("colours in a grid for each component, such as '{}', are left out: one grid of vectors has all three",
                                   component->name));
  for (const VdbFile::Entry* entry : {temperature_, albedo_})
    if (entry)
      if (const std::string why = whyTransformUnusable(file.readMetadata(*entry)->transform()); !why.empty())
        fail(ErrorKind::Input, "grid '{}' of '{}' cannot be rendered: {}", entry->name, file.path().string(), why);
}

void VdbChannels::read(const openvdb::math::Transform& lattice) {
  if (temperature_) temperatures_ = onLattice(asFloatGrid(file_.read(*temperature_)), lattice, file_, *temperature_, remarks_);
  if (!albedo_) return;
  const openvdb::GridBase::ConstPtr grid = file_.read(*albedo_);
  openvdb::Vec3SGrid::ConstPtr colors = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(grid);
  if (!colors) colors = std::make_shared<const openvdb::Vec3SGrid>(*openvdb::gridConstPtrCast<openvdb::Vec3DGrid>(grid));
  albedos_ = onLattice(std::move(colors), lattice, file_, *albedo_, remarks_);
}

const VdbFile::Entry* VdbChannels::emptyFlames() const {
  for (const VdbFile::Entry& entry : file_.entries())
    if (isScalar(entry) && roleOfName(entry.baseName).isFlame && file_.read(entry)->activeVoxelCount() == 0) return &entry;
  return nullptr;
}

openvdb::CoordBBox VdbChannels::bounds() const {
  return temperatures_ ? temperatures_->evalActiveVoxelBoundingBox() : openvdb::CoordBBox();
}

void VdbChannels::clip(const openvdb::CoordBBox& box) {
  if (!temperatures_) return;
  const openvdb::FloatGrid::Ptr part = temperatures_->deepCopy();
  part->tree().clip(box);
  temperatures_ = part;
}

void VdbChannels::addTo(Volume& volume) {
  if (temperatures_) {
    volume.temperature = toTemperature(*temperatures_, temperature_->name, volume);
    coverBricks(volume, volume.temperature->values);
    // A simulation of smoke alone has temperatures, too, which make it rise.
    const VdbFile::Entry* noFlames = isTemperatureChosen_ && !areKelvin(*volume.temperature) ? emptyFlames() : nullptr;
    if (noFlames) {
      remarks_.push_back(fmt::format("nothing burns, as grid '{}' is empty", noFlames->name));
      volume.temperature->isBurning = false;
    } else if (isTemperatureFound_) {
      remarks_.push_back(fmt::format("temperatures are those of grid '{}' ({} chooses another, {} leaves them out)", temperature_->name,
                                     Parameter("temperature-grid"), Parameter("emission", "none")));
    }
  }
  if (albedos_) volume.albedo = toAlbedo(*albedos_, albedo_->name, volume);
  if (albedos_ && isAlbedoChosen_)
    remarks_.push_back(fmt::format("colours are those of grid '{}' ({} leaves them out)", albedo_->name, Parameter("albedo-grid", "none")));
  volume.remarks.insert(volume.remarks.end(), remarks_.begin(), remarks_.end());
}

}  // namespace freevoxels
