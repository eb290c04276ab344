#pragma once
// Fonts, colours and spacings of the window.

struct ImFont;

namespace freevoxels {

/// Height of a line of text in pixels on a monitor of the usual density.
inline constexpr float kFontPixels = 15.0f;

/// Loads the fonts and sets the style of the current Dear ImGui context. `scale` is Window::contentScale(). The font files are
/// DejaVu's or Noto's, wherever the distribution has put them; without any, Dear ImGui's own font is used.
void applyTheme(float scale);

/// The font of command lines, whose characters are equally wide.
ImFont* monospacedFont();

}  // namespace freevoxels
