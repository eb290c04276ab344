#pragma once
// What the menus and the keys do, in one table.

#include <array>
#include <optional>
#include <string>

namespace freevoxels {

enum class Action {
  Open,
  RestoreScene,
  SaveImage,
  SaveScene,
  SaveTurntable,
  Quit,
  Undo,
  Redo,
  CopyImage,
  CopyCommand,
  FrameVolume,
  Projection,
  FromRight,
  FromLeft,
  FromAbove,
  FromBelow,
  FromFront,
  FromBack,  // in the order of alongAxis()
  AddBookmark,
  Axes,
  Box,
  ScaleBar,
  ColorBar,
  Slices,
  Panel,
  Keys,
  Cancel,
};
inline constexpr int kActions = int(Action::Cancel) + 1;

/// What a menu shows of an action now.
struct ActionState {
  bool enabled = true;
  std::optional<bool> ticked;  ///< only of those that are on or off
};

/// Whether keys without Ctrl are meant for the image: no text field has the cursor, and no dialog is open.
bool keysAreFree();

/// The action whose key was pressed in this frame. None while the user types, except for those with Ctrl that no text field has.
std::optional<Action> pressedAction();

/// Draws the menus into the window's main menu bar, which has begun. Returns the action that is chosen.
std::optional<Action> drawMenus(const std::array<ActionState, kActions>& states);

/// A window that lists keys and mouse; closed by its button, F1 or Escape.
void drawKeysWindow(bool& open);

}  // namespace freevoxels
