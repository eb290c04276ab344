#include "apps/view/slice_view.h"

#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "apps/view/ui_painter.h"
#include "engine/core/error.h"
#include "engine/description/scene_fields.h"
#include "engine/volume/transfer_source.h"

namespace freevoxels {

namespace {

constexpr std::array kColors{IM_COL32(224, 96, 88, 255), IM_COL32(124, 196, 96, 255), IM_COL32(92, 148, 240, 255)};

/// Behind voxels without data, linear.
constexpr glm::vec3 kNoData(0.0052f, 0.0065f, 0.013f);

/// The colours of slices; grey where those of a baked volume cannot be had of its values.
Classification colorsOf(const ClassificationDescription& description, const Volume& volume) {
  try {
    return description.resolveSliced(volume);
  } catch (const Error&) {
    return {.transferFunction = fitted(readTransferCurves(kFunctionOfWindow), volume)};
  }
}

double voxelEdge(const Volume& volume, int axis) {
  return glm::length(glm::dvec3(volume.indexToWorld[axis]));
}

}  // namespace

int upAxis(const Volume& volume) {
  const glm::dvec3 up = glm::abs(glm::transpose(glm::dmat3(volume.indexToWorld)) * volume.up);
  return up.y > up.z ? 1 : 2;
}

glm::ivec2 axesAcross(int axis, int up) {
  const int other = 3 - up;
  return axis == 0 ? glm::ivec2(other, up) : glm::ivec2(0, axis == up ? other : up);
}

char patientSide(const Volume& volume, int axis, bool opposite) {
  if (volume.lengthUnit != "mm" || volume.up != glm::dvec3(0.0, 0.0, 1.0)) return 0;
  const glm::dvec3 direction = glm::dvec3(volume.indexToWorld[axis]) * (opposite ? -1.0 : 1.0), size = glm::abs(direction);
  if (size.x >= size.y && size.x >= size.z) return direction.x > 0.0 ? 'L' : 'R';
  if (size.y >= size.z) return direction.y > 0.0 ? 'P' : 'A';
  return direction.z > 0.0 ? 'S' : 'I';
}

std::vector<std::uint8_t> sliceTexels(const Volume& volume, const Classification& colors, int axis, int voxel) {
  const glm::ivec2 axes = axesAcross(axis, upAxis(volume)), size(volume.dimensions[axes.x], volume.dimensions[axes.y]);
  SlicePixels pixels{.corner = glm::dvec3(-0.5)};
  pixels.corner[axis] = voxel;
  pixels.corner[axes.y] = size.y - 0.5;
  pixels.right[axes.x] = 1.0;
  pixels.down[axes.y] = -1.0;
  return srgbTexels(drawSlice(volume, colors, pixels, size), {.background = Background{kNoData, kNoData}});
}

void SliceView::follow(const ViewState& state) {
  const std::shared_ptr<const Volume>& volume = state.latest->whole ? state.latest->whole : state.latest->scene.volume;
  const ClassificationDescription& classification = state.latest->request.scene.classification;
  const std::string text = textOf({.classification = classification}, {"classification"});
  if (volume == volume_ && text == colorsText_) return;
  colors_ = colorsOf(classification, *volume);
  colorsText_ = text;
  const bool sameBox = volume_ && volume_->dimensions == volume->dimensions;  // as of the frames of a sequence
  volume_ = volume;
  if (!sameBox) voxel_ = volume->dimensions / 2;
  for (Slice& slice : slices_) {
    slice.texture = nullptr;
    if (!sameBox) slice = {};
  }
}

/// `size` is that of the unzoomed slice, `middle` that of its room.
void SliceView::zoom(Slice& slice, ImVec2 middle, ImVec2 size) const {
  const ImGuiIO& io = ImGui::GetIO();
  constexpr float kStep = 1.25f, kMost = 32.0f;
  if (ImGui::IsItemActive() && io.MouseDown[ImGuiMouseButton_Middle]) {
    slice.shift.x += io.MouseDelta.x / size.x;
    slice.shift.y += io.MouseDelta.y / size.y;
  }
  if (!ImGui::IsItemHovered()) return;
  if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) {
    slice.zoom = 1.0f;
    slice.shift = {0.0f, 0.0f};
  }
  if (!io.KeyCtrl || io.MouseWheel == 0.0f) return;
  // What is under the mouse stays there.
  const float before = slice.zoom;
  slice.zoom = std::clamp(before * std::pow(kStep, io.MouseWheel), 1.0f, kMost);
  const ImVec2 mouse((io.MousePos.x - middle.x) / size.x, (io.MousePos.y - middle.y) / size.y);
  slice.shift.x = mouse.x - (mouse.x - slice.shift.x) * slice.zoom / before;
  slice.shift.y = mouse.y - (mouse.y - slice.shift.y) * slice.zoom / before;
}

/// The sides of the patient at the borders of a slice's room.
void SliceView::drawSides(int axis, ImVec2 low, ImVec2 high) const {
  const glm::ivec2 axes = axesAcross(axis, upAxis(*volume_));
  const ImVec2 middle(0.5f * (low.x + high.x), 0.5f * (low.y + high.y)), size = ImGui::CalcTextSize("A");
  const auto draw = [&](char letter, ImVec2 place) {
    if (letter == 0) return;
    const char text[] = {letter, '\0'};
    ImGui::GetWindowDrawList()->AddText({place.x - 0.5f * size.x, place.y - 0.5f * size.y}, IM_COL32(235, 225, 160, 255), text);
  };
  draw(patientSide(*volume_, axes.x, true), {low.x + size.x, middle.y});
  draw(patientSide(*volume_, axes.x, false), {high.x - size.x, middle.y});
  draw(patientSide(*volume_, axes.y, true), {middle.x, high.y - 0.6f * size.y});
  draw(patientSide(*volume_, axes.y, false), {middle.x, low.y + 0.6f * size.y});
}

void SliceView::handle(int axis, const ImageFrame& frame) {
  const glm::ivec2 axes = axesAcross(axis, upAxis(*volume_));
  const ImGuiIO& io = ImGui::GetIO();
  const glm::ivec3 last = volume_->dimensions - 1;
  glm::ivec3 under = voxel_;
  under[axes.x] = int(std::floor((io.MousePos.x - frame.low.x) / frame.size().x * float(volume_->dimensions[axes.x])));
  under[axes.y] = int(std::floor((frame.high.y - io.MousePos.y) / frame.size().y * float(volume_->dimensions[axes.y])));
  const bool inside = glm::clamp(under, glm::ivec3(0), last) == under;
  if (ImGui::IsItemActive() && io.MouseDown[ImGuiMouseButton_Left]) voxel_ = glm::clamp(under, glm::ivec3(0), last);
  if (!ImGui::IsItemHovered()) return;
  if (io.MouseWheel != 0.0f && !io.KeyCtrl) voxel_[axis] = std::clamp(voxel_[axis] + (io.MouseWheel > 0.0f ? 1 : -1), 0, last[axis]);
  if (!inside) return;
  const float value = volume_->scalars.at(under);
  const std::string text = value == kInactiveVoxel ? "no data" : fmt::format("{:.5g}", value);
  ImGui::SetTooltip("voxel %d, %d, %d: %s", under.x, under.y, under.z, text.c_str());
}

/// Fitted into `size` with the proportions of the world.
void SliceView::drawSlice(int axis, ImVec2 size) {
  Slice& slice = slices_[std::size_t(axis)];
  const glm::ivec2 axes = axesAcross(axis, upAxis(*volume_));
  if (!slice.texture || slice.voxel != voxel_[axis]) {
    slice.voxel = voxel_[axis];
    slice.texture = std::make_unique<Texture>(device_, glm::ivec2(volume_->dimensions[axes.x], volume_->dimensions[axes.y]), "slice");
    slice.texture->upload(device_, sliceTexels(*volume_, colors_, axis, slice.voxel));
  }
  const double width = voxelEdge(*volume_, axes.x) * volume_->dimensions[axes.x];
  const double height = voxelEdge(*volume_, axes.y) * volume_->dimensions[axes.y];
  const double pixels = std::min(double(size.x) / width, double(size.y) / height);
  const ImVec2 corner = ImGui::GetCursorScreenPos(), middle(corner.x + 0.5f * size.x, corner.y + 0.5f * size.y);
  const ImVec2 whole(float(pixels * width), float(pixels * height)), zoomed(slice.zoom * whole.x, slice.zoom * whole.y);
  const ImVec2 low(middle.x + slice.shift.x * whole.x - 0.5f * zoomed.x, middle.y + slice.shift.y * whole.y - 0.5f * zoomed.y);
  const ImageFrame frame{low, {low.x + zoomed.x, low.y + zoomed.y}};
  const char* const name = axis == 0 ? "sagittal" : axis == upAxis(*volume_) ? "axial" : "coronal";
  ImGui::InvisibleButton(name, size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonMiddle);
  zoom(slice, middle, whole);
  handle(axis, frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(corner, {corner.x + size.x, corner.y + size.y}, true);
  list.AddImage(textureId(*slice.texture), frame.low, frame.high);
  const auto place = [&](int along, float least, float most) {
    return least + (float(voxel_[along]) + 0.5f) / float(volume_->dimensions[along]) * (most - least);
  };
  const float x = place(axes.x, frame.low.x, frame.high.x), y = place(axes.y, frame.high.y, frame.low.y);
  constexpr ImU32 kAlpha = 0xA0FFFFFF;
  list.AddLine({x, frame.low.y}, {x, frame.high.y}, kColors[std::size_t(axes.x)] & kAlpha);
  list.AddLine({frame.low.x, y}, {frame.high.x, y}, kColors[std::size_t(axes.y)] & kAlpha);
  list.AddRect(frame.low, frame.high, kColors[std::size_t(axis)]);
  const std::string title = fmt::format("{}  {} = {}", name, "xyz"[axis], voxel_[axis]);
  list.AddText({corner.x + 5.0f, corner.y + 2.0f}, kColors[std::size_t(axis)], title.c_str());
  drawSides(axis, corner, {corner.x + size.x, corner.y + size.y});
  list.PopClipRect();
}

void SliceView::draw(const ViewState& state) {
  if (!state.latest) return;
  follow(state);
  const ImVec2 room = ImGui::GetContentRegionAvail();
  const float gap = ImGui::GetStyle().ItemSpacing.y;
  const int up = upAxis(*volume_);
  for (const int axis : {up, 3 - up, 0}) drawSlice(axis, {std::max(room.x, 1.0f), std::max((room.y - 2.0f * gap) / 3.0f, 1.0f)});
}

void SliceView::drawOutlines(const ViewState& state, const ImageFrame& frame) const {
  if (!volume_ || !state.camera) return;
  for (int axis = 0; axis < 3; ++axis) {
    const glm::ivec2 axes = axesAcross(axis, upAxis(*volume_));
    std::array<std::optional<ImVec2>, 4> corners;
    for (int i = 0; i < 4; ++i) {
      glm::dvec3 index;
      index[axis] = voxel_[axis];
      index[axes.x] = (i == 1 || i == 2 ? volume_->dimensions[axes.x] : 0) - 0.5;
      index[axes.y] = (i >= 2 ? volume_->dimensions[axes.y] : 0) - 0.5;
      corners[std::size_t(i)] = frame.place(*state.camera, glm::dvec3(volume_->indexToWorld * glm::dvec4(index, 1.0)));
    }
    for (std::size_t i = 0; i < 4; ++i)
      if (corners[i] && corners[(i + 1) % 4])
        ImGui::GetWindowDrawList()->AddLine(*corners[i], *corners[(i + 1) % 4], kColors[std::size_t(axis)] & 0xB0FFFFFF, 1.5f);
  }
}

}  // namespace freevoxels
