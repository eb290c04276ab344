#include "apps/view/view_state.h"

namespace freevoxels {

std::optional<MethodOptions> ViewState::comparedMethod() const {
  if (diagnosis.shown != Shown::Picture) return std::nullopt;
  MethodOptions other = method;
  switch (comparison) {
    case 1:
      other.composite = int(Composite::Sorted);
      return other;
    case 2:
      return MethodOptions{.paper = true};
    case 3:
      other.attenuation = int(AttenuationLookup::Exact);
      return other;
    case 4:
      other.lod = 0.0;
      other.culling = false;
      return other;
    default:
      return std::nullopt;
  }
}

void ViewState::look(const Camera& from) {
  camera = from;
  CameraOptions& options = scene.camera;
  options.orbit.reset();
  options.position = from.position;
  options.lookAt = from.lookAt;
  options.up = from.up;
  options.verticalFov.reset();
  options.orthographicHeight.reset();
  if (from.orthographic)
    options.orthographicHeight = from.orthographicHeight;
  else
    options.verticalFov = from.verticalFov;
  changed = true;
}

void ViewState::open(const std::string& file) {
  const glm::ivec2 size = scene.camera.size;
  scene.input = {.input = file};
  scene.classification = {};
  scene.emission = {};
  scene.camera = {.size = size};
  camera.reset();
  problem.clear();
  changed = true;
}

std::string ViewState::commandLine(const std::string& picture) const {
  if (!whole) return "";
  OptionList options = whole->options;
  options.insert(options.begin() + 1, {"", picture});  // behind the volume
  return "freevoxels render " + commandText(options);
}

}  // namespace freevoxels
