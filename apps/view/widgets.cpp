#include "apps/view/widgets.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "apps/view/typed_text.h"
#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

constexpr float kLabelWidth = 8.2f, kNumberWidth = 5.0f;  // in units of the font's size

std::string rowName;
ImVec2 labelLow, labelHigh;  // of the last row

/// As many digits as a slider shows, so that a command line stays short.
double withFewDigits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  return roundedTo(value, std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0));
}

/// `name` is a widget's, after beginRow(). The number is beside the slider, where its grab does not hide it, and can be typed.
bool slideBy(const char* name, double& value, double low, double high, const char* format,
             ImGuiSliderFlags flags) {
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x, width = ImGui::CalcItemWidth();
  const float number = std::min(kNumberWidth * ImGui::GetFontSize(), 0.5f * width);
  double slid = value, typed = value;
  static double lastTyped = 0.0;  // of the one field in which something is typed
  ImGui::BeginGroup();
  ImGui::PushID(name);
  ImGui::SetNextItemWidth(std::max(width - number - gap, 1.0f));
  const bool isSlid =
      ImGui::SliderScalar("##slider", ImGuiDataType_Double, &slid, &low, &high, "",
                          flags | ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat | ImGuiSliderFlags_NoInput);
  ImGui::SameLine(0.0f, gap);
  ImGui::SetNextItemWidth(number);
  if (ImGui::InputScalar("##number", ImGuiDataType_Double, &typed, nullptr, nullptr, format, ImGuiInputTextFlags_AutoSelectAll))
    lastTyped = typed;
  const bool isTyped = ImGui::IsItemDeactivatedAfterEdit();
  ImGui::PopID();
  ImGui::EndGroup();
  if (isTyped && std::isfinite(lastTyped)) slid = std::clamp(lastTyped, low, high);
  if (isSlid) slid = withFewDigits(slid);
  if ((!isSlid && !isTyped) || slid == value) return false;
  value = slid;
  return true;
}

bool editColorBy(const char* name, glm::dvec3& linear, ImGuiColorEditFlags flags) {
  const double brightness = std::max({linear.r, linear.g, linear.b, 1.0});
  glm::vec3 shown(linear / brightness);
  for (int c = 0; c < 3; ++c) shown[c] = srgbFromLinear(shown[c]);
  if (!ImGui::ColorEdit3(name, &shown.x, flags)) return false;
  for (int c = 0; c < 3; ++c) linear[c] = roundedTo(brightness * double(linearFromSrgb(shown[c])), 1e-4);
  return true;
}

/// The letters that were typed since the last frame. No blanks, since the space bar chooses the entry that has the focus.
std::string typedLetters() {
  const ImGuiIO& io = ImGui::GetIO();
  std::string letters;
  if (io.KeyCtrl || io.KeyAlt) return letters;
  for (const ImWchar letter : io.InputQueueCharacters)
    if (letter > ' ' && letter < 0x7f) letters += char(letter);
  return letters;
}

/// Makes the last item the one that the arrows go on from and that Enter chooses, and shows it as that.
void focusLastItem() {
  ImGui::SetKeyboardFocusHere(-1);
#if IMGUI_VERSION_NUM >= 19140  // older ones show it by themselves
  ImGui::SetNavCursorVisible(true);
#endif
}

}  // namespace

const char* beginRow(const char* label) {
  const float width = kLabelWidth * ImGui::GetFontSize(), height = ImGui::GetFrameHeight();
  labelLow = ImGui::GetCursorScreenPos();
  labelHigh = {labelLow.x + width, labelLow.y + height};
  const std::string_view shown = std::string_view(label).substr(0, std::string_view(label).find("##"));
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown.data(), shown.data() + shown.size());
  ImGui::SameLine();
  ImGui::SetCursorScreenPos({labelHigh.x, labelLow.y});
  ImGui::SetNextItemWidth(-1.0f);
  rowName = std::string("##") + label;
  return rowName.c_str();
}

void heading(const char* text) {
  ImGui::Spacing();
  ImGui::TextDisabled("%s", text);
}

void hint(const char* text, const char* option) {
  const bool label = ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(labelLow, labelHigh) &&
                     ImGui::GetItemRectMin().y == labelLow.y;
  if (!label && !ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(24.0f * ImGui::GetFontSize());
  ImGui::TextUnformatted(text);
  if (option != nullptr) ImGui::TextDisabled("%s", option);
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void drawSentence(const std::string& sentence, bool good) {
  if (sentence.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text, good ? ImVec4(0.6f, 0.85f, 0.6f, 1.0f) : ImVec4(1.0f, 0.55f, 0.45f, 1.0f));
  ImGui::TextWrapped("%s", sentence.c_str());
  ImGui::PopStyleColor();
}

std::string meantFile(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  const std::string name = text.substr(first, text.find_last_not_of(' ') + 1 - first);
  const char* const home = std::getenv("HOME");
  return name.starts_with("~/") && home != nullptr ? home + name.substr(1) : name;
}

std::uint32_t shownColor(glm::dvec3 linear, float alpha) {
  const glm::vec3 cut(glm::clamp(linear, 0.0, 1.0));
  return ImGui::ColorConvertFloat4ToU32(
      {srgbFromLinear(cut.r), srgbFromLinear(cut.g), srgbFromLinear(cut.b), alpha});
}

bool editColor(const char* label, glm::dvec3& linear) {
  return editColorBy(beginRow(label), linear, ImGuiColorEditFlags_None);
}

bool editSwatch(const char* name, glm::dvec3& linear) {
  return editColorBy(name, linear, ImGuiColorEditFlags_NoInputs);
}

bool slide(const char* label, double& value, double low, double high, const char* format) {
  return slideBy(beginRow(label), value, low, high, format, ImGuiSliderFlags_None);
}

bool slideLogarithmic(const char* label, double& value, double low, double high, const char* format) {
  return slideBy(beginRow(label), value, low, high, format, ImGuiSliderFlags_Logarithmic);
}

bool slideWhole(const char* label, int& value, int low, int high, const std::string& shown, bool isLogarithmic) {
  const char* const name = beginRow(label);
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x, width = ImGui::CalcItemWidth();
  const float text = std::min(kNumberWidth * ImGui::GetFontSize(), 0.5f * width);
  const ImGuiSliderFlags flags = isLogarithmic ? ImGuiSliderFlags_Logarithmic : ImGuiSliderFlags_None;
  ImGui::BeginGroup();
  ImGui::SetNextItemWidth(std::max(width - text - gap, 1.0f));
  const bool changed = ImGui::SliderInt(name, &value, low, high, "", flags | ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoInput);
  ImGui::SameLine(0.0f, gap);
  ImGui::AlignTextToFramePadding();
  ImGui::TextUnformatted(shown.c_str());
  ImGui::EndGroup();
  return changed;
}

bool slideOptional(const char* label, std::optional<double>& value, double usual, double low, double high,
                   const char* format) {
  double slid = value.value_or(usual);
  if (!slide(label, slid, low, high, format)) return false;
  value = slid;
  if (slid == usual) value.reset();
  return true;
}

bool dragVector(const char* label, glm::dvec3& value, double step) {
  if (!ImGui::DragScalarN(beginRow(label), ImGuiDataType_Double, &value.x, 3, float(step), nullptr, nullptr, "%.3g",
                          ImGuiSliderFlags_NoRoundToFormat))
    return false;
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(value[c])) value[c] = 0.0;
  const double digits = std::pow(10.0, std::floor(std::log10(step)) - 1.0);
  for (int c = 0; c < 3; ++c) value[c] = roundedTo(value[c], digits);
  return true;
}

void drawEntries(const std::vector<std::string>& entries, std::size_t chosen, const std::function<void(std::size_t)>& draw) {
  static TypedText typed;  // of the one combo box that is open
  static std::size_t current = 0;
  if (ImGui::IsWindowAppearing()) {
    typed = {};
    current = chosen;
  }
  const std::optional<std::size_t> found = typed.find(entries, current, typedLetters(), ImGui::GetTime());
  for (std::size_t i = 0; i < entries.size(); ++i) {
    draw(i);
    if (i == chosen) ImGui::SetItemDefaultFocus();
    if (i == found) focusLastItem();
    if (ImGui::IsItemFocused()) current = i;
  }
  if (found) current = *found;  // which has the focus from the next frame on
}

bool choose(const char* label, const std::vector<std::string>& words, int& value) {
  const int before = value;
  if (!ImGui::BeginCombo(beginRow(label), words[std::size_t(before)].c_str())) return false;
  drawEntries(words, std::size_t(before), [&](std::size_t i) {
    if (ImGui::Selectable(words[i].c_str(), int(i) == before)) value = int(i);
  });
  ImGui::EndCombo();
  return value != before;
}

bool panelHeader(const char* name, bool hasImage, bool isOpenAtFirst) {
  if (hasImage) return ImGui::CollapsingHeader(name, isOpenAtFirst ? ImGuiTreeNodeFlags_DefaultOpen : ImGuiTreeNodeFlags_None);
  ImGui::BeginDisabled();
  ImGui::PushID("without an image");
  ImGui::CollapsingHeader(name, ImGuiTreeNodeFlags_Leaf);
  ImGui::PopID();
  ImGui::EndDisabled();
  return false;
}

bool checkBox(const char* label, bool* value) {
  ImGui::PushStyleVar(ImGuiStyleVar_FrameBorderSize, 1.0f);
  ImGui::PushStyleColor(ImGuiCol_Border, {0.55f, 0.55f, 0.57f, 1.0f});  // 4.4 times as light as the panel
  const bool changed = ImGui::Checkbox(label, value);
  ImGui::PopStyleColor();
  ImGui::PopStyleVar();
  return changed;
}

bool tick(const char* label, bool& value) {
  ImGui::SetCursorPosX(ImGui::GetCursorPosX() + kLabelWidth * ImGui::GetFontSize());
  return checkBox(label, &value);
}

bool tick(const char* label, std::optional<bool>& value, bool usual) {
  bool ticked = value.value_or(usual);
  if (!tick(label, ticked)) return false;
  value = ticked;
  if (ticked == usual) value.reset();
  return true;
}

bool editText(const char* label, std::string& text, const char* whenEmpty) {
  ImGui::InputTextWithHint(beginRow(label), whenEmpty, &text);
  return ImGui::IsItemDeactivatedAfterEdit();
}

bool AutomaticSlider::draw(const char* label, const char* meaning, const char* option, std::optional<double>& value,
                           std::optional<double> automatic, const char* format) {
  if (automatic) middle_ = automatic;
  if (!middle_ && value) middle_ = value;
  const double middle = middle_ && *middle_ > 0.0 ? *middle_ : 1.0;
  double slid = value.value_or(middle);
  const float reset = value ? ImGui::CalcTextSize("auto").x + 2.0f * ImGui::GetStyle().FramePadding.x : 0.0f;
  const char* const name = beginRow(label);
  if (value) ImGui::SetNextItemWidth(-reset - ImGui::GetStyle().ItemInnerSpacing.x);
  bool changed = slideBy(name, slid, middle / factor_, middle * factor_, format, ImGuiSliderFlags_Logarithmic);
  hint(meaning, option);
  if (changed) value = slid;
  if (value) {
    ImGui::PushID(label);
    ImGui::SameLine(0.0f, ImGui::GetStyle().ItemInnerSpacing.x);
    if (ImGui::Button("auto")) {
      value.reset();
      changed = true;
    }
    hint("Back to what suits this volume");
    ImGui::PopID();
  }
  return changed;
}

}  // namespace freevoxels
