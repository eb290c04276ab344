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

bool standAlike(std::span<const Light> some, std::span<const Light> others) {
  return std::ranges::equal(some, others,
                            [](const Light& a, const Light& b) { return a.place == b.place && a.atInfinity == b.atInfinity; });
}

void LightPass::setBeyond(Commands& commands, const DeviceVolume& volume, DirectionSet set, Placed& placed) {
  int slot = 0;
  placed.beyondDepths =
      Buffer(device_, std::max<VkDeviceSize>(placed.onDevice.size(), 1) * kEyeDepthsBytes, MemoryUse::Device, "depths beyond lights");
  for (std::size_t i = 0; i < placed.onDevice.size(); ++i) {
    const RaySource source = lightSource(placed.lighting.lights[i], volume.indexToWorld);
    if (!isInside(source, volume.layout.dimensions)) continue;
    beyond_.record(commands, volume, set, source, placed.beyondDepths, slot);
    placed.onDevice[i].beyond = addressWords(placed.beyondDepths.address() + VkDeviceSize(slot++) * kEyeDepthsBytes);
  }
}

void LightPass::setRays(Commands& commands, const DeviceVolume& volume, const OccupiedCells* cells, Placed& placed) const {
  const std::vector<RaySource> sources = sourcesOf(placed.lighting, volume);
  checkRaysFit(device_, rayMemory(volume.layout.dimensions, sources));
  for (std::size_t i = 0; i < placed.onDevice.size(); ++i) {
    RaySweep& sweep = placed.rays.emplace_back(device_, "light sweep");
    sweep.record(commands, volume, sources[i], placed.scalars, cells);
    std::ranges::copy(sweep.fans(), placed.onDevice[i].fans);
  }
}

LightPass::Placed LightPass::place(const DeviceVolume& volume, DirectionSet set, const Lighting& lighting, bool scalars,
                                   const OccupiedCells* cells, std::vector<StageTime>& times, const Progress& progress) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  Placed placed{.lighting = lighting, .scalars = scalars};
  for (const Light& light : lighting.lights) placed.onDevice.push_back(deviceLight(light, lightSource(light, volume.indexToWorld), middle));
  Commands commands(device_);
  if (lighting.attenuation == LightAttenuation::Exact)
    setRays(commands, volume, cells, placed);
  else
    setBeyond(commands, volume, set, placed);
  commands.submitAndWait(progress);
  addTimes(times, commands.times());
  const auto bytes = std::as_bytes(std::span(placed.onDevice));
  placed.lights = Buffer(device_, std::max<VkDeviceSize>(bytes.size(), 4), MemoryUse::Device, "lights");
  upload(device_, placed.lights, bytes);
  return placed;
}

shader::FrameLighting LightPass::prepare(const DeviceVolume& volume, const TableSettings& table, const FrameSettings& settings,
                                         bool scalars, const OccupiedCells* cells, std::vector<StageTime>& times,
                                         const Progress& progress) {
  const Lighting& lighting = *settings.lighting;
  const auto placeAgain = [&] { placed_ = place(volume, table.directions, lighting, scalars, cells, times, progress); };
  const bool stand = placed_ && standAlike(placed_->lighting.lights, lighting.lights) &&
                     placed_->lighting.attenuation == lighting.attenuation && placed_->scalars == scalars &&
                     (!isOld_ || settings.allowsOldLight);
  if (!stand) {
    // The old lights stay until the new ones are complete, for a draft that follows if these are given up.
    try {
      placeAgain();
    } catch (const Error& error) {
      if (error.kind() != ErrorKind::OutOfMemory || !placed_) throw;
      placed_.reset();
      placeAgain();
    }
    isOld_ = false;
    ++version_;
  } else if (placed_->lighting.lights != lighting.lights) {
    for (std::size_t i = 0; i < lighting.lights.size(); ++i)
      placed_->onDevice[i].color = lighting.lights[i].intensity * lighting.lights[i].color;
    upload(device_, placed_->lights, std::as_bytes(std::span(placed_->onDevice)));
  }
  placed_->lighting = lighting;
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
