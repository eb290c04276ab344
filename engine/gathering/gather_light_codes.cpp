// The part of GatherVolume for lights that are evaluated at samples: codes of optical depths towards them,
// and gradients of surfaces.

#include <algorithm>
#include <array>
#include <cmath>

#include "embedded/light_depths.h"
#include "embedded/other_depths.h"
#include "embedded/surface_gradients.h"
#include "engine/core/error.h"
#include "engine/gathering/gather_volume.h"
#include "engine/lighting/light_pass.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

namespace {

/// Three signed components of 9 bits with a shared exponent of 5 bits, which is 16 more than it says (shaders/packed_gradient.glsl).
glm::dvec3 unpackGradient(std::uint32_t bits) {
  glm::dvec3 gradient;
  for (int axis = 0; axis < 3; ++axis) {
    const int part = int(bits >> (9 * axis) & 0x1ffu);
    gradient[axis] = std::ldexp(double(part < 256 ? part : part - 512) / 255.0, int(bits >> 27) - 16);
  }
  return gradient;
}

}  // namespace

bool GatherVolume::lightsSamples(const Lighting* lighting) {
  if (lighting == nullptr) return false;
  return lighting->lights.empty() ||
         (lighting->lights.size() <= std::size_t(shader::kMaxSampleLights) && lighting->attenuation == LightAttenuation::Exact);
}

/// Keeps the codes until the lights are swept again. `shading` is null where light is not evaluated at samples.
void GatherVolume::prepareSampled(const Shading* shading) {
  isSampled_ = shading != nullptr;
  const std::vector<Light> lights = shading != nullptr ? shading->lighting->lights : std::vector<Light>();
  const std::uint64_t version = !lights.empty() && surroundings_ == nullptr ? shading->lights->version() : 0;
  if (!standAlike(lights, sampled_) || version != lightVersion_) dropLightCodes();
  sampled_ = lights;
  lightVersion_ = version;
  const std::uint64_t bytes = std::uint64_t(capacity_) * shader::kGatherBrickBlocks * sizeof(std::uint16_t);
  for (int slot = 0; slot < shader::kMaxSampleLights; ++slot) {
    Buffer& codes = lightCodes_[std::size_t(slot)];
    if (slot >= sampleLights())
      codes = {};
    else if (codes.bytes() < bytes)
      codes = Buffer(device_, bytes, MemoryUse::Device, kLightCodes, VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT);
    if (surroundings_ == nullptr || slot >= sampleLights()) continue;
    const std::vector<std::uint16_t> given = surroundings_->codes(slot, *this);
    upload(device_, codes, std::as_bytes(std::span(given)));
  }
}

void GatherVolume::dropLightCodes() {
  lightMade_ = {};
  for (Quads& quads : quads_) quads.lightMade = {};
}

/// Computes the codes of all blocks of bricks, occupied or not.
void GatherVolume::recordLightCodes(Commands& commands, const Shading& shading) {
  if (!bricks_.lack(lightMade_, wantedLevels_)) return;
  const bool isFirst = lightMade_.levels == 0;
  std::vector<GatherBricks::Range> missing;
  bricks_.forEachMissing(lightMade_, wantedLevels_, [&](const GatherBricks::Range& range) { missing.push_back(range); });
  if (surroundings_ != nullptr) return;  // whose codes are uploaded
  commands.beginPass("light depths");
  if (isFirst)
    for (int slot = 0; slot < sampleLights(); ++slot) commands.clear(lightCodes_[std::size_t(slot)]);  // of the empty brick
  for (const GatherBricks::Range& range : missing) recordLightDepths(commands, shading, range);
  commands.barrier(kComputeStage, kComputeStage);
  recordShadows(commands, shading, missing);
}

/// Adds the depths of other volumes, one after the other.
void GatherVolume::recordShadows(Commands& commands, const Shading& shading, std::span<const GatherBricks::Range> ranges) {
  const DeviceVolume& volume = built_.volume;
  for (const ShadowingVolume& other : shading.others) {
    const auto number = std::size_t(&other - shading.others.data());
    if (number == others_.size()) others_.emplace_back(device_, sizeof(shader::OtherVolume), MemoryUse::Device, "volume beside");
    const glm::dmat4 toOther = glm::inverse(other.indexToWorld) * volume.indexToWorld;
    commands.update(others_[number],
                    shader::OtherVolume{.toOther = glm::dmat3(toOther), .offset = glm::dvec3(toOther[3]), .dimensions = other.dimensions});
    for (const GatherBricks::Range& range : ranges) recordOtherDepths(commands, other, others_[number], range);
    commands.barrier(kComputeStage, kComputeStage);
  }
}

void GatherVolume::recordOtherDepths(Commands& commands, const ShadowingVolume& other, const Buffer& constants,
                                     const GatherBricks::Range& range) {
  for (int light = 0; light < sampleLights(); ++light) {
    const RaySweep& rays = other.lights->rays(light);
    const std::optional<TexelView>& texels = rays.depthTexels();
    const Pipeline pass =
        makeComputePipeline(device_, shaders::other_depths, {other.scalars, texels.has_value(), sampled_[std::size_t(light)].atInfinity});
    const TexelView& places = bricks_.placeTexels();
    const std::array<Binding, 4> bindings{&places, &constants, &other.lights->lights(), texels ? &*texels : &places};
    const shader::OtherDepthsPush push{.firstBrick = range.first,
                                       .count = range.count(),
                                       .light = light,
                                       .edge = 1 << range.level,
                                       .voxels = built_.volume.layout.dimensions,
                                       .depths = addressWords(lightCodes_[std::size_t(light)].address()),
                                       .rays = addressWords(rays.depths().address())};
    commands.dispatchLinear(pass, bindings, push, std::uint64_t(range.count()) * shader::kBrickQuadsThreads);
  }
}

void GatherVolume::recordLightDepths(Commands& commands, const Shading& shading, const GatherBricks::Range& range) {
  const DeviceVolume& volume = built_.volume;
  const int level = range.level;
  for (int light = 0; light < sampleLights(); ++light) {
    const RaySweep& rays = shading.lights->rays(light);
    const std::optional<TexelView>& texels = rays.depthTexels();
    const bool rows = level == 0 && sampled_[std::size_t(light)].atInfinity && rays.fans()[0].axis != 0;
    const Pipeline pass = makeComputePipeline(device_, shaders::light_depths, {hasScalars(), texels.has_value(), level == 0, rows});
    const TexelView& places = bricks_.placeTexels();
    const std::array<Binding, 4> bindings{&places, &volume.occupancyTexels, &shading.lights->lights(), texels ? &*texels : &places};
    const shader::LightDepthsPush push{.level = volume.onDevice(level),
                                       .firstBrick = range.first,
                                       .count = range.count(),
                                       .light = light,
                                       .edge = 1 << level,
                                       .voxels = volume.layout.dimensions,
                                       .indexToWorld = glm::dmat3(volume.indexToWorld),
                                       .extinction = addressWords(volume.extinction.address()),
                                       .depths = addressWords(lightCodes_[std::size_t(light)].address()),
                                       .rays = addressWords(rays.depths().address())};
    commands.dispatchLinear(pass, bindings, push, std::uint64_t(range.count()) * shader::kBrickQuadsThreads);
  }
}

void GatherVolume::viewGradients() {
  gradientTexels_ = {};
  if (gradients_.bytes() > 0)
    gradientTexels_ = TexelView(device_, gradients_, VK_FORMAT_R32_UINT, inPieces() ? sizeof(std::uint32_t) : VK_WHOLE_SIZE);
}

void GatherVolume::recordGradients(Commands& commands) {
  if (!bricks_.lack(gradientsMade_, wantedLevels_)) return;
  const std::uint64_t bytes = std::uint64_t(capacity_) * shader::kGatherBrickBlocks * sizeof(std::uint32_t);
  if (gradients_.bytes() < bytes) {
    gradients_ = Buffer(device_, bytes, MemoryUse::Device, kGradients,
                        VK_BUFFER_USAGE_UNIFORM_TEXEL_BUFFER_BIT | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT);
    viewGradients();
  }
  commands.beginPass("surface gradients");
  if (gradientsMade_.levels == 0) commands.clear(gradients_);  // of the empty brick
  const DeviceVolume& volume = built_.volume;
  const TexelView* const codes = hasScalars() && volume.scalarBricks->codeTexels ? &*volume.scalarBricks->codeTexels : nullptr;
  const TexelView& places = bricks_.placeTexels();
  const std::array<Binding, 5> bindings{&places, &volume.occupancyTexels, codes != nullptr ? codes : &places,
                                        codes != nullptr ? &*volume.scalarBricks->numberTexels : &places, &gradientTexels_};
  bricks_.forEachMissing(gradientsMade_, wantedLevels_, [&](const GatherBricks::Range& range) {
    const auto scalars = scalarCodes(range.level);
    const Pipeline pass = makeComputePipeline(device_, shaders::surface_gradients, {scalars.has_value(), !inPieces(), codes != nullptr});
    const shader::SurfaceGradientsPush push{.level = volume.onDevice(range.level),
                                            .firstBrick = range.first,
                                            .count = range.count(),
                                            .extinction = addressWords(volume.extinction.address()),
                                            .gradients = addressWords(gradients_.address()),
                                            .scalars = scalars.value_or(shader::CodeBricks())};
    commands.dispatchLinear(pass, bindings, push, std::uint64_t(range.count()) * shader::kBrickQuadsThreads);
  });
  commands.barrier(kComputeStage, kComputeStage);
}

void GatherVolume::recordLightQuads(Commands& commands, int axis) {
  Quads& quads = quads_[std::size_t(axis)];
  if (!bricks_.lack(quads.lightMade, wantedLevels_)) return;
  commands.beginPass("brick quads");
  const auto make = [&](const GatherBricks::Range& range) {
    const shader::GatherLevel& cells = bricks_.levels()[std::size_t(range.level)];
    for (std::size_t slot = 0; slot < std::size_t(sampleLights()); ++slot) {
      const shader::CodeBricks codes{
          .numbers = addressWords(bricks_.numberBuffer().address() + VkDeviceAddress(cells.firstCell) * sizeof(std::uint32_t)),
          .codes = addressWords(lightCodes_[slot].address()),
          .corner = glm::ivec3(0),
          .cells = {cells.cellStrides.x, cells.cellStrides.y / cells.cellStrides.x, 0}};
      recordBricks(commands, axis, range, codes, quads.light[slot], false);
    }
  };
  if (quads.lightMade.levels == 0) make(kEmptyBrick);
  bricks_.forEachMissing(quads.lightMade, wantedLevels_, make);
  commands.barrier(kComputeStage, kComputeStage);
}

/// From the volume's index space to that of the cells of scattered light.
glm::dmat4 GatherVolume::toMedium(const ScatteringSolver& scattered) const {
  const glm::dmat4 &own = built_.volume.indexToWorld, &cells = scattered.medium().indexToWorld();
  return own == cells ? glm::dmat4(1.0) : glm::inverse(cells) * own;
}

void GatherVolume::describeLights(shader::GatherFrame& frame) const {
  if (!isSampled_) return;
  const DeviceVolume& volume = built_.volume;
  const glm::dmat3 linear(volume.indexToWorld);
  const glm::ivec3 dimensions = surroundings_ != nullptr ? surroundings_->dimensions : volume.layout.dimensions;
  for (std::size_t i = 0; i < sampled_.size(); ++i) {
    const Light& light = sampled_[i];
    const glm::dvec3 first = surroundings_ != nullptr ? glm::dvec3(surroundings_->first) : glm::dvec3(0.0);
    const glm::dvec3 place = light.atInfinity ? glm::normalize(light.place) : lightSource(light, volume.indexToWorld).place + first;
    frame.lights[i] = {.positionOrDirection = place, .atInfinity = light.atInfinity ? 1 : 0, .color = light.intensity * light.color};
    glm::dvec3 fromFirst = place, fromLast = place - glm::dvec3(dimensions - 1);
    if (light.atInfinity) {
      const glm::dvec3 way = lightSource(light, volume.indexToWorld).place, size = glm::abs(way);
      frame.lights[i].across = way / std::max({size.x, size.y, size.z});
      fromFirst = fromLast = way;
    }
    frame.lights[i].lightsFirst = glm::vec3(glm::lessThan(fromFirst, glm::dvec3(0.0)));
    frame.lights[i].lightsLast = glm::vec3(glm::greaterThan(fromLast, glm::dvec3(0.0)));
  }
  // A medium of several volumes has an index space of its own.
  if (hasScattered()) frame.scattered = surroundings_ != nullptr ? scattered_->onDevice() : scattered_->onDevice(toMedium(*scattered_));
  frame.tint = lighting_->tint * deltaScale_;
  frame.forward = float(splitPhase(*lighting_).forward);
  frame.phaseG = float(lighting_->phaseG);
  frame.surface = float(lighting_->surface);
  frame.nearestLight2 = float(double(shader::kNearestLight2) * volume.voxelSize * volume.voxelSize);
  frame.indexToWorld = linear;
  frame.gradients = addressWords(gradients_.address());
  frame.gradientToWorld = glm::transpose(glm::inverse(linear));
}

std::vector<GatherLight> GatherVolume::downloadLight() const {
  const auto words = [&](const Buffer& buffer) {
    std::vector<std::uint32_t> result(buffer.bytes() / sizeof(std::uint32_t));
    if (!result.empty()) download(device_, buffer, std::as_writable_bytes(std::span(result)));
    return result;
  };
  std::vector<std::vector<std::uint32_t>> codes;
  for (int slot = 0; slot < sampleLights(); ++slot) codes.push_back(words(lightCodes_[std::size_t(slot)]));
  const std::vector<std::uint32_t> gradients = hasSurfaces() ? words(gradients_) : std::vector<std::uint32_t>();
  std::vector<GatherLight> levels(bricks_.levels().size());
  for (std::size_t level = 0; level < levels.size(); ++level) {
    if (((wantedLevels_ & lightMade_.levels) >> level & 1u) == 0 || codes.empty()) continue;
    const shader::GatherLevel& cells = bricks_.levels()[level];
    GatherLight& light = levels[level];
    light.depths.resize(std::size_t(sampleLights()));
    glm::ivec3 block;
    for (block.z = 0; block.z < cells.dimensions.z; ++block.z)
      for (block.y = 0; block.y < cells.dimensions.y; ++block.y)
        for (block.x = 0; block.x < cells.dimensions.x; ++block.x) {
          const glm::ivec3 cell = block / shader::kGatherBrickEdge, local = block % shader::kGatherBrickEdge;
          const std::uint32_t brick =
              bricks_.numbers()[std::size_t(cells.firstCell + cell.x + cell.y * cells.cellStrides.x + cell.z * cells.cellStrides.y)];
          const std::size_t index = ((std::size_t(brick) * shader::kGatherBrickEdge + std::size_t(local.z)) * shader::kGatherBrickEdge +
                                     std::size_t(local.y)) * shader::kGatherBrickEdge + std::size_t(local.x);
          for (std::size_t slot = 0; slot < codes.size(); ++slot) {
            const double root = double(codes[slot][index / 2] >> (index % 2 * 16) & 0xffffu) / 65535.0;
            light.depths[slot].push_back(kOpaqueDepth * root * root);
          }
          if (!gradients.empty()) light.gradients.push_back(unpackGradient(gradients[index]));
        }
  }
  return levels;
}

}  // namespace freevoxels
