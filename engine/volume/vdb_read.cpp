#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

#include "engine/core/crash_note.h"
#include "engine/core/error.h"
#include "engine/core/printable.h"
#include "engine/volume/scan.h"
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

double voxelsIn(glm::i64vec3 extent) {
  return double(extent.x) * double(extent.y) * double(extent.z);
}

void checkSize(const CoordBBox& bounds, std::uint64_t maximumVoxels, const std::string& source) {
  const glm::i64vec3 extent = extentOf(bounds);
  if (voxelsIn(extent) <= double(maximumVoxels) && std::max({extent.x, extent.y, extent.z}) <= kLongestReadEdge) return;
  fail(ErrorKind::OutOfMemory,
       "{} is too large: its {} x {} x {} box needs {:.0f} voxels and at most {} are possible "
       "here; "
       "resample or crop the volume, for example with vdb_tool or Houdini",
       source, extent.x, extent.y, extent.z, voxelsIn(extent), maximumVoxels);
}

glm::dmat4 indexToWorldOf(const FloatGrid& grid, glm::ivec3 indexOrigin) {
  const openvdb::Mat4d matrix = grid.transform().baseMap()->getAffineMap()->getMat4();
  glm::dmat4 indexToWorld;  // OpenVDB multiplies row vectors from the left, so its rows are glm's columns
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) indexToWorld[i][j] = matrix(i, j);
  indexToWorld[3] = indexToWorld * glm::dvec4(glm::dvec3(indexOrigin), 1.0);
  return indexToWorld;
}

/// Moves a volume near to the origin, and scales it, where its coordinates would leave double precision too few digits to tell
/// its voxels apart, or single precision's range when they are squared; warns of it, as cameras and densities then count in other
/// units.
void normaliseWorld(Volume& volume) {
  constexpr double kFarthest = 1e10;  // voxels from the origin
  constexpr double kLargest = 1e9;    // world units of a voxel, and their inverse
  const double voxel = volume.voxelSize();
  const glm::dvec3 centre(volume.indexToWorld * glm::dvec4((glm::dvec3(volume.dimensions) - 1.0) / 2.0, 1.0));
  if (glm::length(centre) > kFarthest * voxel) {
    volume.indexToWorld[3] -= glm::dvec4(centre, 0.0);
    volume.warnings.push_back(
        fmt::format("{} is so far from the origin that its voxels can hardly be told apart: its middle, {:g},{:g},{:g}, becomes the "
                    "origin, from which positions of cameras and lights count",
                    volume.source, centre.x, centre.y, centre.z));
  }
  if (voxel > kLargest || voxel < 1.0 / kLargest) {
    const double scale = std::pow(10.0, -std::floor(std::log10(voxel)));
    for (int column = 0; column < 4; ++column) volume.indexToWorld[column] = glm::dvec4(glm::dvec3(volume.indexToWorld[column]) * scale, column == 3);
    volume.warnings.push_back(
        fmt::format("voxels of {} are {:g} world units large: it is scaled by {:g}, so that the camera, the lights and the scale of "
                    "densities count in units of {:g}",
                    volume.source, voxel, scale, 1.0 / scale));
  }
}

/// Without voxels.
Volume boxVolume(const FloatGrid& grid, const CoordBBox& bounds, const std::string& source) {
  Volume volume{.source = source,
                .dimensions = glm::ivec3(extentOf(bounds)),
                .indexOrigin = {bounds.min().x(), bounds.min().y(), bounds.min().z()}};
  volume.indexToWorld = indexToWorldOf(grid, volume.indexOrigin);
  normaliseWorld(volume);
  return volume;
}

/// Adds what the file says of the volume, once the values are known.
void finishVolume(VdbFile& file, const VdbFile::Entry& entry, Volume& volume) {
  volume.warnings.insert(volume.warnings.begin(), file.warnings().begin(), file.warnings().end());
  orientScan(volume);
  if (!file.isFromBlender(entry)) return;
  volume.upReason = "Blender wrote the file";
  volume.up = {0.0, 0.0, 1.0};
}

/// Makes the volume of the box around the voxels that `toDensity` keeps and around `more`.
template <typename ToDensity>
Volume toVolume(const FloatGrid& grid, const ToDensity& toDensity, const std::string& source,
                const CoordBBox& more, std::uint64_t maximumVoxels, const Progress& progress) {
  std::vector<const VdbLeaf*> leaves;
  grid.tree().getNodes(leaves);
  CoordBBox bounds = boundsOf(grid.tree(), leaves, toDensity);
  if (bounds.empty())
    throw EmptyVolumeError(ErrorKind::Input, fmt::format("{} cannot be rendered: {}", source, kNothingInsideClause));
  bounds.expand(more);
  checkSize(bounds, maximumVoxels, source);

  Volume volume = boxVolume(grid, bounds, source);
  volume.scalars = bricksOf(grid.tree(), std::move(leaves), volume.dimensions, volume.indexOrigin, toDensity, progress);
  summariseValues(volume);
  return volume;
}

std::string whyUnusable(const VdbFile& file, const VdbFile::Entry& entry, const std::string& why) {
  return fmt::format("grid '{}' of '{}' cannot be rendered: {}", entry.name, file.path().string(), why);
}

void checkUsable(VdbFile& file, const VdbFile::Entry& entry) {
  for (const std::string& why : {whyTypeUnusable(entry.treeType, entry.valueType), whyTransformUnusable(file.readMetadata(entry)->transform())})
    if (!why.empty()) throw Error(ErrorKind::Input, whyUnusable(file, entry, why));
}

}  // namespace

Volume readVdb(const std::filesystem::path& path, const std::string& gridName, std::uint64_t maximumVoxels,
               const MoreGrids& more, const Progress& progress) {
  VdbFile file(path, {.progress = progress});
  const VdbFile::Entry& entry = file.choose(gridName);
  checkUsable(file, entry);
  VdbChannels channels(file, entry, more);

  const openvdb::GridBase::Ptr grid = file.read(entry);
  if (grid->activeVoxelCount() == 0) throw EmptyVolumeError(ErrorKind::Input, whyUnusable(file, entry, kEmptyGridClause));
  const FloatGrid::ConstPtr floats = asFloatGrid(grid);
  const std::string source = fmt::format("{} {}", path.filename().string(), entry.name);
  try {
    channels.read();
    Volume volume = withDensity(*grid, [&](const auto& toDensity) {
      return toVolume(*floats, toDensity, source, channels.bounds(), maximumVoxels, progress);
    });
    channels.addTo(volume);
    volume.isLevelSet = grid->getGridClass() == openvdb::GRID_LEVEL_SET;
    finishVolume(file, entry, volume);
    return volume;
  } catch (const std::bad_alloc&) {
    fail(ErrorKind::OutOfMemory, "not enough memory for {}; free some, or resample or crop the volume",
         source);
  }
}

namespace {

constexpr int kSampleEdge = 256;
/// Cubes of this number of voxels along an edge are read at a time, and this number of them is kept in memory.
constexpr int kCubeEdge = 64;
constexpr std::size_t kCubes = 16;
/// Of a box that is gone through cube by cube.
constexpr double kMaxVoxels = 1e12;
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
};

std::unique_ptr<VdbParts> VdbParts::open(const std::filesystem::path& path, const std::string& gridName, std::uint64_t mostBytes) {
  auto source = std::make_unique<Source>(path);
  if (!source->file.delaysValues()) return nullptr;
  source->entry = &source->file.choose(gridName);
  checkUsable(source->file, *source->entry);
  source->name = fmt::format("{} {}", path.filename().string(), source->entry->name);
  const openvdb::GridBase::ConstPtr grid = source->file.read(*source->entry);
  if (!grid->isType<FloatGrid>() || grid->getGridClass() == openvdb::GRID_LEVEL_SET) return nullptr;
  source->grid = openvdb::gridConstPtrCast<FloatGrid>(grid);
  if (source->grid->tree().leafCount() * sizeof(ScalarBricks::Brick) <= mostBytes) return nullptr;
  const CoordBBox bounds = source->grid->evalActiveVoxelBoundingBox();
  if (bounds.empty()) return nullptr;
  const glm::i64vec3 n = extentOf(bounds);
  if (voxelsIn(n) > kMaxVoxels || std::max({n.x, n.y, n.z}) > kLongestPartsEdge) return nullptr;
  return std::unique_ptr<VdbParts>(new VdbParts(std::move(source)));
}

VdbParts::VdbParts(std::unique_ptr<Source> source)
    : source_(std::move(source)), outline_(boxVolume(*source_->grid, source_->grid->evalActiveVoxelBoundingBox(), source_->name)) {
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
  for (std::size_t first = 0; first < cubes.size(); first += kCubes) {
    std::vector<Volume> parts(std::min(kCubes, cubes.size() - first));
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t i) { parts[i] = read(cubes[first + i], kCubeEdge); });
    for (std::size_t i = 0; i < parts.size(); ++i) {
      const Volume& part = parts[i];
      if (part.activeVoxels == 0) continue;
      addToSample(part, cubes[first + i]);
      outline_.minimum = outline_.activeVoxels == 0 ? part.minimum : std::min(outline_.minimum, part.minimum);
      outline_.maximum = outline_.activeVoxels == 0 ? part.maximum : std::max(outline_.maximum, part.maximum);
      outline_.activeVoxels += part.activeVoxels;
      outline_.nanVoxels += part.nanVoxels;
      outline_.negativeVoxels += part.negativeVoxels;
    }
  }

  summariseValues(sample_);
  finishVolume(source_->file, *source_->entry, sample_);
  outline_.warnings = sample_.warnings;
  outline_.up = sample_.up;
  outline_.upReason = sample_.upReason;
  sample_.minimum = outline_.minimum;
  sample_.maximum = outline_.maximum;
  sample_.nanVoxels = outline_.nanVoxels;
  sample_.negativeVoxels = outline_.negativeVoxels;
}

VdbParts::~VdbParts() = default;

Volume VdbParts::read(glm::ivec3 first, int edge) const {
  constexpr int n = ScalarBricks::kEdge;
  const CrashNote note(fmt::format("cannot read {}: the file was cut or overwritten while it was read; copy it again", printable(source_->name)));
  const openvdb::FloatTree& tree = source_->grid->tree();
  Volume part{.dimensions = glm::ivec3(edge), .scalars = ScalarBricks(glm::ivec3(edge))};
  const glm::ivec3 begin = first + outline_.indexOrigin, last = glm::min(first + (edge - 1), outline_.dimensions - 1) + outline_.indexOrigin;
  forEachLeafIn({{begin.x, begin.y, begin.z}, {last.x, last.y, last.z}}, [&](const openvdb::Coord& at) {
    const VdbLeaf* const kept = tree.probeConstLeaf(at);
    if (kept == nullptr && !tree.isValueOn(at)) return;
    const VdbLeaf leaf = kept == nullptr ? VdbLeaf(at, tree.getValue(at), true) : load(*kept, source_->name);
    const glm::ivec3 corner(at.x(), at.y(), at.z());
    const glm::ivec3 low = glm::max(corner, begin) - corner, high = glm::min(corner + (n - 1), last) - corner;
    for (glm::ivec3 v = low; v.z <= high.z; ++v.z)
      for (v.y = low.y; v.y <= high.y; ++v.y)
        for (v.x = low.x; v.x <= high.x; ++v.x)
          if (const openvdb::Index place = VdbLeaf::coordToOffset({v.x, v.y, v.z}); leaf.isValueOn(place))
            part.scalars.set(corner - begin + v, leaf.getValue(place));
  });
  summariseValues(part);
  return part;
}

}  // namespace freevoxels
