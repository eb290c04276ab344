#include "apps/view/light_panel.h"

#include <algorithm>
#include <cmath>
#include <imgui.h>

#include "apps/view/light_edits.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr int kRings = 12, kSectors = 40;
constexpr double kDarkest = 0.03, kBrightest = 0.8;
constexpr ImU32 kDot = IM_COL32(255, 196, 64, 255), kEdge = IM_COL32(120, 128, 140, 255);

struct Disc {
  ImVec2 middle;
  float radius;

  ImVec2 at(glm::dvec2 place) const {
    return {middle.x + radius * float(place.x), middle.y - radius * float(place.y)};
  }
};

/// Triangles of rings around the middle, whose corners are shaded after Lambert.
void drawShaded(ImDrawList& list, const Disc& disc, glm::dvec3 direction, glm::dvec3 color) {
  const ImVec2 white = ImGui::GetFontTexUvWhitePixel();
  const auto first = ImDrawIdx(list._VtxCurrentIdx);
  list.PrimReserve(6 * kRings * kSectors, (kRings + 1) * kSectors);
  for (int ring = 0; ring <= kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const double angle = 2.0 * std::numbers::pi * sector / kSectors;
      const glm::dvec2 place = double(ring) / kRings * glm::dvec2(std::cos(angle), std::sin(angle));
      const double light = std::max(glm::dot(directionOnBall(place), direction), 0.0);
      list.PrimWriteVtx(disc.at(place), white, shownColor(color * (kDarkest + kBrightest * light), 1.0f));
    }
  for (int ring = 0; ring < kRings; ++ring)
    for (int sector = 0; sector < kSectors; ++sector) {
      const int next = (sector + 1) % kSectors;
      const auto corner = [&](int r, int s) { return ImDrawIdx(first + r * kSectors + s); };
      for (const ImDrawIdx index : {corner(ring, sector), corner(ring + 1, sector), corner(ring + 1, next),
                                    corner(ring, sector), corner(ring + 1, next), corner(ring, next)})
        list.PrimWriteIdx(index);
    }
}

constexpr float kBall = 7.0f;         // width in units of the font's size
constexpr float kHeaderStrength = 0.5f;            // of a panel's header
constexpr double kDirectionSteps = 1e-4;

glm::dvec3 roundedDirection(glm::dvec3 direction) {
  for (int c = 0; c < 3; ++c) direction[c] = roundedTo(direction[c], kDirectionSteps);
  return direction;
}

bool drawDirection(Light& light, const Camera& camera) {
  const glm::dmat3 toCamera(worldToCamera(camera));
  glm::dvec3 seen = toCamera * glm::normalize(light.place);
  bool changed = drawLightBall(beginRow("Direction"), kBall * ImGui::GetFontSize(), seen, light.color);
  if (changed) light.place = roundedDirection(glm::transpose(toCamera) * seen);
  glm::dvec2 angles = anglesOf(light.place);
  bool turned = slide("Azimuth", angles.x, -180.0, 180.0, "%.0f°");
  hint("Where the light comes from: angle about +y from +z", "--light direction=...");
  turned |= slide("Elevation", angles.y, -90.0, 90.0, "%.0f°");
  if (turned) light.place = roundedDirection(directionOf(angles));
  changed |= turned | editColor("Colour", light.color);
  return changed;
}

bool drawPosition(Light& light, const Volume& volume) {
  constexpr double kPerPixel = 0.01;
  bool changed = dragVector("Position", light.place, kPerPixel * halfDiagonal(volume));
  hint("World units; drag a number to move the light", "--light position=...");
  changed |= editColor("Colour", light.color);
  return changed;
}

bool drawIntensity(LightingDescription::GivenLight& given, const Volume& volume) {
  std::optional<double> intensity;
  if (given.hasIntensity) intensity = given.light.intensity;
  const bool changed =
      AutomaticSlider().draw("Intensity", given.light.atInfinity ? "Irradiance" : "Irradiance at distance 1", "--light ...,intensity=",
                             intensity, defaultIntensity(given.light, volume));
  given.hasIntensity = intensity.has_value();
  given.light.intensity = intensity.value_or(Light{}.intensity);
  return changed;
}

/// False in `stays` where the light is to be taken out.
bool drawLight(std::size_t number, LightingDescription::GivenLight& given, const Camera& camera,
               const Volume& volume, bool& stays) {
  const std::string title =
      fmt::format("{} {}###light", given.light.atInfinity ? "Directional light" : "Point light", number + 1);
  ImGui::PushStyleColor(ImGuiCol_Header, ImGui::GetColorU32(ImGuiCol_Header, kHeaderStrength));
  const bool open = ImGui::CollapsingHeader(title.c_str(), &stays, ImGuiTreeNodeFlags_DefaultOpen);
  ImGui::PopStyleColor();
  if (!open) return !stays;
  bool changed =
      given.light.atInfinity ? drawDirection(given.light, camera) : drawPosition(given.light, volume);
  changed |= drawIntensity(given, volume);
  return changed || !stays;
}

/// A colour and how bright it is; each keeps the other.
bool editRadiance(glm::dvec3& radiance) {
  constexpr double kMin = 1e-3, kMax = 100.0;
  double brightness = std::max({radiance.r, radiance.g, radiance.b});
  glm::dvec3 color = brightness > 0.0 ? radiance / brightness : glm::dvec3(1.0);
  bool changed = editColor("Ambient colour", color);
  changed |= slideLogarithmic("Radiance", brightness, kMin, kMax);
  hint("Radiance from all directions", "--ambient");
  if (changed)
    for (int c = 0; c < 3; ++c) radiance[c] = roundedTo(std::max(brightness, kMin) * color[c], 1e-5);
  return changed;
}

/// Whether lights see surfaces in the volume, were their share not 0.
bool hasSurfaces(LightingDescription options, const Scene& scene) {
  options.surface.reset();
  return options.surfaceOf(*scene.volume, scene.classification) > 0.0;
}

/// `scene` is that of the image.
bool drawScattering(LightingDescription& options, const Scene& scene) {
  bool changed = choose("Shading", kShadingWords, options.shading, Shading::Auto);
  hint("As fog, or as surfaces across the gradient; auto: surfaces with a transfer function", "--shading");
  if (hasSurfaces(options, scene)) {
    changed |= slideOptional("Surface share", options.surface, 1.0, 0.0, 1.0);
    hint("Share of the light that surfaces reflect; the rest is scattered as in fog", "--surface-share");
  }
  constexpr int kMaxShown = 10;  // the next position of the slider is all orders
  const int given = options.scattering.value_or(kAllOrders);
  int orders = given == kAllOrders ? kMaxShown + 1 : given;
  const std::string shown = given == kAllOrders ? "all orders" : given == 1 ? "single" : fmt::format("{} orders", given);
  if (slideWhole("Scattering", orders, 1, std::max(kMaxShown + 1, orders), shown)) {
    options.scattering = orders;
    if (orders > kMaxShown) options.scattering.reset();
    changed = true;
  }
  hint("Orders of scattering in fog; 1 is single scattering", "--scattering");
  changed |= slideOptional("Phase g", options.phaseG, 0.0, -kMaxPhaseG, kMaxPhaseG, "%.2f");
  hint("Henyey-Greenstein asymmetry: forwards above 0, backwards below", "--phase-g");
  changed |= choose("Shadows", kLightAttenuationWords, options.attenuation, LightAttenuation::Auto);
  hint("Transmittance to the lights: from the table, or exact along rays", "--light-attenuation");
  return changed;
}

bool drawTint(LightingDescription& options) {
  glm::dvec3 tint = options.tint.value_or(glm::dvec3(1.0));
  const bool changed =
      ImGui::SliderScalarN(beginRow("Extinction tint"), ImGuiDataType_Double, &tint.x, 3, &kMinTint, &kMaxTint, "%.2f",
                           ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_AlwaysClamp);
  hint("Factors of the red, green and blue extinction of light", "--extinction-tint");
  if (!changed) return false;
  options.tint = tint;
  if (tint == glm::dvec3(1.0)) options.tint.reset();
  return true;
}

}  // namespace

bool drawLightBall(const char* name, float size, glm::dvec3& direction, glm::dvec3 color) {
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const Disc disc{{low.x + 0.5f * size, low.y + 0.5f * size}, 0.42f * size};
  ImGui::InvisibleButton(name, {size, size});
  hint("Drag to where the light comes from; past the edge: behind");
  ImDrawList& list = *ImGui::GetWindowDrawList();
  drawShaded(list, disc, direction, color / std::max({color.r, color.g, color.b, 1.0}));
  list.AddCircle(disc.middle, disc.radius, kEdge, kSectors);
  const ImVec2 dot = disc.at(direction);
  const float radius = 0.05f * size;
  if (direction.z >= 0.0)
    list.AddCircleFilled(dot, radius, kDot);
  else
    list.AddCircle(dot, radius, kDot, 0, 1.5f);

  const ImGuiIO& io = ImGui::GetIO();
  if (!ImGui::IsItemActive() || (io.MouseDelta.x == 0.0f && io.MouseDelta.y == 0.0f)) return false;
  direction = directionOnBall(glm::dvec2(io.MousePos.x - disc.middle.x, disc.middle.y - io.MousePos.y) /
                              double(disc.radius));
  return true;
}

bool drawLights(LightingDescription& options, const Camera& camera, const Volume& volume) {
  bool changed = false;
  for (std::size_t i = 0; i < options.lights.size(); ++i) {
    ImGui::PushID(int(i));
    bool stays = true;
    changed |= drawLight(i, options.lights[i], camera, volume, stays);
    ImGui::PopID();
    if (!stays) options.lights.erase(options.lights.begin() + std::ptrdiff_t(i--));
  }
  const bool directional = ImGui::Button("Add directional light");
  hint("Parallel rays, as of the sun", "--light direction=...");
  ImGui::SameLine();
  const bool positional = ImGui::Button("Add point light");
  hint("A lamp somewhere in the world", "--light position=...");
  if (!directional && !positional) return changed;
  options.lights.push_back(newLight(camera, volume, directional, options.lights.size()));
  return true;
}

void LightPanel::draw(ViewState& state) {
  if (!panelHeader("Light", state.latest && state.camera, false)) return;
  ImGui::PushID("light");
  LightingDescription& options = state.scene.lighting;
  const bool lit = options.hasLight() && !options.unlit;
  if (!lit) ImGui::TextDisabled("No light: voxels show their own colour.");
  bool changed = drawLights(options, *state.camera, *state.latest->scene.volume);
  ImGui::Separator();
  changed |= drawAround(options);
  if (lit) {
    ImGui::Separator();
    if (!options.lights.empty()) changed |= drawScattering(options, state.latest->scene);
    changed |= drawTint(options);
  }
  ImGui::PopID();
  if (!changed) return;
  dropIdleOptions(options);
  options.unlit = !options.hasLight();
  state.changed = true;
}

bool LightPanel::drawAround(LightingDescription& options) {
  bool ambient = options.ambient.has_value();
  bool changed = tick("Ambient light", ambient);
  if (changed) {
    constexpr double kFirst = 0.3;
    options.ambient.reset();
    if (ambient) options.ambient = glm::dvec3(kFirst);
  }
  if (options.ambient) changed |= editRadiance(*options.ambient);
  changed |= drawEnvironment(options);
  return changed;
}

bool LightPanel::drawEnvironment(LightingDescription& options) {
  const std::string given = options.environment.value_or("");
  if (given != environment_) environment_ = environmentText_ = given;
  bool changed = false;
  if (editText("Environment", environmentText_, "name.exr or name.hdr")) {
    environment_ = environmentText_;
    options.environment.reset();
    if (!environment_.empty()) options.environment = environment_;
    changed = true;
  }
  hint("Latitude-longitude image of the light from all around; empty: none", "--environment");
  if (!options.environment) return changed;
  changed |= slideOptional("Rotation", options.environmentRotation, 0.0, -180.0, 180.0, "%.0f°");
  hint("Of the environment, about +y", "--environment-rotation");
  double intensity = options.environmentIntensity.value_or(1.0);
  if (slideLogarithmic("Brightness", intensity, 0.01, 100.0)) {
    options.environmentIntensity = intensity;
    changed = true;
  }
  hint("Factor of the environment's radiance", "--environment-intensity");
  return changed;
}

}  // namespace freevoxels
