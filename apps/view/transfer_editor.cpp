#include "apps/view/transfer_editor.h"

#include <GLFW/glfw3.h>

#include <array>
#include <cmath>

#include "apps/view/keys.h"
#include "apps/view/widgets.h"

namespace freevoxels {

namespace {

constexpr float kHeight = 9.0f;      // of the plot, in units of the font's size
constexpr float kColumn = 2.0f;      // pixels
constexpr ImU32 kGround = IM_COL32(20, 22, 26, 255), kBars = IM_COL32(96, 104, 116, 255), kLines = IM_COL32(255, 255, 255, 28),
                kLineTexts = IM_COL32(255, 255, 255, 200), kCurve = IM_COL32(240, 240, 240, 255), kSelected = IM_COL32(255, 196, 64, 255);

/// Logarithms of counts, relative to the largest that is in view.
void drawHistogram(ImDrawList& list, const Histogram& histogram, const PlotSpan& span, float top,
                   float bottom, glm::dvec2 range) {
  const auto count = [&](float pixel) {
    const glm::dvec2 ends(span.x(pixel), span.x(pixel + kColumn));
    const glm::dvec2 values = range.x + ends * (range.y - range.x);
    return std::log1p(double(histogram.countBetween(values.x, values.y)));
  };
  double most = 1.0;
  for (float pixel = span.low; pixel < span.high; pixel += kColumn) most = std::max(most, count(pixel));
  for (float pixel = span.low; pixel < span.high; pixel += kColumn)
    list.AddRectFilled({pixel, bottom + float(count(pixel) / most) * 0.95f * (top - bottom)},
                       {pixel + kColumn, bottom}, kBars);
}

}  // namespace

bool OpacityCurve::draw(TransferModel& model, glm::dvec2 range, const Histogram* histogram) {
  const float text = ImGui::GetFontSize(), inset = kPointRadius * text;
  const ImVec2 low = ImGui::GetCursorScreenPos(), size(ImGui::GetContentRegionAvail().x, kHeight * text);
  const ImVec2 high(low.x + size.x, low.y + size.y);
  const Frame frame{{low.x + inset, high.x - inset}, low.y + inset, high.y - inset};
  ImGui::InvisibleButton("opacity", size,
                         ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  if (selected_ && *selected_ >= model.opacity.size()) selected_.reset();
  bool changed = handle(model, frame);

  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled(low, high, kGround, ImGui::GetStyle().FrameRounding);
  if (histogram) drawHistogram(list, *histogram, frame.span, frame.top, frame.bottom, range);
  constexpr std::array kMarks{std::pair(0.5, "0.5"), std::pair(0.1, "0.1"), std::pair(0.01, "0.01"), std::pair(0.001, "0.001")};
  for (const auto& [alpha, name] : kMarks) list.AddLine({low.x, frame.y(alpha)}, {high.x, frame.y(alpha)}, kLines);
  for (float pixel = frame.span.low; pixel < frame.span.high; pixel += kColumn) {
    const double x = frame.span.x(pixel);
    list.AddRectFilled({pixel, frame.y(model.alphaAt(x))}, {pixel + kColumn, frame.bottom},
                       shownColor(model.colorAt(x), 0.55f));
  }
  float next = low.y;  // where no other name is
  for (const auto& [alpha, name] : kMarks) {
    if (frame.y(alpha) - text < next) continue;
    const ImVec2 place(low.x + 2.0f, frame.y(alpha) - text);
    list.AddText({place.x + 1.0f, place.y + 1.0f}, kGround, name);
    list.AddText(place, kLineTexts, name);
    next = frame.y(alpha);
  }
  drawPoints(model, frame);
  changed |= drawFields(model, range);
  return changed;
}

bool OpacityCurve::handle(TransferModel& model, const Frame& frame) {
  const ImVec2 mouse = ImGui::GetIO().MousePos;
  const auto place = [&](const auto& point) { return ImVec2(frame.span.at(point.x), frame.y(point.alpha)); };
  const std::optional<std::size_t> hovered = pointUnderMouse(model.opacity, place);
  const double x = frame.span.x(mouse.x), alpha = frame.alpha(mouse.y);
  if (ImGui::IsItemHovered() && !ImGui::IsItemActive())
    ImGui::SetTooltip(hovered ? "Drag to move, right click or Delete to remove" : "Click to add a point");
  if (ImGui::IsItemClicked(ImGuiMouseButton_Right)) return hovered && remove(model, *hovered);
  if (ImGui::IsItemClicked(ImGuiMouseButton_Left)) {
    selected_ = hovered ? *hovered : model.addOpacity(x, alpha);
    return !hovered;
  }
  if (selected_ && ImGui::IsItemHovered() && isKeyPressed(GLFW_KEY_DELETE, true))
    return remove(model, *selected_);
  const bool moved = ImGui::GetIO().MouseDelta.x != 0.0f || ImGui::GetIO().MouseDelta.y != 0.0f;
  if (!selected_ || !moved || !ImGui::IsItemActive() || !ImGui::IsMouseDown(ImGuiMouseButton_Left))
    return false;
  model.moveOpacity(*selected_, x, alpha);
  return true;
}

bool OpacityCurve::remove(TransferModel& model, std::size_t point) {
  selected_.reset();
  return model.removeOpacity(point);
}

void OpacityCurve::drawPoints(const TransferModel& model, const Frame& frame) const {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  for (float pixel = frame.span.low; pixel < frame.span.high; pixel += kColumn)
    list.PathLineTo({pixel, frame.y(model.alphaAt(frame.span.x(pixel)))});
  list.PathStroke(kCurve, 0, 1.5f);
  const float radius = kPointRadius * ImGui::GetFontSize();
  for (std::size_t i = 0; i < model.opacity.size(); ++i) {
    const ImVec2 place(frame.span.at(model.opacity[i].x), frame.y(model.opacity[i].alpha));
    list.AddCircleFilled(place, radius, selected_ == i ? kSelected : kCurve);
    list.AddCircle(place, radius, kGround);
  }
}

/// What a hand is not exact enough for.
bool OpacityCurve::drawFields(TransferModel& model, glm::dvec2 range) {
  if (!selected_) {
    ImGui::AlignTextToFramePadding();
    ImGui::Text("%.4g", range.x);
    const std::string highest = fmt::format("{:.4g}", range.y);
    ImGui::SameLine(ImGui::GetContentRegionMax().x - ImGui::CalcTextSize(highest.c_str()).x);
    ImGui::TextUnformatted(highest.c_str());
    return false;
  }
  const TransferModel::OpacityPoint point = model.opacity[*selected_];
  double value = range.x + point.x * (range.y - range.x), alpha = point.alpha;
  bool changed = ImGui::InputDouble(beginRow("Value"), &value, 0.0, 0.0, "%.4g");
  hint("Of the chosen point");
  changed |= ImGui::InputDouble(beginRow("Opacity"), &alpha, 0.0, 0.0, "%.4g");
  hint("Of a layer as thick as the unit distance");
  const double width = range.y - range.x;  // 0 of a uniform volume
  if (changed) model.moveOpacity(*selected_, width > 0.0 ? (value - range.x) / width : point.x, alpha);
  return changed;
}

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
    list.AddCircleFilled(place, radius, selected_ == i ? kSelected : kCurve);
    list.AddCircleFilled(place, 0.6f * radius, shownColor(model.color[i].color, 1.0f));
    list.AddCircle(place, radius, kGround);
  }
  if (selected_) return editColor("Colour##point", model.color[*selected_].color) || changed;
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
  if (selected_ && ImGui::IsItemHovered() && isKeyPressed(GLFW_KEY_DELETE, true))
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
