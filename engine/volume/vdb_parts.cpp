#include "engine/volume/vdb_parts.h"

#include <tbb/parallel_for.h>

#include <algorithm>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/value_range.h"
#include "engine/volume/vdb_bricks.h"
#include "engine/volume/vdb_channels.h"
#include "engine/volume/vdb_volume.h"

namespace freevoxels {

namespace {

using openvdb::CoordBBox;
using openvdb::FloatGrid;

constexpr int kSampleEdge = 256;
/// Cubes of this number of voxels along an edge are read at a time, and this number of them is kept in memory.
constexpr int kCubeEdge = 64;
constexpr std::size_t kCubes = 16;

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
  bool hasEmptyTiles = false;
  Outliers outliers;            ///< once the whole volume was read
  std::optional<float> noData;  ///< the value of voxels without data

  FogToDensity toDensity() const { return {.hasEmptyTiles = isFog(*grid) || hasEmptyTiles}; }
  /// As readVdb has them, without reading values.
  CoordBBox bounds() const {
    CoordBBox bounds;
    for (auto leaf = grid->tree().cbeginLeaf(); leaf; ++leaf) leaf->evalActiveBoundingBox(bounds);
    visitTiles(grid->tree(), toDensity(), [&](const CoordBBox& box, float) { bounds.expand(box); });
    return bounds;
  }
};

std::unique_ptr<VdbParts> VdbParts::open(const std::filesystem::path& path, const ReadRequest& request, std::uint64_t mostBytes) {
  auto source = std::make_unique<Source>(path);
  if (!source->file.delaysValues()) return nullptr;
  source->entry = source->file.chooseDensity(request.grid, request.more.mayBeMissing);
  const VdbChannels channels(source->file, source->entry, request.more);
  const auto isAsked = [](const std::optional<GridRequest>& grid) { return grid && grid->isRequired; };
  if (!source->entry || request.labels.of(isWhole(*source->entry)) || isAsked(request.more.temperature) || isAsked(request.more.albedo))
    return nullptr;
  checkUsable(source->file, *source->entry);
  source->name = fmt::format("{} {}", path.filename().string(), source->entry->name);
  const openvdb::GridBase::ConstPtr grid = source->file.read(*source->entry);
  if (!grid->isType<FloatGrid>() || isLevelSet(*grid)) return nullptr;
  source->grid = openvdb::gridConstPtrCast<FloatGrid>(grid);
  source->hasEmptyTiles = hasEmptyZeros(*grid);
  if (source->grid->tree().leafCount() * sizeof(ScalarBricks::Brick) <= mostBytes) return nullptr;
  const CoordBBox bounds = source->bounds();
  if (bounds.empty()) return nullptr;
  const glm::i64vec3 n = extentOf(bounds);
  if (std::max({n.x, n.y, n.z}) > kLongestReadEdge) return nullptr;
  std::unique_ptr<VdbParts> parts(new VdbParts(std::move(source), request.noData));
  for (const VdbFile::Entry* entry : {channels.temperature(), channels.albedo()})
    if (entry)
      parts->sample_.remarks.push_back(
          fmt::format("grid '{}' is left out, as the file is read in parts ({} or {} read it, and all at once)", entry->name,
                      Parameter("emission"), Parameter("albedo-grid")));
  return parts;
}

VdbParts::VdbParts(std::unique_ptr<Source> source, const std::optional<NoData>& noData)
    : source_(std::move(source)), outline_(boxVolume(source_->grid->transform(), source_->bounds(), source_->name)) {
  if (noData) source_->noData = noData->scalar();
  const Volume unread = outline_;
  sumUp();
  if (!noData) source_->noData = paddingOf(sample_);
  if (!noData && source_->noData) {
    outline_ = unread;
    outline_.remarks = {paddingRemark(*source_->noData)};
    sumUp();
  }
  if (looksLikeScan(sample_)) outline_.padding = sample_.padding = source_->noData;
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

  std::vector<glm::ivec3> cubes = occupied(kCubeEdge);
  for (glm::ivec3& cube : cubes) cube *= kCubeEdge;
  ValueSummary whole;
  for (std::size_t first = 0; first < cubes.size(); first += kCubes) {
    std::vector<Volume> parts(std::min(kCubes, cubes.size() - first));
    std::vector<ValueSummary> summaries(parts.size());
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) {
      parts[i] = readValues(cubes[first + i], kCubeEdge);
      summaries[i] = summarise(parts[i].scalars);
    });
    for (std::size_t i = 0; i < parts.size(); ++i) {
      outline_.overflownVoxels += parts[i].overflownVoxels;
      whole.missing += parts[i].missingVoxels;  // of no data
      if (summaries[i].active > 0) addToSample(parts[i], cubes[first + i]);
      whole.add(summaries[i]);
    }
  }

  source_->outliers = outliersOf(whole);
  summariseValues(sample_, source_->outliers);
  takeSummary(outline_, whole, source_->outliers);
  sample_.missingVoxels = std::uint64_t(double(outline_.missingVoxels) * double(sample_.voxelCount()) / double(outline_.voxelCount()));
  finishVolume(source_->file, *source_->entry, *source_->grid, sample_);
  outline_.warnings = sample_.warnings;
  outline_.up = sample_.up;
  outline_.upReason = sample_.upReason;
  outline_.isFog = sample_.isFog;
  sample_.overflownVoxels = outline_.overflownVoxels;
  takeCounts(sample_, outline_);
}

VdbParts::~VdbParts() = default;

std::vector<glm::ivec3> VdbParts::occupied(int edge) const {
  SparseGrid<std::uint8_t> cubes((outline_.dimensions + edge - 1) / edge);
  const auto add = [&](const CoordBBox& box) {
    const auto placeOf = [&](const openvdb::Coord& at) {
      return glm::clamp(glm::ivec3(at.x(), at.y(), at.z()) - outline_.indexOrigin, glm::ivec3(0), outline_.dimensions - 1) / edge;
    };
    const glm::ivec3 low = placeOf(box.min()), high = placeOf(box.max());
    for (glm::ivec3 cube = low; cube.z <= high.z; ++cube.z)
      for (cube.y = low.y; cube.y <= high.y; ++cube.y)
        for (cube.x = low.x; cube.x <= high.x; ++cube.x) cubes[cube] = 1;
  };
  for (auto leaf = source_->grid->tree().cbeginLeaf(); leaf; ++leaf) add(leaf->getNodeBoundingBox());
  visitTiles(source_->grid->tree(), source_->toDensity(), [&](const CoordBBox& box, float) { add(box); });
  std::vector<glm::ivec3> cells;
  cubes.forEach([&](glm::ivec3 cube, std::uint8_t) { cells.push_back(cube); });
  return cells;
}

Volume VdbParts::read(glm::ivec3 first, int edge) const {
  Volume part = readValues(first, edge);
  summariseValues(part, source_->outliers);
  return part;
}

/// Without the summary of the values.
Volume VdbParts::readValues(glm::ivec3 first, int edge) const {
  constexpr int n = ScalarBricks::kEdge;
  const CrashNote note(
      fmt::format("cannot read {}: the file was cut or overwritten while it was read; copy it again", printable(source_->name)));
  const openvdb::FloatTree& tree = source_->grid->tree();
  const FogToDensity toDensity = source_->toDensity();
  Volume part{.dimensions = glm::ivec3(edge), .scalars = ScalarBricks(glm::ivec3(edge))};
  const glm::ivec3 begin = first + outline_.indexOrigin,
                   last = glm::min(first + (edge - 1), outline_.dimensions - 1) + outline_.indexOrigin;
  forEachLeafIn({{begin.x, begin.y, begin.z}, {last.x, last.y, last.z}}, [&](const openvdb::Coord& at) {
    const VdbLeaf* const kept = tree.probeConstLeaf(at);
    if (kept == nullptr && toDensity.tile(tree.getValue(at), tree.isValueOn(at)) == kInactiveVoxel) return;
    const VdbLeaf leaf = kept == nullptr ? VdbLeaf(at, tree.getValue(at), true) : load(*kept, source_->name);
    const glm::ivec3 corner(at.x(), at.y(), at.z());
    const glm::ivec3 low = glm::max(corner, begin) - corner, high = glm::min(corner + (n - 1), last) - corner;
    for (glm::ivec3 v = low; v.z <= high.z; ++v.z)
      for (v.y = low.y; v.y <= high.y; ++v.y)
        for (v.x = low.x; v.x <= high.x; ++v.x) {
          const openvdb::Index place = VdbLeaf::coordToOffset({v.x, v.y, v.z});
          if (!leaf.isValueOn(place)) continue;
          if (const float value = leaf.getValue(place); value != source_->noData)
            part.scalars.set(corner - begin + v, value);
          else
            ++part.missingVoxels;
        }
  });
  if (source_->entry->valueType == "half") limitOverflow(part.scalars, part.overflownVoxels);
  return part;
}

}  // namespace freevoxels
