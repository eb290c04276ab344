#include "apps/view/theme.h"

#include <imgui.h>

#include <cmath>
#include <span>

#include "apps/view/font_files.h"

namespace freevoxels {

namespace {

/// Latin, Greek and Cyrillic with their punctuation, superscripts, arrows and mathematical operators.
constexpr ImWchar kGlyphs[]{0x0020, 0x024F, 0x0370, 0x052F, 0x2010, 0x2027, 0x2070, 0x209F,
                            0x2190, 0x21FF, 0x2200, 0x22FF, 0x25A0, 0x25FF, 0};

void addFont(std::span<const unsigned char> file, float pixels) {
  ImFontConfig config;
  config.FontDataOwnedByAtlas = false;
  // Dear ImGui takes the bytes as its own to change, and leaves them as they are.
  ImGui::GetIO().Fonts->AddFontFromMemoryTTF(const_cast<unsigned char*>(file.data()), int(file.size()), pixels, &config, kGlyphs);
}

ImVec4 grey(float value, float alpha = 1.0f) {
  return {value, value, 1.03f * value, alpha};
}

void setColors(ImGuiStyle& style) {
  const ImVec4 accent(0.28f, 0.45f, 0.70f, 1.0f), bright(0.36f, 0.56f, 0.84f, 1.0f);
  ImVec4* const colors = style.Colors;
  colors[ImGuiCol_Text] = grey(0.88f);
  colors[ImGuiCol_TextDisabled] = grey(0.56f);
  colors[ImGuiCol_WindowBg] = grey(0.155f);
  colors[ImGuiCol_PopupBg] = grey(0.13f, 0.98f);
  colors[ImGuiCol_MenuBarBg] = grey(0.125f);
  colors[ImGuiCol_Border] = grey(0.26f);
  colors[ImGuiCol_FrameBg] = grey(0.225f);
  colors[ImGuiCol_FrameBgHovered] = grey(0.28f);
  colors[ImGuiCol_FrameBgActive] = grey(0.32f);
  colors[ImGuiCol_TitleBg] = colors[ImGuiCol_TitleBgActive] = grey(0.20f);
  colors[ImGuiCol_CheckMark] = bright;
  colors[ImGuiCol_SliderGrab] = accent;
  colors[ImGuiCol_SliderGrabActive] = bright;
  colors[ImGuiCol_Button] = grey(0.29f);
  colors[ImGuiCol_ButtonHovered] = grey(0.36f);
  colors[ImGuiCol_ButtonActive] = accent;
  colors[ImGuiCol_Header] = grey(0.21f);
  colors[ImGuiCol_HeaderHovered] = grey(0.27f);
  colors[ImGuiCol_HeaderActive] = grey(0.31f);
  colors[ImGuiCol_Separator] = grey(0.24f);
  colors[ImGuiCol_ResizeGrip] = grey(0.30f, 0.0f);
  colors[ImGuiCol_ScrollbarBg] = grey(0.155f);
  colors[ImGuiCol_PlotHistogram] = accent;
  colors[ImGuiCol_TextSelectedBg] = {accent.x, accent.y, accent.z, 0.6f};
  colors[ImGuiCol_ModalWindowDimBg] = {0.0f, 0.0f, 0.0f, 0.45f};
}

}  // namespace

void applyTheme(float scale) {
  const float pixels = std::round(kFontPixels * scale);
  addFont(sansFont(), pixels);
  addFont(monospacedFontFile(), std::round(0.86f * pixels));
  ImGui::StyleColorsDark();
  ImGuiStyle& style = ImGui::GetStyle();
  setColors(style);
  style.WindowPadding = {10.0f, 8.0f};
  style.FramePadding = {7.0f, 3.0f};
  style.ItemSpacing = {7.0f, 5.0f};
  style.ItemInnerSpacing = {6.0f, 4.0f};
  style.IndentSpacing = 14.0f;
  style.ScrollbarSize = 12.0f;
  style.GrabMinSize = 9.0f;
  style.FrameRounding = style.GrabRounding = style.PopupRounding = 3.0f;
  style.WindowRounding = 4.0f;
  style.ScaleAllSizes(scale);
}

ImFont* monospacedFont() {
  const ImVector<ImFont*>& fonts = ImGui::GetIO().Fonts->Fonts;
  return fonts[fonts.Size - 1];
}

}  // namespace freevoxels
