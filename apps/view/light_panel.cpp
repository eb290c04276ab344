#include "apps/view/light_panel.h"

#include <imgui.h>

#include <algorithm>

#include "apps/view/light_edits.h"
#include "apps/view/light_list.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

/// A colour and how bright it is; each keeps the other.
bool editRadiance(glm::dvec3& radiance) {
  constexpr double kLeast = 1e-3, kMost = 100.0;
  double brightness = std::max({radiance.r, radiance.g, radiance.b});
  glm::dvec3 color = brightness > 0.0 ? radiance / brightness : glm::dvec3(1.0);
  bool changed = editColor("ambient colour", color);
  changed |= slideLogarithmic("ambient", brightness, kLeast, kMost);
  hint("Radiance from everywhere");
  if (changed)
    for (int c = 0; c < 3; ++c) radiance[c] = roundedTo(std::max(brightness, kLeast) * color[c], 1e-5);
  return changed;
}

bool drawScattering(LightingOptions& options) {
  bool changed = choose("shading", kShadingWords, options.shading, int(Shading::Auto));
  hint("As fog, or as surfaces across the gradient; auto: with a transfer function");
  if (options.shading != int(Shading::Scatter)) {
    changed |= slideOptional("surface share", options.surface, 1.0, 0.0, 1.0);
    hint("How much of it is surface; the rest is fog");
  }
  changed |= slideOptional("phase g", options.phaseG, 0.0, -kMostPhaseG, kMostPhaseG, "%.2f");
  hint("Scattering: forwards above 0, backwards below");
  changed |= choose("shadows", kLightAttenuationWords, options.attenuation, int(LightAttenuation::Auto));
  hint("Looked up in the table, or exact along rays of each light");
  return changed;
}

bool drawTint(LightingOptions& options) {
  glm::dvec3 tint = options.tint.value_or(glm::dvec3(1.0));
  const bool changed =
      ImGui::SliderScalarN("tint", ImGuiDataType_Double, &tint.x, 3, &kLeastTint, &kMostTint, "%.2f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  hint("Red, green and blue extinction on the way of the light, times this");
  if (!changed) return false;
  options.tint = tint;
  if (tint == glm::dvec3(1.0)) options.tint.reset();
  return true;
}

}  // namespace

void LightPanel::draw(ViewState& state) {
  if (!ImGui::CollapsingHeader("Light") || !state.latest || !state.camera) return;
  ImGui::PushID("light");
  const LabelRoom room;
  LightingOptions& options = state.scene.lighting;
  const bool lit = options.hasLight() && !options.unlit;
  if (!lit) ImGui::TextDisabled("No light: voxels send out their colour.");
  bool changed = drawLights(options, *state.camera, *state.latest->scene.volume);
  ImGui::Separator();
  changed |= drawAround(options);
  if (lit) {
    ImGui::Separator();
    if (!options.lights.empty()) changed |= drawScattering(options);
    changed |= drawTint(options);
  }
  ImGui::PopID();
  if (!changed) return;
  dropIdleOptions(options);
  options.unlit = !options.hasLight();
  state.changed = true;
}

bool LightPanel::drawAround(LightingOptions& options) {
  bool ambient = options.ambient.has_value();
  bool changed = ImGui::Checkbox("ambient light", &ambient);
  if (changed) {
    constexpr double kFirst = 0.3;
    options.ambient.reset();
    if (ambient) options.ambient = glm::dvec3(kFirst);
  }
  if (options.ambient) changed |= editRadiance(*options.ambient);
  changed |= drawEnvironment(options);
  return changed;
}

bool LightPanel::drawEnvironment(LightingOptions& options) {
  const std::string given = options.environment.value_or("");
  if (given != environment_) environment_ = environmentText_ = given;
  bool changed = false;
  if (editText("environment", environmentText_, "FILE.exr")) {
    environment_ = environmentText_;
    options.environment.reset();
    if (!environment_.empty()) options.environment = environment_;
    changed = true;
  }
  hint("A lat-long picture of light from all around; empty: none");
  if (!options.environment) return changed;
  changed |= slideOptional("rotation", options.environmentRotation, 0.0, -180.0, 180.0, "%.0f deg");
  double intensity = options.environmentIntensity.value_or(1.0);
  if (slideLogarithmic("brightness", intensity, 0.01, 100.0)) {
    options.environmentIntensity = intensity;
    changed = true;
  }
  hint("Of the environment: times its radiance");
  return changed;
}

}  // namespace freevoxels
