#include "apps/view/diagnosis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

#include "engine/core/error.h"
#include "engine/renderer_stages.h"
#include "engine/volume/procedural.h"

namespace freevoxels {

namespace {

constexpr float kFarShade = 0.45f;  // of the farthest blocks, so that shapes can be told

/// Different for all blocks of a volume.
std::uint64_t keyOf(const Block& block) {
  constexpr int kBits = 19;
  std::uint64_t key = std::uint64_t(block.level);
  for (int axis = 0; axis < 3; ++axis) key = key << kBits | std::uint64_t(block.cell[axis]);
  return key;
}

struct Square {
  glm::vec2 centre{0.0f};  ///< pixels
  float half = 0.0f;
  float distance = 0.0f;  ///< from the eye plane; negative behind it
};

Square squareOf(const PaintedBlock& painted, glm::ivec3 dimensions, const glm::dmat4& indexToWorld,
                const glm::dmat4& worldToCamera, const Camera& camera, glm::ivec2 size) {
  const BlockBox box = boxOf(painted.block, dimensions);
  const glm::dvec3 seen(worldToCamera * indexToWorld * glm::dvec4(box.centre(), 1.0));
  const double height = camera.orthographic
                            ? camera.orthographicHeight
                            : -2.0 * seen.z * std::tan(0.5 * glm::radians(camera.verticalFov));
  const double pixels = double(size.y) / height;
  const double edge = std::cbrt(std::abs(glm::determinant(glm::dmat3(indexToWorld)))) * painted.block.edge();
  return {.centre = glm::vec2(0.5 * glm::dvec2(size) + pixels * glm::dvec2(seen.x, -seen.y)),
          .half = float(0.5 * edge * pixels),
          .distance = float(-seen.z)};
}

const glm::vec3 kNothingThere(0.02f, 0.03f, 0.06f);  // no grey, so that black and white stand out
const glm::vec3 kLeftOutColor(0.30f, 0.02f, 0.05f);
constexpr float kShownOpacity = 0.5f;  // of a voxel: the surface shows, without hard edges

Image greyImage(const std::vector<SplatSums>& sums, glm::ivec2 size, double (*brightness)(const SplatSums&),
                  double scale) {
  Image image{.size = size};
  image.pixels.reserve(sums.size());
  for (const SplatSums& pixel : sums)
    image.pixels.emplace_back(glm::vec3(float(brightness(pixel) * scale)), 1.0f);
  return image;
}

Image sumsImage(Shown shown, Renderer& renderer, const Camera& camera, const FrameSettings& settings) {
  FrameSettings ordered = settings;
  if (settings.gathers() || settings.isSorted()) ordered.method = SplatSettings{};  // which alone have sums
  ordered.holdout = nullptr;
  const std::vector<SplatSums> sums = RendererStages(renderer).renderSums(camera, ordered);
  if (shown == Shown::Transmittance)
    return greyImage(
        sums, settings.size, [](const SplatSums& pixel) { return std::exp(-pixel.depth); }, 1.0);
  const double largest = std::ranges::max(sums, {}, &SplatSums::energy).energy;
  return greyImage(
      sums, settings.size, [](const SplatSums& pixel) { return pixel.energy; },
      largest > 0.0 ? 1.0 / largest : 0.0);
}

Image blocksImage(const std::optional<Camera>& chosenFor, Renderer& renderer, const Volume& volume,
                    const Camera& camera, const FrameSettings& settings) {
  FrameSettings splats = settings;
  if (settings.gathers()) splats.method = SplatSettings{};  // the gather chooses no blocks
  splats.holdout = nullptr;
  renderer.render(chosenFor.value_or(camera), splats);
  const std::vector<Block> drawn = RendererStages(renderer).downloadDrawnBlocks();
  std::vector<PaintedBlock> painted;
  for (const Block& block : drawn) painted.push_back({block, levelColor(block.level)});
  if (chosenFor) {
    std::vector<Block> voxels;
    const glm::ivec3 size = volume.dimensions;
    for (const std::uint32_t index : RendererStages(renderer).downloadBlockList()) {
      const int row = int(index / std::uint32_t(size.x));
      voxels.push_back({0, {int(index % std::uint32_t(size.x)), row % size.y, row / size.y}});
    }
    for (const Block& block : leftOut(drawn, voxels)) painted.push_back({block, kLeftOutColor});
  }
  return paintBlocks(painted, volume.dimensions, volume.indexToWorld, camera, settings.size);
}

/// Fitted into the image, a voxel as large along both of its axes.
Image sliceImage(const Diagnosis& diagnosis, const std::vector<std::uint8_t>& codes, AttenuationCode code,
                   const Volume& volume, glm::ivec2 size) {
  const int across = diagnosis.axis, right = (across + 1) % 3, up = (across + 2) % 3;
  const glm::ivec3 count = volume.dimensions;
  const double pixels = std::min(double(size.x) / count[right], double(size.y) / count[up]);
  const glm::dvec2 corner = 0.5 * (glm::dvec2(size) - pixels * glm::dvec2(count[right], count[up]));
  Image image{.size = size};
  image.pixels.assign(std::size_t(size.x) * std::size_t(size.y), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  for (int y = 0; y < size.y; ++y)
    for (int x = 0; x < size.x; ++x) {
      const glm::dvec2 place = (glm::dvec2(x, size.y - 1 - y) + 0.5 - corner) / pixels;
      if (place.x < 0.0 || place.y < 0.0 || place.x >= count[right] || place.y >= count[up]) continue;
      glm::ivec3 voxel;
      voxel[across] = std::min(int(diagnosis.place * count[across]), count[across] - 1);
      voxel[right] = int(place.x);
      voxel[up] = int(place.y);
      const std::size_t index = volume.at(voxel.x, voxel.y, voxel.z);
      const bool held = volume.scalars.at(voxel) != kInactiveVoxel;
      const auto grey = float(std::exp(-decodeOpticalDepth(code, codes[index])));
      image.pixels[std::size_t(x) + std::size_t(size.x) * std::size_t(y)] =
          glm::vec4(held ? glm::vec3(grey) : kNothingThere, 1.0f);
    }
  return image;
}

/// Scalars are transmittances along a direction.
Volume transmittances(const Volume& volume, const std::vector<std::uint8_t>& codes, AttenuationCode code) {
  return makeVolume(volume.dimensions, volume.indexToWorld, [&](int x, int y, int z) {
    if (volume.scalar(x, y, z) == kInactiveVoxel) return kInactiveVoxel;
    return float(std::exp(-decodeOpticalDepth(code, codes[volume.at(x, y, z)])));
  });
}

}  // namespace

glm::vec3 levelColor(int level) {
  static constexpr std::array<glm::vec3, 6> kColors{{{0.80f, 0.80f, 0.80f},
                                                     {0.10f, 0.45f, 0.90f},
                                                     {0.10f, 0.65f, 0.25f},
                                                     {0.95f, 0.65f, 0.08f},
                                                     {0.85f, 0.20f, 0.12f},
                                                     {0.55f, 0.20f, 0.75f}}};
  return kColors[std::size_t(level) % kColors.size()];
}

Image paintBlocks(std::span<const PaintedBlock> blocks, glm::ivec3 dimensions, const glm::dmat4& indexToWorld,
                  const Camera& camera, glm::ivec2 size) {
  const glm::dmat4 toCamera = worldToCamera(camera);
  std::vector<Square> squares;
  float nearest = std::numeric_limits<float>::max(), farthest = 0.0f;
  for (const PaintedBlock& block : blocks) {
    squares.push_back(squareOf(block, dimensions, indexToWorld, toCamera, camera, size));
    if (squares.back().distance <= 0.0f) continue;
    nearest = std::min(nearest, squares.back().distance);
    farthest = std::max(farthest, squares.back().distance);
  }
  Image image{.size = size};
  image.pixels.assign(std::size_t(size.x) * std::size_t(size.y), glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  std::vector<float> depth(image.pixels.size(), std::numeric_limits<float>::max());
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const Square& square = squares[i];
    if (square.distance <= 0.0f) continue;
    const float far = farthest > nearest ? (square.distance - nearest) / (farthest - nearest) : 0.0f;
    const glm::vec4 color((1.0f - far * (1.0f - kFarShade)) * blocks[i].color, 1.0f);
    const glm::vec2 limit(size);
    const glm::ivec2 low(glm::clamp(glm::floor(square.centre - square.half), glm::vec2(0.0f), limit));
    const glm::ivec2 high(glm::clamp(glm::ceil(square.centre + square.half), glm::vec2(0.0f), limit));
    for (int y = low.y; y < high.y; ++y)
      for (int x = low.x; x < high.x; ++x) {
        const std::size_t pixel = std::size_t(x) + std::size_t(size.x) * std::size_t(y);
        if (square.distance >= depth[pixel]) continue;
        depth[pixel] = square.distance;
        image.pixels[pixel] = color;
      }
  }
  return image;
}

std::vector<Block> leftOut(std::span<const Block> drawn, std::span<const Block> voxels) {
  std::unordered_set<std::uint64_t> keys;
  int coarsest = 0;
  for (const Block& block : drawn) {
    keys.insert(keyOf(block));
    coarsest = std::max(coarsest, block.level);
  }
  std::vector<Block> result;
  for (const Block& voxel : voxels) {
    Block block = voxel;
    while (block.level < coarsest && !keys.contains(keyOf(block))) block = block.parent();
    if (!keys.contains(keyOf(block))) result.push_back(voxel);
  }
  return result;
}

void Diagnoser::reset() {
  codes_.clear();
  tableRenderer_ = nullptr;
  tableDirection_ = -1;
}

const std::vector<std::vector<std::uint8_t>>& Diagnoser::codes(Renderer& renderer) {
  if (codes_.empty()) codes_ = RendererStages(renderer).downloadTable();
  return codes_;
}

Image Diagnoser::drawTable(int direction, Renderer& renderer, const Volume& volume,
                           const TableSettings& table, const Camera& camera, glm::ivec2 size) {
  if (!tableRenderer_ || tableDirection_ != direction) {
    Classification classification;
    classification.transferFunction =
        TransferFunction{.opacity = {{0.0f, kShownOpacity}},
                         .color = {{0.0f, glm::vec3(0.0f)}, {1.0f, glm::vec3(1.0f)}},
                         .unitDistance = volume.voxelSize()};
    tableRenderer_ = nullptr;  // not both at once
    tableVolume_ = transmittances(volume, codes(renderer)[std::size_t(direction)], table.code);
    tableRenderer_ = std::make_unique<Renderer>(device_, tableVolume_, classification, table);
    tableDirection_ = direction;
  }
  Image image = tableRenderer_->render(camera, {.size = size, .method = SplatSettings{}});
  for (glm::vec4& pixel : image.pixels) pixel += glm::vec4((1.0f - pixel.a) * kNothingThere, 1.0f - pixel.a);
  return image;
}

Image Diagnoser::make(const Diagnosis& diagnosis, Renderer& renderer, const Volume& volume,
                      const TableSettings& table, const Camera& camera, const FrameSettings& settings) {
  const int direction = std::min(diagnosis.direction, directionCount(table.directions) - 1);
  switch (diagnosis.shown) {
    case Shown::Energy:
    case Shown::Transmittance:
      return sumsImage(diagnosis.shown, renderer, camera, settings);
    case Shown::Blocks:
      return blocksImage(diagnosis.chosenFor, renderer, volume, camera, settings);
    case Shown::TableSlice:
      return sliceImage(diagnosis, codes(renderer)[std::size_t(direction)], table.code, volume,
                          settings.size);
    case Shown::TableImage:
      return drawTable(direction, renderer, volume, table, camera, settings.size);
    case Shown::Image:
      break;
  }
  throw InternalError("an image is no diagnosis");
}

}  // namespace freevoxels
