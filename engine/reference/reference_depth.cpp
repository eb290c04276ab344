#include "engine/reference/reference_depth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <tuple>
#include <utility>

#include "engine/core/error.h"
#include "engine/reference/reference_rays.h"

namespace freevoxels {

namespace {

/// The direction scaled to the length of a lattice layer.
glm::dvec3 acrossLayer(glm::dvec3 direction) {
  return direction / std::abs(direction[majorAxis(direction)]);
}

class TableDepth : public ReferenceDepth {
 public:
  TableDepth(const Volume& volume, std::span<const double> extinction,
             const std::vector<std::vector<std::uint8_t>>& table, std::span<const LevelData> coarser,
             const TableSettings& settings, AttenuationLookup lookup, ToEye toEye,
             std::optional<glm::dvec3> eyeInside, std::span<const glm::dvec3> emission)
      : volume_(volume),
        extinction_(extinction),
        emission_(emission),
        table_(table),
        coarser_(coarser),
        settings_(settings),
        lookup_(lookup),
        toEye_(std::move(toEye)),
        eyeInside_(eyeInside) {
    FV_CHECK_EQ(table.size(), std::size_t(directionCount(settings.directions)));
    for (int i = 0; i < int(table.size()); ++i)
      layerLengths_.push_back(stepLength(volume.indexToWorld, directionAt(settings.directions, i), true));
  }

  double at(const Block& block) const override { return -std::log(transmittance(block).all); }
  double unsaturated(const Block& block) const override {
    const Transmittance found = transmittance(block);
    return found.unsaturated / found.all;
  }
  double slope(const Block& block, int axis) const override {
    const Block before = neighbour(block, axis, -1), after = neighbour(block, axis, 1);
    const double apart = centre(after)[axis] - centre(before)[axis];
    return before == after ? 0.0 : (at(after) - at(before)) / apart;
  }
  double countedLength(double layerLength) const override {
    return settings_.pathLengthCorrection ? layerLength : volume_.voxelSize();
  }

 private:
  struct Transmittance {
    double all = 0.0, unsaturated = 0.0;
  };
  Transmittance transmittance(const Block& block) const;
  glm::dvec3 centre(const Block& block) const { return boxOf(block, volume_.dimensions).centre(); }
  /// The neighbour, or the block itself if that is not occupied or outside.
  Block neighbour(Block block, int axis, int steps) const {
    Block next = block;
    next.cell[axis] += steps;
    const bool holds = extinctionOf(next, volume_, extinction_, coarser_) > 0.0 ||
                       emissionOf(next, volume_, emission_, coarser_) != glm::dvec3(0.0);
    return holds ? next : block;
  }
  double extinctionAt(glm::dvec3 place) const;
  /// The depth of a table byte, scaled as if the layers of its line had this world length.
  double stored(int direction, int byte, double layer) const;
  double sourceDepth(int direction, double layer) const;

  const Volume& volume_;
  const std::span<const double> extinction_;
  const std::span<const glm::dvec3> emission_;
  const std::vector<std::vector<std::uint8_t>>& table_;
  const std::span<const LevelData> coarser_;
  const TableSettings settings_;
  const AttenuationLookup lookup_;
  const ToEye toEye_;
  const std::optional<glm::dvec3> eyeInside_;
  std::vector<double> layerLengths_;  ///< by direction, world length
};

double TableDepth::stored(int direction, int byte, double layer) const {
  const double depth = decodeOpticalDepth(settings_.code, byte);
  if (!settings_.pathLengthCorrection) return depth;
  return depth * layer / layerLengths_[std::size_t(direction)];
}

/// Interpolates between the eight voxels around a position; 0 outside.
double TableDepth::extinctionAt(glm::dvec3 place) const {
  const glm::ivec3 low(glm::floor(place));
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 voxel = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::dvec3 share = 1.0 - glm::abs(place - glm::dvec3(voxel));
    sum += share.x * share.y * share.z * extinctionOf({0, voxel}, volume_, extinction_, coarser_);
  }
  return sum;
}

/// The depth from the eye to the outside, with half of the voxel at the eye.
double TableDepth::sourceDepth(int direction, double layer) const {
  if (!eyeInside_) return 0.0;
  const glm::dvec3 last(volume_.dimensions - 1), step = directionAt(settings_.directions, direction);
  glm::dvec3 place = glm::clamp(*eyeInside_, glm::dvec3(0.0), last);
  double sum = 0.5 * extinctionAt(place);
  for (place += step;
       glm::all(glm::greaterThan(place, glm::dvec3(-1.0))) && glm::all(glm::lessThan(place, last + 1.0));
       place += step)
    sum += extinctionAt(place);
  return sum * countedLength(layer);
}

TableDepth::Transmittance TableDepth::transmittance(const Block& block) const {
  const glm::dvec3 toEye = toEye_(centre(block));
  const glm::dmat3 toWorld(volume_.indexToWorld);
  const double layer = glm::length(toWorld * acrossLayer(toEye));
  const LevelData* level = block.level == 0 ? nullptr : &coarser_[std::size_t(block.level) - 1];
  const auto& table = level == nullptr ? table_ : level->table;
  const std::size_t index =
      level == nullptr ? volume_.at(block.cell.x, block.cell.y, block.cell.z) : level->at(block.cell);
  const DirectionSet set = settings_.directions;
  const int end = settings_.code == AttenuationCode::Linear8 ? 0 : 255;
  Transmittance result;
  const auto add = [&](double weight, int direction) {
    const int byte = table[std::size_t(direction)][index];
    const double depth = std::max(stored(direction, byte, layer) - sourceDepth(direction, layer), 0.0);
    result.all += weight * std::exp(-depth);
    if (byte != end) result.unsaturated += weight * std::exp(-depth);
  };
  if (lookup_ == AttenuationLookup::Nearest) {
    add(1.0, nearestDirection(set, toEye));
    return result;
  }
  const DirectionBlend blend = bilinearDirections(set, toEye);
  for (std::size_t i = 0; i < 4; ++i) add(blend.weights[i], blend.directions[i]);
  return result;
}

/// Catmull-Rom as a Hermite spline: value and derivative at x between p[1] and p[2].
std::pair<double, double> spline(const std::array<double, 4>& p, double x) {
  const double m1 = (p[2] - p[0]) / 2.0, m2 = (p[3] - p[1]) / 2.0, rise = p[2] - p[1];
  const double b = 3.0 * rise - 2.0 * m1 - m2, a = m1 + m2 - 2.0 * rise;
  return {p[1] + x * (m1 + x * (b + x * a)), m1 + x * (2.0 * b + x * 3.0 * a)};
}

class RayDepth : public ReferenceDepth {
 public:
  RayDepth(const Volume& volume, const RaySource& source, RayCodes codes)
      : volume_(volume),
        source_(source),
        fans_(faceRays(volume.dimensions, source)),
        codes_(std::move(codes)) {
    for (std::size_t f = 0; f < fans_.size(); ++f)
      FV_CHECK_EQ(codes_[f].size(), fans_[f].rays() * std::size_t(fans_[f].planeCount));
  }

  double at(const Block& block) const override { return lookUp(block).x; }
  double slope(const Block& block, int axis) const override {
    const FaceRays& fan = fanOf(boxOf(block, volume_.dimensions).centre());
    return lookUp(block)[axis == (fan.axis + 1) % 3 ? 1 : 2];
  }

 private:
  glm::dvec3 fromSource(glm::dvec3 position) const {
    return source_.atInfinity ? -source_.place : position - source_.place;
  }
  const FaceRays& fanOf(glm::dvec3 position) const {
    return fans_[std::size_t(fanIndex(fromSource(position)))];
  }
  glm::dvec3 lookUp(const Block& block) const;
  glm::dvec3 lookUp(const FaceRays& fan, glm::dvec3 onPlane) const;

  const Volume& volume_;
  const RaySource source_;
  const std::array<FaceRays, 6> fans_;
  const RayCodes codes_;
};

/// The depth and its slopes along the two sides of the face.
glm::dvec3 RayDepth::lookUp(const Block& block) const {
  const BlockBox box = boxOf(block, volume_.dimensions);
  const glm::dvec3 centre = box.centre();
  const FaceRays& fan = fanOf(centre);
  if (box.extent[fan.axis] % 2 == 1) return lookUp(fan, centre);
  const glm::dvec3 ray = fromSource(centre), halfLayer = 0.5 * ray / ray[fan.axis];
  return 0.5 * (lookUp(fan, centre + halfLayer) + lookUp(fan, centre - halfLayer));
}

glm::dvec3 RayDepth::lookUp(const FaceRays& fan, glm::dvec3 onPlane) const {
  if (fan.planeCount == 0) return glm::dvec3(0.0);  // only for a voxel at the source
  const std::vector<std::uint16_t>& codes = codes_[std::size_t(&fan - fans_.data())];
  // At the source, the first axis.
  const int plane = std::clamp((int(std::lround(onPlane[fan.axis])) - fan.firstPlane) * fan.direction, 0,
                               fan.planeCount - 1);
  const double up = fan.firstPlane + fan.direction * plane - fan.farthest;
  const double apart = fan.spacing * (1.0 + fan.convergence * up);
  const glm::dvec2 side(onPlane[(fan.axis + 1) % 3], onPlane[(fan.axis + 2) % 3]);
  const glm::dvec2 place = (side - fan.origin - fan.slope * up) / apart;
  const glm::ivec2 low = glm::clamp(glm::ivec2(glm::floor(place)), glm::ivec2(1), fan.rayCount - 3);
  const glm::dvec2 x = glm::clamp(place - glm::dvec2(low), 0.0, 1.0);
  std::array<double, 4> values, slopes;
  for (int j = 0; j < 4; ++j) {
    std::array<double, 4> line;
    for (int i = 0; i < 4; ++i)
      line[std::size_t(i)] = decodeRayDepth(
          codes[std::size_t(low.x - 1 + i) +
                std::size_t(fan.rayCount.x) *
                    (std::size_t(low.y - 1 + j) + std::size_t(fan.rayCount.y) * std::size_t(plane))]);
    std::tie(values[std::size_t(j)], slopes[std::size_t(j)]) = spline(line, x.x);
  }
  const auto [value, alongY] = spline(values, x.y);
  return {std::max(value, 0.0), spline(slopes, x.y).first / apart, alongY / apart};
}

/// `level` is null for voxels.
bool isOutside(const Block& block, const LevelData* level, const Volume& volume) {
  const glm::ivec3 n = level == nullptr ? volume.dimensions : level->dimensions;
  return glm::any(glm::lessThan(block.cell, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(block.cell, n));
}

}  // namespace

double extinctionOf(const Block& block, const Volume& volume, std::span<const double> extinction,
                    std::span<const LevelData> coarser) {
  const LevelData* level = block.level == 0 ? nullptr : &coarser[std::size_t(block.level) - 1];
  if (isOutside(block, level, volume)) return 0.0;
  if (level == nullptr) return extinction[volume.at(block.cell.x, block.cell.y, block.cell.z)];
  return level->extinction[level->at(block.cell)];
}

glm::dvec3 emissionOf(const Block& block, const Volume& volume, std::span<const glm::dvec3> emission,
                      std::span<const LevelData> coarser) {
  const LevelData* level = block.level == 0 ? nullptr : &coarser[std::size_t(block.level) - 1];
  const bool isDark = level == nullptr ? emission.empty() : level->emission.empty();
  if (isDark || isOutside(block, level, volume)) return glm::dvec3(0.0);
  if (level == nullptr) return emission[volume.at(block.cell.x, block.cell.y, block.cell.z)];
  return level->emission[level->at(block.cell)];
}

glm::dvec3 ReferenceDepth::gradient(const Block& block, glm::dvec3 toEye, double layerDepth) const {
  const glm::dvec3 direction = acrossLayer(toEye);
  const int along = majorAxis(direction);
  glm::dvec3 gradient(0.0);
  for (int axis = 0; axis < 3; ++axis)
    if (axis != along) gradient[axis] = slope(block, axis);
  gradient[along] = -(layerDepth + glm::dot(gradient, direction)) / direction[along];
  return gradient;
}

std::unique_ptr<ReferenceDepth> tableDepth(const Volume& volume, std::span<const double> extinction,
                                           const std::vector<std::vector<std::uint8_t>>& table,
                                           std::span<const LevelData> coarser, const TableSettings& settings,
                                           AttenuationLookup lookup, ToEye toEye,
                                           std::optional<glm::dvec3> eyeInside,
                                           std::span<const glm::dvec3> emission) {
  return std::make_unique<TableDepth>(volume, extinction, table, coarser, settings, lookup, std::move(toEye),
                                      eyeInside, emission);
}

std::unique_ptr<ReferenceDepth> rayDepth(const Volume& volume, const RaySource& source, RayCodes codes) {
  return std::make_unique<RayDepth>(volume, source, std::move(codes));
}

}  // namespace freevoxels
