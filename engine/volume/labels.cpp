#include "engine/volume/labels.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "engine/volume/classification.h"

namespace freevoxels {

namespace {

/// The hue is 0 to 1, as are the others.
glm::vec3 colorOfHue(float hue, float saturation, float value) {
  const glm::vec3 wheel = glm::abs(glm::fract(glm::vec3(hue) + glm::vec3(0.0f, 2.0f / 3.0f, 1.0f / 3.0f)) * 6.0f - 3.0f) - 1.0f;
  return value * glm::mix(glm::vec3(1.0f), glm::clamp(wheel, 0.0f, 1.0f), saturation);
}

/// The density of a voxel with an opacity, relative to that of kSolidOpticalDepth.
float densityOf(float opacity) {
  const double depth = -std::log1p(-std::min(double(opacity), kMaxOpacity));
  return float(std::min(depth / kSolidOpticalDepth, 1.0));
}

bool isInBox(glm::ivec3 voxel, glm::ivec3 dimensions) {
  return glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) && glm::all(glm::lessThan(voxel, dimensions));
}

/// Voxels around a voxel, along each axis, of which its density is a mean.
constexpr int kMeanReach = 2;

/// A label as it is drawn: not at all with density kInactiveVoxel.
struct Look {
  float density = kInactiveVoxel;
  glm::vec3 color{kInactiveVoxel};

  bool operator==(const Look&) const = default;
};

Look lookOf(const Labels& labels, std::int64_t label) {
  if (!labels.shows(label)) return {};
  const auto style = labels.styles.find(label);
  if (style == labels.styles.end()) return {densityOf(1.0f), automaticLabelColor(label)};
  if (!(style->second.opacity > 0.0f)) return {};
  return {densityOf(style->second.opacity), style->second.color ? *style->second.color : automaticLabelColor(label)};
}

/// The voxels of a brick and those around it, of which the former's densities are means: the surfaces of solids would have steps otherwise.
class Neighbourhood {
 public:
  Neighbourhood(const ScalarBricks& values, glm::ivec3 firstVoxel, const Labels& labels) {
    std::int64_t last = 0;  // which most neighbours share
    Look look;
    std::size_t index = 0;
    for (glm::ivec3 v(-kReach); v.z < kEnd; ++v.z)
      for (v.y = -kReach; v.y < kEnd; ++v.y)
        for (v.x = -kReach; v.x < kEnd; ++v.x, ++index) {
          const glm::ivec3 voxel = firstVoxel + v;
          const float scalar = isInBox(voxel, values.dimensions()) ? values.at(voxel) : kInactiveVoxel;
          const std::int64_t label = scalar == kInactiveVoxel ? 0 : labelOf(scalar);
          if (label != std::exchange(last, label)) look = lookOf(labels, label);
          looks_[index] = look;
          isUniform_ &= look == looks_.front();
        }
  }

  /// Of the voxel at a place in the brick: the mean density, with binomial weights, and the colour of the nearest voxel with a label. Parts
  /// that are thinner than a voxel of the mean keep half of their density.
  Look at(glm::ivec3 place) const {
    constexpr std::array<float, 2 * kReach + 1> kWeights{1.0f / 16, 4.0f / 16, 6.0f / 16, 4.0f / 16, 1.0f / 16};
    const Look& own = lookAt(place);
    if (isUniform_) return own;
    float mean = 0.0f;
    int nearest = std::numeric_limits<int>::max();
    Look result;
    for (glm::ivec3 d(-kReach); d.z <= kReach; ++d.z)
      for (d.y = -kReach; d.y <= kReach; ++d.y)
        for (d.x = -kReach; d.x <= kReach; ++d.x) {
          const Look& other = lookAt(place + d);
          if (other.density == kInactiveVoxel) continue;
          mean += kWeights[std::size_t(d.x + kReach)] * kWeights[std::size_t(d.y + kReach)] * kWeights[std::size_t(d.z + kReach)] *
                  other.density;
          if (const int distance = d.x * d.x + d.y * d.y + d.z * d.z; distance < nearest) nearest = distance, result.color = other.color;
        }
    if (mean > 0.0f) result.density = std::max(mean, 0.5f * own.density);
    return result;
  }

 private:
  static constexpr int kReach = kMeanReach, kEnd = ScalarBricks::kEdge + kReach, kEdge = ScalarBricks::kEdge + 2 * kReach;
  const Look& lookAt(glm::ivec3 place) const {
    const glm::ivec3 at = place + kReach;
    return looks_[std::size_t(at.x + kEdge * (at.y + kEdge * at.z))];
  }

  std::array<Look, std::size_t(kEdge) * kEdge * kEdge> looks_;
  bool isUniform_ = true;  ///< as inside of a part, or where there is none
};

/// Makes the bricks that means of the values of a brick reach, as far as there are cells.
void makeBricksAround(ScalarBricks& bricks, const ScalarBricks& values, std::size_t brick, const Labels& labels) {
  constexpr int kEdge = ScalarBricks::kEdge;
  glm::ivec3 low(kEdge), high(-1);  // of the voxels with labels that are shown
  const ScalarBricks::Brick scalars = values.brick(brick);
  for (std::size_t i = 0; i < scalars.size(); ++i) {
    const float value = scalars[i];
    if (value == kInactiveVoxel || !labels.shows(labelOf(value))) continue;
    low = glm::min(low, ScalarBricks::placeInBrick(i));
    high = glm::max(high, ScalarBricks::placeInBrick(i));
  }
  if (high.x < 0) return;
  const glm::ivec3 cell = values.cell(brick), reach(kMeanReach);
  const glm::ivec3 first = glm::max(cell - glm::ivec3(glm::lessThan(low, reach)), 0);
  const glm::ivec3 last = glm::min(cell + glm::ivec3(glm::greaterThanEqual(high, kEdge - reach)), bricks.cells() - 1);
  for (glm::ivec3 c = first; c.z <= last.z; ++c.z)
    for (c.y = first.y; c.y <= last.y; ++c.y)
      for (c.x = first.x; c.x <= last.x; ++c.x) bricks.makeBrick(c);
}

}  // namespace

glm::vec3 automaticLabelColor(std::int64_t label) {
  constexpr double kGoldenRatio = 0.6180339887498949;  // its multiples are spread most evenly
  constexpr std::int64_t kHues = 7;                    // after which the saturation changes
  const double turns = double(label) * kGoldenRatio;
  const bool isPale = (label / kHues) % 2 != 0;
  return colorOfHue(float(turns - std::floor(turns)), isPale ? 0.45f : 0.8f, 0.85f);
}

std::int64_t labelOf(float scalar) {
  return std::int64_t(std::nearbyint(std::clamp(double(scalar), -9e15, 9e15)));
}

void showLabels(Volume& volume, const Labels& labels) {
  const ScalarBricks values = std::exchange(volume.scalars, {});
  ScalarBricks densities(volume.dimensions, values.corner());
  for (std::size_t brick = 0; brick < values.count(); ++brick) makeBricksAround(densities, values, brick, labels);
  AlbedoGrid colors{.name = "labels", .values = {}};
  colors.values.fill(densities);
  std::array<std::span<ScalarBricks::Brick>, 3> colorBricks;
  for (std::size_t c = 0; c < 3; ++c) colorBricks[c] = colors.values[c].editable();
  const std::span<ScalarBricks::Brick> bricks = densities.editable();
  tbb::parallel_for(std::size_t(0), bricks.size(), [&](std::size_t brick) {
    const glm::ivec3 first = densities.firstVoxel(brick);
    const Neighbourhood there(values, first, labels);
    for (std::size_t i = 0; i < bricks[brick].size(); ++i) {
      const glm::ivec3 place = ScalarBricks::placeInBrick(i);
      const Look look = isInBox(first + place, volume.dimensions) ? there.at(place) : Look();
      bricks[brick][i] = look.density;
      for (int c = 0; c < 3; ++c) colorBricks[std::size_t(c)][brick][i] = look.color[c];
    }
  });
  volume.scalars = std::move(densities);
  volume.albedo = std::move(colors);
  volume.madeOf = MadeOf::Labels;
  volume.isSolid = true;
  summariseValues(volume);
}

}  // namespace freevoxels
