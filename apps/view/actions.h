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
  PreviousView,
  NextView,
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

/// Gives arrows, Enter and Escape to menus and lists of choices while one of them is open. Before a frame begins.
void takeKeysOfPopups(bool isDialogOpen);

/// The action whose key was pressed in this frame. None while a dialog is open or the user types; while a menu is open those with Ctrl.
std::optional<Action> pressedAction(bool isDialogOpen);

/// Draws the menus into the window's main menu bar, which has begun. Returns the action that is chosen.
std::optional<Action> drawMenus(const std::array<ActionState, kActions>& states);

/// A window that lists keys and mouse; closed by its button, F1 or Escape.
void drawKeysWindow(bool& open);

}  // namespace freevoxels
