#pragma once
// The panel "Light": lights, light from around, and scattering.

#include <glm/glm.hpp>
#include <string>

#include "engine/description/scene_description.h"
#include "apps/view/view_state.h"
#include "engine/scene/camera.h"

namespace freevoxels {

/// `direction` is the unit vector towards the light in camera space: right, up, towards the eye. `size` is
/// the width on the screen. Returns true if the user changed it.
bool drawLightBall(const char* name, float size, glm::dvec3& direction, glm::dvec3 color);

/// `camera` is that of the image. Returns true if a light was changed.
bool drawLights(LightingDescription& options, const Camera& camera, const Volume& volume);

class LightPanel {
 public:
  void draw(ViewState& state);

 private:
  bool drawAround(LightingDescription& options);
  bool drawEnvironment(LightingDescription& options);

  std::string environment_, environmentText_;  ///< of the option, and as typed
};

}  // namespace freevoxels
