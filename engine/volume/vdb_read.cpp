#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/core/error.h"
#include "engine/volume/blackbody.h"
#include "engine/volume/scan.h"
#include "engine/volume/stray_voxels.h"
#include "engine/volume/subject.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_bricks.h"
#include "engine/volume/vdb_channels.h"
#include "engine/volume/vdb_grids.h"
#include "engine/volume/vdb_lattice.h"
#include "engine/volume/vdb_volume.h"

namespace freevoxels {

namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

/// What makes a volume too large: what is occupied of it, and 32-bit coordinates.
struct Size {
  glm::i64vec3 box{0};
  double occupied = 0.0;  ///< voxels of the bricks that hold something

  bool fits(std::uint64_t maximumVoxels) const {
    return occupied <= double(maximumVoxels) && std::max({box.x, box.y, box.z}) <= kLongestReadEdge;
  }
};

void checkSize(const Size& size, std::uint64_t maximumVoxels, const std::string& source) {
  if (size.fits(maximumVoxels)) return;
  const glm::i64vec3 box = size.box;
  fail(ErrorKind::OutOfMemory,
       "{} is too large: {:.0f} voxels of its {} x {} x {} box are occupied, and at most {} of them and boxes of {} voxels along an edge "
       "are "
       "possible here; draw a part of it with {}, or resample the volume",
       source, size.occupied, box.x, box.y, box.z, maximumVoxels, kLongestReadEdge, Parameter("clip-box"));
}

/// The part of the whole box that a clip box counted in it leaves.
CoordBBox clippedBounds(const CoordBBox& whole, const VoxelBox& clip) {
  const glm::i64vec3 last = extentOf(whole) - std::int64_t(1);
  CoordBBox part = whole;
  for (int axis = 0; axis < 3; ++axis) {
    part.max()[axis] = int(whole.min()[axis] + std::min(std::int64_t(clip.last[axis]), last[axis]));
    part.min()[axis] = int(whole.min()[axis] + std::min(std::int64_t(clip.first[axis]), last[axis]));
  }
  return part;
}

/// A copy of the grid without the voxels beyond a box.
FloatGrid::ConstPtr clippedGrid(const FloatGrid& grid, const CoordBBox& box) {
  const FloatGrid::Ptr part = grid.deepCopy();
  part->tree().clip(box);
  return part;
}

/// How the values of a grid are drawn if they are labels; null if they are not.
const Labels* labelsOf(const ReadRequest& request, const VdbFile::Entry& entry) {
  return request.labels.of(isWhole(entry));
}

/// Makes the volume of the box around the voxels that `toDensity` keeps and around the channels.
template <typename ToDensity>
Volume toVolume(FloatGrid::ConstPtr grid, const ToDensity& toDensity, const std::string& source, const VdbFile::Entry& entry,
                VdbChannels& channels, const ReadRequest& request) {
  std::vector<const VdbLeaf*> leaves;
  grid->tree().getNodes(leaves);
  CoordBBox bounds = boundsOf(grid->tree(), leaves, toDensity);
  bounds.expand(channels.bounds());
  if (bounds.empty())
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: {}", source,
                                                         labelsOf(request, entry) ? kNoLabelClause : kNothingInsideClause));
  const auto sizeNow = [&] {
    const glm::i64vec3 box = extentOf(bounds);
    return Size{.box = box, .occupied = std::min(occupiedVoxels(grid->tree(), leaves, toDensity), voxelsIn(box))};
  };
  const bool isPart = request.clipBox && !sizeNow().fits(request.maximumVoxels);
  if (isPart) {
    bounds = clippedBounds(bounds, *request.clipBox);
    grid = clippedGrid(*grid, bounds);
    channels.clip(bounds);
    leaves.clear();
    grid->tree().getNodes(leaves);
  }
  checkSize(sizeNow(), request.maximumVoxels, source);

  Volume volume = boxVolume(grid->transform(), bounds, source);
  volume.isPart = isPart;
  volume.scalars = bricksOf(grid->tree(), std::move(leaves), volume.dimensions, volume.indexOrigin, toDensity, request.progress);
  if (entry.valueType == "half") limitOverflow(volume.scalars, volume.overflownVoxels);
  if (const Labels* labels = labelsOf(request, entry))
    showLabels(volume, *labels);
  else
    summariseValues(volume, request.noData ? request.noData->scalar() : std::nullopt);
  if (voxelsIn(extentOf(bounds)) > double(std::numeric_limits<std::int32_t>::max())) warnOfStrayVoxels(volume);
  channels.addTo(volume);
  if (volume.activeVoxels == 0 && (!volume.temperature || volume.temperature->activeVoxels == 0))
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: none of its {} active voxels has a number that is data",
                                                         source, volume.missingVoxels));
  return volume;
}

/// A grid without voxels.
openvdb::GridBase::ConstPtr emptyLike(const openvdb::GridBase& grid) {
  const FloatGrid::Ptr empty = FloatGrid::create(0.0f);
  empty->setTransform(grid.transform().copy());
  empty->setGridClass(openvdb::GRID_FOG_VOLUME);
  return empty;
}

/// Whether a volume has temperatures that are of no fire.
bool isCold(const Volume& volume) {
  const std::optional<TemperatureGrid>& grid = volume.temperature;
  return grid && (areBelowZero(*grid) || (areKelvin(*grid) && double(grid->maximum) <= kColdestLight));
}

/// Says what was chosen by the names of the grids, and fails where that gives nothing to see.
void remarkOn(Volume& volume, const VdbFile& file, const VdbFile::Entry* density, const ReadRequest& request) {
  if (!density) {
    if (isCold(volume) && !request.more.temperature->isRequired)
      throw EmptyVolumeError(
          ErrorKind::Input,
          fmt::format("{} has temperatures alone, none of which is above {:g} K, where light begins: {} draws them as a density",
                      volume.source, kColdestLight, Parameter("grid", volume.temperature->name)));
    volume.remarks.insert(volume.remarks.begin(), "there is no density");
  } else if (request.grid.empty() && file.entries().size() > 1 && density->baseName != "density") {
    volume.remarks.insert(volume.remarks.begin(),
                          fmt::format("densities are those of grid '{}' ({} chooses another)", density->name, Parameter("grid")));
  }
}

/// The temperatures of a file that has nothing else, such as those of weather.
Volume readField(const std::filesystem::path& path, const std::string& grid, ReadRequest request) {
  request.grid = grid;
  Volume volume = readVdb(path, request);
  volume.remarks.insert(volume.remarks.begin(),
                        fmt::format("temperatures of grid '{}' are too cold to shine, and are drawn like a density", grid));
  return volume;
}

/// The grid of a channel: of its name, or its number among all grids.
const VdbFile::Entry& entryOf(VdbFile& file, const ChannelStyle& channel) {
  const bool isNumber = std::ranges::all_of(channel.name, [](char c) { return c >= '0' && c <= '9'; });
  return file.has(channel.name) || !isNumber ? file.choose(channel.name) : file.entries()[channelNumber(channel, file.entries().size())];
}

/// Several grids in one volume.
Volume readMixture(VdbFile& file, const ReadRequest& request) {
  std::vector<FloatGrid::ConstPtr> grids;
  std::vector<std::string> remarks;
  CoordBBox bounds;
  double occupied = 0.0;
  constexpr FogToDensity kScalar{.hasEmptyTiles = true, .hasEmptyVoxels = true};
  for (const ChannelStyle& channel : request.channels) {
    const VdbFile::Entry& entry = entryOf(file, channel);
    checkUsable(file, entry);
    const FloatGrid::ConstPtr grid = asFloatGrid(file.read(entry));
    grids.push_back(grids.empty() ? grid : onLattice(grid, grids.front()->transform(), file, entry, remarks));
    std::vector<const VdbLeaf*> leaves;
    grids.back()->tree().getNodes(leaves);
    bounds.expand(boundsOf(grids.back()->tree(), leaves, kScalar));
    occupied += occupiedVoxels(grids.back()->tree(), leaves, kScalar);
  }
  const std::string source = fmt::format("{} with {} channels", file.path().filename().string(), grids.size());
  if (bounds.empty()) throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: {}", source, kEmptyGridClause));
  const Size size{.box = extentOf(bounds), .occupied = occupied};
  const bool isPart = request.clipBox && !size.fits(request.maximumVoxels);
  const CoordBBox box = isPart ? clippedBounds(bounds, *request.clipBox) : bounds;
  if (!isPart) checkSize(size, request.maximumVoxels, source);
  Volume volume = boxVolume(grids.front()->transform(), box, source);
  volume.isPart = isPart;
  std::vector<ScalarBricks> values;
  for (FloatGrid::ConstPtr& grid : grids) {
    if (volume.isPart) grid = clippedGrid(*grid, box);
    std::vector<const VdbLeaf*> leaves;
    grid->tree().getNodes(leaves);
    values.push_back(bricksOf(grid->tree(), std::move(leaves), volume.dimensions, volume.indexOrigin, kScalar, request.progress));
    grid.reset();
  }
  mixChannels(volume, request.channels, std::move(values));
  volume.remarks = std::move(remarks);
  volume.warnings = file.warnings();
  return volume;
}

}  // namespace

Volume readVdb(const std::filesystem::path& path, const ReadRequest& request) {
  VdbFile file(path, {.progress = request.progress});
  if (!request.channels.empty()) return readMixture(file, request);
  const VdbFile::Entry* const density = file.chooseDensity(request.grid, request.more.mayBeMissing);
  if (density) checkUsable(file, *density);
  const Labels* const labels = density ? labelsOf(request, *density) : nullptr;
  MoreGrids more = request.more;
  if (labels != nullptr) more.albedo.reset();  // labels have their own colours
  VdbChannels channels(file, density, more);
  if (!density && !channels.temperature())
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("'{}' has no density: {} draws one of its grids as a density", path.string(),
                                                         Parameter("grid", "NAME")));

  const VdbFile::Entry& entry = density ? *density : *channels.temperature();
  const openvdb::GridBase::ConstPtr grid = density ? openvdb::GridBase::ConstPtr(file.read(entry)) : emptyLike(*file.readMetadata(entry));
  const std::string source = fmt::format("{} {}", path.filename().string(), entry.name);
  try {
    channels.read(grid->transform());
    if (grid->activeVoxelCount() == 0 && channels.bounds().empty())
      throw EmptyVolumeError(ErrorKind::Input, whyUnusable(file, entry, kEmptyGridClause));
    Volume volume = withDensity(
        *grid, labels, [&](const auto& toDensity) { return toVolume(asFloatGrid(grid), toDensity, source, entry, channels, request); });
    const bool isField = !density && isCold(volume) && !request.more.mayBeMissing && !request.more.temperature->isRequired;
    if (isField) return readField(path, entry.name, request);
    finishVolume(file, entry, *grid, volume);
    settleNoData(volume, request.noData);
    remarkOn(volume, file, density, request);
    return volume;
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
}

Volume readVdb(const std::filesystem::path& path, const std::string& gridName, std::uint64_t maximumVoxels, const MoreGrids& more,
               const Progress& progress) {
  ReadRequest request;
  request.grid = gridName;
  request.maximumVoxels = maximumVoxels;
  request.more = more;
  request.progress = progress;
  return readVdb(path, request);
}

std::optional<VdbExtent> extentOfVdb(const std::filesystem::path& path, const std::string& gridName, const MoreGrids& more) {
  VdbFile file(path);
  const VdbFile::Entry* const density = file.chooseDensity(gridName, more.mayBeMissing);
  const VdbChannels channels(file, density, more);
  VdbExtent extent;
  // Temperatures are there of cold air, too: they count where there is no density.
  for (const VdbFile::Entry* entry : {density, channels.temperature()}) {
    if (!entry || extent.voxels > 0) continue;
    checkUsable(file, *entry);
    const openvdb::GridBase::Ptr grid = file.readMetadata(*entry);
    const auto first = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MIN);
    const auto last = grid->getMetadata<openvdb::Vec3IMetadata>(openvdb::GridBase::META_FILE_BBOX_MAX);
    const auto voxels = grid->getMetadata<openvdb::Int64Metadata>(openvdb::GridBase::META_FILE_VOXEL_COUNT);
    if (!first || !last || !voxels || voxels->value() < 0) return std::nullopt;
    if (voxels->value() == 0) continue;
    const CoordBBox box{openvdb::Coord(first->value()), openvdb::Coord(last->value())};
    if (box.empty() || voxelsIn(extentOf(box)) > kMaxVoxels) return std::nullopt;
    extent.voxels = std::uint64_t(voxels->value());
    extent.corners = boxOf(boxVolume(grid->transform(), box, "")).points;
  }
  return extent;
}

}  // namespace freevoxels
