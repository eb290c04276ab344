#include "engine/storage/region_sweep.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <map>

#include "engine/core/error.h"
#include "engine/scene/directions.h"
#include "engine/volume/classification.h"

namespace freevoxels::fvx {

namespace {

constexpr DirectionSet kSet = DirectionSet::Directions26;

}  // namespace

/// A march through all planes of a level, with all directions of which the lines are met in this order of the planes.
class LevelSweep {
 public:
  LevelSweep(SweptRegions& target, const SweptLevel& level, bool upwards)
      : target_(target),
        level_(level),
        upwards_(upwards),
        cells_(regionCells(level.dimensions)),
        numbers_(std::size_t(cells_.x) * std::size_t(cells_.y) * std::size_t(cells_.z), -1) {
    for (std::size_t i = 0; i < level.regions.size(); ++i) numbers_[cellIndex(level.regions[i])] = int(i);
    for (int i = 0; i < directionCount(kSet); ++i) {
      const glm::ivec3 step = directionCell(kSet, i);
      // The march goes against the direction. Those within planes take part in the march upwards.
      if (upwards ? step.z <= 0 : step.z > 0) lines_.push_back({.step = step, .length = float(stepLength(level.indexToWorld, step, true))});
    }
    for (Lines& lines : lines_) {
      lines.depths.assign(planeVoxels(), 0.0f);
      lines.row.resize(std::size_t(level.dimensions.x));
      for (std::size_t face = 0; face < entryFaces().size(); ++face)
        if (entryFaces()[face].direction == lines.step) lines.faces.push_back(face);
    }
  }

  void run(const std::function<void(double)>& progress) {
    const int layers = (level_.dimensions.z + kSweptPlanes - 1) / kSweptPlanes;
    std::vector<float> planes(planeVoxels() * kSweptPlanes);
    for (int i = 0; i < layers; ++i) {
      if (progress) progress(double(i) / double(layers));
      const int first = (upwards_ ? i : layers - 1 - i) * kSweptPlanes;
      level_.planes(first, planes);
      openRegions(first);
      if (upwards_) keepHalos(first, planes);
      toExtinction(planes);
      tbb::parallel_for(std::size_t(0), lines_.size(), [&](std::size_t line) { march(lines_[line], first, planes); });
      closeRegions(first);
    }
  }

 private:
  /// The lattice lines of a direction.
  struct Lines {
    glm::ivec3 step{0};   ///< towards the outside
    float length = 0.0f;  ///< of a step, world units
    std::vector<float> depths;  ///< of the current plane, without the voxels themselves
    std::vector<float> row;
    std::vector<std::size_t> faces;  ///< of entryFaces()
  };
  /// What a region has of the march so far.
  struct OpenRegion {
    std::array<std::vector<std::uint16_t>, kEntryFaces> faces;
    std::vector<float> halo;
  };

  std::size_t planeVoxels() const { return std::size_t(level_.dimensions.x) * std::size_t(level_.dimensions.y); }
  std::size_t cellIndex(glm::ivec3 cell) const {
    return std::size_t(cell.x) + std::size_t(cells_.x) * (std::size_t(cell.y) + std::size_t(cells_.y) * std::size_t(cell.z));
  }

  /// Calls `use(region, cell)` for the wanted regions that have planes among those from `first` to `end` - 1.
  template <typename Use>
  void forRegions(int first, int end, const Use& use) const {
    for (int z = 0; z < cells_.z; ++z) {
      const VoxelBox box = regionWithHalo({0, 0, z}, level_.dimensions);
      if (box.first.z >= end || box.end.z <= first) continue;
      for (int y = 0; y < cells_.y; ++y)
        for (int x = 0; x < cells_.x; ++x)
          if (const int region = numbers_[cellIndex({x, y, z})]; region >= 0) use(region, glm::ivec3(x, y, z));
    }
  }

  void openRegions(int first) {
    forRegions(first, first + kSweptPlanes, [&](int region, glm::ivec3 cell) {
      if (open_.contains(region)) return;
      OpenRegion& opened = open_[region];
      const glm::ivec3 extent = regionWithHalo(cell, level_.dimensions).extent();
      for (const Lines& lines : lines_)
        for (const std::size_t face : lines.faces) opened.faces[face].assign(faceVoxels(extent, entryFaces()[face].axis), 0);
      if (upwards_) opened.halo.assign(haloVoxels(cell, level_.dimensions), 0.0f);
    });
  }

  /// Stores what is not 0 of the regions that the march has left behind.
  void closeRegions(int first) {
    const int last = upwards_ ? std::min(first + kSweptPlanes, level_.dimensions.z) : first;
    std::erase_if(open_, [&](const auto& entry) {
      const int region = entry.first;  // Clang 14 captures no structured bindings
      const auto& opened = entry.second;
      const VoxelBox box = regionWithHalo(level_.regions[std::size_t(region)], level_.dimensions);
      if (upwards_ ? box.end.z > last : box.first.z < last) return false;
      const auto store = [&](std::size_t part, std::span<const std::byte> bytes) {
        target_.parts_[std::size_t(region)][part] = {target_.spool_.bytes(), bytes.size()};
        target_.spool_.append(bytes);
      };
      for (std::size_t face = 0; face < kEntryFaces; ++face)
        if (std::ranges::any_of(opened.faces[face], [](std::uint16_t code) { return code != 0; }))
          store(face, std::as_bytes(std::span(opened.faces[face])));
      if (std::ranges::any_of(opened.halo, [](float density) { return density > 0.0f; })) {
        std::vector<std::byte> bytes(opened.halo.size() * level_.encoding.bytesPerValue());
        encode(level_.encoding, opened.halo, bytes);
        store(kEntryFaces, bytes);
      }
      return true;
    });
  }

  void keepHalos(int first, std::span<const float> densities) {
    const int end = std::min(first + kSweptPlanes, level_.dimensions.z);
    forRegions(first, end, [&](int region, glm::ivec3 cell) {
      std::vector<float>& halo = open_.at(region).halo;
      forHaloRows(cell, level_.dimensions, [&](glm::ivec3 voxel, int endX, std::size_t index) {
        if (voxel.z < first || voxel.z >= end) return;
        const std::size_t row = std::size_t(voxel.y) + std::size_t(level_.dimensions.y) * std::size_t(voxel.z - first);
        const auto from = densities.subspan(row * std::size_t(level_.dimensions.x) + std::size_t(voxel.x), std::size_t(endX - voxel.x));
        std::ranges::copy(from, halo.begin() + std::ptrdiff_t(index));
      });
    });
  }

  /// As in brick_row.glsl.
  void toExtinction(std::span<float> densities) const {
    const float scale = float(std::min(level_.densityScale, double(std::numeric_limits<float>::max())));
    for (float& density : densities) density = std::min(std::max(density, 0.0f) * scale, float(kMaximumExtinction));
  }

  void march(Lines& lines, int first, std::span<const float> extinction) {
    const int count = std::min(kSweptPlanes, level_.dimensions.z - first);
    for (int i = 0; i < count; ++i) {
      const int z = first + (upwards_ ? i : count - 1 - i);
      const std::span<const float> plane = extinction.subspan(std::size_t(z - first) * planeVoxels(), planeVoxels());
      if (lines.step.z == 0) marchWithin(lines, plane);
      keep(lines, z);
      if (lines.step.z != 0) step(lines, plane);
    }
  }

  /// From the depths of a plane to those of the next: each voxel's are those of the voxel a step on, and that voxel's own.
  void step(Lines& lines, std::span<const float> plane) {
    const int rows = level_.dimensions.y, dy = lines.step.y;
    // Rows are overwritten after they were read.
    for (int i = 0; i < rows; ++i) {
      const int y = dy < 0 ? rows - 1 - i : i;
      takeRow(lines, y, y + dy, plane);
    }
  }

  /// Depths of row `to` from those of row `from` in the direction, which may be the same.
  void takeRow(Lines& lines, int to, int from, std::span<const float> plane) const {
    const auto width = std::size_t(level_.dimensions.x);
    const std::span<float> target = std::span(lines.depths).subspan(std::size_t(to) * width, width);
    if (from < 0 || from >= level_.dimensions.y) {
      std::ranges::fill(target, 0.0f);
      return;
    }
    const float* const depths = lines.depths.data() + std::size_t(from) * width;
    const float* const sigma = plane.data() + std::size_t(from) * width;
    for (std::size_t x = 0; x < width; ++x) lines.row[x] = depths[x] + sigma[x] * lines.length;
    const auto source = std::span<const float>(lines.row);
    if (lines.step.x > 0) {
      std::ranges::copy(source.subspan(1), target.begin());
      target.back() = 0.0f;
    } else if (lines.step.x < 0) {
      std::ranges::copy(source.first(width - 1), target.begin() + 1);
      target.front() = 0.0f;
    } else {
      std::ranges::copy(source, target.begin());
    }
  }

  /// The depths of a plane in which the lines lie.
  void marchWithin(Lines& lines, std::span<const float> plane) const {
    const int rows = level_.dimensions.y;
    if (lines.step.y != 0) {
      for (int i = 0; i < rows; ++i) {
        const int y = lines.step.y > 0 ? rows - 1 - i : i;
        takeRow(lines, y, y + lines.step.y, plane);
      }
      return;
    }
    const int width = level_.dimensions.x;
    for (int y = 0; y < rows; ++y) {
      float depth = 0.0f;
      for (int i = 0; i < width; ++i) {
        const std::size_t at = std::size_t(y) * std::size_t(width) + std::size_t(lines.step.x > 0 ? width - 1 - i : i);
        lines.depths[at] = depth;
        depth += plane[at] * lines.length;
      }
    }
  }

  /// Keeps the depths of plane z that are on faces of regions.
  void keep(const Lines& lines, int z) {
    forRegions(z, z + 1, [&](int region, glm::ivec3 cell) {
      OpenRegion& opened = open_.at(region);
      const VoxelBox box = regionWithHalo(cell, level_.dimensions);
      for (const std::size_t face : lines.faces) keepFace(lines, z, box, entryFaces()[face].axis, opened.faces[face]);
    });
  }

  void keepFace(const Lines& lines, int z, const VoxelBox& box, int axis, std::vector<std::uint16_t>& codes) const {
    const glm::ivec3 extent = box.extent();
    const int entry = lines.step[axis] > 0 ? box.end[axis] - 1 : box.first[axis];
    const auto depthAt = [&](int x, int y) { return lines.depths[std::size_t(x) + std::size_t(level_.dimensions.x) * std::size_t(y)]; };
    const auto keepRow = [&](int y, std::size_t row) {
      std::uint16_t* const to = &codes[row * std::size_t(extent.x)];
      for (int x = 0; x < extent.x; ++x) to[x] = encodeEntryDepth(depthAt(box.first.x + x, y));
    };
    if (axis == 0)
      for (int y = 0; y < extent.y; ++y)
        codes[std::size_t(y) + std::size_t(extent.y) * std::size_t(z - box.first.z)] = encodeEntryDepth(depthAt(entry, box.first.y + y));
    else if (axis == 1)
      keepRow(entry, std::size_t(z - box.first.z));
    else if (z == entry)
      for (int y = 0; y < extent.y; ++y) keepRow(box.first.y + y, std::size_t(y));
  }

  SweptRegions& target_;
  const SweptLevel& level_;
  const bool upwards_;
  const glm::ivec3 cells_;
  std::vector<int> numbers_;  ///< index of each wanted region, otherwise -1
  std::vector<Lines> lines_;
  std::map<int, OpenRegion> open_;  ///< by region
};

void SweptRegions::sweep(const SweptLevel& level, const std::function<void(double)>& progress) {
  parts_.assign(level.regions.size(), {});
  for (const bool upwards : {true, false})
    LevelSweep(*this, level, upwards).run([&](double fraction) {
      if (progress) progress(0.5 * (fraction + (upwards ? 0.0 : 1.0)));
    });
  spool_.flush();
}

std::uint64_t SweptRegions::parts(std::size_t region) const {
  std::uint64_t mask = 0;
  for (std::size_t part = 0; part < parts_[region].size(); ++part)
    if (parts_[region][part].bytes > 0) mask |= std::uint64_t(1) << part;
  return mask;
}

std::vector<std::byte> SweptRegions::bytes(std::size_t region) const {
  std::uint64_t count = 0;
  for (const Part& part : parts_[region]) count += part.bytes;
  std::vector<std::byte> bytes(count);
  std::span<std::byte> rest(bytes);
  for (const Part& part : parts_[region]) {
    spool_.readAt(part.offset, rest.first(part.bytes));
    rest = rest.subspan(part.bytes);
  }
  return bytes;
}

}  // namespace freevoxels::fvx
