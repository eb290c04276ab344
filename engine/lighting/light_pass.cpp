#include "engine/lighting/light_pass.h"

#include <algorithm>
#include <span>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

static_assert(shader::kHighlight == float(kHighlight));
static_assert(shader::kHighlightExponent == float(kHighlightExponent));

shader::Light deviceLight(const Light& light, const RaySource& source, glm::dvec3 middle) {
  const glm::dvec3 size = glm::abs(source.place);
  return {
      .place = light.atInfinity ? source.place / std::max({size.x, size.y, size.z}) : source.place - middle,
      .atInfinity = light.atInfinity ? 1 : 0,
      .color = light.intensity * light.color,
      .beyond = {0, 0}};
}

RayMemory rayMemory(glm::ivec3 dimensions, std::span<const RaySource> sources) {
  RayMemory memory;
  for (const RaySource& source : sources) {
    memory.bytes += rayBytes(dimensions, source);
    memory.largest = std::max(memory.largest, rayBytes(dimensions, source));
  }
  return memory;
}

void checkRaysFit(const Device& device, const RayMemory& rays) {
  const std::uint64_t memory = device.availableBytes();
  const std::uint64_t piece = std::min(std::uint64_t(device.maximumAllocation()), memory);
  if (rays.bytes > memory || rays.largest > piece)
    fail(ErrorKind::OutOfMemory,
         "exact shadows of these lights need {} MiB for their rays, {} MiB in one piece, and {} has {} and "
         "{} MiB: "
         "use {}, fewer lights or a smaller volume",
         rays.bytes >> 20, rays.largest >> 20, device.description().name, memory >> 20, piece >> 20,
         Parameter("light-attenuation", "table"));
}

std::vector<RaySource> sourcesOf(const Lighting& lighting, const DeviceVolume& volume) {
  std::vector<RaySource> sources;
  for (const Light& light : lighting.lights) sources.push_back(lightSource(light, volume.indexToWorld));
  return sources;
}

}  // namespace

RayMemory lightRayMemory(const DeviceVolume& volume, const Lighting& lighting) {
  return rayMemory(volume.layout.dimensions, sourcesOf(lighting, volume));
}

void LightPass::setBeyond(Commands& commands, const DeviceVolume& volume, DirectionSet set,
                          const Lighting& lighting, std::vector<shader::Light>& lights) {
  int slot = 0;
  beyondDepths_ = Buffer(device_, std::max<VkDeviceSize>(lights.size(), 1) * kEyeDepthsBytes,
                         MemoryUse::Device, "depths beyond lights");
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const RaySource source = lightSource(lighting.lights[i], volume.indexToWorld);
    if (!isInside(source, volume.layout.dimensions)) continue;
    beyond_.record(commands, volume, set, source, beyondDepths_, slot);
    lights[i].beyond = addressWords(beyondDepths_.address() + VkDeviceSize(slot++) * kEyeDepthsBytes);
  }
}

void LightPass::setRays(Commands& commands, const DeviceVolume& volume, const Lighting& lighting, bool scalars, const OccupiedCells* cells,
                        std::vector<shader::Light>& lights) {
  const std::vector<RaySource> sources = sourcesOf(lighting, volume);
  checkRaysFit(device_, rayMemory(volume.layout.dimensions, sources));
  for (std::size_t i = 0; i < lights.size(); ++i) {
    RaySweep& sweep = rays_.emplace_back(device_, "light sweep");
    sweep.record(commands, volume, sources[i], scalars, cells);
    std::ranges::copy(sweep.fans(), lights[i].fans);
  }
}

std::vector<shader::Light> LightPass::place(Commands& commands, const DeviceVolume& volume, DirectionSet set, const Lighting& lighting,
                                            bool scalars, const OccupiedCells* cells) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  std::vector<shader::Light> lights;
  for (const Light& light : lighting.lights)
    lights.push_back(deviceLight(light, lightSource(light, volume.indexToWorld), middle));
  rays_.clear();
  if (lighting.attenuation == LightAttenuation::Exact)
    setRays(commands, volume, lighting, scalars, cells, lights);
  else
    setBeyond(commands, volume, set, lighting, lights);
  return lights;
}

shader::FrameLighting LightPass::prepare(const DeviceVolume& volume, const TableSettings& table, const FrameSettings& settings,
                                         bool scalars, const OccupiedCells* cells, std::vector<StageTime>& times,
                                         const Progress& progress) {
  const Lighting& lighting = *settings.lighting;
  const DirectionSet set = table.directions;
  const bool stand =
      placed_ && placed_->lights == lighting.lights && placed_->attenuation == lighting.attenuation && placedScalars_ == scalars;
  if (!stand) {
    placed_.reset();  // invalid until the new lights are complete
    Commands commands(device_);
    const std::vector<shader::Light> lights = place(commands, volume, set, lighting, scalars, cells);
    commands.submitAndWait(progress);
    addTimes(times, commands.times());
    const auto bytes = std::as_bytes(std::span(lights));
    lights_ = Buffer(device_, std::max<VkDeviceSize>(bytes.size(), 4), MemoryUse::Device, "lights");
    upload(device_, lights_, bytes);
  }
  placed_ = lighting;
  placedScalars_ = scalars;
  return {.lightCount = int(lighting.lights.size()),
          .lookup = lighting.attenuation == LightAttenuation::Exact ? shader::kLookupExact : int(settings.tableLookup()),
          .tint = lighting.tint,
          .forward = 0.0f,
          .deltaScale = glm::vec3(1.0f),
          .phaseG = float(lighting.phaseG),
          .surface = float(lighting.surface),
          .scattered = {},
          .gradientToWorld = glm::transpose(glm::inverse(glm::dmat3(volume.indexToWorld))),
          .scalars = volume.scalarBricks ? volume.scalarBricks->onDevice() : shader::CodeBricks()};
}

}  // namespace freevoxels
