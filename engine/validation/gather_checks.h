#pragma once
// The gather, stage by stage, against engine/reference/reference_gather.h.

#include <functional>
#include <memory>

#include "engine/gathering/gather_stages.h"
#include "engine/scene/camera.h"
#include "engine/scene/render_settings.h"
#include "engine/validation/report.h"
#include "engine/validation/validation_scene.h"
#include "engine/vulkan/device.h"

namespace freevoxels {

/// What the checks look at. Whoever checks the checks hands in others than the device's, broken on purpose.
class GatherOutputs {
 public:
  virtual ~GatherOutputs() = default;
  /// Draws a frame whose Draw is Gather.
  virtual GatherStages frame(const Camera& camera, const FrameSettings& settings) = 0;
};
using GatherMaker = std::function<std::unique_ptr<GatherOutputs>(const Volume&, const Classification&)>;

/// Makes frames with the Renderer. `device` and the volumes have to outlive what is made.
GatherMaker deviceGather(const Device& device);

/// Frames of the scene without lights, `size` pixels each: blocks as they are stored, sums of the lattice's samples, sums after
/// the stencil, and the image, each against a reference that is given what the stage before it made. With a transfer function
/// both classified before and after interpolation.
ReportSection gatherChecks(const GatherMaker& make, const ValidationScene& scene, glm::ivec2 size);

/// Frames with lights at the samples, of smooth fog: depths towards the lights as they are stored, and the image against the oracle's.
ReportSection gatherLightChecks(const GatherMaker& make, glm::ivec2 size);
/// The same of scalars that are classified after interpolation.
ReportSection gatherScalarLightChecks(const GatherMaker& make, glm::ivec2 size);
/// A frame with light of all orders of scattering: the light as it is stored, and the image.
ReportSection gatherScatteringChecks(const GatherMaker& make, glm::ivec2 size);
/// The frames of gatherLightChecks() of voxels that emit light, too.
ReportSection gatherEmissionChecks(const GatherMaker& make, glm::ivec2 size);
/// Spheres whose surfaces reflect light: the image against its closed form, and gradients as they are stored.
ReportSection gatherSurfaceChecks(const GatherMaker& make);

}  // namespace freevoxels
