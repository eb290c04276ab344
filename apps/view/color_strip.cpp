#include "apps/view/color_strip.h"

#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr float kColumn = 2.0f;  // pixels
constexpr ImU32 kEdge = IM_COL32(20, 22, 26, 255), kUnselected = IM_COL32(240, 240, 240, 255),
                kSelected = IM_COL32(255, 196, 64, 255);

}  // namespace

bool ColorStrip::draw(TransferModel& model) {
  const float text = ImGui::GetFontSize(), radius = kPointRadius * text;
  const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, 1.8f * text);
  const PlotSpan span{low.x + radius, low.x + size.x - radius};
  const float bottom = low.y + size.y - 2.0f * radius, y = bottom + 0.5f * radius;
  ImGui::InvisibleButton("colours", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  if (selected_ && *selected_ >= model.color.size()) selected_.reset();
  bool changed = handle(model, span, y);

  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (float pixel = span.low; pixel < span.high; pixel += kColumn)
    list.AddRectFilled({pixel, low.y}, {std::min(pixel + kColumn, span.high), bottom},
                       shownColor(model.colorAt(span.x(pixel)), 1.0f));
  for (std::size_t i = 0; i < model.color.size(); ++i) {
    const ImVec2 place(span.at(model.color[i].x), y);
    list.AddCircleFilled(place, radius, selected_ == i ? kSelected : kUnselected);
    list.AddCircleFilled(place, 0.6f * radius, shownColor(model.color[i].color, 1.0f));
    list.AddCircle(place, radius, kEdge);
  }
  if (selected_) return editColor("colour##point", model.color[*selected_].color) || changed;
  ImGui::AlignTextToFramePadding();
  ImGui::TextDisabled(model.color.empty() ? "White. Click the strip to add a colour."
                                          : "Click a point to change its colour.");
  return changed;
}

bool ColorStrip::handle(TransferModel& model, const PlotSpan& span, float y) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto place = [&](const auto& point) { return ImVec2(span.at(point.x), y); };
  const std::optional<std::size_t> hovered = pointUnderMouse(model.color, place);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
    ImGui::SetTooltip(hovered ? "Click to change the colour, drag to move, right click or Delete to remove"
                              : "Click to add a colour");
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) return hovered && remove(model, *hovered);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
    selected_ = hovered ? *hovered : model.addColor(span.x(mouse.x));
    return !hovered;
  }
  if (selected_ && ImGui::IsItemHovered() && ImGui::IsKeyPressed(ImGui::GetKeyIndex(ImGuiKey_Delete)))
    return remove(model, *selected_);
  if (!selected_ || ImGui::GetIO().MouseDelta.x == 0.0f || !ImGui::IsItemActive() ||
      !ImGui::IsMouseDown(ImGuiMouseButton_Left))
    return false;
  model.moveColor(*selected_, span.x(mouse.x));
  return true;
}

bool ColorStrip::remove(TransferModel& model, std::size_t point) {
  selected_.reset();
  return model.removeColor(point);
}

}  // namespace freevoxels
