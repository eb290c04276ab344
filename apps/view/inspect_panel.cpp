#include "apps/view/inspect_panel.h"

#include <fmt/format.h>
#include <imgui.h>
#include <algorithm>
#include <optional>
#include <vector>

#include "apps/view/diagnosis.h"
#include "apps/view/widgets.h"
#include "engine/scene/directions.h"

namespace freevoxels {

namespace {

constexpr double kMinThreshold = 1e-5, kMaxThreshold = 0.1;

/// What is not given comes to.
struct Usual {
  TableSettings table;
  SplatSettings splats;
  double lod = 0.0;
};

Usual usualOf(bool paper) {
  const MethodDescription none{.paper = paper, .draw = Draw::Splats};
  FrameSettings frame;
  none.apply(frame);
  return {.table = none.table(), .splats = frame.splats(), .lod = double(frame.lod)};
}

bool drawPaper(MethodDescription& method) {
  bool paper = method.paper;
  if (!tick("As in the paper", paper)) {
    hint("Subr et al. 2007: additive, nearest, no gradient", "--paper");
    return false;
  }
  method = {.paper = paper, .cullThreshold = method.cullThreshold, .hierarchyFilter = method.hierarchyFilter};
  return true;
}

bool drawTable(MethodDescription& method, const TableSettings& usual) {
  bool changed = choose("Directions", kDirectionWords, method.directions, usual.directions);
  hint("Of the attenuation table; 98 are more exact, and take more memory and time", "--directions");
  changed |= choose("Code", kCodeWords, method.code, usual.code);
  hint("What a byte of the table holds: optical depth, or transmittance", "--code");
  changed |= choose("Block mean", kHierarchyFilterWords, method.hierarchyFilter, usual.filter);
  hint("Mean of the transmittances of a block's voxels", "--hierarchy-filter");
  changed |= tick("Path length corr.", method.pathLengthCorrection, usual.pathLengthCorrection);
  hint("A diagonal step counts its full length", "--path-length-correction");
  return changed;
}

bool drawDetail(MethodDescription& method, const Usual& usual) {
  bool changed = tick("Gradient in splats", method.gradient, usual.splats.gradient);
  hint("Transmittance varies across a splat", "--gradient");
  changed |= slideOptional("Level of detail", method.lod, usual.lod, 0.0, 8.0, "%.2g px");
  hint("Blocks up to so many pixels wide are drawn as one", "--lod");
  changed |= tick("Culling", method.culling, usual.splats.culling);
  hint("Leaves out blocks outside of the image, and the rest of rays that nothing shows behind", "--culling");
  ImGui::BeginDisabled(!method.culling.value_or(usual.splats.culling));
  double threshold = std::max(method.cullThreshold.value_or(double(GatherSettings{}.endTransmittance)), kMinThreshold);
  if (slideLogarithmic("Cull threshold", threshold, kMinThreshold, kMaxThreshold)) {
    method.cullThreshold = threshold;
    changed = true;
  }
  hint("Share of the light that reaches the eye, below which blocks are left out and rays end", "--cull-threshold");
  ImGui::EndDisabled();
  return changed;
}

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

/// The direction under the mouse, among those that face the camera.
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
  const DirectionSet set = state.scene.method.table().directions;
  state.changed |= ImGui::SliderInt(beginRow("Direction"), &diagnosis.direction, 0, directionCount(set) - 1);
  diagnosis.direction = std::clamp(diagnosis.direction, 0, directionCount(set) - 1);
  if (diagnosis.shown != Shown::TableSlice) return;
  state.changed |= ImGui::Combo(beginRow("Across"), &diagnosis.axis, "x\0y\0z\0");
  auto place = float(diagnosis.place);
  if (ImGui::SliderFloat(beginRow("At"), &place, 0.0f, 1.0f)) {
    diagnosis.place = double(place);
    state.changed = true;
  }
}

void drawBlockControls(ViewState& state) {
  bool kept = state.diagnosis.chosenFor.has_value();
  if (checkBox("Keep the cut, look from elsewhere", &kept)) {
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
    ImGui::Text("%llu of %d³ voxels", static_cast<unsigned long long>(drawn[level]), 1 << level);
  }
}

void drawComparison(ViewState& state) {
  state.changed |=
      choose("Compare with", {"nothing", "sorted splats", "the paper's method", "splats", "every voxel, no culling"}, state.comparison);
}

std::string megabytes(std::uint64_t bytes) {
  return fmt::format("{:.1f} MiB", double(bytes) / double(1 << 20));
}

void drawFigures(const DrawnImage& drawn) {
  if (!ImGui::TreeNode("Times, memory, counts")) return;
  const auto line = [](const std::string& name, const std::string& value) {
    const float gap = ImGui::GetStyle().ItemSpacing.x, width = ImGui::CalcTextSize(value.c_str()).x;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const float right = low.x + ImGui::GetContentRegionAvail().x;
    ImGui::PushClipRect(low, {right - width - gap, low.y + ImGui::GetTextLineHeightWithSpacing()}, true);  // a long name ends there
    ImGui::TextUnformatted(name.c_str());
    ImGui::PopClipRect();
    ImGui::SetCursorScreenPos({right - width, low.y});
    ImGui::TextUnformatted(value.c_str());
  };
  for (const StageTime& time : drawn.times)
    line(time.name + (time.onDevice ? " (device)" : ""), fmt::format("{:.2f} ms", time.milliseconds));
  ImGui::Separator();
  const VolumeMemory& memory = drawn.memory;
  line("extinction", megabytes(memory.extinction + memory.occupancy));
  line("table", megabytes(memory.table));
  line("colours, light", megabytes(memory.colors + memory.emission));
  line("lists, splats", megabytes(memory.lists + memory.splats));
  ImGui::Separator();
  if (drawn.visibleVoxels) line("voxels", fmt::format("{}", *drawn.visibleVoxels));
  if (drawn.request.scene.method.drawing() != Draw::Splats) return ImGui::TreePop();
  line("considered", fmt::format("{}", drawn.cut.considered));
  line("empty", fmt::format("{}", drawn.cut.empty));
  line("outside", fmt::format("{}", drawn.cut.outside));
  line("hidden", fmt::format("{}", drawn.cut.hidden));
  std::uint64_t splats = 0;
  for (const std::uint64_t count : drawn.cut.drawn) splats += count;
  line("splats", fmt::format("{}", splats));
  ImGui::TreePop();
}

/// The choice of the renderer's method, and of what it shows in its place.
void drawMethod(ViewState& state) {
  if (!ImGui::TreeNode("Method")) return;
  MethodDescription& method = state.scene.method;
  bool changed = choose("Draw", kDrawWords, method.draw, method.drawing());
  hint("By gathering samples along rays, or by splats, as the paper does", "--draw");
  if (method.draw == Draw::Gather) {
    method.paper = false;
    method.composite.reset();
    method.attenuation.reset();
    method.draw.reset();
  }
  changed |= drawPaper(method);
  const Usual usual = usualOf(method.paper);
  changed |= choose("Composite", kCompositeWords, method.composite, usual.splats.composite);
  hint("How splats become an image; sorted is classic splatting", "--composite");
  const bool sorted = method.composite == Composite::Sorted;
  ImGui::BeginDisabled(sorted);
  changed |= choose("Attenuation", kAttenuationWords, method.attenuation, usual.splats.attenuation);
  hint("Transmittance of splats to the eye: from four directions of the table, or its nearest one", "--attenuation");
  changed |= drawDetail(method, usual);
  ImGui::EndDisabled();
  changed |= drawTable(method, usual.table);
  if (ImGui::Button("Back to the defaults")) {
    method = {};
    changed = true;
  }
  ImGui::TreePop();
  state.changed |= changed;
}

}  // namespace

void drawInspectPanel(ViewState& state) {
  if (!ImGui::CollapsingHeader("Inspect") || !state.latest || !state.camera) return;
  ImGui::PushID("inspect");
  Diagnosis& diagnosis = state.diagnosis;
  int shown = int(diagnosis.shown);
  if (ImGui::Combo(
          beginRow("Show"), &shown,
          "image\0energy E\0transmittance, exp(-T)\0blocks by level\0slice of the table\0"
          "table on the volume\0")) {
    diagnosis.shown = Shown(shown);
    state.changed = true;
  }
  if (diagnosis.shown == Shown::Image) drawComparison(state);
  if (diagnosis.shown == Shown::Blocks) drawBlockControls(state);
  if (diagnosis.shown == Shown::TableSlice || diagnosis.shown == Shown::TableImage)
    drawTableControls(state);
  heading("Directions of the attenuation table, from the eye");
  drawSphere(state, state.scene.method.table().directions);
  drawMethod(state);
  drawFigures(*state.latest);
  ImGui::PopID();
}

}  // namespace freevoxels
