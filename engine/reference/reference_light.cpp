#include "engine/reference/reference_light.h"

#include <algorithm>
#include <cmath>

#include "engine/reference/reference_rays.h"

namespace freevoxels {

namespace {

/// In index space: at a smaller distance from a light the direction is undefined, and +z is used.
constexpr double kAtLight = 1e-3;

/// The integral of exp(-x t) over t from 0 to 1.
double meanOver(double x) {
  return std::abs(x) < 1e-9 ? 1.0 : -std::expm1(-x) / x;
}

}  // namespace

ReferenceLight::ReferenceLight(const LightInputs& inputs, const FrameSettings& settings)
    : inputs_(inputs), lighting_(*settings.lighting), toWorld_(inputs.volume.indexToWorld) {
  const AttenuationLookup lookup = settings.tableLookup();
  for (const Light& light : lighting_.lights) {
    const RaySource source = lightSource(light, inputs_.volume.indexToWorld);
    sources_.push_back(source);
    if (lightAttenuationFor(settings) == LightAttenuation::Exact) {
      depths_.push_back(
          rayDepth(inputs_.volume, source, referenceRays(inputs_.volume, inputs_.extinction, source)));
      continue;
    }
    depths_.push_back(tableDepth(
        inputs_.volume, inputs_.extinction, inputs_.table, inputs_.coarser, inputs_.tableSettings, lookup,
        [this, source](glm::dvec3 position) { return toLight(source, position); },
        isInside(source, inputs_.volume.dimensions) ? std::optional(source.place) : std::nullopt,
        inputs_.emission));
  }
}

glm::dvec3 ReferenceLight::toLight(const RaySource& source, glm::dvec3 position) const {
  if (source.atInfinity) return source.place;
  const glm::dvec3 way = source.place - position;
  return glm::length(way) < kAtLight ? glm::dvec3(0.0, 0.0, 1.0) : way;
}

glm::dvec3 ReferenceLight::lightReaching(const Block& block, glm::dvec3 toEye, glm::dvec3 direction, double depth, double unsaturated,
                                         double counted) const {
  const double sigma = extinctionOf(block, inputs_.volume, inputs_.extinction, inputs_.coarser);
  const auto layersOf = [&](glm::dvec3 way) {
    return boxOf(block, inputs_.volume.dimensions).extent[majorAxis(way)];
  };
  const auto own = [&](glm::dvec3 way) {
    return sigma * layersOf(way) * glm::length(toWorld_ * (way / std::abs(way[majorAxis(way)])));
  };
  const double inFront = std::max(depth - 0.5 * (layersOf(direction) - 1) * unsaturated * sigma * counted, 0.0);
  const double e = own(toEye);
  const double cosine = glm::dot(glm::normalize(toWorld_ * toEye), glm::normalize(toWorld_ * direction));
  const bool isUnknown = unsaturated == 0.0 || depth >= 0.9999 * kOpaqueDepth;
  if ((lighting_.isTinted() || inputs_.deltaScale != glm::dvec3(1.0)) && isUnknown) return glm::dvec3(0.0);
  glm::dvec3 part;
  for (int c = 0; c < 3; ++c) {
    // The integral of exp(-e t) times exp(-l t), or where the light comes from the other side exp(-l (1 -
    // t)), over t from 0 to 1.
    const double tint = lighting_.tint[c] * inputs_.deltaScale[c], l = tint * own(direction);
    const double sameSide = meanOver(e + l);
    const double otherSide = std::exp(-std::min(e, l)) * meanOver(std::abs(e - l));
    part[c] = std::exp(-tint * inFront) *
              (0.5 * (1.0 + cosine) * sameSide + 0.5 * (1.0 - cosine) * otherSide) / meanOver(e);
  }
  return part;
}

glm::dvec3 ReferenceLight::extinctionGradient(const Block& block) const {
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    Block before = block, after = block;
    before.cell[axis] -= 1;
    after.cell[axis] += 1;
    gradient[axis] = (extinctionOf(after, inputs_.volume, inputs_.extinction, inputs_.coarser) -
                      extinctionOf(before, inputs_.volume, inputs_.extinction, inputs_.coarser)) /
                     2.0;
  }
  return gradient;
}

glm::dvec3 ReferenceLight::normalGradient(const Block& block, const glm::dvec3& ofExtinction) const {
  if (block.level != 0 || inputs_.scalars == nullptr) return ofExtinction;
  const auto codeOf = [&](glm::ivec3 voxel) { return int(inputs_.scalars->code(inputs_.volume.scalars.at(voxel))); };
  const int own = codeOf(block.cell);
  if (own == 0) return ofExtinction;
  glm::dvec3 gradient(0.0);
  for (int axis = 0; axis < 3; ++axis)
    for (const int way : {-1, 1}) {
      glm::ivec3 next = block.cell;
      next[axis] += way;
      const bool isInside = next[axis] >= 0 && next[axis] < inputs_.volume.dimensions[axis];
      const int code = isInside ? codeOf(next) : 0;
      gradient[axis] += way * (code == 0 ? own : code);
    }
  return gradient == glm::dvec3(0.0) ? ofExtinction : gradient;
}

glm::dvec3 ReferenceLight::scattered(const Block& block, glm::dvec3 toEye) const {
  const glm::dvec3 centre = boxOf(block, inputs_.volume.dimensions).centre();
  const glm::dvec3 after = glm::normalize(toWorld_ * toEye);
  const double edge = inputs_.volume.voxelSize() * block.edge();
  const glm::dvec3 gradient = lighting_.surface > 0.0 ? extinctionGradient(block) : glm::dvec3(0.0);
  glm::dvec3 normal(0.0), sum(0.0);
  double surface = 0.0;
  if (gradient != glm::dvec3(0.0)) {
    const double sigma = extinctionOf(block, inputs_.volume, inputs_.extinction, inputs_.coarser);
    normal = glm::normalize(glm::inverse(glm::transpose(toWorld_)) * normalGradient(block, gradient));
    surface =
        lighting_.surface * surfaceShare(glm::length(gradient) / sigma);  // infinite if sigma is 0
  }
  for (std::size_t i = 0; i < sources_.size(); ++i) {
    const Light& light = lighting_.lights[i];
    const glm::dvec3 way = toLight(sources_[i], centre);
    const glm::dvec3 across = way / std::abs(way[majorAxis(way)]);
    const ReferenceDepth& depth = *depths_[i];
    const double counted = depth.countedLength(glm::length(toWorld_ * across));
    const glm::dvec3 before = -glm::normalize(toWorld_ * way);
    const glm::dvec3 apart = toWorld_ * (sources_[i].place - centre);
    const double distance2 = std::max(glm::dot(apart, apart), kNearestLight2 * edge * edge);
    const double irradiance = light.intensity / (light.atInfinity ? 1.0 : distance2);
    double phase = (1.0 - surface) * phaseFunction(lighting_.phaseG, glm::dot(before, after));
    if (surface > 0.0) phase += surface * surfaceScattering(normal, -before, after);
    sum += light.color * (irradiance * phase) * lightReaching(block, toEye, way, depth.at(block), depth.unsaturated(block), counted);
  }
  if (inputs_.scattered != nullptr) sum += inputs_.scattered->at(centre, after);
  return sum;
}

}  // namespace freevoxels
