#include "engine/validation/level_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <random>

#include "engine/core/error.h"
#include "engine/reference/reference_hierarchy.h"
#include "engine/reference/reference_splats.h"
#include "engine/renderer_stages.h"
#include "engine/validation/max_error.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr double kExtinctionTolerance = 1e-5;  ///< for sums of eight 32-bit floats
constexpr double kLightTolerance = 2e-3;       ///< half a step of 9 bits
constexpr double kLightFloor = 1e-3;           ///< as a fraction of the brightest: fainter blocks count as that
constexpr double kColorTolerance = 1e-3;       ///< for 16-bit halves
constexpr double kCodeTolerance = 1.0;
constexpr int kCameras = 24;

struct Variant {
  const char* name;
  TableSettings settings;
};
const std::array<Variant, 4> kVariants{
    {{"depth8", {}},
     {"depth8, arithmetic", {.filter = HierarchyFilter::Arithmetic}},
     {"linear8", {.code = AttenuationCode::Linear8}},
     {"depth8, 98 directions", {.directions = DirectionSet::Directions98}}}};

std::string blockText(int level, std::size_t index) {
  return fmt::format("level {}, block {}", level, index);
}

double opticalDepthOf(const LevelData& level, int number, glm::ivec3 dimensions) {
  double sum = 0.0;
  const glm::ivec3 n = level.dimensions;
  for (int z = 0; z < n.z; ++z)
    for (int y = 0; y < n.y; ++y)
      for (int x = 0; x < n.x; ++x)
        sum += level.extinction[level.at({x, y, z})] * boxOf({number, {x, y, z}}, dimensions).voxels();
  return sum;
}

void compareMedium(const LevelData& level, const LevelData& reference, int number, MaxError& extinction,
                   MaxError& color, MaxError& light) {
  FV_CHECK_EQ(level.extinction.size(), reference.extinction.size());
  FV_CHECK_EQ(level.colors.size(), reference.colors.size());
  for (std::size_t i = 0; i < level.extinction.size(); ++i) {
    const double expected = reference.extinction[i], difference = std::abs(level.extinction[i] - expected);
    extinction.take(difference == 0.0 ? 0.0 : difference / expected, [&] { return blockText(number, i); });
  }
  FV_CHECK_EQ(level.emission.size(), reference.emission.size());
  const auto largest = [](glm::dvec3 v) { return std::max({v.r, v.g, v.b}); };
  double brightest = 0.0;
  for (const glm::dvec3& expected : reference.emission) brightest = std::max(brightest, largest(expected));
  for (std::size_t i = 0; i < level.emission.size(); ++i) {
    const double apart = largest(glm::abs(level.emission[i] - reference.emission[i]));
    const double scale = std::max(largest(reference.emission[i]), kLightFloor * brightest);
    light.take(apart == 0.0 ? 0.0 : apart / scale, [&] { return blockText(number, i); });
  }
  for (std::size_t i = 0; i < level.colors.size(); ++i)
    for (int c = 0; c < 3; ++c)
      color.take(std::abs(level.colors[i][c] - reference.colors[i][c]), [&] { return blockText(number, i); });
}

void compareTables(const LevelData& level, const LevelData& reference, int number, DirectionSet set,
                   MaxError& worst) {
  FV_CHECK_EQ(level.table.size(), reference.table.size());
  for (std::size_t d = 0; d < level.table.size(); ++d) {
    FV_CHECK_EQ(level.table[d].size(), reference.table[d].size());
    for (std::size_t i = 0; i < level.table[d].size(); ++i)
      if (reference.isOccupied(i))
        worst.take(std::abs(int(level.table[d][i]) - int(reference.table[d][i])),
                   [&] { return fmt::format("{}, {}", directionText(set, int(d)), blockText(number, i)); });
  }
}

/// A random camera around or inside the volume, looking at a point in it.
Camera randomCamera(const Volume& volume, std::mt19937& generator) {
  std::uniform_real_distribution<double> uniform(0.0, 1.0);
  const auto place = [&](double beyond) {
    const glm::dvec3 part(uniform(generator), uniform(generator), uniform(generator));
    const glm::dvec3 index = (part * (1.0 + 2.0 * beyond) - beyond) * glm::dvec3(volume.dimensions);
    return glm::dvec3(volume.indexToWorld * glm::dvec4(index, 1.0));
  };
  Camera camera{.position = place(2.0 * uniform(generator)), .lookAt = place(0.0)};
  camera.verticalFov = 20.0 + 80.0 * uniform(generator);
  return camera;
}

/// Cameras with a level of detail for which several levels are likely to be drawn.
Check checkCoverage(Renderer& renderer, const Volume& volume, const LevelData& voxels, glm::ivec2 size) {
  std::mt19937 generator(5);
  MaxError worst;
  for (int i = 0; i < kCameras; ++i) {
    FrameSettings settings{.size = size, .method = SplatSettings{.attenuation = AttenuationLookup::Nearest, .culling = false}};
    const Camera camera = randomCamera(volume, generator);
    settings.lod = float(std::uniform_real_distribution<double>(0.5, 40.0)(generator));
    renderer.render(camera, settings);
    worst.take(
        double(coverageErrors(volume, voxels.extinction, RendererStages(renderer).downloadDrawnBlocks(), voxels.emission)),
        [&] { return fmt::format("camera {}", i); });
  }
  return worst.atMost(0.0, "cut: voxels that are not covered once, from random places", "voxels");
}

/// A view near enough for several levels.
Check checkCutImage(Renderer& renderer, const ValidationScene& scene, const LevelData& voxels, std::span<const LevelData> levels,
                    const TableSettings& table, glm::ivec2 size) {
  Camera camera =
      framingCamera(scene.volume, kDefaultAzimuth, kDefaultElevation, double(size.x) / size.y, {});
  camera.position = camera.lookAt + 0.6 * (camera.position - camera.lookAt);
  const FrameSettings settings{.size = size, .method = SplatSettings{}, .lod = 6.0f};
  const Image image = renderer.render(camera, settings);
  const SplatInputs inputs{.extinction = voxels.extinction,
                           .table = voxels.table,
                           .tableSettings = table,
                           .coarser = levels,
                           .emission = voxels.emission};
  const auto sums = referenceBlockSums(scene.volume, scene.classification, inputs, camera, settings,
                                       RendererStages(renderer).downloadDrawnBlocks());
  return largestDifference(image, referenceResolve(sums, settings)).atMost(kImageTolerance, "cut: image of several levels");
}

/// A bound as half a byte keeps it: never darker, and for linear8 0 only for 0.
int packedBound(int code, bool largest) {
  return largest ? std::min((code + 15) / 16, 15) * 16 : code / 16 * 16;
}

using Bounds = std::vector<std::vector<int>>;  // [direction][block], any where nothing is held

/// A bound is what half a byte keeps of the code of the block's most transparent occupied voxel. `own` has
/// those of the children and is replaced by those of the parents.
void compareBounds(const LevelData& level, const LevelData& children, int number,
                   const TableSettings& settings, Bounds& own, MaxError& worst) {
  const bool largest = settings.code == AttenuationCode::Linear8;
  for (std::size_t direction = 0; direction < own.size(); ++direction) {
    std::vector<int> expected(level.bounds[direction].size(), largest ? 0 : 255);
    const glm::ivec3 n = children.dimensions;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) {
          if (!children.isOccupied(children.at({x, y, z}))) continue;  // not stored
          int& bound = expected[level.at(glm::ivec3(x, y, z) / 2)];
          const int code = own[direction][children.at({x, y, z})];
          bound = largest ? std::max(bound, code) : std::min(bound, code);
        }
    own[direction] = expected;
    for (std::size_t i = 0; i < expected.size(); ++i)
      if (level.isOccupied(i))
        worst.take(std::abs(level.bounds[direction][i] - packedBound(expected[i], largest)), [&] {
          return fmt::format("level {}, block {}, {}", number, i,
                             directionText(settings.directions, int(direction)));
        });
  }
}

}  // namespace

std::vector<Check> compareLevels(const Volume& volume, const LevelData& voxels,
                                 std::span<const LevelData> levels, const TableSettings& settings,
                                 const char* name) {
  MaxError extinction, color, light, depth, table, bounds;
  Bounds own;
  for (const std::vector<std::uint8_t>& codes : voxels.table) own.emplace_back(codes.begin(), codes.end());
  const double whole = opticalDepthOf(voxels, 0, volume.dimensions);
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const int level = int(i) + 1;
    const LevelData reference = referenceParents(i == 0 ? voxels : levels[i - 1], level, volume, settings);
    compareMedium(levels[i], reference, level, extinction, color, light);
    compareTables(levels[i], reference, level, settings.directions, table);
    compareBounds(levels[i], i == 0 ? voxels : levels[i - 1], level, settings, own, bounds);
    const double kept = opticalDepthOf(levels[i], level, volume.dimensions);
    depth.take(kept == whole ? 0.0 : std::abs(kept / whole - 1.0),
               [&] { return fmt::format("level {}", level); });
  }
  return {extinction.atMost(kExtinctionTolerance, fmt::format("octree: extinction, {}", name), "relative"),
          color.atMost(kColorTolerance, fmt::format("octree: colour, {}", name)),
          light.atMost(kLightTolerance, fmt::format("octree: light, {}", name), "relative"),
          depth.atMost(kExtinctionTolerance, fmt::format("octree: optical depth of the whole, {}", name),
                       "relative"),
          table.atMost(kCodeTolerance, fmt::format("octree: table, {}", name), "codes"),
          bounds.atMost(0.0, fmt::format("octree: bounds, {}", name), "codes")};
}

std::size_t coverageErrors(const Volume& volume, std::span<const double> extinction,
                           std::span<const Block> blocks, std::span<const glm::dvec3> emission) {
  std::vector<int> covered(volume.voxelCount(), 0);
  for (const Block& block : blocks) {
    const BlockBox box = boxOf(block, volume.dimensions);
    const glm::ivec3 end = box.first + box.extent;
    for (int z = box.first.z; z < end.z; ++z)
      for (int y = box.first.y; y < end.y; ++y)
        for (int x = box.first.x; x < end.x; ++x) ++covered[volume.at(x, y, z)];
  }
  std::size_t errors = 0;
  const auto holds = [&](std::size_t voxel) {
    return extinction[voxel] > 0.0 || (!emission.empty() && emission[voxel] != glm::dvec3(0.0));
  };
  for (std::size_t i = 0; i < covered.size(); ++i)
    if (covered[i] > 1 || (covered[i] == 0 && holds(i))) ++errors;
  return errors;
}

ReportSection levelChecks(const Device& device, const ValidationScene& scene, glm::ivec2 size) {
  ReportSection section{
      .title = fmt::format("Levels: {}", scene.name),
      .text =
          "Every level of the octree on the device against a double-precision version on the CPU that is "
          "given what the device made of the level below; the cuts of random cameras, in which every voxel "
          "is in one block; and a cut of several levels drawn by both."};
  for (const Variant& variant : kVariants) {
    Renderer renderer(device, scene.volume, scene.classification, variant.settings);
    const std::vector<float> extinction = RendererStages(renderer).downloadExtinction();
    const LevelData voxels =
        referenceVoxelLevel(scene.volume, scene.classification, {extinction.begin(), extinction.end()},
                            RendererStages(renderer).downloadTable(), RendererStages(renderer).downloadEmission());
    const std::vector<LevelData> levels = RendererStages(renderer).downloadLevels();
    for (Check& check : compareLevels(scene.volume, voxels, levels, variant.settings, variant.name))
      section.checks.push_back(std::move(check));
    if (&variant != &kVariants.front()) continue;
    section.checks.push_back(checkCoverage(renderer, scene.volume, voxels, size));
    section.checks.push_back(checkCutImage(renderer, scene, voxels, levels, variant.settings, size));
  }
  return section;
}

}  // namespace freevoxels
