#include "engine/reference/light_march.h"

#include <limits>

#include "engine/reference/ray_march.h"
#include "engine/reference/reference_scattering.h"

namespace freevoxels {

namespace {

constexpr double kTolerance = 1e-4;  // of the light of all orders

}  // namespace

LightMarch::LightMarch(const ReferenceField& field, const Volume& volume, const Classification& classification, const Lighting& lighting,
                       const Progress& progress)
    : field_(field), toWorld_(volume.indexToWorld), lighting_(lighting) {
  for (const Light& light : lighting.lights) sources_.push_back(lightSource(light, volume.indexToWorld));
  const ScatteringMedium medium(volume, classification);
  deltaScale_ = deltaScaleOf(lighting, medium);
  if (lighting.hasIndirectLight() || medium.emits()) scattered_ = referenceScattering(medium, lighting, kTolerance, progress);
}

glm::dvec3 LightMarch::transmittance(glm::dvec3 position, glm::dvec3 direction, double end) const {
  const MarchedRay ray{
      .origin = position, .direction = direction, .worldLength = glm::length(toWorld_ * direction)};
  return glm::exp(-marchDepth(field_, ray, end) * lighting_.tint * deltaScale_);
}

glm::dvec3 LightMarch::scatteredFrom(std::size_t i, glm::dvec3 position, glm::dvec3 toEye) const {
  const Light& light = lighting_.lights[i];
  const RaySource& source = sources_[i];
  const glm::dvec3 way = source.atInfinity ? source.place : source.place - position;
  const glm::dvec3 worldWay = toWorld_ * way;
  const double length = glm::length(worldWay);
  if (!(length > 0.0)) return glm::dvec3(0.0);
  const double end = source.atInfinity ? std::numeric_limits<double>::infinity() : 1.0;
  const double irradiance = light.intensity / (source.atInfinity ? 1.0 : length * length);
  return light.color * irradiance * phaseFunction(lighting_.phaseG, glm::dot(-worldWay / length, toEye)) *
         transmittance(position, way, end);
}

glm::dvec3 LightMarch::scattered(glm::dvec3 position, glm::dvec3 toEye) const {
  glm::dvec3 sum(0.0);
  for (std::size_t i = 0; i < sources_.size(); ++i) sum += scatteredFrom(i, position, toEye);
  if (scattered_) sum += scattered_->at(position, toEye);
  return sum;
}

}  // namespace freevoxels
