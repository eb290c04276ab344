// The part of ReferenceGather that lights samples.

#include <algorithm>
#include <cmath>

#include "engine/reference/reference_depth.h"
#include "engine/reference/reference_gather_ray.h"
#include "engine/reference/reference_light.h"
#include "engine/reference/reference_rays.h"
#include "shaders/gather_interface.h"

namespace freevoxels {

namespace {

/// Least share of a pixel's alpha for which light is computed along the scalar's gradient, and for which a surface has a normal: for
/// blocks, and for scalars, of whose stretches each has two halves.
constexpr double kMinShown = 1.0 / 512.0;
/// Share of reflected light from which on the rest is computed coarsely.
constexpr double kMostlySurface = 0.95;
/// Blocks from a surface at which the light that reaches it is looked up.
constexpr double kOutside = 2.5;
/// Depths from this one on may be larger than they are stored.
constexpr double kUnknownDepth = 0.99 * kOpaqueDepth;

}  // namespace

std::vector<double> referenceLightDepths(const Volume& volume, std::span<const double> extinction, const LevelData& medium, int level,
                                         const Light& light) {
  const RaySource source = lightSource(light, volume.indexToWorld);
  const auto depths = rayDepth(volume, source, referenceRays(volume, extinction, source));
  std::vector<double> result;
  glm::ivec3 cell;
  for (cell.z = 0; cell.z < medium.dimensions.z; ++cell.z)
    for (cell.y = 0; cell.y < medium.dimensions.y; ++cell.y)
      for (cell.x = 0; cell.x < medium.dimensions.x; ++cell.x) {
        const Block block{level, cell};
        const glm::dvec3 way = source.atInfinity ? source.place : source.place - boxOf(block, volume.dimensions).centre();
        const double layer = glm::length(glm::dmat3(volume.indexToWorld) * (way / std::abs(way[majorAxis(way)])));
        // Rays have what is in front of a layer.
        result.push_back(depths->at(block) + 0.5 * layer * medium.extinction[medium.at(cell)]);
      }
  return result;
}

std::vector<glm::dvec3> referenceGradients(std::span<const double> values, glm::ivec3 dimensions, bool continued) {
  std::vector<glm::dvec3> gradients;
  glm::ivec3 block;
  for (block.z = 0; block.z < dimensions.z; ++block.z)
    for (block.y = 0; block.y < dimensions.y; ++block.y)
      for (block.x = 0; block.x < dimensions.x; ++block.x) {
        const double outside = continued ? values[indexOf(block, dimensions)] : 0.0;
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 27; ++i) {
          const glm::ivec3 offset = glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1, next = block + offset;
          const bool within = glm::all(glm::greaterThanEqual(next, glm::ivec3(0))) && glm::all(glm::lessThan(next, dimensions));
          const double value = within ? values[indexOf(next, dimensions)] : outside;
          const glm::dvec3 smoothing = 2.0 - glm::abs(glm::dvec3(offset));  // 1 2 1 across the derivative's axis
          for (int axis = 0; axis < 3; ++axis)
            sum[axis] += value * offset[axis] * smoothing[(axis + 1) % 3] * smoothing[(axis + 2) % 3];
        }
        gradients.push_back(sum / 32.0);
      }
  return gradients;
}

std::vector<double> ReferenceGather::scalars() const {
  std::vector<double> result;
  for (std::size_t i = 0; i < volume_.voxelCount(); ++i) {
    const glm::ivec3 n = volume_.dimensions;
    const glm::ivec3 voxel(int(i) % n.x, int(i) / n.x % n.y, int(i) / n.x / n.y);
    result.push_back(scalarOf(voxel).value());
  }
  return result;
}

glm::ivec3 ReferenceGather::dimensionsOf(const Slab& slab) const {
  const int edge = int(slab.edge);
  return (volume_.dimensions + edge - 1) / edge;
}

/// Whether light arrives at the first or the last border of an axis from beyond it.
bool ReferenceGather::isLitBorder(std::size_t light, int axis, bool first) const {
  const RaySource& source = lights_[light];
  const double toLight = source.place[axis] - (source.atInfinity || first ? 0.0 : volume_.dimensions[axis] - 1.0);
  return first ? toLight < 0.0 : toLight > 0.0;
}

/// Interpolates the codes, which are the roots of depths, with 0 beyond the volume.
ReferenceGather::Arriving ReferenceGather::storedAt(const GatherLight& light, const Slab& slab, glm::dvec2 position, int slice) const {
  Arriving roots;
  const glm::ivec3 dimensions = dimensionsOf(slab);
  forCorners(position, slab.axis, slice, dimensions, [&](std::size_t, double weight, glm::ivec3 block) {
    const std::size_t i = indexOf(block, dimensions);
    for (std::size_t l = 0; l < light.depths.size(); ++l) roots.depths[l] += weight * std::sqrt(light.depths[l][i]);
  });
  for (double& root : roots.depths) root *= root;
  return roots;
}

/// What reaches a ray on a slice, up to a block beyond the volume's sides: towards a light on that side nothing is in between at the end,
/// behind the volume it is as much as at the border.
ReferenceGather::Arriving ReferenceGather::arrivingAt(const GatherLight& light, const Ray& ray, const Slab& slab, int slice) const {
  const glm::dvec2 position = slab.position(ray, slice);
  const glm::dvec2 last = onSides(glm::dvec3(dimensionsOf(slab) - 1), slab.axis);
  Arriving arriving = storedAt(light, slab, position, slice);
  for (int side = 0; side < 2; ++side) {
    const bool first = position[side] < 0.0;
    const double within = 1.0 - (first ? -position[side] : position[side] - last[side]);
    if (within >= 1.0 || within <= 0.0) continue;
    for (std::size_t l = 0; l < lights_.size(); ++l)
      if (!isLitBorder(l, sidesOf(slab.axis)[std::size_t(side)], first)) arriving.depths[l] /= within * within;
  }
  return arriving;
}

/// What reaches a slice beyond the volume's first or last one, from what reaches the volume there.
void ReferenceGather::setBeyond(Arriving& beyond, const Arriving& within, const Slab& slab, int slice) const {
  for (std::size_t l = 0; l < lights_.size(); ++l)
    beyond.depths[l] = isLitBorder(l, slab.axis, slice < 0) ? 0.0 : within.depths[l];
}

/// The scalar between the eight voxels around a position, and their share that has data.
std::pair<double, double> ReferenceGather::scalarNear(glm::dvec3 position) const {
  const glm::dvec3 low = glm::floor(position);
  double sum = 0.0, coverage = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const glm::ivec3 voxel = glm::ivec3(low) + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
    if (glm::any(glm::lessThan(voxel, glm::ivec3(0))) || glm::any(glm::greaterThanEqual(voxel, volume_.dimensions))) continue;
    const std::optional<double> scalar = scalarOf(voxel);
    if (!scalar) continue;
    const glm::dvec3 shares = 1.0 - glm::abs(position - glm::dvec3(voxel));
    const double weight = shares.x * shares.y * shares.z;
    coverage += weight;
    sum += weight * *scalar;
  }
  return {coverage > 0.0 ? sum / coverage : 0.0, coverage};
}

/// Depths of scalars are known from the next layer towards a light; adds that up to there.
void ReferenceGather::addLayerTowards(Arriving& arriving, const Scalar& scalar, glm::dvec3 position, bool shows) const {
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const glm::dvec3 way = lights_[l].atInfinity ? lights_[l].place : lights_[l].place - position;
    const glm::dvec3 across = way / std::max(std::abs(way[majorAxis(way)]), 1e-6);
    const double layer = glm::length(linear_ * across);
    if (!shows) {
      arriving.depths[l] += layer * scalar.coverage * mediumAt(scalar.value).a;
      continue;
    }
    const auto [next, coverage] = scalarNear(position + across);
    const double mean = scalar.coverage == 0.0 ? mediumAt(next).a
                        : coverage == 0.0      ? mediumAt(scalar.value).a
                                               : meanBetween(scalar.value, next).a;
    arriving.depths[l] += layer * 0.5 * (scalar.coverage + coverage) * mean;
  }
}

glm::dvec3 ReferenceGather::gradientAt(const GatherLight& light, const Ray& ray, const Slab& slab, int slice) const {
  const glm::ivec3 dimensions = dimensionsOf(slab);
  const int within = std::clamp(slice, 0, dimensions[slab.axis] - 1);
  glm::dvec3 gradient(0.0);
  const glm::dvec2 position = glm::clamp(slab.position(ray, within), glm::dvec2(0.0), onSides(glm::dvec3(dimensions - 1), slab.axis));
  forCorners(position, slab.axis, within, dimensions,
             [&](std::size_t, double weight, glm::ivec3 block) { gradient += weight * light.gradients[indexOf(block, dimensions)]; });
  return gradient;
}

/// `decrease` is the relative decrease of the extinction along the gradient.
void ReferenceGather::setSurface(Stretch& stretch, glm::dvec3 gradient, double decrease) const {
  const glm::dvec3 downwards = decrease < 0.0 ? -gradient : decrease > 0.0 ? gradient : glm::dvec3(0.0);
  const glm::dvec3 normal = glm::transpose(glm::inverse(linear_)) * downwards;
  stretch.normal = glm::length(normal) > 1e-15 ? glm::normalize(normal) : glm::dvec3(0.0);
  stretch.surface = lighting_->surface * std::min(2.0 * std::abs(decrease), 1.0);
}

/// Lights surfaces from a point that is outside of them.
void ReferenceGather::lightFromOutside(std::span<Stretch> stretches, const GatherLight& light, const Ray& ray, const Slab& slab,
                                       double slice, glm::dvec3 outwards) const {
  const glm::dvec2 slope = glm::abs(slab.position(ray, 1.0) - slab.position(ray, 0.0));
  const double distance = kOutside - 0.5 * std::max(std::max(slope.x, slope.y) - 1.0, 0.0);
  const glm::dvec3 offset = glm::length(outwards) > 1e-15 ? distance * glm::normalize(outwards) : glm::dvec3(0.0);
  const int at = std::clamp(int(std::floor(slice + offset[slab.axis] + 0.5)), 0, dimensionsOf(slab)[slab.axis] - 1);
  const Arriving outside = storedAt(light, slab, slab.position(ray, slice) + onSides(offset, slab.axis), at);
  for (Stretch& stretch : stretches) {
    stretch.outside = outside.depths;
    stretch.scatteredOffset = stretch.surface * slab.edge * offset;
  }
}

/// The radiance that a stretch sends to the eye for a source term of 1 per unit of its length. `depth` is its depth for light, by colour.
glm::dvec3 ReferenceGather::leaving(const Stretch& stretch, glm::dvec3 depth, glm::dvec3 toEye) const {
  glm::dvec3 sum(0.0);
  if (scattered_) {
    sum = scattered_->at(stretch.position + stretch.scatteredOffset, toEye);
    for (int c = 0; c < 3; ++c) sum[c] *= meanTransmittance(depth[c]);
  }
  const glm::dvec3 tints = lighting_->tint * deltaScale_;
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    const Light& light = lighting_->lights[l];
    const glm::dvec3 apart = light.atInfinity ? light.place : linear_ * (lights_[l].place - stretch.position);
    const double nearest2 = kNearestLight2 * volume_.voxelSize() * volume_.voxelSize();
    const double distance2 = light.atInfinity ? 1.0 : std::max(glm::dot(apart, apart), nearest2);
    const glm::dvec3 toLight = apart / std::max(glm::length(apart), 1e-15);
    const double begin = stretch.begin.depths[l], change = stretch.end.depths[l] - begin;
    if ((lighting_->isTinted() || forward_ > 0.0) && begin + std::max(change, 0.0) >= kUnknownDepth) continue;
    const bool facing = glm::dot(stretch.normal, toLight) > 0.0;
    for (int c = 0; c < 3; ++c) {
      double reaching = (1.0 - stretch.surface) * phaseFunction(lighting_->phaseG, -glm::dot(toLight, toEye)) *
                        std::exp(-tints[c] * begin) * meanTransmittance(depth[c] + tints[c] * change);
      if (stretch.surface > 0.0) {
        const double through = facing ? 0.5 * std::exp(-tints[c] * stretch.outside[l]) * meanTransmittance(depth[c])
                                      : std::exp(-tints[c] * begin) * meanTransmittance(depth[c] + tints[c] * change);
        reaching += stretch.surface * surfaceScattering(stretch.normal, toLight, toEye) * through;
      }
      sum[c] += light.intensity * light.color[c] / distance2 * reaching;
    }
  }
  return sum;
}

void ReferenceGather::addLit(GatherSums& sums, Transmittance& before, glm::dvec4 medium, double length, double distance,
                             const Stretch& stretch, const Ray& ray) const {
  const double depth = medium.a * length;
  const glm::dvec3 ofLight = depth - forward_ * length * glm::dvec3(medium);
  const glm::dvec3 toEye = -glm::normalize(linear_ * ray.direction);
  if (length > 0.0) sums.color += before.light * length * (leaving(stretch, ofLight, toEye) * glm::dvec3(medium) + stretch.emission);
  sums.distance += before.alpha * -std::expm1(-depth) * std::max(distance, 0.0);
  before.alpha *= std::exp(-depth);
  before.light *= glm::exp(-ofLight);
}

/// From slice to slice: source term and extinction are the means of both, depths change linearly. The halves emit what their slices do.
void ReferenceGather::marchLitBlocks(GatherSums& sums, Transmittance& transmittance, const Ray& ray, const Slab& slab,
                                     const GatherBlocks& blocks, const GatherLight& light) const {
  const int end = dimensionsOf(slab)[slab.axis];
  glm::dvec4 lastMedium(0.0);
  glm::dvec3 lastEmission(0.0);
  Arriving last;
  for (int number = 0; number <= slab.count; ++number) {
    const int slice = slab.slice(number), before = slice - slab.sign;
    const bool within = number < slab.count;
    const glm::dvec4 medium = within ? blockAt(ray, slab, slice, blocks) : glm::dvec4(0.0), mean = 0.5 * (lastMedium + medium);
    const glm::dvec3 emission = within ? emissionAt(ray, slab, slice, blocks) : glm::dvec3(0.0);
    const Arriving found = within ? arrivingAt(light, ray, slab, slice) : last;
    Stretch stretch{.begin = last, .end = found};
    if (number == 0) {
      stretch.begin = found;
      for (double& depth : stretch.begin.depths) depth = std::max(depth - slab.layer(ray) * mean.a, 0.0);
    }
    if (before < 0 || before >= end) setBeyond(stretch.begin, found, slab, before);
    if (slice < 0 || slice >= end) setBeyond(stretch.end, last, slab, slice);
    stretch.position = ray.origin + slab.distance(ray, slice - 0.5 * slab.sign) * ray.direction;
    if (lighting_->surface > 0.0 && transmittance.alpha * slab.layer(ray) * mean.a > kMinShown) {
      const glm::dvec3 gradient = 0.5 * (gradientAt(light, ray, slab, before) + gradientAt(light, ray, slab, slice));
      const double reach = glm::length(gradient);
      setSurface(stretch, gradient, -std::min(2.0 * reach / std::max(mean.a + reach, 1e-20), 1.0));
      lightFromOutside({&stretch, 1}, light, ray, slab, slice - 0.5 * slab.sign, -gradient);
    }
    const double length = std::clamp(slab.ahead(ray, slice), 0.0, 1.0) * slab.layer(ray);
    const double near = 0.5 * length * lastMedium.a, far = 0.5 * length * medium.a;
    stretch.emission = 0.5 * (meanTransmittance(near) * lastEmission + std::exp(-near) * meanTransmittance(far) * emission);
    addLit(sums, transmittance, mean, length, slab.distance(ray, slice - 0.5 * slab.sign), stretch, ray);
    lastMedium = medium;
    lastEmission = emission;
    last = found;
  }
}

/// Lights the halves of a stretch as surfaces, whose normals are the scalar's gradients. `first` and `second` are the scalars at its ends.
void ReferenceGather::lightSurfaces(std::array<Stretch, 2>& halves, const GatherLight& light, const Ray& ray, const Slab& slab, int slice,
                                    double first, double second) const {
  const glm::dvec3 a = gradientAt(light, ray, slab, slice - slab.sign), b = gradientAt(light, ray, slab, slice);
  glm::dvec3 gradients(0.0);
  double changes = 0.0;
  for (std::size_t i = 0; i < 2; ++i) {
    const double part = i == 0 ? 0.25 : 0.75;
    const glm::dvec3 gradient = glm::mix(a, b, part);
    const double scalar = glm::mix(first, second, part), reach = glm::length(gradient);
    const double above = mediumAt(std::min(scalar + reach, double(shader::kTransferIntervals))).a;
    const double below = mediumAt(std::max(scalar - reach, 0.0)).a;
    const double change = (above - below) / std::max({above, below, 1e-20});
    setSurface(halves[i], gradient, -change);
    gradients += gradient;
    changes += change;
  }
  const glm::dvec3 outwards = changes > 0.0 ? -gradients : changes < 0.0 ? gradients : glm::dvec3(0.0);
  lightFromOutside(halves, light, ray, slab, slice - 0.5 * slab.sign, outwards);
}

/// What reaches the two halves of a stretch between slices of scalars. `lastArriving` is what reached the end of the stretch before, if
/// that had a medium, and is set to that of this one.
std::array<ReferenceGather::Stretch, 2> ReferenceGather::lightStretch(const GatherLight& light, const Ray& ray, const Slab& slab,
                                                                      const ScalarStretch& scalars, double transmittance,
                                                                      std::optional<Arriving>& lastArriving) const {
  const int slice = scalars.slice, before = slice - slab.sign, end = volume_.dimensions[slab.axis];
  const Scalar &last = scalars.begin, &found = scalars.end;
  const auto place = [&](double at) { return ray.origin + slab.distance(ray, at) * ray.direction; };
  const Arriving atLast = arrivingAt(light, ray, slab, before), atFound = arrivingAt(light, ray, slab, std::clamp(slice, 0, end - 1));
  const double sum = scalars.means[0].a + scalars.means[1].a, share = sum > 0.0 ? scalars.means[0].a / sum : 0.5;
  const double shown = transmittance * slab.layer(ray) *
                       (scalars.coverages[0] * scalars.means[0].a + scalars.coverages[1] * scalars.means[1].a);

  std::array<Stretch, 2> halves;
  for (Stretch& half : halves) half.position = place(slice - 0.5 * slab.sign);
  if (lighting_->surface > 0.0 && shown > 2.0 * kMinShown) lightSurfaces(halves, light, ray, slab, slice, scalars.first().value, scalars.second().value);
  if (sum <= 0.0 || last.coverage + scalars.middle.coverage + found.coverage == 0.0) {
    lastArriving.reset();
    return halves;
  }
  const bool shows = shown > kMinShown && std::min(halves[0].surface, halves[1].surface) < kMostlySurface;
  const auto upTo = [&](const Arriving& stored, const Scalar& scalar, int at) {
    Arriving arriving = stored;
    addLayerTowards(arriving, scalar, place(at), shows);
    return arriving;
  };
  const bool enters = before < 0 || before >= end, leaves = slice < 0 || slice >= end;
  if (!lastArriving) lastArriving = upTo(atLast, last, before);
  Arriving foundArriving = leaves ? *lastArriving : upTo(atFound, found, slice);
  if (leaves) setBeyond(foundArriving, *lastArriving, slab, slice);
  if (enters) setBeyond(*lastArriving, foundArriving, slab, before);
  for (std::size_t l = 0; l < lights_.size(); ++l) {
    halves[0].begin.depths[l] = lastArriving->depths[l];
    halves[0].end.depths[l] = halves[1].begin.depths[l] = glm::mix(lastArriving->depths[l], foundArriving.depths[l], share);
    halves[1].end.depths[l] = foundArriving.depths[l];
  }
  lastArriving = foundArriving;
  return halves;
}

}  // namespace freevoxels
