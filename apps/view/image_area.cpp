#include "apps/view/image_area.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/actions.h"
#include "apps/view/keys.h"
#include "apps/view/navigation.h"
#include "apps/view/transfer_model.h"
#include "apps/view/ui_painter.h"
#include "apps/view/widgets.h"
#include "engine/volume/subject.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

constexpr double kDollyPerNotch = 0.9;
constexpr double kFlightPerSecond = 0.5;  // of the box's longest edge
constexpr float kSplitReach = 8.0f;       // of the mouse, to take the split
constexpr float kCheckEdge = 12.0f;       // of the squares behind what is transparent

constexpr std::array kFlightKeys{GLFW_KEY_D, GLFW_KEY_A, GLFW_KEY_E, GLFW_KEY_Q, GLFW_KEY_W, GLFW_KEY_S};

double longestEdge(const Volume& volume) {
  const glm::dmat3 axes(volume.indexToWorld);
  double longest = 0.0;
  for (int axis = 0; axis < 3; ++axis)
    longest = std::max(longest, glm::length(axes[axis]) * volume.dimensions[axis]);
  return longest;
}

/// What is transparent shows as squares.
void drawChecks(const ImageFrame& frame) {
  const auto [low, high] = frame;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, IM_COL32(38, 38, 38, 255));
  for (float y = low.y; y < high.y; y += kCheckEdge)
    for (float x = low.x + (int((y - low.y) / kCheckEdge) % 2 != 0 ? kCheckEdge : 0.0f); x < high.x;
         x += 2 * kCheckEdge)
      list.AddRectFilled({x, y}, {std::min(x + kCheckEdge, high.x), std::min(y + kCheckEdge, high.y)},
                         IM_COL32(46, 46, 46, 255));
}

/// The other method's image, right of the split.
void drawCompared(const Texture& texture, float part, bool isOpaque, const ImageFrame& frame) {
  const auto [low, high] = frame;
  const float split = low.x + part * (high.x - low.x);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect({split, low.y}, high, true);
  if (!isOpaque) drawChecks(frame);
  list.AddImage(textureId(texture), low, high);
  list.PopClipRect();
  list.AddLine({split, low.y}, {split, high.y}, IM_COL32(255, 200, 60, 255), 2.0f);
}

/// `isOpaque`: the textures are, so that nothing behind them is seen.
void drawTextures(const ShownTextures& textures, float split, bool isOpaque, const ImageFrame& frame) {
  if (textures.image == nullptr || !isOpaque) drawChecks(frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const bool fades = textures.before != nullptr && textures.weight < 1.0f;
  if (fades) list.AddImage(textureId(*textures.before), frame.low, frame.high);
  const auto alpha = fades ? ImU32(255.0f * textures.weight) : 255u;
  if (textures.image != nullptr)
    list.AddImage(textureId(*textures.image), frame.low, frame.high, {0.0f, 0.0f}, {1.0f, 1.0f}, IM_COL32(255, 255, 255, alpha));
  if (textures.compared != nullptr) drawCompared(*textures.compared, split, isOpaque, frame);
}

/// Moves the values under the curves of the transfer function: to the right a wider window, upwards a lower level, as on the
/// console of a scanner. False if there is no transfer function.
bool changeWindow(ViewState& state, glm::dvec2 way) {
  ClassificationDescription& look = state.scene.classification;
  if ((!look.transferFunction && !look.window) || !state.latest) return false;
  const Volume& volume = *state.latest->scene.volume;
  const ValueWindow all{volume.minimum, volume.maximum};
  const double width = all.high - all.low;
  if (way == glm::dvec2(0.0) || !(width > 0.0)) return true;
  attempt(state, [&] {
    if (!look.window) look.window = windowOf(readTransferCurves(*look.transferFunction), volume);
    look.window = movedWindow(*look.window, all, {way.x * width, -way.y * width});
    state.changed = true;
  });
  return true;
}

}  // namespace

Camera framedVolume(const ViewState& state) {
  const double aspect = double(state.scene.camera.size.x) / double(state.scene.camera.size.y);
  Subject subject = contentOf(*state.latest->scene.volume, state.latest->scene.classification);
  subject.centre = imageCentre(*state.camera, subject);
  return framed(*state.camera, subject, aspect);
}

void ImageArea::press(ViewState& state, const ShownTextures& textures, const ImageFrame& frame) {
  const float split = frame.low.x + state.split * frame.size().x;
  const std::optional<int> axis =
      state.overlays.axes && ImGui::IsMouseDown(ImGuiMouseButton_Left) ? axisUnderMouse(*state.camera, frame) : std::nullopt;
  const ClipHandles handles(state, frame);
  const ClipHandles::Handle* const clip = ImGui::IsMouseDown(ImGuiMouseButton_Left) ? handles.hovered() : nullptr;
  held_ = Held::Camera;
  const bool mayTakeLight = ImGui::IsMouseDown(ImGuiMouseButton_Left) && state.latest && !state.scene.lighting.unlit;
  if (const auto light = mayTakeLight ? lightUnderMouse(state, frame) : std::nullopt) {
    held_ = Held::Light;
    light_ = {*light, state.scene.lighting.lights[*light].light.place, {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}};
  } else if (clip != nullptr) {
    held_ = Held::Clip;
    const InputDescription& input = state.scene.input;
    clip_ = {clip->side, clip->step, {ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y}, input.clipBox, input.clipPlane};
  } else if (axis) {
    held_ = Held::Axes;
    state.setCamera(alongAxis(*state.camera, state.pole, *axis));
  } else if (textures.compared != nullptr && std::abs(ImGui::GetIO().MousePos.x - split) < kSplitReach) {
    held_ = Held::Split;
  }
}

/// The side follows the mouse along its axis, and the plane along its normal.
void ImageArea::dragClip(ViewState& state) const {
  const glm::vec2 way = glm::vec2(ImGui::GetIO().MousePos.x, ImGui::GetIO().MousePos.y) - clip_.mouse;
  const float length = glm::dot(clip_.step, clip_.step);
  if (length <= 0.0f) return;
  const double voxels = double(glm::dot(way, clip_.step) / length);
  const InputDescription& now = state.scene.input;
  if (clip_.side == ClipHandles::kPlane) {
    if (!now.clipPlane) return;
    ClipPlane plane = *clip_.plane;
    plane.point += voxels * state.latest->scene.volume->voxelSize() * glm::normalize(plane.normal);
    if (plane.point != now.clipPlane->point) state.clip(now.clipBox, plane);
  } else if (now.clipBox && state.latest->whole) {
    const VoxelBox box = withSideMoved(*clip_.box, clip_.side, int(std::lround(voxels)), state.latest->whole->dimensions);
    if (box.first != now.clipBox->first || box.last != now.clipBox->last) state.clip(box, now.clipPlane);
  }
}

/// The light follows the mouse at its distance from the eye.
void ImageArea::dragLight(ViewState& state, const ImageFrame& frame) const {
  std::vector<LightingDescription::GivenLight>& lights = state.scene.lighting.lights;
  if (light_.number >= lights.size() || !state.latest) return;
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const glm::dvec2 way(mouse.x - light_.mouse.x, light_.mouse.y - mouse.y);
  const double step = std::pow(10.0, std::floor(std::log10(state.latest->scene.volume->voxelSize())) - 1.0);
  glm::dvec3 place = light_.place + wayBeside(state.latest->scene.camera, light_.place, way, double(frame.size().y));
  for (int c = 0; c < 3; ++c) place[c] = roundedTo(place[c], step);
  if (place == lights[light_.number].light.place || way == glm::dvec2(0.0)) return;
  lights[light_.number].light.place = place;
  state.changed = true;
}

void ImageArea::drag(ViewState& state, const ImageFrame& frame) {
  const ImGuiIO& io = ImGui::GetIO();
  const glm::dvec2 way = glm::dvec2(io.MouseDelta.x, -io.MouseDelta.y) / double(frame.size().y);
  const bool left = ImGui::IsMouseDown(ImGuiMouseButton_Left);
  if (way == glm::dvec2(0.0)) return;
  if (ImGui::IsMouseDown(ImGuiMouseButton_Middle) || (left && io.KeyShift)) {
    state.setCamera(panned(*state.camera, way));
  } else if (ImGui::IsMouseDown(ImGuiMouseButton_Right)) {
    if (io.KeyShift || !changeWindow(state, way)) state.setCamera(turned(*state.camera, state.pole, way));
  } else if (left && io.KeyCtrl) {
    state.setCamera(dollied(*state.camera, std::exp(-4.0 * way.y)));
  } else if (left) {
    state.setCamera(orbited(*state.camera, state.pole, way));
    turned_ = true;
  }
}

void ImageArea::fly(ViewState& state) {
  // A key that is still down after a shortcut or after text was not pressed to fly.
  const bool free = keysAreFree() && !ImGui::GetIO().KeyCtrl;
  for (std::size_t i = 0; i < kFlightKeys.size(); ++i) {
    const bool pressed = flies_[i] || isKeyPressed(kFlightKeys[i]);
    flies_[i] = free && pressed && isKeyDown(kFlightKeys[i]);
  }
  glm::dvec3 way{double(flies_[0]) - double(flies_[1]), double(flies_[2]) - double(flies_[3]),
                 double(flies_[4]) - double(flies_[5])};
  if (way == glm::dvec3(0.0) || !state.latest) return;
  moves_ = true;
  const double pace = ImGui::GetIO().KeyShift ? 4.0 : 1.0;
  way *=
      pace * kFlightPerSecond * longestEdge(*state.latest->scene.volume) * double(ImGui::GetIO().DeltaTime);
  state.setCamera(flown(*state.camera, way));
}

void ImageArea::draw(ViewState& state, const ShownTextures& textures) {
  const ImGuiIO& io = ImGui::GetIO();
  const ImVec2 low = ImGui::GetCursorScreenPos(), room = ImGui::GetContentRegionAvail();
  pixels_ = glm::max(
      glm::ivec2(glm::vec2(room.x * io.DisplayFramebufferScale.x, room.y * io.DisplayFramebufferScale.y)),
      glm::ivec2(0));
  moves_ = false;
  if (room.x < 1.0f || room.y < 1.0f) return;
  const ImageFrame frame{low, {low.x + room.x, low.y + room.y}};
  drawTextures(textures, state.split, textures.isOpaque && state.look().background.has_value(), frame);
  constexpr ImGuiButtonFlags kAnyButton = ImGuiButtonFlags_MouseButtonLeft |
                                          ImGuiButtonFlags_MouseButtonMiddle |
                                          ImGuiButtonFlags_MouseButtonRight;
  ImGui::InvisibleButton("image", room, kAnyButton);
  if (!state.camera) return;
  const bool hovered = ImGui::IsItemHovered();
  drawOverlays(state, frame);
  if (ImGui::IsItemActivated())
    press(state, textures, frame);  // a motion of this frame was before the press
  else if (ImGui::IsItemActive() && held_ == Held::Camera)
    drag(state, frame);
  else if (ImGui::IsItemActive() && held_ == Held::Clip)
    dragClip(state);
  else if (ImGui::IsItemActive() && held_ == Held::Light)
    dragLight(state, frame);
  else if (ImGui::IsItemActive() && held_ == Held::Split)
    state.split = std::clamp((io.MousePos.x - low.x) / room.x, 0.0f, 1.0f);
  moves_ = ImGui::IsItemActive() && held_ == Held::Camera;
  if (hovered && io.MouseWheel != 0.0f) state.setCamera(dollied(*state.camera, std::pow(kDollyPerNotch, double(io.MouseWheel))));
  fly(state);
}

}  // namespace freevoxels
