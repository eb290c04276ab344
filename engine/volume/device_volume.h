#pragma once
// A classified volume on the device: scalars, extinction and the transfer function.

#include <cstdint>
#include <glm/glm.hpp>
#include <vector>

#include "engine/core/stages.h"
#include "engine/hierarchy/hierarchy_layout.h"
#include "engine/volume/classification.h"
#include "engine/volume/grid_layout.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/buffer.h"
#include "engine/vulkan/commands.h"

namespace freevoxels {

struct DeviceVolume {
  GridLayout layout;
  HierarchyLayout hierarchy;  ///< its level 0 is `layout`
  Buffer scalars;             ///< float
  Buffer extinction;  ///< float, per world unit, of all levels; ClassifyPass writes the voxels', LevelPass
                      ///< the rest
  QuadView extinctionQuads;
  Buffer blockColors;     ///< four halves, of the levels above the voxels; empty where there is one colour
  Buffer transferPoints;  ///< vec4: opacity points, then colour points (transfer_function.glsl)
  std::uint32_t opacityPointCount = 0, colorPointCount = 0;  ///< 0 = physical
  glm::dmat4 indexToWorld{1.0};
  glm::vec3 albedo{0.0f};
  double voxelSize = 0.0;
  std::uint64_t activeVoxels = 0;  ///< no more than this many can be visible
};

DeviceVolume uploadVolume(const Device& device, const Volume& volume, const Classification& classification);

/// COMPUTE classify.comp
class ClassifyPass {
 public:
  explicit ClassifyPass(const Device& device);
  void record(Commands& commands, const DeviceVolume& volume, const Classification& classification) const;

 private:
  Pipeline pipeline_;
};

}  // namespace freevoxels
