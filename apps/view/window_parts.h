#pragma once
// The parts that the window is divided into.

#include <imgui.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/view/view_state.h"

namespace freevoxels {

inline constexpr ImGuiWindowFlags kFixedWindow = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoTitleBar |
                                                 ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoSavedSettings;

inline constexpr float kSplitterWidth = 6.0f;
/// Of the window's width.
inline constexpr float kMaxPanelShare = 0.6f;

/// Begins a Dear ImGui window without border at a place in the window; ImGui::End() ends it.
void beginPart(const char* name, ImVec2 low, ImVec2 size, ImVec2 padding, ImGuiWindowFlags flags = 0);

/// The border at the right end of the panel, kSplitterWidth wide. Returns the panel's new width while it is dragged. `scale` is
/// Window::contentScale().
std::optional<float> drawSplitter(const char* name, float border, float scale, float top, float height);

/// What is being done, and the fraction of it that is done.
using Activity = std::optional<std::pair<std::string, double>>;

/// The last problem, `activity`, or the last notice, and the size and time of the image. `cancels`: the activity can be cancelled.
void drawStatusBar(const ViewState& state, const Activity& activity, bool cancels, float top, float height);

/// A text on how to turn, for those who have not turned yet: at the lower border of the current part, which shows the image, between axes
/// and scale bar. Nothing where it would not be below the volume.
void drawTurnHint();

/// Writes a text into the middle of the last widget, which is the image, and dims the image if there is one. Returns the place below the
/// text's middle.
ImVec2 drawOverImage(const std::string& text, bool hasImage);

/// What is chosen to be opened.
struct OtherFile {
  bool opensDialog = false;
  std::optional<std::string> file;
};
/// Buttons below a place for a window that shows nothing: for the dialog, for the last of the files `recent` but `failed`, and for a
/// sample.
OtherFile drawOtherFiles(ImVec2 middle, std::vector<std::string> recent, const std::string& failed);

}  // namespace freevoxels
