#pragma once
// The input of the checks: the results of every stage for one volume. The device's come from the Renderer;
// tests of the checks supply results that are broken on purpose.

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "engine/image/image.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/scene/source_rays.h"
#include "engine/splatting/splat_sums.h"
#include "engine/volume/classification.h"
#include "engine/volume/volume.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// Bytes [direction][voxel], voxels x fastest.
using TableBytes = std::vector<std::vector<std::uint8_t>>;

class StageOutputs {
 public:
  virtual ~StageOutputs() = default;
  /// Extinction of every voxel, per world unit.
  virtual std::vector<float> extinction() = 0;
  /// Emission of every voxel, per world unit; empty if there is none.
  virtual std::vector<glm::dvec3> emission() = 0;
  virtual TableBytes table() = 0;
  virtual std::vector<std::uint32_t> visibleVoxels() = 0;
  /// Depths along rays from a source.
  virtual RayCodes rays(const RaySource& source) = 0;
  /// The sums of every pixel before the resolve.
  virtual std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) = 0;
  virtual Image image(const Camera& camera, const FrameSettings& settings) = 0;
};

/// Runs the stages. The volume is not needed after the call.
using StageMaker =
    std::function<std::unique_ptr<StageOutputs>(const Volume&, const Classification&, const TableSettings&)>;

/// Stages of the Renderer. `device` must outlive the result.
StageMaker deviceStages(const Device& device);

}  // namespace freevoxels
