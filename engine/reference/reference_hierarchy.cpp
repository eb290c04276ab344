#include "engine/reference/reference_hierarchy.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/scene/directions.h"
#include "engine/visibility/detail_rule.h"
#include "engine/volume/voxel_classifier.h"

namespace freevoxels {

namespace {

/// A child of which a part is inside of the volume.
struct Child {
  std::size_t index;  ///< index in its level
  double voxels;
};

std::vector<Child> childrenOf(const Block& parent, const LevelData& children, glm::ivec3 dimensions) {
  std::vector<Child> result;
  for (int z = 0; z < 2; ++z)
    for (int y = 0; y < 2; ++y)
      for (int x = 0; x < 2; ++x) {
        const Block child{parent.level - 1, 2 * parent.cell + glm::ivec3(x, y, z)};
        if (glm::all(glm::lessThan(child.cell, children.dimensions)))
          result.push_back({children.at(child.cell), boxOf(child, dimensions).voxels()});
      }
  return result;
}

template <typename ValueOf>
auto meanOf(const std::vector<Child>& children, const ValueOf& valueOf) {
  decltype(0.0 * valueOf(0)) sum(0.0);
  double voxels = 0.0;
  for (const Child& child : children) {
    sum += child.voxels * valueOf(child.index);
    voxels += child.voxels;
  }
  return sum / voxels;
}

glm::dvec3 colorOf(const std::vector<Child>& children, const LevelData& level, double edge) {
  glm::dvec3 sum(0.0);
  double weights = 0.0;
  for (const Child& child : children) {
    const double weight = child.voxels * -std::expm1(-level.extinction[child.index] * edge);
    sum += weight * level.colors[child.index];
    weights += weight;
  }
  return weights > 0.0 ? sum / weights : sum;
}

/// The mean over the occupied children; 0 if there are none.
std::uint8_t codeOf(const std::vector<Child>& children, const std::vector<std::uint8_t>& codes,
                    const TableSettings& settings) {
  if (std::ranges::all_of(children, [&](const Child& child) { return codes[child.index] == 0; })) return 0;
  const auto depth = [&](std::size_t child) {
    const bool belowCodes = settings.code == AttenuationCode::Linear8 && codes[child] == 0;
    return belowCodes ? -std::log(0.5 / 255.0) : decodeOpticalDepth(settings.code, codes[child]);
  };
  const double mean =
      settings.filter == HierarchyFilter::Geometric
          ? meanOf(children, depth)
          : -std::log(meanOf(children, [&](std::size_t child) { return std::exp(-depth(child)); }));
  return std::uint8_t(encodeOpticalDepth(settings.code, mean));
}

}  // namespace

LevelData referenceVoxelLevel(const Volume& volume, const Classification& classification,
                              std::vector<double> extinction, std::vector<std::vector<std::uint8_t>> table,
                              std::vector<glm::dvec3> emission) {
  LevelData level{.dimensions = volume.dimensions,
                  .extinction = std::move(extinction),
                  .colors = {},
                  .emission = std::move(emission),
                  .table = std::move(table)};
  if (!classification.transferFunction && !volume.albedo) return level;
  const VoxelClassifier classifier(classification, volume);
  const glm::ivec3 n = volume.dimensions;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) level.colors.push_back(classifier.at({x, y, z}).color);
  return level;
}

LevelData referenceParents(const LevelData& children, int level, const Volume& volume,
                           const TableSettings& settings) {
  LevelData parents{.dimensions = (children.dimensions + 1) / 2, .extinction = {}, .colors = {}, .table = {}};
  const glm::ivec3 n = parents.dimensions;
  std::vector<std::vector<Child>> family, holding;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        family.push_back(childrenOf({level, {x, y, z}}, children, volume.dimensions));
  for (std::vector<Child> block : family) {
    std::erase_if(block, [&](const Child& child) { return !children.isOccupied(child.index); });
    holding.push_back(std::move(block));
  }
  const double edge = volume.voxelSize() * (1 << (level - 1));
  for (const std::vector<Child>& block : family) {
    parents.extinction.push_back(
        meanOf(block, [&](std::size_t child) { return children.extinction[child]; }));
    if (!children.emission.empty())
      parents.emission.push_back(meanOf(block, [&](std::size_t child) { return children.emission[child]; }));
    if (!children.colors.empty()) parents.colors.push_back(colorOf(block, children, edge));
  }
  parents.table.resize(children.table.size());
  tbb::parallel_for(std::size_t(0), children.table.size(), [&](std::size_t direction) {
    for (const std::vector<Child>& block : holding)
      parents.table[direction].push_back(codeOf(block, children.table[direction], settings));
  });
  return parents;
}

std::vector<LevelData> referenceLevels(const LevelData& voxels, const Volume& volume,
                                       const TableSettings& settings) {
  std::vector<LevelData> levels;
  const int top = HierarchyLayout(volume.dimensions).top();
  for (int level = 1; level <= top; ++level)
    levels.push_back(referenceParents(level == 1 ? voxels : levels.back(), level, volume, settings));
  return levels;
}

std::vector<Block> referenceCut(const Volume& volume, std::span<const double> extinction,
                                const Camera& camera, const FrameSettings& settings,
                                std::span<const glm::dvec3> emission) {
  const HierarchyLayout hierarchy(volume.dimensions);
  const DetailRule rule =
      detailRule(hierarchy, pixelRays(camera, settings.size, volume.indexToWorld), settings.size, settings.blockPixels());
  std::vector<Block> cut;
  const glm::ivec3 n = volume.dimensions;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x) {
        const std::size_t voxel = volume.at(x, y, z);
        const bool shines = !emission.empty() && emission[voxel] != glm::dvec3(0.0);
        if (!(extinction[voxel] > 0.0) && !shines) continue;
        Block block{0, {x, y, z}};
        while (block.level < rule.coarsest && (block.level < rule.finest || rule.isSmall(block.parent())))
          block = block.parent();
        cut.push_back(block);
      }
  const auto order = [&](const Block& block) { return hierarchy.indexOf(block); };
  std::ranges::sort(cut, {}, order);
  const auto repeated = std::ranges::unique(cut);
  cut.erase(repeated.begin(), repeated.end());
  return cut;
}

}  // namespace freevoxels
