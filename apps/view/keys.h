#pragma once
// Keys by GLFW's numbers with every version of Dear ImGui: before 1.87 it has these numbers too, since then keys of its own.

struct GLFWwindow;

namespace freevoxels {

/// Whether the key went down since the last frame; if `repeats`, also each time that it is repeated while it is held.
bool isKeyPressed(int key, bool repeats = false);
bool isKeyDown(int key);

/// The key, by its place on a US keyboard as GLFW counts, that has on this place the letter, the comma or the full stop that the user's
/// keyboard has there; other keys, and those of other alphabets, stay as they are.
int keyOfLayout(int key);

/// Tells Dear ImGui that a key of the window, as keyOfLayout() has it, went down or up. A key that neither it nor the viewer has a use for
/// may be ignored.
void giveKey(GLFWwindow* window, int key, bool down);

/// To be called at the beginning of each frame. Outside of text fields Tab is the viewer's: Dear ImGui would go from field to field.
void keepTab();

}  // namespace freevoxels
