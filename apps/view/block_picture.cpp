#include "apps/view/block_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_set>

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

}  // namespace freevoxels
