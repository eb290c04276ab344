#include "apps/view/inspect_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <optional>
#include <vector>

#include "apps/view/block_picture.h"
#include "apps/view/widgets.h"
#include "engine/scene/directions.h"

namespace freevoxels {

namespace {

constexpr float kSphereRadius = 62.0f;  // pixels at the usual density of text
constexpr float kDotRadius = 3.5f;

/// From the middle of the volume to the eye, index space.
glm::dvec3 towardsEye(const Scene& scene, const Camera& camera) {
  const glm::dmat4 toIndex = glm::inverse(scene.volume->indexToWorld);
  if (camera.orthographic) return glm::dmat3(toIndex) * (camera.position - camera.lookAt);
  const glm::dvec3 middle = 0.5 * (glm::dvec3(scene.volume->dimensions) - 1.0);
  return glm::dvec3(toIndex * glm::dvec4(camera.position, 1.0)) - middle;
}

bool isBlended(const DirectionBlend& blend, int direction) {
  for (std::size_t i = 0; i < blend.directions.size(); ++i)
    if (blend.directions[i] == direction && blend.weights[i] > 0.0) return true;
  return false;
}

/// A dot on the sphere of directions.
struct DirectionDot {
  int direction = 0;
  ImVec2 place;
  bool faces = false;    ///< the camera
  bool blended = false;  ///< is one of the four around the line of sight
};

std::vector<DirectionDot> placeDots(const Scene& scene, const Camera& camera, DirectionSet set,
                                    const std::optional<DirectionBlend>& blend, ImVec2 centre, float radius) {
  const glm::dmat3 toCamera = glm::dmat3(worldToCamera(camera)) * glm::dmat3(scene.volume->indexToWorld);
  std::vector<DirectionDot> dots;
  for (int i = 0; i < directionCount(set); ++i) {
    const glm::dvec3 seen = glm::normalize(toCamera * directionAt(set, i));
    dots.push_back({.direction = i,
                    .place = {centre.x + radius * float(seen.x), centre.y - radius * float(seen.y)},
                    .faces = seen.z > 0.0,
                    .blended = blend && isBlended(*blend, i)});
  }
  return dots;
}

void drawDot(const DirectionDot& dot, ImVec2 centre, bool chosen) {
  constexpr ImU32 kBlended = IM_COL32(255, 200, 60, 255), kLine = IM_COL32(255, 200, 60, 110);
  const int shade = dot.faces ? 170 : 80;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (dot.blended) list.AddLine(centre, dot.place, kLine);
  if (dot.faces || dot.blended)
    list.AddCircleFilled(dot.place, kDotRadius, dot.blended ? kBlended : IM_COL32(shade, shade, shade, 255));
  else
    list.AddCircle(dot.place, kDotRadius, IM_COL32(shade, shade, shade, 255));
  if (chosen) list.AddCircle(dot.place, 2.0f * kDotRadius, IM_COL32(90, 160, 255, 255));
}

/// Of those that face the camera, the one under the mouse.
std::optional<int> dotUnderMouse(const std::vector<DirectionDot>& dots) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  float nearest = 8.0f * 8.0f;
  std::optional<int> found;
  for (const DirectionDot& dot : dots) {
    const float x = mouse.x - dot.place.x, y = mouse.y - dot.place.y;
    if (!dot.faces || x * x + y * y >= nearest) continue;
    nearest = x * x + y * y;
    found = dot.direction;
  }
  return found;
}

/// The directions of the table as the camera sees them; the four around the line of sight to the middle are
/// bright. A click chooses one.
void drawSphere(ViewState& state, DirectionSet set) {
  const Scene& scene = state.latest->scene;
  const float radius = kSphereRadius * ImGui::GetFontSize() / 13.0f;
  const ImVec2 low = ImGui::GetCursorScreenPos();
  const ImVec2 centre(low.x + radius + 8.0f, low.y + radius + 4.0f);
  ImGui::InvisibleButton("sphere", {2.0f * radius + 16.0f, 2.0f * radius + 8.0f});
  const bool clicked = ImGui::IsItemClicked();
  ImGui::GetWindowDrawList()->AddCircle(centre, radius, IM_COL32(110, 110, 110, 255), 48);
  const glm::dvec3 toEye = towardsEye(scene, *state.camera);
  std::optional<DirectionBlend> blend;
  if (toEye != glm::dvec3(0.0)) blend = bilinearDirections(set, toEye);
  const auto dots = placeDots(scene, *state.camera, set, blend, centre, radius);
  for (const DirectionDot& dot : dots) drawDot(dot, centre, dot.direction == state.diagnosis.direction);
  if (const auto chosen = clicked ? dotUnderMouse(dots) : std::nullopt) {
    state.diagnosis.direction = *chosen;
    state.changed = true;
  }
  for (std::size_t i = 0; blend && i < blend->directions.size(); ++i) {
    if (blend->weights[i] <= 0.0) continue;
    const glm::dvec3 d = directionAt(set, blend->directions[i]);
    ImGui::Text("%.0f %%  towards %g, %g, %g", 100.0 * blend->weights[i], d.x, d.y, d.z);
  }
}

void drawTableControls(ViewState& state) {
  Diagnosis& diagnosis = state.diagnosis;
  const DirectionSet set = state.method.table().directions;
  state.changed |= ImGui::SliderInt("direction", &diagnosis.direction, 0, directionCount(set) - 1);
  diagnosis.direction = std::clamp(diagnosis.direction, 0, directionCount(set) - 1);
  if (diagnosis.shown != Shown::TableSlice) return;
  state.changed |= ImGui::Combo("across", &diagnosis.axis, "x\0y\0z\0");
  auto place = float(diagnosis.place);
  if (ImGui::SliderFloat("at", &place, 0.0f, 1.0f)) {
    diagnosis.place = double(place);
    state.changed = true;
  }
}

void drawBlockControls(ViewState& state) {
  bool kept = state.diagnosis.chosenFor.has_value();
  if (ImGui::Checkbox("keep the choice, look from elsewhere", &kept)) {
    state.diagnosis.chosenFor = kept ? state.camera : std::nullopt;
    state.changed = true;
  }
  if (ImGui::IsItemHovered())
    ImGui::SetTooltip("Blocks stay those of this camera; dark red is what it leaves out.");
  const std::vector<std::uint64_t>& drawn = state.latest->cut.drawn;
  for (std::size_t level = 0; level < drawn.size(); ++level) {
    if (drawn[level] == 0) continue;
    const float size = ImGui::GetFontSize();
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImGui::GetWindowDrawList()->AddRectFilled(corner, {corner.x + size, corner.y + size},
                                              shownColor(levelColor(int(level)), 1.0f));
    ImGui::Dummy({size, size});
    ImGui::SameLine();
    ImGui::Text("%llu of %d^3 voxels", static_cast<unsigned long long>(drawn[level]), 1 << level);
  }
}

void drawComparison(ViewState& state) {
  static constexpr std::array kNames{"nothing", "sorted back to front", "the paper's method", "exact rays",
                                     "every voxel, no culling"};
  int chosen = state.comparison;
  if (!ImGui::BeginCombo("beside it", kNames[std::size_t(chosen)])) return;
  for (int i = 0; i < int(kNames.size()); ++i)
    if (ImGui::Selectable(kNames[std::size_t(i)], i == chosen)) {
      state.comparison = i;
      state.changed = true;
    }
  ImGui::EndCombo();
}

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MiB", double(bytes) / double(1 << 20));
}

void drawFigures(const Picture& picture) {
  if (!ImGui::TreeNode("Times, memory, counts")) return;
  const auto line = [](const std::string& name, const std::string& value) {
    ImGui::TextUnformatted(name.c_str());
    ImGui::SameLine(0.6f * ImGui::GetContentRegionAvail().x);
    ImGui::TextUnformatted(value.c_str());
  };
  for (const StageTime& time : picture.times)
    line(time.name + (time.onDevice ? " (device)" : ""), fmt::format("{:.2f} ms", time.milliseconds));
  ImGui::Separator();
  const VolumeMemory& memory = picture.memory;
  line("extinction", megabytes(memory.extinction + memory.occupancy));
  line("table", megabytes(memory.table - memory.unseen));
  line("colours, light", megabytes(memory.colors + memory.emission));
  line("lists, splats", megabytes(memory.lists + memory.splats));
  ImGui::Separator();
  if (picture.visibleVoxels) line("voxels", fmt::format("{}", *picture.visibleVoxels));
  line("considered", fmt::format("{}", picture.cut.considered));
  line("empty", fmt::format("{}", picture.cut.empty));
  line("outside", fmt::format("{}", picture.cut.outside));
  line("hidden", fmt::format("{}", picture.cut.hidden));
  std::uint64_t splats = 0;
  for (const std::uint64_t count : picture.cut.drawn) splats += count;
  line("splats", fmt::format("{}", splats));
  ImGui::TreePop();
}

}  // namespace

void drawInspectPanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Inspect") || !state.latest || !state.camera) return;
  Diagnosis& diagnosis = state.diagnosis;
  int shown = int(diagnosis.shown);
  if (ImGui::Combo(
          "show", &shown,
          "the picture\0E, what is seen\0transmittance, exp(-T)\0blocks by level\0slice of the table\0"
          "table on the volume\0")) {
    diagnosis.shown = Shown(shown);
    state.changed = true;
  }
  if (diagnosis.shown == Shown::Picture) drawComparison(state);
  if (diagnosis.shown == Shown::Blocks) drawBlockControls(state);
  if (diagnosis.shown == Shown::TableSlice || diagnosis.shown == Shown::TablePicture)
    drawTableControls(state);
  drawSphere(state, state.method.table().directions);
  drawFigures(*state.latest);
}

}  // namespace freevoxels
