#include "apps/view/overlays.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "apps/common/annotation.h"
#include "apps/view/transfer_model.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr std::array kAxisColors{IM_COL32(224, 96, 88, 255), IM_COL32(124, 196, 96, 255), IM_COL32(92, 148, 240, 255)};
/// Colours of lines and letters, of what is behind them, and of the box.
struct Ink {
  ImU32 line, shade, box;
};
constexpr Ink kLightInk{IM_COL32(235, 235, 240, 255), IM_COL32(0, 0, 0, 150), IM_COL32(200, 205, 215, 110)};
constexpr Ink kDarkInk{IM_COL32(24, 24, 28, 255), IM_COL32(255, 255, 255, 150), IM_COL32(60, 62, 68, 150)};
constexpr ImU32 kPlaneColor = IM_COL32(240, 200, 80, 255);
constexpr float kHandle = 9.0f;     // reach of the mouse, in units
constexpr float kMinSlope = 0.15f;  // sine of the angle between a plane's normal and the view from which its handle follows the normal
constexpr float kGap = 0.5f;        // least distance between overlays, in units of the font's size
// In units: the middle of the axes from the image's corner, how far they reach from there, and the distance of the bars from its borders.
constexpr float kAxesMiddle = 52.0f, kAxesReach = 44.0f, kBarMargin = 18.0f;
constexpr float kLongestScaleBar = 140.0f, kScaleBarShare = 0.35f;  // in units, and of the image's width
constexpr float kHighestColorBar = 220.0f, kColorBarShare = 0.4f;   // in units, and of the image's height

float unit() {
  return ImGui::GetFontSize() / 15.0f;
}

/// Legible on the background.
const Ink& inkOn(const std::optional<glm::dvec3>& background) {
  constexpr double kBright = 0.2;  // linear luminance
  return background && glm::dot(*background, glm::dvec3(0.2126, 0.7152, 0.0722)) > kBright ? kDarkInk : kLightInk;
}

/// Legible on any image.
void drawText(ImDrawList& list, ImVec2 place, const Ink& ink, const std::string& text) {
  list.AddText({place.x + 1.0f, place.y + 1.0f}, ink.shade, text.c_str());
  list.AddText(place, ink.line, text.c_str());
}

/// An end of the axes in the corner.
struct AxisEnd {
  int axis = 0;  ///< 0 to 5
  ImVec2 place;
  double nearness = 0.0;
};

std::array<AxisEnd, 6> axisEnds(const Camera& camera, const ImageFrame& frame, ImVec2& centre) {
  const float length = 34.0f * unit();
  centre = {frame.low.x + kAxesMiddle * unit(), frame.high.y - kAxesMiddle * unit()};
  const glm::dmat3 toCamera(worldToCamera(camera));
  std::array<AxisEnd, 6> ends;
  for (int i = 0; i < 6; ++i) {
    const glm::dvec3 seen = toCamera[i / 2] * (i % 2 == 0 ? 1.0 : -1.0);
    ends[std::size_t(i)] = {i, {centre.x + length * float(seen.x), centre.y - length * float(seen.y)}, seen.z};
  }
  std::ranges::sort(ends, {}, &AxisEnd::nearness);
  return ends;
}

OverlayRoom roomOf(const ImageFrame& frame) {
  return OverlayRoom(frame, kGap * ImGui::GetFontSize());
}

bool takeAxes(OverlayRoom& room, const ImageFrame& frame) {
  const float near = (kAxesMiddle - kAxesReach) * unit(), far = (kAxesMiddle + kAxesReach) * unit();
  return room.take({frame.low.x + near, frame.high.y - far}, {frame.low.x + far, frame.high.y - near});
}

/// False where there is no room for them.
bool drawAxes(const Camera& camera, const ImageFrame& frame, const Ink& ink, OverlayRoom& room) {
  if (!takeAxes(room, frame)) return false;
  constexpr std::array kNames{"x", "y", "z"};
  ImVec2 centre;
  const auto ends = axisEnds(camera, frame, centre);
  const std::optional<int> hovered = axisUnderMouse(camera, frame);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float radius = 8.0f * unit();
  for (const AxisEnd& end : ends) {
    const ImU32 color = kAxisColors[std::size_t(end.axis / 2)];
    const bool positive = end.axis % 2 == 0;
    if (positive) list.AddLine(centre, end.place, color, 2.0f * unit());
    list.AddCircleFilled(end.place, radius, positive ? color : IM_COL32(40, 42, 48, 200));
    if (!positive) list.AddCircle(end.place, radius, (color & 0x00FFFFFF) | 0xB0000000);
    if (hovered == end.axis) list.AddCircle(end.place, radius + 1.5f, ink.line, 0, 2.0f);
    if (!positive) continue;
    const char* const name = kNames[std::size_t(end.axis / 2)];
    const ImVec2 text = ImGui::CalcTextSize(name);
    list.AddText({end.place.x - 0.5f * text.x, end.place.y - 0.55f * text.y}, IM_COL32(20, 20, 24, 255), name);
  }
  return true;
}

/// A corner of the volume's box in the world; bits 0 to 2 of `i` say whether it is the last one along x, y and z.
glm::dvec3 boxCorner(const Volume& volume, int i) {
  const glm::dvec3 index = glm::dvec3(i & 1, i >> 1 & 1, i >> 2 & 1) * glm::dvec3(volume.dimensions) - 0.5;
  return glm::dvec3(volume.indexToWorld * glm::dvec4(index, 1.0));
}

/// The box of what is drawn, without voxels. The volume of a draft is not clipped.
Volume shownBox(const DrawnImage& drawn) {
  const Volume& volume = *drawn.scene.volume;
  Volume box{.source = volume.source, .dimensions = volume.dimensions};
  box.indexToWorld = volume.indexToWorld;
  const std::optional<VoxelBox>& clipped = drawn.request.scene.input.clipBox;
  if (!clipped || drawn.whole != drawn.scene.volume) return box;
  box.dimensions = glm::min(clipped->last, volume.dimensions - 1) - clipped->first + 1;
  box.indexToWorld[3] = volume.indexToWorld * glm::dvec4(glm::dvec3(clipped->first), 1.0);
  return box;
}

void drawPlane(const Volume& volume, const ClipPlane& plane, const Camera& camera, const ImageFrame& frame) {
  std::vector<ImVec2> places;
  for (const glm::dvec3 corner : planeInBox(volume, plane))
    if (const auto place = frame.place(camera, corner)) places.push_back(*place);
  ImGui::GetWindowDrawList()->AddPolyline(places.data(), int(places.size()), kPlaneColor, ImDrawFlags_Closed, 1.5f * unit());
}

void drawBox(const Volume& volume, const Camera& camera, const ImageFrame& frame, const Ink& ink) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const auto corner = [&](int i) { return boxCorner(volume, i); };
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if ((i >> axis & 1) != 0) continue;
      const auto from = frame.place(camera, corner(i)), to = frame.place(camera, corner(i | 1 << axis));
      if (from && to) list.AddLine(*from, *to, i == 0 ? kAxisColors[std::size_t(axis)] : ink.box, i == 0 ? 2.0f : 1.0f);
    }
}

/// The world coordinates of two opposite corners of the volume's box, where there is room for them.
void drawCorners(const Volume& volume, const Camera& camera, const ImageFrame& frame, const Ink& ink, OverlayRoom& room) {
  for (const int i : {0, 7}) {
    const glm::dvec3 world = boxCorner(volume, i);
    const auto corner = frame.place(camera, world);
    if (!corner) continue;
    const std::string text = fmt::format("{:.3g}, {:.3g}, {:.3g}", world.x, world.y, world.z);
    const ImVec2 low(corner->x + 5.0f, corner->y + 2.0f), size = ImGui::CalcTextSize(text.c_str());
    if (room.take(low, {low.x + size.x, low.y + size.y})) drawText(*ImGui::GetWindowDrawList(), low, ink, text);
  }
}

/// False where there is no room for it.
bool drawScaleBar(const Camera& camera, const ImageFrame& frame, const std::string& lengthUnit, const Ink& ink, OverlayRoom& room) {
  const double pixel = pixelLength(camera, double(frame.size().y));
  const double length = roundLength(double(std::min(kLongestScaleBar * unit(), kScaleBarShare * frame.size().x)) * pixel);
  const auto width = float(length / pixel);
  const std::string text =
      !lengthUnit.empty() ? lengthText(length, lengthUnit) : fmt::format("{:g} {}", length, length == 1.0 ? "unit" : "units");
  const float textWidth = ImGui::CalcTextSize(text.c_str()).x;
  // Of a text that is longer than the bar, the right end is at the margin.
  const ImVec2 end(frame.high.x - kBarMargin * unit() - 0.5f * std::max(textWidth - width, 0.0f), frame.high.y - kBarMargin * unit());
  const ImVec2 textLow(end.x - 0.5f * (width + textWidth), end.y - 1.5f * ImGui::GetFontSize());
  if (!room.take({std::min(textLow.x, end.x - width), textLow.y}, {std::max(textLow.x + textWidth, end.x), end.y})) return false;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (const auto& [shift, color] : {std::pair(1.0f, ink.shade), std::pair(0.0f, ink.line)}) {
    const ImVec2 right(end.x + shift, end.y + shift), left(right.x - width, right.y);
    list.AddLine(left, right, color, 2.0f);
    for (const ImVec2 at : {left, right}) list.AddLine({at.x, at.y - 5.0f}, {at.x, at.y + 1.0f}, color, 2.0f);
  }
  drawText(list, textLow, ink, text);
  return true;
}

/// The colours of the transfer function with the values of its ends and middle. False where there is no room for them.
bool drawColorBar(const ViewState& state, const ImageFrame& frame, const Ink& ink, OverlayRoom& room) {
  const auto& function = state.latest->scene.classification.transferFunction;
  if (!function) return true;
  const float height = std::min(kHighestColorBar * unit(), kColorBarShare * frame.size().y), width = 12.0f * unit();
  const float toText = 6.0f * unit(), text = ImGui::GetFontSize();
  const ImVec2 low(frame.high.x - kBarMargin * unit() - width, frame.low.y + kBarMargin * unit());
  const double least = std::min(function->opacity.front().scalar, function->color.front().scalar);
  const double span = double(std::max(function->opacity.back().scalar, function->color.back().scalar)) - least;
  std::array<std::string, 3> values;
  float widest = 0.0f;
  for (std::size_t i = 0; i < values.size(); ++i) {
    values[i] = fmt::format("{:.4g}", least + 0.5 * double(i) * span);
    widest = std::max(widest, ImGui::CalcTextSize(values[i].c_str()).x);
  }
  if (!room.take({low.x - toText - widest, low.y - 0.5f * text}, {low.x + width, low.y + height + 0.5f * text})) return false;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  TransferModel model;
  for (const auto& [scalar, color] : function->color)
    model.color.push_back({span > 0.0 ? (double(scalar) - least) / span : 0.0, glm::dvec3(color)});
  for (float y = 0.0f; y < height; y += 1.0f)
    list.AddRectFilled({low.x, low.y + y}, {low.x + width, low.y + y + 1.0f},
                       shownColor(model.colorAt(1.0 - double(y / height)), 1.0f));
  list.AddRect({low.x - 1.0f, low.y - 1.0f}, {low.x + width + 1.0f, low.y + height + 1.0f}, ink.shade);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const float y = low.y + (1.0f - 0.5f * float(i)) * height;
    drawText(list, {low.x - toText - ImGui::CalcTextSize(values[i].c_str()).x, y - 0.5f * text}, ink, values[i]);
  }
  return true;
}

}  // namespace

std::optional<ImVec2> ImageFrame::place(const Camera& camera, glm::dvec3 world) const {
  const glm::dvec3 seen(worldToCamera(camera) * glm::dvec4(world, 1.0));
  if (!camera.orthographic && seen.z > -1e-6) return std::nullopt;
  const double halfHeight =
      camera.orthographic ? 0.5 * camera.orthographicHeight : -seen.z * std::tan(0.5 * glm::radians(camera.verticalFov));
  const double pixels = 0.5 * double(high.y - low.y) / halfHeight;
  return ImVec2(0.5f * (low.x + high.x) + float(seen.x * pixels), 0.5f * (low.y + high.y) - float(seen.y * pixels));
}

double pixelLength(const Camera& camera, double height) {
  const double length = camera.orthographic ? camera.orthographicHeight
                                            : 2.0 * glm::distance(camera.position, camera.lookAt) *
                                                  std::tan(0.5 * glm::radians(camera.verticalFov));
  return length / height;
}

glm::dvec3 wayBeside(const Camera& camera, glm::dvec3 position, glm::dvec2 pixels, double height) {
  const glm::dmat4 toCamera = worldToCamera(camera);
  const glm::dmat3 toWorld = glm::transpose(glm::dmat3(toCamera));
  double length = pixelLength(camera, height);
  if (!camera.orthographic) length *= -(toCamera * glm::dvec4(position, 1.0)).z / glm::distance(camera.position, camera.lookAt);
  return length * (pixels.x * toWorld[0] + pixels.y * toWorld[1]);
}

std::optional<std::size_t> lightUnderMouse(const ViewState& state, const ImageFrame& frame) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const std::vector<LightingDescription::GivenLight>& lights = state.scene.lighting.lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    if (lights[i].light.atInfinity) continue;
    const auto place = frame.place(state.latest->scene.camera, lights[i].light.place);
    if (place && std::hypot(place->x - mouse.x, place->y - mouse.y) < kHandle * unit()) return i;
  }
  return {};
}

bool OverlayRoom::take(ImVec2 low, ImVec2 high) {
  const bool isWithin = low.x >= frame_.low.x && low.y >= frame_.low.y && high.x <= frame_.high.x && high.y <= frame_.high.y;
  if (!isWithin || 2.0f * (high.x - low.x) > frame_.size().x || 2.0f * (high.y - low.y) > frame_.size().y) return false;
  for (const auto& [otherLow, otherHigh] : taken_)
    if (low.x < otherHigh.x + gap_ && otherLow.x < high.x + gap_ && low.y < otherHigh.y + gap_ && otherLow.y < high.y + gap_) return false;
  taken_.emplace_back(low, high);
  return true;
}

ImageFrame betweenAxesAndScaleBar(const ImageFrame& frame) {
  const float gap = kGap * ImGui::GetFontSize();
  return {{frame.low.x + (kAxesMiddle + kAxesReach) * unit() + gap, frame.low.y},
          {frame.high.x - (kBarMargin + kLongestScaleBar) * unit() - gap, frame.high.y}};
}

std::optional<int> axisUnderMouse(const Camera& camera, const ImageFrame& frame) {
  if (OverlayRoom room = roomOf(frame); !takeAxes(room, frame)) return {};
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  ImVec2 centre;
  const auto ends = axisEnds(camera, frame, centre);
  std::optional<int> found;
  for (const AxisEnd& end : ends)  // the nearest last
    if (std::hypot(end.place.x - mouse.x, end.place.y - mouse.y) <= 9.0f * unit()) found = end.axis;
  return found;
}

std::vector<glm::dvec3> planeInBox(const Volume& volume, const ClipPlane& plane) {
  const glm::dvec3 normal = glm::normalize(plane.normal);
  std::array<glm::dvec3, 8> corners;
  for (int i = 0; i < 8; ++i) corners[std::size_t(i)] = boxCorner(volume, i);
  std::vector<glm::dvec3> points;
  glm::dvec3 middle(0.0);
  for (int i = 0; i < 8; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      if ((i >> axis & 1) != 0) continue;
      const glm::dvec3 from = corners[std::size_t(i)], to = corners[std::size_t(i | 1 << axis)];
      const double before = glm::dot(normal, from - plane.point), behind = glm::dot(normal, to - plane.point);
      if ((before > 0.0) == (behind > 0.0)) continue;
      points.push_back(glm::mix(from, to, before / (before - behind)));
      middle += points.back();
    }
  if (points.empty()) return points;
  middle /= double(points.size());
  const glm::dvec3 right = glm::normalize(glm::cross(normal, std::abs(normal.x) < 0.8 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0)));
  const auto angle = [&](glm::dvec3 point) {
    return std::atan2(glm::dot(glm::cross(normal, right), point - middle), glm::dot(right, point - middle));
  };
  std::ranges::sort(points, {}, angle);
  return points;
}

ClipHandles::ClipHandles(const ViewState& state, const ImageFrame& frame) {
  if (!state.latest) return;
  addBox(state, frame);
  addPlane(state, frame);
}

void ClipHandles::addBox(const ViewState& state, const ImageFrame& frame) {
  if (!state.scene.input.clipBox || !state.latest->request.scene.input.clipBox || !state.latest->whole) return;
  const VoxelBox& box = *state.scene.input.clipBox;
  const glm::dvec3 first(box.first), last(glm::min(box.last, state.latest->whole->dimensions - 1));
  const auto place = [&](glm::dvec3 voxel) {
    return frame.place(state.latest->scene.camera, glm::dvec3(state.latest->whole->indexToWorld * glm::dvec4(voxel, 1.0)));
  };
  for (int side = 0; side < 6; ++side) {
    const int axis = side / 2;
    glm::dvec3 middle = 0.5 * (first + last);
    middle[axis] = side % 2 == 0 ? first[axis] - 0.5 : last[axis] + 0.5;
    glm::dvec3 next = middle;
    next[axis] += 1.0;
    const auto from = place(middle), to = place(next);
    if (from && to) handles.push_back({side, *from, {to->x - from->x, to->y - from->y}});
  }
}

void ClipHandles::addPlane(const ViewState& state, const ImageFrame& frame) {
  if (!state.scene.input.clipPlane) return;
  const ClipPlane& plane = *state.scene.input.clipPlane;
  const Volume volume = shownBox(*state.latest);
  glm::dvec3 middle(0.0);
  const std::vector<glm::dvec3> corners = planeInBox(volume, plane);
  for (const glm::dvec3 corner : corners) middle += corner / double(corners.size());
  if (corners.empty()) middle = plane.point;
  const double voxel = volume.voxelSize();
  const auto from = frame.place(state.latest->scene.camera, middle),
             to = frame.place(state.latest->scene.camera, middle + voxel * glm::normalize(plane.normal));
  const glm::dvec3 cameraUp = glm::transpose(glm::dmat3(worldToCamera(state.latest->scene.camera)))[1];
  const auto beside = frame.place(state.latest->scene.camera, middle + voxel * cameraUp);
  if (!from || !to || !beside) return;
  glm::vec2 step(to->x - from->x, to->y - from->y);
  // Seen along its normal, the plane follows the mouse up and down.
  const glm::vec2 upwards(beside->x - from->x, beside->y - from->y);
  if (glm::length(step) < kMinSlope * glm::length(upwards)) step = upwards;
  handles.push_back({kPlane, *from, step});
}

const ClipHandles::Handle* ClipHandles::hovered() const {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  for (const Handle& handle : handles)
    if (std::hypot(handle.place.x - mouse.x, handle.place.y - mouse.y) < kHandle * unit()) return &handle;
  return nullptr;
}

VoxelBox withSideMoved(const VoxelBox& box, int side, int voxels, glm::ivec3 dimensions) {
  VoxelBox moved{box.first, glm::min(box.last, dimensions - 1)};
  const int axis = side / 2;
  if (side % 2 == 0)
    moved.first[axis] = std::clamp(moved.first[axis] + voxels, 0, moved.last[axis]);
  else
    moved.last[axis] = std::clamp(moved.last[axis] + voxels, moved.first[axis], dimensions[axis] - 1);
  return moved;
}

/// The scene's point lights, as handles.
void drawLights(const ViewState& state, const ImageFrame& frame) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const std::optional<std::size_t> hovered = lightUnderMouse(state, frame);
  const std::vector<LightingDescription::GivenLight>& lights = state.scene.lighting.lights;
  for (std::size_t i = 0; i < lights.size(); ++i) {
    const auto place = lights[i].light.atInfinity ? std::nullopt : frame.place(state.latest->scene.camera, lights[i].light.place);
    if (!place) continue;
    const glm::dvec3& color = lights[i].light.color;
    list.AddCircleFilled(*place, 5.0f * unit(), shownColor(color / std::max({color.r, color.g, color.b, 1e-6}), 1.0f));
    list.AddCircle(*place, 5.0f * unit(), i == hovered ? kLightInk.line : kLightInk.shade, 0, 2.0f);
    constexpr int kRays = 8;
    for (int ray = 0; ray < kRays; ++ray) {
      const float angle = 2.0f * std::numbers::pi_v<float> * float(ray) / kRays, x = std::cos(angle), y = std::sin(angle);
      list.AddLine({place->x + 8.0f * unit() * x, place->y + 8.0f * unit() * y},
                   {place->x + 12.0f * unit() * x, place->y + 12.0f * unit() * y}, kPlaneColor, 2.0f);
    }
  }
}

void drawOverlays(const ViewState& state, const ImageFrame& frame) {
  // What is over the image is seen by the camera of the image, which a newer one may have replaced.
  const Camera& camera = state.latest ? state.latest->scene.camera : *state.camera;
  const Ink& ink = inkOn(state.scene.output.background);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.PushClipRect(frame.low, frame.high, true);
  const bool isVolume = state.latest && state.diagnosis.shown == Shown::Image;
  const ClipHandles clip(state, frame);
  const bool showsBox = state.latest && (state.overlays.box || state.scene.input.clipBox);
  const Volume box = state.latest ? shownBox(*state.latest) : Volume();
  if (showsBox) drawBox(box, camera, frame, ink);
  if (state.latest && state.scene.input.clipPlane) drawPlane(box, *state.scene.input.clipPlane, camera, frame);
  // In the order of their importance: what has no room in a small image is left out, and so is what is less important.
  OverlayRoom room = roomOf(frame);
  bool hasRoom = !state.overlays.axes || drawAxes(camera, frame, ink, room);
  if (hasRoom && state.overlays.scaleBar)
    hasRoom = drawScaleBar(camera, frame, state.latest ? state.latest->scene.volume->lengthUnit : "", ink, room);
  if (hasRoom && state.overlays.colorBar && isVolume) hasRoom = drawColorBar(state, frame, ink, room);
  if (hasRoom && showsBox) drawCorners(box, camera, frame, ink, room);
  if (isVolume && !state.scene.lighting.unlit) drawLights(state, frame);
  const ClipHandles::Handle* const hovered = clip.hovered();
  for (const ClipHandles::Handle& handle : clip.handles) {
    const ImU32 color = handle.side == ClipHandles::kPlane ? kPlaneColor : kAxisColors[std::size_t(handle.side / 2)];
    list.AddCircleFilled(handle.place, 7.0f * unit(), color);
    list.AddCircle(handle.place, 7.0f * unit(), &handle == hovered ? kLightInk.line : kLightInk.shade, 0, 2.0f);
  }
  list.PopClipRect();
}

}  // namespace freevoxels
