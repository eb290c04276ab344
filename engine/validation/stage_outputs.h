#pragma once
// What the checks look at: the outcome of every stage for one volume. The device's own come from the
// Renderer; whoever checks the checks hands in others, broken on purpose.

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

/// Bytes [direction][voxel], voxels in the order of Volume::values.
using TableBytes = std::vector<std::vector<std::uint8_t>>;

class StageOutputs {
 public:
  virtual ~StageOutputs() = default;
  /// Of every voxel, per world unit.
  virtual std::vector<float> extinction() = 0;
  /// The same of light; empty where no voxel sends out any.
  virtual std::vector<glm::dvec3> emission() = 0;
  virtual TableBytes table() = 0;
  virtual std::vector<std::uint32_t> visibleVoxels() = 0;
  /// From the camera's eye.
  virtual RayCodes rays(const Camera& camera) = 0;
  /// Before the resolve, one a pixel.
  virtual std::vector<SplatSums> sums(const Camera& camera, const FrameSettings& settings) = 0;
  virtual Image picture(const Camera& camera, const FrameSettings& settings) = 0;
};

/// Runs the stages. The volume need not outlive the call.
using StageMaker =
    std::function<std::unique_ptr<StageOutputs>(const Volume&, const Classification&, const TableSettings&)>;

/// By the Renderer, as everything else is drawn. `device` has to outlive what is made.
StageMaker deviceStages(const Device& device);

}  // namespace freevoxels
