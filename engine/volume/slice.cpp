#include "engine/volume/slice.h"

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "engine/core/error.h"
#include "engine/core/parameter.h"
#include "engine/volume/channels.h"

namespace freevoxels {

namespace {

constexpr double kFaceRounding = 1e-6;  ///< voxels by which positions on the faces of a box may be rounded to its outside

/// A corner of the cell of voxel centres that a position is in.
struct Corner {
  glm::ivec3 voxel{0};
  float weight = 0.0f;
};

/// `place` is in voxels, and at most half a voxel beyond the centres.
std::array<Corner, 8> cornersAround(const glm::dvec3& place, const glm::ivec3& dimensions) {
  const glm::dvec3 inside = glm::clamp(place, glm::dvec3(0.0), glm::dvec3(dimensions - 1));
  const glm::ivec3 first = glm::min(glm::ivec3(inside), glm::max(dimensions - 2, glm::ivec3(0)));
  const glm::dvec3 part = inside - glm::dvec3(first);
  std::array<Corner, 8> corners;
  for (int i = 0; i < 8; ++i) {
    const glm::ivec3 step(i & 1, i >> 1 & 1, i >> 2);
    const glm::dvec3 weights = glm::mix(1.0 - part, part, glm::dvec3(step));
    corners[std::size_t(i)] = {glm::min(first + step, dimensions - 1), float(weights.x * weights.y * weights.z)};
  }
  return corners;
}

glm::vec3 voxelColor(const std::array<ScalarBricks, 3>& colors, glm::ivec3 voxel) {
  return {colors[0].at(voxel), colors[1].at(voxel), colors[2].at(voxel)};
}

/// What a position of a slice shows, by what the volume is made of; premultiplied.
using Sampler = std::function<glm::vec4(const glm::dvec3& place)>;

/// The colour of the mean of the values, where the corners without data do not count, and how much of the corners' weight has data.
Sampler samplerOfValues(const Volume& volume, const Classification& classification) {
  return [&volume, &classification](const glm::dvec3& place) {
    double sum = 0.0, weight = 0.0;
    for (const Corner& corner : cornersAround(place, volume.dimensions)) {
      const float value = corner.weight > 0.0f ? volume.scalars.at(corner.voxel) : kInactiveVoxel;
      if (value == kInactiveVoxel) continue;
      sum += double(corner.weight) * double(value);
      weight += double(corner.weight);
    }
    return weight > 0.0 ? float(weight) * glm::vec4(classify(classification, float(sum / weight)).color, 1.0) : glm::vec4(0.0f);
  };
}

Sampler samplerOfChannels(const Volume& volume) {
  return [&volume](const glm::dvec3& place) {
    glm::vec3 sum(0.0f);
    for (const Corner& corner : cornersAround(place, volume.dimensions)) {
      const auto add = [&](const ScalarBricks& amounts, const std::array<ScalarBricks, 3>& colors) {
        if (const float amount = amounts.at(corner.voxel); amount > 0.0f) sum += corner.weight * amount * voxelColor(colors, corner.voxel);
      };
      if (volume.albedo) add(volume.scalars, volume.albedo->values);
      if (volume.temperature) add(volume.temperature->values, volume.temperature->colors);
    }
    return glm::vec4(glm::min(sum, 1.0f), 1.0f);
  };
}

/// Whether a voxel has a label. Densities are means, so that they reach beyond the labels, and there they are less than half of those
/// inside.
bool isLabelled(const Volume& volume, glm::ivec3 voxel) {
  const float density = volume.scalars.at(voxel);
  if (density == kInactiveVoxel) return false;
  const glm::vec3 color = voxelColor(volume.albedo->values, voxel);
  float most = density;
  for (glm::ivec3 d(-1); d.z <= 1; ++d.z)
    for (d.y = -1; d.y <= 1; ++d.y)
      for (d.x = -1; d.x <= 1; ++d.x) {
        const glm::ivec3 other = glm::clamp(voxel + d, glm::ivec3(0), volume.dimensions - 1);
        if (voxelColor(volume.albedo->values, other) == color) most = std::max(most, volume.scalars.at(other));
      }
  return density > 0.5f * most;
}

Sampler samplerOfLabels(const Volume& volume) {
  return [&volume](const glm::dvec3& place) {
    const glm::ivec3 voxel = glm::clamp(glm::ivec3(glm::floor(place + 0.5)), glm::ivec3(0), volume.dimensions - 1);
    return isLabelled(volume, voxel) ? glm::vec4(voxelColor(volume.albedo->values, voxel), 1.0f) : glm::vec4(0.0f);
  };
}

Sampler samplerOf(const Volume& volume, const Classification& classification) {
  if (volume.madeOf != MadeOf::Grids) return volume.madeOf == MadeOf::Channels ? samplerOfChannels(volume) : samplerOfLabels(volume);
  FV_CHECK_EQ(classification.transferFunction.has_value(), true);
  return samplerOfValues(volume, classification);
}

/// Samples along an edge of a pixel that goes so far in voxels.
int samplesAlong(const glm::dvec3& step) {
  constexpr double kMostSamples = 64.0;
  const glm::dvec3 voxels = glm::abs(step);
  return int(std::clamp(std::ceil(std::max({voxels.x, voxels.y, voxels.z}) - kFaceRounding), 1.0, kMostSamples));
}

}  // namespace

WorldBox worldBox(const Volume& volume) {
  const glm::dvec3 first(-0.5), last = glm::dvec3(volume.dimensions) - 0.5;
  WorldBox box{glm::dvec3(volume.indexToWorld * glm::dvec4(first, 1.0)), {}};
  box.high = box.low;
  for (int corner = 1; corner < 8; ++corner) {
    const glm::dvec3 index = glm::mix(first, last, glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2));
    const glm::dvec3 place(volume.indexToWorld * glm::dvec4(index, 1.0));
    box.low = glm::min(box.low, place);
    box.high = glm::max(box.high, place);
  }
  return box;
}

SliceAxes sliceAxes(int axis, glm::dvec3 up) {
  const int upright = std::abs(up.y) > std::abs(up.z) ? 1 : 2;
  glm::dvec3 upwards(0.0);
  upwards[upright] = up[upright] < 0.0 ? -1.0 : 1.0;
  const glm::dvec3 x(1.0, 0.0, 0.0);
  if (axis == 0) return {glm::cross(upwards, x), upwards};
  return {x, axis == upright ? glm::cross(x, upwards) : upwards};
}

Camera sliceCamera(const SlicePlane& plane, glm::dvec3 up, const WorldBox& box, glm::ivec2 size) {
  const double low = box.low[plane.axis], high = box.high[plane.axis];
  const double along = plane.isPercent ? low + plane.position / 100.0 * (high - low) : plane.position;
  const char name = "xyz"[plane.axis];
  if (!(low <= along && along <= high))
    fail(ErrorKind::Usage,
         "{} is beyond the volume, which is from {:.6g} to {:.6g} along {}: choose a position there, or {}:50% for its middle",
         Parameter("slice", fmt::format("{}:{}{}", name, plane.position, plane.isPercent ? "%" : "")), low, high, name, name);
  const SliceAxes axes = sliceAxes(plane.axis, up);
  const glm::dvec3 extent = box.high - box.low;
  const double width = std::abs(glm::dot(extent, axes.right)), height = std::abs(glm::dot(extent, axes.up));
  Camera camera{.up = axes.up, .orthographic = true};
  camera.lookAt = 0.5 * (box.low + box.high);
  camera.lookAt[plane.axis] = along;
  camera.position = camera.lookAt + glm::length(extent) * glm::cross(axes.right, axes.up);
  camera.orthographicHeight = std::max(height, width * double(size.y) / double(size.x));
  return camera;
}

SlicePixels slicePixels(const Volume& volume, const Camera& camera, glm::ivec2 size) {
  const PixelRays rays = pixelRays(camera, size, volume.indexToWorld);
  return {rays.origin + glm::length(camera.lookAt - camera.position) * rays.direction, rays.originX, rays.originY};
}

Image drawSlice(const Volume& volume, const Classification& classification, const SlicePixels& pixels, glm::ivec2 size) {
  const int across = samplesAlong(pixels.right), down = samplesAlong(pixels.down);
  const Sampler sample = samplerOf(volume, classification);
  const glm::dvec3 low(-0.5 - kFaceRounding), high = glm::dvec3(volume.dimensions) - 0.5 + kFaceRounding;
  Image image{.size = size, .pixels = std::vector<glm::vec4>(std::size_t(size.x) * std::size_t(size.y))};
  tbb::parallel_for(0, size.y, [&](int row) {
    for (int column = 0; column < size.x; ++column) {
      glm::vec4 sum(0.0f);
      for (int i = 0; i < across * down; ++i) {
        const double x = column + (i % across + 0.5) / across, y = row + (i / across + 0.5) / down;
        const glm::dvec3 place = pixels.corner + x * pixels.right + y * pixels.down;
        const bool isInside = glm::all(glm::lessThanEqual(low, place)) && glm::all(glm::lessThanEqual(place, high));
        if (isInside) sum += sample(place);
      }
      image.pixels[std::size_t(row) * std::size_t(size.x) + std::size_t(column)] = sum / float(across * down);
    }
  });
  return image;
}

}  // namespace freevoxels
