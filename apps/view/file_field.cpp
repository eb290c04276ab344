#include "apps/view/file_field.h"

#include <imgui.h>
#include <imgui_stdlib.h>

#include <cstdlib>

namespace freevoxels {

bool fileField(const char* button, std::string& text, bool focus) {
  const ImGuiStyle& style = ImGui::GetStyle();
  const float buttonWidth = ImGui::CalcTextSize(button).x + 2.0f * style.FramePadding.x;
  ImGui::PushID(button);
  if (focus) {
    ImGui::SetKeyboardFocusHere();
    ImGui::SetScrollHereY();
  }
  ImGui::SetNextItemWidth(-buttonWidth - style.ItemSpacing.x);
  const bool entered = ImGui::InputText(
      "##name", &text, ImGuiInputTextFlags_EnterReturnsTrue | ImGuiInputTextFlags_AutoSelectAll);
  ImGui::SameLine();
  const bool clicked = ImGui::Button(button);
  ImGui::PopID();
  return (entered || clicked) && !meantFile(text).empty();
}

std::string meantFile(const std::string& text) {
  const std::size_t first = text.find_first_not_of(' ');
  if (first == std::string::npos) return "";
  const std::string name = text.substr(first, text.find_last_not_of(' ') + 1 - first);
  const char* const home = std::getenv("HOME");
  return name.starts_with("~/") && home != nullptr ? home + name.substr(1) : name;
}

void drawSentence(const std::string& sentence, bool good) {
  if (sentence.empty()) return;
  ImGui::PushStyleColor(ImGuiCol_Text,
                        good ? ImVec4(0.6f, 0.9f, 0.6f, 1.0f) : ImVec4(1.0f, 0.5f, 0.4f, 1.0f));
  ImGui::TextWrapped("%s", sentence.c_str());
  ImGui::PopStyleColor();
}

}  // namespace freevoxels
