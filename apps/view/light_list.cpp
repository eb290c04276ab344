#include "apps/view/light_list.h"

#include <imgui.h>

#include "apps/view/light_ball.h"
#include "apps/view/light_edits.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr float kBall = 5.6f, kBallLabels = 6.0f;  // widths in units of text's size
constexpr float kHeaderStrength = 0.5f;            // of a panel's header
constexpr double kDirectionSteps = 1e-4;

glm::dvec3 roundedDirection(glm::dvec3 direction) {
  for (int c = 0; c < 3; ++c) direction[c] = roundedTo(direction[c], kDirectionSteps);
  return direction;
}

bool drawDirection(Light& light, const Camera& camera) {
  const glm::dmat3 toCamera(worldToCamera(camera));
  glm::dvec3 seen = toCamera * glm::normalize(light.place);
  bool changed = drawLightBall("ball", kBall * ImGui::GetFontSize(), seen, light.color);
  if (changed) light.place = roundedDirection(glm::transpose(toCamera) * seen);
  ImGui::SameLine();
  ImGui::BeginGroup();
  ImGui::PushItemWidth(-kBallLabels * ImGui::GetFontSize());
  glm::dvec2 angles = anglesOf(light.place);
  bool turned = slide("azimuth", angles.x, -180.0, 180.0, "%.0f deg");
  hint("Of where the light comes from, about +y from +z");
  turned |= slide("elevation", angles.y, -90.0, 90.0, "%.0f deg");
  if (turned) light.place = roundedDirection(directionOf(angles));
  changed |= turned | editColor("colour", light.color);
  ImGui::PopItemWidth();
  ImGui::EndGroup();
  return changed;
}

bool drawPosition(Light& light, const Volume& volume) {
  constexpr double kPerPixel = 0.01;
  bool changed = dragVector("position", light.place, kPerPixel * halfDiagonal(volume));
  hint("In the world; drag a number to move the light");
  changed |= editColor("colour", light.color);
  return changed;
}

bool drawIntensity(LightingOptions::GivenLight& given, const Volume& volume) {
  std::optional<double> intensity;
  if (given.hasIntensity) intensity = given.light.intensity;
  const bool changed =
      AutomaticSlider().draw("intensity", given.light.atInfinity ? "Irradiance" : "Irradiance at distance 1",
                             intensity, defaultIntensity(given.light, volume));
  given.hasIntensity = intensity.has_value();
  given.light.intensity = intensity.value_or(Light{}.intensity);
  return changed;
}

/// False in `stays` where the light is to be taken out.
bool drawLight(std::size_t number, LightingOptions::GivenLight& given, const Camera& camera,
               const Volume& volume, bool& stays) {
  const std::string title =
      fmt::format("{} {}###light", given.light.atInfinity ? "directional light" : "point light", number + 1);
  ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetColorU32(ImGuiCol_Header, kHeaderStrength));
  const bool open = ImGui::CollapsingHeader(title.c_str(), &stays, ImGuiTreeNodeFlags_DefaultOpen);
  ImGui::PopStyleColor();
  if (!open) return !stays;
  bool changed =
      given.light.atInfinity ? drawDirection(given.light, camera) : drawPosition(given.light, volume);
  changed |= drawIntensity(given, volume);
  return changed || !stays;
}

}  // namespace

bool drawLights(LightingOptions& options, const Camera& camera, const Volume& volume) {
  bool changed = false;
  for (std::size_t i = 0; i < options.lights.size(); ++i) {
    ImGui::PushID(int(i));
    bool stays = true;
    changed |= drawLight(i, options.lights[i], camera, volume, stays);
    ImGui::PopID();
    if (!stays) options.lights.erase(options.lights.begin() + std::ptrdiff_t(i--));
  }
  const bool directional = ImGui::Button("+ directional light");
  hint("Parallel rays, as of the sun");
  ImGui::SameLine();
  const bool positional = ImGui::Button("+ point light");
  hint("A lamp somewhere in the world");
  if (!directional && !positional) return changed;
  options.lights.push_back(newLight(camera, volume, directional));
  return true;
}

}  // namespace freevoxels
