#include "engine/reference/reference_gather_ray.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/core/error.h"
#include "engine/octree/hierarchy_layout.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

constexpr double kSamplesPerVoxel = 2.4;
constexpr double kCoarseVoxels = 1.25;  ///< largest distance between coarse samples of adaptive sampling
constexpr double kMinPitch = 0.5;  // of images of up to 4 million pixels; larger ones are not compared
/// For a camera near the volume the lattice is made for this part of the distance to the farthest corner.
constexpr double kNearReference = 0.75;
/// A ray marches along the main axis if its component along it is at least this part of its largest
/// component.
constexpr double kMinAlongMain = 0.5;
/// Lengths in voxels of a stretch from slice to slice, in the middle of the image, from which on its quarters count, and count fully. So
/// they do from slopes along the diagonal of a voxel's face.
constexpr double kLongStretch = 1.45, kLongestStretch = 1.6, kObliqueSlope = 0.87, kDiagonalSlope = 0.97;
/// The mean of a transfer function is that of both ends if they are fewer intervals apart than this.
constexpr double kMinChange = 16.0;

/// The part in front of the eye of a tent with a half width of 1, whose middle is `ahead` in front of the
/// eye.
double partOfTent(double ahead) {
  const double a = std::clamp(ahead, -1.0, 1.0);
  return a < 0.0 ? 0.5 * (1.0 + a) * (1.0 + a) : 1.0 - 0.5 * (1.0 - a) * (1.0 - a);
}

std::array<glm::dvec3, 8> cornersOf(glm::dvec3 low, glm::dvec3 high) {
  std::array<glm::dvec3, 8> corners;
  for (int i = 0; i < 8; ++i) corners[std::size_t(i)] = glm::mix(low, high, glm::dvec3(i & 1, i >> 1 & 1, i >> 2));
  return corners;
}

/// A stretch with constant extinction (a) and source term (rgb), both per world unit. `distance` is that of
/// its middle.
void addPart(GatherSums& sums, double& transmittance, glm::dvec4 medium, double length, double distance) {
  const double depth = medium.a * length, through = std::exp(-depth);
  sums.color += transmittance * length * meanTransmittance(depth) * glm::dvec3(medium);
  sums.distance += transmittance * -std::expm1(-depth) * std::max(distance, 0.0);
  transmittance *= through;
}

}  // namespace

GatherBlocks referenceGatherBlocks(const LevelData& medium, int level, glm::ivec3 voxels, glm::dvec3 albedo, bool emissionApart) {
  GatherBlocks blocks{.dimensions = medium.dimensions, .extinction = {}, .source = {}};
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < medium.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < medium.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < medium.dimensions.x; ++cell.x) {
        const std::size_t i = medium.at(cell);
        const Block block{level, cell};
        const double inside = boxOf(block, voxels).voxels() / std::pow(double(block.edge()), 3.0);
        const glm::dvec3 color = medium.colors.empty() ? albedo : medium.colors[i];
        const glm::dvec3 emission = medium.emission.empty() ? glm::dvec3(0.0) : medium.emission[i];
        blocks.extinction.push_back(inside * medium.extinction[i]);
        blocks.source.push_back(inside * (medium.extinction[i] * color + (emissionApart ? glm::dvec3(0.0) : emission)));
        if (emissionApart && !medium.emission.empty()) blocks.emission.push_back(inside * emission);
      }
  return blocks;
}

ReferenceGather::ReferenceGather(const Volume& volume, const Classification& classification, const Camera& camera,
                                 const FrameSettings& settings)
    : volume_(volume),
      size_(settings.size),
      middle_(0.5 * glm::dvec2(settings.size)),
      rays_(pixelRays(camera, settings.size, volume.indexToWorld)),
      linear_(volume.indexToWorld),
      detail_(detailRule(HierarchyLayout(volume.dimensions), rays_, settings.size, settings.blockPixels())) {
  // Levels come in slice by slice, which may be complete only after all blocks are small.
  if (!rays_.orthographic || detail_.coarsestShare < 1.0) detail_.finest = std::max(detail_.finest - 1, 0);
  const Ray middle = rayThrough(glm::dvec2(0.0));
  toPixel_ = glm::inverse(rays_.orthographic ? glm::dmat3(rays_.originX, rays_.originY, middle.direction)
                                             : glm::dmat3(rays_.directionX, rays_.directionY, middle.direction));
  mainAxis_ = majorAxis(middle.direction);
  const double stretch = glm::length(middle.direction) / std::abs(middle.direction[mainAxis_]);
  const std::array<int, 2> sides = sidesOf(mainAxis_);
  const double slope =
      std::max(std::abs(middle.direction[sides[0]]), std::abs(middle.direction[sides[1]])) / std::abs(middle.direction[mainAxis_]);
  quarters_ = std::clamp(
      std::max((stretch - kLongStretch) / (kLongestStretch - kLongStretch), (slope - kObliqueSlope) / (kDiagonalSlope - kObliqueSlope)),
      0.0, 1.0);
  const double voxel = std::min(glm::length(linear_[sides[0]]), glm::length(linear_[sides[1]])) /
                       glm::length(linear_ * (rays_.orthographic ? rays_.originX : rays_.directionX));  // seen from straight in front

  double mean = 0.0, farthest = 0.0;
  for (const glm::dvec3& corner : cornersOf(glm::dvec3(0.0), glm::dvec3(volume.dimensions - 1))) {
    const double distance = (toPixel_ * (corner - middle.origin)).z;
    mean += distance / 8.0;
    farthest = std::max(farthest, distance);
  }
  const double reference = rays_.orthographic ? 1.0 : std::max(mean, kNearReference * farthest);
  const double pitch = std::clamp(voxel / (kSamplesPerVoxel * reference), kMinPitch, double(std::max(size_.x, size_.y)));
  lattice_.pitch = std::round(pitch * 1024.0) / 1024.0;  // so that the device's samples have the same positions
  adapts_ = 2.0 * lattice_.pitch * reference <= kCoarseVoxels * voxel;
  lattice_.samples = (glm::ivec2(glm::floor(glm::dvec2(size_ - 1) / lattice_.pitch)) + 4) | 1;  // odd
  lattice_.first = 0.5 - middle_ - lattice_.pitch;

  constexpr double kEverywhere = 1e9;
  seenLow_ = glm::dvec2(kEverywhere);
  seenHigh_ = glm::dvec2(-kEverywhere);
  for (const glm::dvec3& corner : cornersOf(glm::dvec3(-1.0), glm::dvec3(volume.dimensions))) {
    const glm::dvec3 pixel = toPixel_ * (corner - middle.origin);
    const bool beside = !rays_.orthographic && !(pixel.z > 1e-6);
    const glm::dvec2 position = rays_.orthographic ? glm::dvec2(pixel) : glm::dvec2(pixel) / pixel.z;
    seenLow_ = beside ? glm::dvec2(-kEverywhere) : glm::min(seenLow_, position - 1.0);
    seenHigh_ = beside ? glm::dvec2(kEverywhere) : glm::max(seenHigh_, position + 1.0);
  }
  if (classification.isPost(volume)) {
    table_.emplace(*classification.transferFunction, volume.minimum, volume.maximum);
    texels_ = table_->texels(1.0);
  }
}

ReferenceGather::Ray ReferenceGather::rayThrough(glm::dvec2 position) const {
  const glm::dvec2 pixel = middle_ + position;
  Ray ray{.origin = rays_.origin + pixel.x * rays_.originX + pixel.y * rays_.originY,
          .direction = rays_.direction + pixel.x * rays_.directionX + pixel.y * rays_.directionY,
          .worldLength = 0.0};
  ray.worldLength = glm::length(linear_ * ray.direction);
  return ray;
}

int ReferenceGather::axisOf(glm::dvec2 position, const Ray& ray) const {
  const bool seen = glm::all(glm::greaterThanEqual(position, seenLow_)) && glm::all(glm::lessThanEqual(position, seenHigh_));
  const glm::dvec3 size = glm::abs(ray.direction);
  const bool isMain = size[mainAxis_] >= kMinAlongMain * std::max({size.x, size.y, size.z});
  return !seen || isMain ? mainAxis_ : majorAxis(ray.direction);
}

/// The border between voxels at which the march enters a level: the first multiple of its blocks' edge from which on such
/// blocks are small on the image for every ray of the lattice that may meet the volume.
int ReferenceGather::firstVoxel(const Ray& ray, int axis, int level) const {
  const int voxels = volume_.dimensions[axis], sign = ray.direction[axis] > 0.0 ? 1 : -1, edge = 1 << level;
  if (level <= detail_.finest) return sign > 0 ? 0 : voxels;
  if (level > detail_.coarsest) return sign > 0 ? voxels : 0;
  double steepest = 0.0;
  const glm::dvec2 edgeOfImage = middle_ + 2.0 * lattice_.pitch;
  const glm::dvec2 seenFrom = glm::clamp(seenLow_, -edgeOfImage, edgeOfImage), seenTo = glm::clamp(seenHigh_, -edgeOfImage, edgeOfImage);
  for (const double x : {seenFrom.x, seenTo.x})
    for (const double y : {seenFrom.y, seenTo.y}) steepest = std::max(steepest, std::abs(rayThrough({x, y}).direction[axis]));
  const double border = rays_.orthographic ? (sign > 0 ? 0.0 : voxels) + sign * (1.0 - detail_.coarsestShare) * voxels
                                           : ray.origin[axis] + 0.5 + sign * edge * steepest / detail_.edgePerDistance;
  const double number = sign > 0 ? std::ceil(border / edge) : std::floor(border / edge);
  return int(std::clamp(number, 0.0, double((voxels + edge - 1) / edge))) * edge;
}

ReferenceGather::Slab ReferenceGather::slabOf(const Ray& ray, int axis, int level) const {
  Slab slab{.axis = axis, .sign = ray.direction[axis] > 0.0 ? 1 : -1, .edge = double(1 << level)};
  const int near = firstVoxel(ray, axis, level), far = firstVoxel(ray, axis, level + 1);
  if (slab.sign * (far - near) <= 0) return slab;
  const int edge = 1 << level, low = std::min(near, far) / edge, end = (std::max(near, far) + edge - 1) / edge;
  slab.first = slab.sign > 0 ? low : end - 1;
  slab.count = end - low;
  return slab;
}

/// The bilinear source term and extinction on a slice.
glm::dvec4 ReferenceGather::blockAt(const Ray& ray, const Slab& slab, int slice, const GatherBlocks& blocks) const {
  glm::dvec4 medium(0.0);
  forCorners(slab.position(ray, slice), slab.axis, slice, blocks.dimensions, [&](std::size_t, double weight, glm::ivec3 block) {
    const std::size_t i = indexOf(block, blocks.dimensions);
    medium += weight * glm::dvec4(blocks.source[i], blocks.extinction[i]);
  });
  return medium;
}

void ReferenceGather::marchBlocks(GatherSums& sums, double& transmittance, const Ray& ray, const Slab& slab,
                                  const GatherBlocks& blocks) const {
  for (int number = 0; number < slab.count; ++number) {
    const int slice = slab.slice(number);
    const double part = partOfTent(slab.ahead(ray, slice));
    if (part <= 0.0 || slice >= blocks.dimensions[slab.axis]) continue;
    const glm::dvec4 medium = blockAt(ray, slab, slice, blocks);
    addPart(sums, transmittance, medium, part * slab.layer(ray), slab.distance(ray, slice));
  }
}

std::optional<double> ReferenceGather::scalarOf(glm::ivec3 voxel) const {
  const int code = table_->code(volume_.scalars.at(voxel));
  if (code == 0) return {};
  return double(code - 1) * shader::kTransferIntervals / shader::kScalarCodes;
}

/// The scalar between the four voxels around a ray's point on a slice, and their share that has data.
ReferenceGather::Scalar ReferenceGather::scalarAt(const Ray& ray, const Slab& slab, int slice) const {
  Scalar scalar;
  forCorners(slab.position(ray, slice), slab.axis, slice, volume_.dimensions, [&](std::size_t, double weight, glm::ivec3 voxel) {
    const std::optional<double> found = scalarOf(voxel);
    if (!found) return;
    scalar.coverage += weight;
    scalar.value += weight * *found;
  });
  if (scalar.coverage > 0.0) scalar.value /= scalar.coverage;
  return scalar;
}

glm::dvec4 ReferenceGather::mediumAt(double scalar) const {
  return texels_[2 * std::size_t(std::clamp(int(scalar), 0, shader::kTransferIntervals - 1)) + 1];
}

glm::dvec4 ReferenceGather::integralUpTo(double scalar) const {
  const int interval = std::clamp(int(scalar), 0, shader::kTransferIntervals - 1);
  return glm::dvec4(texels_[2 * std::size_t(interval)]) + (scalar - interval) * mediumAt(scalar);
}

glm::dvec4 ReferenceGather::meanBetween(double from, double to) const {
  if (std::abs(to - from) <= kMinChange) return 0.5 * (mediumAt(from) + mediumAt(to));
  return (integralUpTo(to) - integralUpTo(from)) / (to - from);
}

/// The scalar at a fraction of the way from a slice to the next one, `slice`, between all eight voxels around, and their share that has
/// data.
ReferenceGather::Scalar ReferenceGather::scalarBetween(const Ray& ray, const Slab& slab, int number, double fraction) const {
  Scalar between;
  const int slice = slab.slice(number);
  for (int end = 0; end < 2; ++end) {
    if (end == 1 && number == slab.count) continue;
    const int there = slice - (1 - end) * slab.sign;
    if (there < 0 || there >= volume_.dimensions[slab.axis]) continue;
    const double share = end == 0 ? 1.0 - fraction : fraction;
    forCorners(slab.position(ray, slice - (1.0 - fraction) * slab.sign), slab.axis, there, volume_.dimensions,
               [&](std::size_t, double weight, glm::ivec3 voxel) {
                 const std::optional<double> scalar = scalarOf(voxel);
                 if (!scalar) return;
                 between.coverage += share * weight;
                 between.value += share * weight * *scalar;
               });
  }
  if (between.coverage > 0.0) between.value /= between.coverage;
  return between;
}

/// The stretch that ends at a slice. Beyond the level's last slice there is no data.
ReferenceGather::ScalarStretch ReferenceGather::scalarStretch(const Ray& ray, const Slab& slab, int number, const Scalar& last) const {
  ScalarStretch stretch{.slice = slab.slice(number), .begin = last};
  if (number < slab.count) stretch.end = scalarAt(ray, slab, stretch.slice);
  stretch.middle = scalarBetween(ray, slab, number, 0.5);
  if (stretch.middle.coverage == 0.0) stretch.middle.value = stretch.first().value;
  const std::array<double, 3> ends{stretch.first().value, stretch.middle.value, stretch.second().value};
  for (std::size_t half = 0; half < 2; ++half) {
    stretch.means[half] = meanBetween(ends[half], ends[half + 1]);
    const Scalar quarter = quarters_ > 0.0 ? scalarBetween(ray, slab, number, 0.25 + 0.5 * double(half)) : Scalar();
    if (quarter.coverage > 0.0)
      stretch.means[half] = glm::mix(
          stretch.means[half], 0.5 * (meanBetween(ends[half], quarter.value) + meanBetween(quarter.value, ends[half + 1])), quarters_);
  }
  const double ahead = slab.ahead(ray, stretch.slice);
  stretch.coverages = {glm::mix(stretch.middle.coverage, stretch.begin.coverage, std::clamp(ahead - 0.5, 0.0, 0.5)),
                       glm::mix(stretch.end.coverage, stretch.middle.coverage, std::clamp(ahead, 0.0, 0.5))};
  return stretch;
}

/// Marches from slice to slice in two halves: the scalar is linear up to the middle, and from there on. Extinction falls with the share of
/// voxels with data, which is linear in both halves.
void ReferenceGather::marchScalars(GatherSums& sums, double& transmittance, const Ray& ray, const Slab& slab) const {
  Scalar last;
  for (int number = 0; number <= slab.count; ++number) {
    const ScalarStretch stretch = scalarStretch(ray, slab, number, last);
    for (std::size_t half = 0; half < 2; ++half) {
      const double inFront = std::clamp(slab.ahead(ray, stretch.slice) - (half == 0 ? 0.5 : 0.0), 0.0, 0.5);  // of the half, in slices
      const double length = inFront * slab.layer(ray) * stretch.coverages[half];
      addPart(sums, transmittance, stretch.means[half], length,
              slab.distance(ray, stretch.slice + slab.sign * (half == 0 ? -0.75 : -0.25)));
    }
    last = stretch.end;
  }
}

GatherSums ReferenceGather::sumsAt(glm::dvec2 position, std::span<const GatherBlocks> blocks) const {
  const Ray ray = rayThrough(position);
  const int axis = axisOf(position, ray);
  GatherSums sums;
  double transmittance = 1.0;
  for (int level = detail_.finest; level <= detail_.coarsest; ++level) {
    const Slab slab = slabOf(ray, axis, level);
    if (level == 0 && hasScalars())
      marchScalars(sums, transmittance, ray, slab);
    else
      marchBlocks(sums, transmittance, ray, slab, blocks[std::size_t(level)]);
  }
  sums.energy = 1.0 - transmittance;
  return sums;
}

std::vector<GatherSums> ReferenceGather::samples(std::span<const GatherBlocks> blocks) const {
  std::vector<GatherSums> result(std::size_t(lattice_.samples.x) * std::size_t(lattice_.samples.y));
  tbb::parallel_for(0, lattice_.samples.y, [&](int y) {
    for (int x = 0; x < lattice_.samples.x; ++x)
      result[std::size_t(x) + std::size_t(lattice_.samples.x) * std::size_t(y)] = sumsAt(positionOf({x, y}), blocks);
  });
  return result;
}

}  // namespace freevoxels
