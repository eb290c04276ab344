#include "apps/view/clip_panel.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/view/widgets.h"
#include "engine/scene/camera.h"
#include "engine/volume/subject.h"

namespace freevoxels {

namespace {

bool drawBox(VoxelBox& box, glm::ivec3 last) {
  bool changed = false;
  for (int axis = 0; axis < 3; ++axis) {
    constexpr std::array kLabels{"Voxels in x", "Voxels in y", "Voxels in z"};
    int first = box.first[axis], end = std::min(box.last[axis], last[axis]);
    changed |= ImGui::DragIntRange2(beginRow(kLabels[std::size_t(axis)]), &first, &end, 0.3f, 0, last[axis], "%d", "%d",
                                    ImGuiSliderFlags_AlwaysClamp);
    hint("First and last voxel that is drawn; drag a number", "--clip-box");
    box.first[axis] = first;
    box.last[axis] = std::max(first, end);
  }
  return changed;
}

/// Through the middle of the volume, with the axis that points most towards the eye as its normal.
ClipPlane firstPlane(const Volume& volume, const Camera& camera) {
  const glm::dvec3 towardsEye = camera.position - camera.lookAt, size = glm::abs(towardsEye);
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
  ClipPlane plane{.point = boxOf(volume).centre, .normal = glm::dvec3(0.0)};
  plane.normal[axis] = towardsEye[axis] < 0.0 ? -1.0 : 1.0;
  return plane;
}

/// Sets the normal to one of the axes, towards the eye, or the other way round.
bool drawNormals(ClipPlane& plane, const Camera& camera) {
  static constexpr std::array kNames{"x", "y", "z", "eye", "flip"};
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  bool changed = false;
  beginRow("Normal");
  for (std::size_t i = 0; i < kNames.size(); ++i) {
    if (i > 0) ImGui::SameLine(0.0f, gap);
    if (!ImGui::SmallButton(kNames[i])) continue;
    changed = true;
    if (i < 3) {
      plane.normal = glm::dvec3(0.0);
      plane.normal[int(i)] = 1.0;
    } else {
      plane.normal = i == 3 ? glm::round(1e4 * glm::normalize(camera.position - camera.lookAt)) / 1e4 : -plane.normal;
    }
  }
  hint("Turns the plane across an axis, towards the eye, or the other way round", "--clip-plane");
  return changed;
}

/// Azimuth and elevation about `up` in degrees, as of orbitDirection.
bool slideAngles(ClipPlane& plane, glm::dvec3 up) {
  const glm::dmat3 axes(orbitDirection(up, 90.0, 0.0), glm::normalize(up), orbitDirection(up, 0.0, 0.0));
  const glm::dvec3 normal = glm::normalize(plane.normal) * axes;
  double azimuth = glm::degrees(std::atan2(normal.x, normal.z)), elevation = glm::degrees(std::asin(std::clamp(normal.y, -1.0, 1.0)));
  bool changed = slide("Azimuth", azimuth, -180.0, 180.0, "%.0f°");
  hint("Of the plane's normal, about the direction that is up", "--clip-plane");
  changed |= slide("Elevation", elevation, -89.0, 89.0, "%.0f°");
  hint("Of the plane's normal", "--clip-plane");
  if (changed) plane.normal = glm::round(1e4 * orbitDirection(up, azimuth, elevation)) / 1e4;  // a command line stays short
  return changed;
}

/// The plane's distance from the middle of the volume, in world units.
bool slideOffset(ClipPlane& plane, const Volume& volume) {
  const glm::dvec3 normal = glm::normalize(plane.normal), centre = boxOf(volume).centre;
  const glm::dvec3 reach = glm::abs(normal * glm::dmat3(volume.indexToWorld)) * glm::dvec3(volume.dimensions);
  const double most = 0.5 * (reach.x + reach.y + reach.z), now = glm::dot(normal, plane.point - centre);
  double offset = now;
  const bool changed = slide("Offset", offset, -most, most, "%.3g");
  hint("How far the plane is from the middle of the volume along its normal; its handle can be dragged in the image", "--clip-plane");
  if (changed) plane.point += (offset - now) * normal;
  return changed;
}

bool drawPlane(ClipPlane& plane, const Volume& volume, const Camera& camera) {
  ImGui::PushID("plane");
  bool changed = slideOffset(plane, volume);
  changed |= slideAngles(plane, camera.up);
  changed |= drawNormals(plane, camera);
  ImGui::PopID();
  return changed;
}

/// Two boxes to tick in one row: `box` begins as the whole volume, `plane` cuts it in its middle.
bool drawTicks(std::optional<VoxelBox>& box, std::optional<ClipPlane>& plane, const ViewState& state) {
  bool hasBox = box.has_value(), hasPlane = plane.has_value();
  beginRow("Clip");
  const bool boxTicked = checkBox("box", &hasBox);
  hint("Draws only the voxels in a box, whose sides can be dragged in the image", "--clip-box");
  ImGui::SameLine(0.0f, ImGui::GetFontSize());
  const bool planeTicked = checkBox("plane", &hasPlane);
  hint("Draws only what is behind a plane, which can be dragged in the image", "--clip-plane");
  if (boxTicked) box = hasBox ? std::optional(VoxelBox{glm::ivec3(0), state.latest->whole->dimensions - 1}) : std::nullopt;
  if (planeTicked) plane = hasPlane ? std::optional(firstPlane(*state.latest->scene.volume, *state.camera)) : std::nullopt;
  return boxTicked || planeTicked;
}

}  // namespace

void drawClipping(ViewState& state) {
  if (!state.latest || !state.camera || !state.latest->whole) return;
  std::optional<VoxelBox> box = state.scene.input.clipBox;
  std::optional<ClipPlane> plane = state.scene.input.clipPlane;
  bool changed = drawTicks(box, plane, state);
  if (box) changed |= drawBox(*box, state.latest->whole->dimensions - 1);
  if (plane) changed |= drawPlane(*plane, *state.latest->scene.volume, *state.camera);
  if (changed) state.clip(box, plane);
}

}  // namespace freevoxels
