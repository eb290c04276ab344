#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/blackbody.h"
#include "engine/volume/scan.h"
#include "engine/volume/subject.h"
#include "engine/volume/value_range.h"
#include "engine/volume/vdb.h"
#include "engine/volume/vdb_bricks.h"
#include "engine/volume/vdb_channels.h"
#include "engine/volume/vdb_grids.h"
#include "engine/volume/vdb_parts.h"

namespace freevoxels {

namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

/// Voxels along an edge of a box, to which margins and edges of bricks are added.
constexpr std::int64_t kLongestReadEdge = 1 << 30;

/// Of a box that is not read at once.
constexpr double kMaxVoxels = 1e12;

double voxelsIn(glm::i64vec3 extent) {
  return double(extent.x) * double(extent.y) * double(extent.z);
}

void checkSize(const CoordBBox& bounds, std::uint64_t maximumVoxels, const std::string& source) {
  const glm::i64vec3 extent = extentOf(bounds);
  if (voxelsIn(extent) <= double(maximumVoxels) && std::max({extent.x, extent.y, extent.z}) <= kLongestReadEdge) return;
  fail(ErrorKind::OutOfMemory,
       "{} is too large: its {} x {} x {} box needs {:.0f} voxels and at most {} are possible here; draw a part of it with {}, or "
       "resample the volume",
       source, extent.x, extent.y, extent.z, voxelsIn(extent), maximumVoxels, Parameter("clip-box"));
}

glm::dmat4 indexToWorldOf(const openvdb::math::Transform& transform, glm::ivec3 indexOrigin) {
  const openvdb::Mat4d matrix = transform.baseMap()->getAffineMap()->getMat4();
  glm::dmat4 indexToWorld;  // OpenVDB multiplies row vectors from the left, so its rows are glm's columns
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) indexToWorld[i][j] = matrix(i, j);
  indexToWorld[3] = indexToWorld * glm::dvec4(glm::dvec3(indexOrigin), 1.0);
  return indexToWorld;
}

/// Without voxels.
Volume boxVolume(const openvdb::math::Transform& transform, const CoordBBox& bounds, const std::string& source) {
  Volume volume{.source = source,
                .dimensions = glm::ivec3(extentOf(bounds)),
                .indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()}};
  volume.indexToWorld = indexToWorldOf(transform, volume.indexOrigin);
  normaliseWorld(volume);
  return volume;
}

/// 16-bit floats beyond their range are infinite in the file.
void limitOverflow(ScalarBricks& scalars, std::uint64_t& overflown) {
  constexpr float kLargestHalf = 65504.0f;
  for (ScalarBricks::Brick& brick : scalars.bricks())
    for (float& scalar : brick)
      if (std::isinf(scalar)) {
        scalar = std::copysign(kLargestHalf, scalar);
        ++overflown;
      }
}

/// Adds what the file says of the volume, once the values are known.
void finishVolume(VdbFile& file, const VdbFile::Entry& entry, const openvdb::GridBase& grid, Volume& volume) {
  volume.warnings.insert(volume.warnings.begin(), file.warnings().begin(), file.warnings().end());
  volume.isLevelSet = isLevelSet(grid);
  volume.isFog = !volume.isLevelSet && isFog(grid);
  if (volume.isLevelSet && grid.getGridClass() != openvdb::GRID_LEVEL_SET)
    volume.remarks.emplace_back("its values are distances from a surface, as those of a level set");
  if (volume.isLevelSet && isInverted(grid))
    volume.remarks.emplace_back("distances of the level set are negative outside, and count the other way round");
  orientScan(volume);
  if (!file.isFromBlender(entry)) return;
  volume.upReason = "Blender wrote the file";
  volume.up = {0.0, 0.0, 1.0};
}

/// The part of the whole box that a clip box counted in it leaves, where the whole has more than `maximumVoxels`.
CoordBBox clippedBounds(const CoordBBox& whole, const std::optional<VoxelBox>& clip, std::uint64_t maximumVoxels) {
  if (!clip || voxelsIn(extentOf(whole)) <= double(maximumVoxels)) return whole;
  const glm::i64vec3 last = extentOf(whole) - std::int64_t(1);
  CoordBBox part = whole;
  for (int axis = 0; axis < 3; ++axis) {
    part.max()[axis] = int(whole.min()[axis] + std::min(std::int64_t(clip->last[axis]), last[axis]));
    part.min()[axis] = int(whole.min()[axis] + std::min(std::int64_t(clip->first[axis]), last[axis]));
  }
  return part;
}

/// A copy of the grid without the voxels beyond a box.
FloatGrid::ConstPtr clippedGrid(const FloatGrid& grid, const CoordBBox& box) {
  const FloatGrid::Ptr part = grid.deepCopy();
  part->tree().clip(box);
  return part;
}

/// Makes the volume of the box around the voxels that `toDensity` keeps and around the channels.
template <typename ToDensity>
Volume toVolume(FloatGrid::ConstPtr grid, const ToDensity& toDensity, const std::string& source, bool savedAsHalf, VdbChannels& channels,
                const ReadRequest& request) {
  std::vector<const VdbLeaf*> leaves;
  grid->tree().getNodes(leaves);
  CoordBBox bounds = boundsOf(grid->tree(), leaves, toDensity);
  bounds.expand(channels.bounds());
  if (bounds.empty())
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: {}", source, kNothingInsideClause));
  const CoordBBox whole = bounds;
  if (const CoordBBox part = clippedBounds(bounds, request.clipBox, request.maximumVoxels); part != bounds) {
    checkSize(part, request.maximumVoxels, source);
    bounds = part;
    grid = clippedGrid(*grid, part);
    channels.clip(part);
    leaves.clear();
    grid->tree().getNodes(leaves);
  }
  checkSize(bounds, request.maximumVoxels, source);

  Volume volume = boxVolume(grid->transform(), bounds, source);
  volume.isPart = request.clipBox && voxelsIn(extentOf(whole)) > double(request.maximumVoxels);
  volume.scalars = bricksOf(grid->tree(), std::move(leaves), volume.dimensions, volume.indexOrigin, toDensity, request.progress);
  if (request.noData)
    for (ScalarBricks::Brick& brick : volume.scalars.bricks()) std::ranges::replace(brick, *request.noData, kInactiveVoxel);
  if (savedAsHalf) limitOverflow(volume.scalars, volume.overflownVoxels);
  summariseValues(volume);
  channels.addTo(volume);
  if (volume.activeVoxels == 0 && (!volume.temperature || volume.temperature->activeVoxels == 0))
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: none of its {} active voxels has a number as its value",
                                                         source, volume.nanVoxels));
  return volume;
}

std::string whyUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  return fmt::format("grid '{}' of '{}' cannot be rendered: {}", entry.name, file.path().string(), why);
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

void checkUsable(VdbFile& file, const VdbFile::Entry& entry) {
  for (const std::string& why : {whyTypeUnusable(entry.treeType, entry.valueType), whyTransformUnusable(file.readMetadata(entry)->transform())})
    if (!why.empty()) throw Error(ErrorKind::Input, whyUnusable(file, entry, why));
}

}  // namespace

namespace {

/// The temperatures of a file that has nothing else, such as those of weather.
Volume readField(const std::filesystem::path& path, const std::string& grid, ReadRequest request) {
  request.grid = grid;
  Volume volume = readVdb(path, request);
  volume.remarks.insert(volume.remarks.begin(),
                        fmt::format("temperatures of grid '{}' are too cold to shine, and are drawn like a density", grid));
  return volume;
}

}  // namespace

Volume readVdb(const std::filesystem::path& path, const ReadRequest& request) {
  VdbFile file(path, {.progress = request.progress});
  const VdbFile::Entry* const density = file.chooseDensity(request.grid, request.more.mayBeMissing);
  if (density) checkUsable(file, *density);
  VdbChannels channels(file, density, request.more);
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
    Volume volume = withDensity(*grid, [&](const auto& toDensity) {
      return toVolume(asFloatGrid(grid), toDensity, source, entry.valueType == "half", channels, request);
    });
    const bool isField = !density && isCold(volume) && !request.more.mayBeMissing && !request.more.temperature->isRequired;
    if (isField) return readField(path, entry.name, request);
    finishVolume(file, entry, *grid, volume);
    remarkOn(volume, file, density, request);
    return volume;
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
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

namespace {

constexpr int kSampleEdge = 256;
/// Cubes of this number of voxels along an edge are read at a time, and this number of them is kept in memory.
constexpr int kCubeEdge = 64;
constexpr std::size_t kCubes = 16;
constexpr std::int64_t kLongestPartsEdge = 1 << 20;

/// A copy with the values, which the tree's leaf leaves in the file.
VdbLeaf load(const VdbLeaf& leaf, const std::string& source) {
  try {
    VdbLeaf loaded(leaf);
    loaded.getFirstValue();
    return loaded;
  } catch (const openvdb::Exception& e) {
    fail(ErrorKind::Input, "cannot read {}: {}; the file may be damaged", source, printable(e.what()));
  }
}

}  // namespace

struct VdbParts::Source {
  explicit Source(const std::filesystem::path& path) : file(path, {.delaysValues = true}) {}

  VdbFile file;
  const VdbFile::Entry* entry = nullptr;
  std::string name;
  FloatGrid::ConstPtr grid;
  WildValues wild;              ///< once the whole volume was read
  std::optional<float> noData;  ///< the value of voxels without data

  FogToDensity toDensity() const { return {.hasEmptyTiles = isFog(*grid)}; }
  /// As readVdb has them, without reading values.
  CoordBBox bounds() const {
    CoordBBox bounds;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) leaf->evalActiveBoundingBox(bounds);
    visitTiles(grid->tree(), toDensity(), [&](const CoordBBox& box, float) { bounds.expand(box); });
    return bounds;
  }
};

std::unique_ptr<VdbParts> VdbParts::open(const std::filesystem::path& path, const ReadRequest& request, std::uint64_t mostBytes,
                                         const std::optional<NoData>& noData) {
  auto source = std::make_unique<Source>(path);
  if (!source->file.delaysValues()) return nullptr;
  source->entry = source->file.chooseDensity(request.grid, request.more.mayBeMissing);
  const VdbChannels channels(source->file, source->entry, request.more);
  const auto isAsked = [](const std::optional<GridRequest>& grid) { return grid && grid->isRequired; };
  if (!source->entry || isAsked(request.more.temperature) || isAsked(request.more.albedo)) return nullptr;
  checkUsable(source->file, *source->entry);
  source->name = fmt::format("{} {}", path.filename().string(), source->entry->name);
  const openvdb::GridBase::ConstPtr grid = source->file.read(*source->entry);
  if (!grid->isType<FloatGrid>() || isLevelSet(*grid)) return nullptr;
  source->grid = openvdb::gridConstPtrCast<FloatGrid>(grid);
  if (source->grid->tree().leafCount() * sizeof(ScalarBricks::Brick) <= mostBytes) return nullptr;
  const CoordBBox bounds = source->bounds();
  if (bounds.empty()) return nullptr;
  const glm::i64vec3 n = extentOf(bounds);
  if (voxelsIn(n) > kMaxVoxels || std::max({n.x, n.y, n.z}) > kLongestPartsEdge) return nullptr;
  std::unique_ptr<VdbParts> parts(new VdbParts(std::move(source), noData));
  for (const VdbFile::Entry* entry : {channels.temperature(), channels.albedo()})
    if (entry)
      parts->sample_.remarks.push_back(
          fmt::format("grid '{}' is left out, as the file is read in parts ({} or {} read it, and all at once)", entry->name,
                      Parameter("emission"), Parameter("albedo-grid")));
  return parts;
}

VdbParts::VdbParts(std::unique_ptr<Source> source, const std::optional<NoData>& noData)
    : source_(std::move(source)), outline_(boxVolume(source_->grid->transform(), source_->bounds(), source_->name)) {
  if (noData && noData->value) source_->noData = float(*noData->value);
  if (!isFog(*source_->grid)) outline_.padding = source_->noData;
  const std::vector<std::string> warnings = outline_.warnings;
  sumUp();
  if (!noData) source_->noData = paddingOf(sample_);
  if (noData || !source_->noData) return;
  outline_.padding = source_->noData;
  outline_.remarks = {paddingRemark(*source_->noData)};
  outline_.warnings = warnings;
  sumUp();
}

/// Reads all voxels once, and fills outline_ and sample_.
void VdbParts::sumUp() {
  const glm::ivec3 n = outline_.dimensions;
  const int step = (std::max({n.x, n.y, n.z}) + kSampleEdge - 1) / kSampleEdge;
  sample_ = outline_;
  sample_.dimensions = glm::max(n / step, 1);
  sample_.indexToWorld[3] = outline_.indexToWorld * glm::dvec4(glm::dvec3((step - 1) / 2.0), 1.0);
  for (int axis = 0; axis < 3; ++axis) sample_.indexToWorld[axis] *= double(step);
  sample_.scalars = ScalarBricks(sample_.dimensions);
  const auto addToSample = [&](const Volume& part, glm::ivec3 first) {
    const glm::ivec3 begin = (first - step / 2 + step - 1) / step, end = (first + kCubeEdge - step / 2 + step - 1) / step;
    for (glm::ivec3 v = glm::max(begin, 0); v.z < std::min(end.z, sample_.dimensions.z); ++v.z)
      for (v.y = std::max(begin.y, 0); v.y < std::min(end.y, sample_.dimensions.y); ++v.y)
        for (v.x = std::max(begin.x, 0); v.x < std::min(end.x, sample_.dimensions.x); ++v.x)
          if (const float value = part.scalars.at(v * step + step / 2 - first); value != kInactiveVoxel) sample_.scalars.set(v, value);
  };

  std::vector<glm::ivec3> cubes;
  for (glm::ivec3 first(0); first.z < n.z; first.z += kCubeEdge)
    for (first.y = 0; first.y < n.y; first.y += kCubeEdge)
      for (first.x = 0; first.x < n.x; first.x += kCubeEdge) cubes.push_back(first);
  ValueSummary whole;
  outline_.overflownVoxels = 0;
  for (std::size_t first = 0; first < cubes.size(); first += kCubes) {
    std::vector<Volume> parts(std::min(kCubes, cubes.size() - first));
    std::vector<ValueSummary> summaries(parts.size());
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
      parts[i] = readValues(cubes[first + i], kCubeEdge);
      summaries[i] = summarise(parts[i].scalars.bricks());
    });
    for (std::size_t i = 0; i < parts.size(); ++i) {
      outline_.overflownVoxels += parts[i].overflownVoxels;
      if (summaries[i].active > 0) addToSample(parts[i], cubes[first + i]);
      whole.add(summaries[i]);
    }
  }

  source_->wild = wildValues(whole);
  summariseValues(sample_, source_->wild);
  takeSummary(outline_, whole, source_->wild);
  finishVolume(source_->file, *source_->entry, *source_->grid, sample_);
  outline_.warnings = sample_.warnings;
  outline_.up = sample_.up;
  outline_.upReason = sample_.upReason;
  outline_.isFog = sample_.isFog;
  sample_.overflownVoxels = outline_.overflownVoxels;
  takeCounts(sample_, outline_);
}

VdbParts::~VdbParts() = default;

Volume VdbParts::read(glm::ivec3 first, int edge) const {
  Volume part = readValues(first, edge);
  summariseValues(part, source_->wild);
  return part;
}

/// Without the summary of the values.
Volume VdbParts::readValues(glm::ivec3 first, int edge) const {
  constexpr int n = ScalarBricks::kEdge;
  const CrashNote note(fmt::format("cannot read {}: the file was cut or overwritten while it was read; copy it again", printable(source_->name)));
  const openvdb::FloatTree& tree = source_->grid->tree();
  const FogToDensity toDensity = source_->toDensity();
  Volume part{.dimensions = glm::ivec3(edge), .scalars = ScalarBricks(glm::ivec3(edge))};
  const glm::ivec3 begin = first + outline_.indexOrigin, last = glm::min(first + (edge - 1), outline_.dimensions - 1) + outline_.indexOrigin;
  forEachLeafIn({{begin.x, begin.y, begin.z}, {last.x, last.y, last.z}}, [&](const openvdb::Coord& at) {
    const VdbLeaf* const kept = tree.probeConstLeaf(at);
    if (kept == nullptr && toDensity.tile(tree.getValue(at), tree.isValueOn(at)) == kInactiveVoxel) return;
    const VdbLeaf leaf = kept == nullptr ? VdbLeaf(at, tree.getValue(at), true) : load(*kept, source_->name);
    const glm::ivec3 corner(at.x(), at.y(), at.z());
    const glm::ivec3 low = glm::max(corner, begin) - corner, high = glm::min(corner + (n - 1), last) - corner;
    for (glm::ivec3 v = low; v.z <= high.z; ++v.z)
      for (v.y = low.y; v.y <= high.y; ++v.y)
        for (v.x = low.x; v.x <= high.x; ++v.x)
          if (const openvdb::Index place = VdbLeaf::coordToOffset({v.x, v.y, v.z}); leaf.isValueOn(place))
            if (const float value = leaf.getValue(place); value != source_->noData) part.scalars.set(corner - begin + v, value);
  });
  if (source_->entry->valueType == "half") limitOverflow(part.scalars, part.overflownVoxels);
  return part;
}

}  // namespace freevoxels
