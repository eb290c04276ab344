#include "apps/view/window_parts.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include "apps/view/overlays.h"
#include "engine/description/scene_description.h"

namespace freevoxels {

namespace {

std::string timeText(const DrawnImage& drawn, bool whole, double perSecond) {
  const std::string often = whole || perSecond == 0.0 ? "" : fmt::format(", {:.0f} images/s", perSecond);
  const glm::ivec2 size = drawn.shown->size();
  return fmt::format("{}   {} × {} px, {:.0f} ms{}", whole ? "complete" : "quick", size.x, size.y, drawn.milliseconds, often);
}

}  // namespace

void beginPart(const char* name, ImVec2 low, ImVec2 size, ImVec2 padding, ImGuiWindowFlags flags) {
  ImGui::SetNextWindowPos(low);
  ImGui::SetNextWindowSize({std::max(size.x, 1.0f), std::max(size.y, 1.0f)});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, padding);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, {1.0f, 1.0f});
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);  // which would hide a part of the image
  ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0.0f);
  ImGui::Begin(name, nullptr, kFixedWindow | flags);
  ImGui::PopStyleVar(4);
}

std::optional<float> drawSplitter(const char* name, float border, float scale, float top, float height) {
  const float width = kSplitterWidth * scale;
  beginPart(name, {border - width, top}, {width, height}, {0.0f, 0.0f}, 0);
  ImGui::InvisibleButton(name, {width, std::max(height, 1.0f)});
  if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
    ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    ImGui::GetWindowDrawList()->AddRectFilled(ImGui::GetItemRectMin(), ImGui::GetItemRectMax(),
                                              ImGui::GetColorU32(ImGuiCol_SliderGrab));
  }
  std::optional<float> dragged;
  if (ImGui::IsItemActive()) dragged = ImGui::GetIO().MousePos.x + 0.5f * width;
  ImGui::End();
  return dragged;
}

void drawStatusBar(const ViewState& state, const Activity& activity, bool cancels, float top, float height) {
  const float width = ImGui::GetIO().DisplaySize.x, text = ImGui::GetFontSize();
  ImGui::PushStyleColor(ImGuiCol_WindowBg, ImGui::GetStyleColorVec4(ImGuiCol_MenuBarBg));
  beginPart("status", {0.0f, top}, {width, height}, {0.6f * text, 0.5f * (height - text)}, ImGuiWindowFlags_NoScrollbar);
  ImGui::PopStyleColor();
  if (!state.problem.empty()) {
    ImGui::TextColored({1.0f, 0.55f, 0.45f, 1.0f}, "%s", state.problem.c_str());
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", state.problem.c_str());
  } else if (activity) {
    ImGui::Text("%s  %.0f %%%s", activity->first.c_str(), 100.0 * activity->second, cancels ? "   (Escape cancels)" : "");
  } else {
    ImGui::TextUnformatted(state.notice.c_str());
  }
  if (state.latest) {
    const std::string time = timeText(*state.latest, state.latest == state.whole, state.imagesPerSecond);
    const float room = ImGui::CalcTextSize(time.c_str()).x + 0.6f * text;
    if (ImGui::GetItemRectMax().x < width - room - text) {
      ImGui::SameLine(width - room);
      ImGui::TextDisabled("%s", time.c_str());
    }
  }
  ImGui::End();
}

void drawTurnHint() {
  const char* const text = "Drag to turn, Shift + drag to pan, wheel to zoom.  F1 lists all keys.";
  const ImVec2 corner = ImGui::GetWindowPos(), size = ImGui::GetWindowSize();
  const ImageFrame free = betweenAxesAndScaleBar({corner, {corner.x + size.x, corner.y + size.y}});
  const float line = 0.85f * ImGui::GetFontSize(), side = 0.6f * line, above = 0.25f * line, width = free.size().x - 2.0f * side;
  if (width < line) return;
  const ImVec2 textSize = ImGui::GetFont()->CalcTextSizeA(line, std::numeric_limits<float>::max(), width, text);
  constexpr float kMostOfHeight = 0.125f;  // below a volume that fills the image as far as it is framed
  const float height = textSize.y + 2.0f * above, bottom = corner.y + size.y - above;
  if (height > kMostOfHeight * size.y) return;
  const float left = std::max(std::min(corner.x + 0.5f * (size.x - textSize.x), free.high.x - side - textSize.x), free.low.x + side);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({left - side, bottom - height}, {left + textSize.x + side, bottom}, IM_COL32(20, 22, 26, 215), 0.5f * line);
  list.AddText(ImGui::GetFont(), line, {left, bottom - height + above}, IM_COL32(235, 235, 240, 255), text, nullptr, width);
}

ImVec2 drawOverImage(const std::string& text, bool hasImage) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  if (hasImage) list.AddRectFilled(low, high, IM_COL32(24, 24, 26, 190));
  const float wrap = 0.8f * (high.x - low.x);
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  const ImVec2 place(0.5f * (low.x + high.x - size.x), 0.5f * (low.y + high.y - size.y));
  list.AddText(ImGui::GetFont(), ImGui::GetFontSize(), place, IM_COL32(235, 235, 238, 255), text.c_str(), nullptr, wrap);
  return {0.5f * (low.x + high.x), place.y + size.y};
}

OtherFile drawOtherFiles(ImVec2 middle, std::vector<std::string> recent, const std::string& failed) {
  constexpr std::size_t kMost = 4;
  constexpr const char* kSample = "procedural:cloud";
  std::erase(recent, failed);
  recent.resize(std::min(recent.size(), kMost));
  if (std::ranges::count(recent, kSample) == 0) recent.emplace_back(kSample);
  OtherFile chosen;
  const float width = 20.0f * ImGui::GetFontSize();
  ImGui::SetCursorScreenPos({middle.x - 0.5f * width, middle.y + ImGui::GetFrameHeight()});
  ImGui::BeginChild("other files", {width, float(kMost + 2) * ImGui::GetFrameHeightWithSpacing()});
  chosen.opensDialog = ImGui::Button("Open... (Ctrl+O)", {-1.0f, 0.0f});
  for (const std::string& file : recent) {
    const std::string label = proceduralName(file) ? file : std::filesystem::path(file).filename().string();
    if (ImGui::Button(fmt::format("{}###{}", label, file).c_str(), {-1.0f, 0.0f})) chosen.file = file;
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", file.c_str());
  }
  ImGui::EndChild();
  return chosen;
}

}  // namespace freevoxels
