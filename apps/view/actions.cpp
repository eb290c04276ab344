#include "apps/view/actions.h"

#include <GLFW/glfw3.h>
#include <imgui.h>

#include <string_view>
#include <utility>

#include "apps/view/keys.h"

namespace freevoxels {

namespace {

enum class Menu { File, Edit, View, Help, None };
constexpr std::array kMenuNames{"File", "Edit", "View", "Help"};

enum class With { Nothing, Control, ControlShift };

struct Entry {
  Action action;
  Menu menu;
  const char* label;
  const char* keys;  ///< as they are shown
  int key = 0;       ///< GLFW's; 0: none
  With with = With::Nothing;
  bool separator = false;  ///< after it in the menu
};

constexpr std::array kEntries{
    Entry{Action::Open, Menu::File, "Open...", "Ctrl+O", GLFW_KEY_O, With::Control},
    Entry{Action::RestoreScene, Menu::File, "Restore last scene", "Ctrl+Shift+O", GLFW_KEY_O, With::ControlShift, true},
    Entry{Action::SaveImage, Menu::File, "Save image...", "Ctrl+S", GLFW_KEY_S, With::Control},
    Entry{Action::SaveScene, Menu::File, "Save scene...", "Ctrl+E", GLFW_KEY_E, With::Control},
    Entry{Action::SaveTurntable, Menu::File, "Save turntable...", "Ctrl+T", GLFW_KEY_T, With::Control, true},
    Entry{Action::Quit, Menu::File, "Quit", "Ctrl+Q", GLFW_KEY_Q, With::Control},
    Entry{Action::Undo, Menu::Edit, "Undo", "Ctrl+Z", GLFW_KEY_Z, With::Control},
    Entry{Action::Redo, Menu::Edit, "Redo", "Ctrl+Y", GLFW_KEY_Y, With::Control, true},
    Entry{Action::CopyImage, Menu::Edit, "Copy image", "Ctrl+C", GLFW_KEY_C, With::Control},
    Entry{Action::CopyCommand, Menu::Edit, "Copy render command", "Ctrl+Shift+C", GLFW_KEY_C, With::ControlShift},
    Entry{Action::FrameVolume, Menu::View, "Frame the volume", "F", GLFW_KEY_F},
    Entry{Action::Projection, Menu::View, "Perspective / orthographic", "O", GLFW_KEY_O, With::Nothing, true},
    Entry{Action::FromRight, Menu::View, "From +x", "1", GLFW_KEY_1},
    Entry{Action::FromLeft, Menu::View, "From -x", "2", GLFW_KEY_2},
    Entry{Action::FromAbove, Menu::View, "From +y", "3", GLFW_KEY_3},
    Entry{Action::FromBelow, Menu::View, "From -y", "4", GLFW_KEY_4},
    Entry{Action::FromFront, Menu::View, "From +z", "5", GLFW_KEY_5},
    Entry{Action::FromBack, Menu::View, "From -z", "6", GLFW_KEY_6, With::Nothing, true},
    Entry{Action::PreviousView, Menu::View, "Camera before", "Ctrl+Shift+Z", GLFW_KEY_Z, With::ControlShift},
    Entry{Action::NextView, Menu::View, "Camera after", "Ctrl+Shift+Y", GLFW_KEY_Y, With::ControlShift},
    Entry{Action::AddBookmark, Menu::View, "Add camera bookmark", "Ctrl+B", GLFW_KEY_B, With::Control, true},
    Entry{Action::Axes, Menu::View, "Axes", ""},
    Entry{Action::Box, Menu::View, "Bounding box", "B", GLFW_KEY_B},
    Entry{Action::ScaleBar, Menu::View, "Scale bar", ""},
    Entry{Action::ColorBar, Menu::View, "Colour bar", ""},
    Entry{Action::Slices, Menu::View, "Slices", "L", GLFW_KEY_L},
    Entry{Action::Panel, Menu::View, "Side panel", "Tab", GLFW_KEY_TAB},
    Entry{Action::Keys, Menu::Help, "Keys and mouse", "F1", GLFW_KEY_F1},
    Entry{Action::Cancel, Menu::None, "Cancel what is being saved or read", "Escape", GLFW_KEY_ESCAPE},
};

constexpr std::array kMouse{
    std::pair("Drag", "turn around the look-at point"),
    std::pair("Shift + drag, middle drag", "pan"),
    std::pair("Ctrl + drag, wheel", "move nearer or farther"),
    std::pair("Right drag", "window and level of a transfer function; otherwise look around"),
    std::pair("Shift + right drag", "look around"),
    std::pair("W A S D Q E", "fly; Shift is four times as fast"),
    std::pair("Space, comma, full stop", "play a sequence; one frame back or on"),
};

bool isPopupOpen() {
  return ImGui::IsPopupOpen("", ImGuiPopupFlags_AnyPopupId | ImGuiPopupFlags_AnyPopupLevel);
}

bool isPressed(const Entry& entry) {
  const ImGuiIO& io = ImGui::GetIO();
  const With with = !io.KeyCtrl ? With::Nothing : io.KeyShift ? With::ControlShift : With::Control;
  if (entry.key == 0 || entry.with != with || !isKeyPressed(entry.key)) return false;
  return !io.WantTextInput || entry.key == GLFW_KEY_F1;  // texts have shortcuts of their own
}

void line(const char* keys, const char* meaning) {
  ImGui::TableNextRow();
  ImGui::TableNextColumn();
  ImGui::TextUnformatted(keys);
  ImGui::TableNextColumn();
  ImGui::TextDisabled("%s", meaning);
}

}  // namespace

bool keysAreFree() {
  return !ImGui::GetIO().WantTextInput && !isPopupOpen();
}

void takeKeysOfPopups(bool isDialogOpen) {
  ImGuiConfigFlags& flags = ImGui::GetIO().ConfigFlags;
  if (isPopupOpen() && !isDialogOpen)
    flags |= ImGuiConfigFlags_NavEnableKeyboard;
  else
    flags &= ~ImGuiConfigFlags_NavEnableKeyboard;
}

std::optional<Action> pressedAction(bool isDialogOpen) {
  if (isDialogOpen) return std::nullopt;
  for (const Entry& entry : kEntries)
    if ((!isPopupOpen() || entry.with != With::Nothing) && isPressed(entry)) return entry.action;
  return std::nullopt;
}

std::optional<Action> drawMenus(const std::array<ActionState, kActions>& states) {
  std::optional<Action> chosen;
  for (std::size_t menu = 0; menu < kMenuNames.size(); ++menu) {
    if (!ImGui::BeginMenu(kMenuNames[menu])) continue;
    for (const Entry& entry : kEntries) {
      if (entry.menu != Menu(menu)) continue;
      const ActionState& state = states[std::size_t(entry.action)];
      if (ImGui::MenuItem(entry.label, entry.keys, state.ticked.value_or(false), state.enabled)) chosen = entry.action;
      if (entry.separator) ImGui::Separator();
    }
    ImGui::EndMenu();
  }
  return chosen;
}

void drawKeysWindow(bool& open) {
  if (!open) return;
  const ImVec2 size = ImGui::GetIO().DisplaySize;
  ImGui::SetNextWindowPos({0.5f * size.x, 0.5f * size.y}, ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowFocus();
  if (ImGui::Begin("Keys and mouse", &open,
                   ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoSavedSettings) &&
      ImGui::BeginTable("keys", 2, ImGuiTableFlags_SizingFixedFit)) {
    for (const auto& [keys, meaning] : kMouse) line(keys, meaning);
    for (const Entry& entry : kEntries)
      if (entry.key != 0) line(entry.keys, entry.label);
    ImGui::EndTable();
  }
  ImGui::End();
  if (isKeyPressed(GLFW_KEY_ESCAPE)) open = false;
}

}  // namespace freevoxels
