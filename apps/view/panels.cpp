#include "apps/view/panels.h"

#include <fmt/format.h>
#include <imgui.h>

#include "apps/view/inspect_panel.h"
#include "apps/view/navigation.h"

namespace freevoxels {

namespace {

/// That of the table, where it was made for this picture.
double tableMilliseconds(const Picture& picture) {
  double sum = 0.0;
  for (const StageTime& time : picture.times)
    if (time.name == "attenuation sweeps" || time.name == "octree table" || time.name == "unseen runs")
      sum += time.milliseconds;
  return sum;
}

void drawPictureTime(const Picture& picture, bool whole, double perSecond) {
  const double table = tableMilliseconds(picture);
  const std::string of = table > 0.0 ? fmt::format(", table {:.0f}", table) : "";
  const std::string often = whole || perSecond == 0.0 ? "" : fmt::format(", {:.0f} a second", perSecond);
  const std::string text =
      fmt::format("{} picture: {:.0f} ms{}{}", whole ? "whole" : "quick", picture.milliseconds, of, often);
  ImGui::TextUnformatted(text.c_str());
}

}  // namespace

void drawStatus(const ViewState& state, const Activity& activity) {
  if (!state.problem.empty()) {
    ImGui::PushStyleColor(ImGuiCol_Text, {1.0f, 0.5f, 0.4f, 1.0f});
    ImGui::TextWrapped("%s", state.problem.c_str());
    ImGui::PopStyleColor();
  }
  if (activity)
    ImGui::Text("%s %.0f %%", activity->first.c_str(), 100.0 * activity->second);
  else if (state.latest)
    drawPictureTime(*state.latest, state.latest == state.whole, state.picturesPerSecond);
  else
    ImGui::TextUnformatted(" ");
}

void drawVolumePanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Volume", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ImGui::TextWrapped("%s", state.scene.input.input.c_str());
  if (!state.latest) return;
  const Volume& volume = *state.latest->scene.volume;
  ImGui::Text("%d x %d x %d voxels, %.3g million active", volume.dimensions.x, volume.dimensions.y,
              volume.dimensions.z, 1e-6 * double(volume.activeVoxels));
  ImGui::Text("values %.4g to %.4g", double(volume.minimum), double(volume.maximum));
}

void drawCameraPanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Camera") || !state.camera) return;
  Camera camera = *state.camera;
  bool moved = false;
  const auto vector = [&](const char* name, glm::dvec3& value) {
    moved |= ImGui::InputScalarN(name, ImGuiDataType_Double, &value.x, 3, nullptr, nullptr, "%.4g");
  };
  vector("eye", camera.position);
  vector("look at", camera.lookAt);
  vector("up", camera.up);
  if (camera.orthographic) {
    moved |= ImGui::InputDouble("height", &camera.orthographicHeight, 0.0, 0.0, "%.4g");
  } else {
    auto field = float(camera.verticalFov);
    if (ImGui::SliderFloat("field of view", &field, 5.0f, 120.0f, "%.0f deg")) {
      camera.verticalFov = double(field);
      moved = true;
    }
  }
  if (moved) state.look(camera);
  bool orthographic = camera.orthographic;
  if (ImGui::Checkbox("orthographic (O)", &orthographic)) state.look(withOtherProjection(camera));
}

void drawPanelsOf(ViewState& state, const Activity& activity, LookPanels& looks) {
  drawStatus(state, activity);
  drawVolumePanel(state);
  looks.draw(state);
  drawCameraPanel(state);
  drawInspectPanel(state);
}

}  // namespace freevoxels
