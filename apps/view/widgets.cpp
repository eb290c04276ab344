#include "apps/view/widgets.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

#include "engine/image/srgb.h"

namespace freevoxels {

namespace {

constexpr float kLabelWidth = 10.5f;  // of the font's size

/// As many digits as a slider shows, so that a command line stays short.
double withFewDigits(double value) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  return roundedTo(value, std::pow(10.0, std::floor(std::log10(std::abs(value))) - 3.0));
}

bool slideBy(const char* label, double& value, double low, double high, const char* format,
             ImGuiSliderFlags flags) {
  double slid = value;
  if (!ImGui::SliderScalar(label, ImGuiDataType_Double, &slid, &low, &high, format,
                           flags | ImGuiSliderFlags_AlwaysClamp | ImGuiSliderFlags_NoRoundToFormat))
    return false;
  slid = withFewDigits(slid);
  if (slid == value) return false;
  value = slid;
  return true;
}

}  // namespace

double roundedTo(double value, double step) {
  const double steps = std::round(value / step);
  return step < 1.0 ? steps / std::round(1.0 / step) : steps * std::round(step);
}

LabelRoom::LabelRoom() {
  ImGui::PushItemWidth(-kLabelWidth * ImGui::GetFontSize());
}

LabelRoom::~LabelRoom() {
  ImGui::PopItemWidth();
}

void hint(const char* text) {
  if (ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled)) ImGui::SetTooltip("%s", text);
}

std::uint32_t shownColor(glm::dvec3 linear, float alpha) {
  const glm::vec3 cut(glm::clamp(linear, 0.0, 1.0));
  return ImGui::ColorConvertFloat4ToU32(
      {srgbFromLinear(cut.r), srgbFromLinear(cut.g), srgbFromLinear(cut.b), alpha});
}

bool editColor(const char* label, glm::dvec3& linear) {
  const double brightness = std::max({linear.r, linear.g, linear.b, 1.0});
  glm::vec3 shown(linear / brightness);
  for (int c = 0; c < 3; ++c) shown[c] = srgbFromLinear(shown[c]);
  if (!ImGui::ColorEdit3(label, &shown.x)) return false;
  for (int c = 0; c < 3; ++c) linear[c] = roundedTo(brightness * double(linearFromSrgb(shown[c])), 1e-4);
  return true;
}

bool slide(const char* label, double& value, double low, double high, const char* format) {
  return slideBy(label, value, low, high, format, ImGuiSliderFlags_None);
}

bool slideLogarithmic(const char* label, double& value, double low, double high, const char* format) {
  return slideBy(label, value, low, high, format, ImGuiSliderFlags_Logarithmic);
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
  if (!ImGui::DragScalarN(label, ImGuiDataType_Double, &value.x, 3, float(step), nullptr, nullptr, "%.3g",
                          ImGuiSliderFlags_NoRoundToFormat))
    return false;
  for (int c = 0; c < 3; ++c)
    if (!std::isfinite(value[c])) value[c] = 0.0;
  const double digits = std::pow(10.0, std::floor(std::log10(step)) - 1.0);
  for (int c = 0; c < 3; ++c) value[c] = roundedTo(value[c], digits);
  return true;
}

bool choose(const char* label, const std::vector<std::string>& words, int& value) {
  bool changed = false;
  if (!ImGui::BeginCombo(label, words[std::size_t(value)].c_str())) return false;
  for (int i = 0; i < int(words.size()); ++i)
    if (ImGui::Selectable(words[std::size_t(i)].c_str(), i == value) && i != value) {
      value = i;
      changed = true;
    }
  ImGui::EndCombo();
  return changed;
}

bool choose(const char* label, const std::vector<std::string>& words, std::optional<int>& value, int usual) {
  int chosen = value.value_or(usual);
  if (!choose(label, words, chosen)) return false;
  value = chosen;
  if (chosen == usual) value.reset();
  return true;
}

bool tick(const char* label, std::optional<bool>& value, bool usual) {
  bool ticked = value.value_or(usual);
  if (!ImGui::Checkbox(label, &ticked)) return false;
  value = ticked;
  if (ticked == usual) value.reset();
  return true;
}

bool editText(const char* label, std::string& text, const char* whenEmpty) {
  ImGui::InputTextWithHint(label, whenEmpty, &text);
  return ImGui::IsItemDeactivatedAfterEdit();
}

bool smallButtonAtRight(const char* label) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float width = ImGui::CalcTextSize(label, nullptr, true).x + 2.0f * style.FramePadding.x;
  ImGui::SameLine(ImGui::GetContentRegionMax().x - width);
  return ImGui::SmallButton(label);
}

bool AutomaticSlider::draw(const char* label, const char* meaning, std::optional<double>& value,
                           std::optional<double> automatic) {
  if (automatic) middle_ = automatic;
  if (!middle_ && value) middle_ = value;
  const double middle = middle_ && *middle_ > 0.0 ? *middle_ : 1.0;
  double slid = value.value_or(middle);
  bool changed = slideLogarithmic(label, slid, middle / factor_, middle * factor_);
  hint(meaning);
  if (changed) value = slid;
  if (value) {
    ImGui::PushID(label);
    if (smallButtonAtRight("auto")) {
      value.reset();
      changed = true;
    }
    hint("Back to what suits this volume");
    ImGui::PopID();
  }
  return changed;
}

}  // namespace freevoxels
