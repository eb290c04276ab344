#include "engine/splatting/depth_sort.h"

#include <array>

#include "embedded/depth_key.h"
#include "engine/vulkan/commands.h"
#include "shaders/interface.h"

namespace freevoxels {

namespace {

shader::DepthKeyPush depthKeyPush(const DeviceVolume& volume, const BlockList& visible,
                                  const Camera& camera) {
  const glm::dvec3 middle = 0.5 * glm::dvec3(volume.layout.dimensions - 1);
  const glm::dvec3 eyeToMiddle =
      camera.orthographic ? glm::normalize(camera.lookAt - camera.position)
                          : glm::dvec3(volume.indexToWorld * glm::dvec4(middle, 1.0)) - camera.position;
  return {.indexToWorld = glm::dmat3(volume.indexToWorld),
          .middle = middle,
          .eyeToMiddle = eyeToMiddle,
          .eyeDistance = float(glm::length(eyeToMiddle)),
          .orthographic = camera.orthographic ? 1 : 0,
          .rowPitch = volume.layout.rowPitch,
          .rows = volume.layout.dimensions.y,
          .chunkCount = visible.chunkCount};
}

}  // namespace

DepthSort::DepthSort(const Device& device, const DeviceVolume& volume)
    : keys_(makeComputePipeline(device, shaders::depth_key)),
      sort_(device),
      pairs_(makeSortPairs(device, std::max<std::uint64_t>(volume.stored.front(), 1))) {}

void DepthSort::record(Commands& commands, const DeviceVolume& volume, const BlockList& visible, const Camera& camera) const {
  const std::array<Binding, 5> keys{&visible.indices, &visible.chunks, &pairs_.count, &pairs_.keys,
                                    &pairs_.values};
  commands.beginPass("depth sort");
  commands.dispatchLinear(keys_, keys, depthKeyPush(volume, visible, camera), pairs_.capacity);
  commands.barrier(kComputeStage, kComputeStage);
  sort_.record(commands, pairs_);
}

}  // namespace freevoxels
