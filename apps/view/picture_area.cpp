#include "apps/view/picture_area.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/view/navigation.h"
#include "apps/view/ui_painter.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

constexpr double kDollyPerNotch = 0.9;
constexpr double kFlightPerSecond = 0.5;  // of the box's longest edge
constexpr float kSplitReach = 8.0f;       // of the mouse, to take the split
constexpr float kCheckEdge = 12.0f;       // of the squares behind what is transparent

bool isDown(int key) {
  return ImGui::IsKeyDown(key);
}

double longestEdge(const Volume& volume) {
  const glm::dmat3 axes(volume.indexToWorld);
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, glm::length(axes[axis]) * volume.dimensions[axis]);
  return longest;
}

/// What is transparent shows as squares.
void drawChecks(ImVec2 low, ImVec2 high) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, IM_COL32(38, 38, 38, 255));
  for (float y = low.y; y < high.y; y += kCheckEdge)
    for (float x = low.x + (int((y - low.y) / kCheckEdge) % 2 != 0 ? kCheckEdge : 0.0f); x < high.x;
         x += 2 * kCheckEdge)
      list.AddRectFilled({x, y}, {std::min(x + kCheckEdge, high.x), std::min(y + kCheckEdge, high.y)},
                         IM_COL32(46, 46, 46, 255));
}

/// The other method's picture, right of the split.
void drawCompared(const Texture& texture, float part, ImVec2 low, ImVec2 high) {
  const float split = low.x + part * (high.x - low.x);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({split, low.y}, high, true);
  drawChecks(low, high);
  list.AddImage(textureId(texture), low, high);
  list.PopClipRect();
  list.AddLine({split, low.y}, {split, high.y}, IM_COL32(255, 200, 60, 255), 2.0f);
}

/// The world's axes as the camera sees them, in a corner.
void drawAxes(const Camera& camera, ImVec2 lowerLeft) {
  const float scale = ImGui::GetFontSize() / 13.0f, length = 28.0f * scale;
  const ImVec2 corner(lowerLeft.x + 44.0f * scale, lowerLeft.y - 44.0f * scale);
  constexpr std::array kColors{IM_COL32(230, 90, 80, 255), IM_COL32(120, 200, 90, 255),
                               IM_COL32(90, 140, 240, 255)};
  constexpr std::array kNames{"x", "y", "z"};
  const glm::dmat3 toCamera(worldToCamera(camera));
  std::array<int, 3> order{0, 1, 2};
  std::ranges::sort(order, {}, [&](int axis) { return toCamera[axis].z; });
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const int axis : order) {
    const ImVec2 end(corner.x + length * float(toCamera[axis].x),
                     corner.y - length * float(toCamera[axis].y));
    list.AddLine(corner, end, kColors[std::size_t(axis)], 2.0f);
    list.AddText({end.x + 3.0f * scale, end.y - 7.0f * scale}, kColors[std::size_t(axis)],
                 kNames[std::size_t(axis)]);
  }
}

}  // namespace

void PictureArea::drag(ViewState& state, glm::vec2 size) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::dvec2 way = glm::dvec2(io.MouseDelta.x, -io.MouseDelta.y) / double(size.y);
  const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (way != glm::dvec2(0.0)) {
    if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || (left && io.KeyShift))
      state.look(panned(*state.camera, way));
    else if (ImGui::IsMouseDown(ImGuiMouseButton_Right))
      state.look(turned(*state.camera, way));
    else if (left && io.KeyCtrl)
      state.look(dollied(*state.camera, std::exp(-4.0 * way.y)));
    else if (left)
      state.look(orbited(*state.camera, way));
  }
}

void PictureArea::fly(ViewState& state) {
  glm::dvec3 way(double(isDown(GLFW_KEY_D)) - double(isDown(GLFW_KEY_A)),
                 double(isDown(GLFW_KEY_E)) - double(isDown(GLFW_KEY_Q)),
                 double(isDown(GLFW_KEY_W)) - double(isDown(GLFW_KEY_S)));
  if (way == glm::dvec3(0.0) || !state.latest) return;
  moves_ = true;
  const double pace = ImGui::GetIO().KeyShift ? 4.0 : 1.0;
  way *=
      pace * kFlightPerSecond * longestEdge(*state.latest->scene.volume) * double(ImGui::GetIO().DeltaTime);
  state.look(flown(*state.camera, way));
}

void PictureArea::keys(ViewState& state) const {
  const double aspect = double(state.scene.camera.size.x) / double(state.scene.camera.size.y);
  if (ImGui::IsKeyPressed(GLFW_KEY_F, false) && state.latest) {
    Subject subject = contentOf(*state.latest->scene.volume, state.latest->scene.classification);
    subject.centre = imageCentre(*state.camera, subject);
    state.look(framed(*state.camera, subject, aspect));
  }
  if (ImGui::IsKeyPressed(GLFW_KEY_O, false)) state.look(withOtherProjection(*state.camera));
  for (int axis = 0; axis < 6; ++axis)
    if (ImGui::IsKeyPressed(GLFW_KEY_1 + axis, false)) state.look(alongAxis(*state.camera, axis));
}

void PictureArea::draw(ViewState& state, const Texture* texture, const Texture* compared) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  pixels_ = glm::max(
      glm::ivec2(glm::vec2(room.x * io.DisplayFramebufferScale.x, room.y * io.DisplayFramebufferScale.y)),
      glm::ivec2(0));
  moves_ = false;
  if (room.x < 1.0f || room.y < 1.0f) return;
  const ImVec2 high(low.x + room.x, low.y + room.y);
  drawChecks(low, high);
  if (texture != nullptr) ImGui::GetWindowDrawList()->AddImage(textureId(*texture), low, high);
  if (compared != nullptr) drawCompared(*compared, state.split, low, high);
  constexpr ImGuiButtonFlags kAnyButton = ImGuiButtonFlags_MouseButtonLeft |
                                          ImGuiButtonFlags_MouseButtonMiddle |
                                          ImGuiButtonFlags_MouseButtonRight;
  ImGui::InvisibleButton("picture", room, kAnyButton);
  if (!state.camera) return;
  drawAxes(*state.camera, {low.x, high.y});
  const float split = low.x + state.split * room.x;
  if (ImGui::IsItemActivated())
    splits_ = compared != nullptr && std::abs(io.MousePos.x - split) < kSplitReach;
  moves_ = ImGui::IsItemActive() && !splits_;
  if (ImGui::IsItemActive() && splits_)
    state.split = std::clamp((io.MousePos.x - low.x) / room.x, 0.0f, 1.0f);
  if (moves_) drag(state, {room.x, room.y});
  if (ImGui::IsItemHovered() && io.MouseWheel != 0.0f)
    state.look(dollied(*state.camera, std::pow(kDollyPerNotch, double(io.MouseWheel))));
  if (io.WantTextInput || io.KeyCtrl) return;
  fly(state);
  keys(state);
}

}  // namespace freevoxels
