#include "apps/view/keys.h"

#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <array>
#include <iterator>

namespace freevoxels {

int keyOfLayout(int key) {
  const bool isPrinted = key >= GLFW_KEY_APOSTROPHE && key <= GLFW_KEY_WORLD_2 && (key < GLFW_KEY_0 || key > GLFW_KEY_9);
  const char* const name = isPrinted ? glfwGetKeyName(key, 0) : nullptr;
  if (name == nullptr || name[0] == '\0' || name[1] != '\0') return key;
  if (name[0] >= 'a' && name[0] <= 'z') return GLFW_KEY_A + (name[0] - 'a');
  if (name[0] == ',') return GLFW_KEY_COMMA;
  return name[0] == '.' ? GLFW_KEY_PERIOD : key;
}

namespace {

/// Where a menu or a list is open, Enter chooses its entry, as the space bar does in Dear ImGui.
bool isEnterOfMenus(int key, bool down) {
  const bool isEnter = key == GLFW_KEY_ENTER || key == GLFW_KEY_KP_ENTER;
  return isEnter && (!down || (ImGui::GetIO().ConfigFlags & ImGuiConfigFlags_NavEnableKeyboard) != 0);
}

}  // namespace

#if IMGUI_VERSION_NUM < 18700

bool isKeyPressed(int key, bool repeats) {
  return ImGui::IsKeyPressed(key, repeats);
}

bool isKeyDown(int key) {
  return ImGui::IsKeyDown(key);
}

void giveKey(GLFWwindow* window, int key, bool down) {
  const int action = down ? GLFW_PRESS : GLFW_RELEASE;
  ImGui_ImplGlfw_KeyCallback(window, key, 0, action, 0);
  if (isEnterOfMenus(key, down)) ImGui_ImplGlfw_KeyCallback(window, GLFW_KEY_SPACE, 0, action, 0);
}

void keepTab() {
  ImGuiIO& io = ImGui::GetIO();
  io.KeyMap[ImGuiKey_Tab] = io.WantTextInput ? GLFW_KEY_TAB : -1;
}

#else

namespace {

struct KeyRange {
  int first, last;  ///< GLFW's
  ImGuiKey named;   ///< the first one's; the others follow
};

constexpr std::array kRanges{
    KeyRange{GLFW_KEY_A, GLFW_KEY_Z, ImGuiKey_A},
    KeyRange{GLFW_KEY_0, GLFW_KEY_9, ImGuiKey_0},
    KeyRange{GLFW_KEY_F1, GLFW_KEY_F12, ImGuiKey_F1},
    KeyRange{GLFW_KEY_SPACE, GLFW_KEY_SPACE, ImGuiKey_Space},
    KeyRange{GLFW_KEY_COMMA, GLFW_KEY_COMMA, ImGuiKey_Comma},
    KeyRange{GLFW_KEY_PERIOD, GLFW_KEY_PERIOD, ImGuiKey_Period},
    KeyRange{GLFW_KEY_ESCAPE, GLFW_KEY_ESCAPE, ImGuiKey_Escape},
    KeyRange{GLFW_KEY_ENTER, GLFW_KEY_ENTER, ImGuiKey_Enter},
    KeyRange{GLFW_KEY_KP_ENTER, GLFW_KEY_KP_ENTER, ImGuiKey_KeypadEnter},
    KeyRange{GLFW_KEY_TAB, GLFW_KEY_TAB, ImGuiKey_Tab},
    KeyRange{GLFW_KEY_BACKSPACE, GLFW_KEY_BACKSPACE, ImGuiKey_Backspace},
    KeyRange{GLFW_KEY_INSERT, GLFW_KEY_INSERT, ImGuiKey_Insert},
    KeyRange{GLFW_KEY_DELETE, GLFW_KEY_DELETE, ImGuiKey_Delete},
    KeyRange{GLFW_KEY_RIGHT, GLFW_KEY_RIGHT, ImGuiKey_RightArrow},
    KeyRange{GLFW_KEY_LEFT, GLFW_KEY_LEFT, ImGuiKey_LeftArrow},
    KeyRange{GLFW_KEY_DOWN, GLFW_KEY_DOWN, ImGuiKey_DownArrow},
    KeyRange{GLFW_KEY_UP, GLFW_KEY_UP, ImGuiKey_UpArrow},
    KeyRange{GLFW_KEY_PAGE_UP, GLFW_KEY_PAGE_UP, ImGuiKey_PageUp},
    KeyRange{GLFW_KEY_PAGE_DOWN, GLFW_KEY_PAGE_DOWN, ImGuiKey_PageDown},
    KeyRange{GLFW_KEY_HOME, GLFW_KEY_HOME, ImGuiKey_Home},
    KeyRange{GLFW_KEY_END, GLFW_KEY_END, ImGuiKey_End},
};

/// The same on the left and on the right of a keyboard.
struct Modifier {
  int left, right;
  ImGuiKey leftNamed, rightNamed, either;
};

constexpr std::array kModifiers{
    Modifier{GLFW_KEY_LEFT_CONTROL, GLFW_KEY_RIGHT_CONTROL, ImGuiKey_LeftCtrl, ImGuiKey_RightCtrl, ImGuiKey(ImGuiMod_Ctrl)},
    Modifier{GLFW_KEY_LEFT_SHIFT, GLFW_KEY_RIGHT_SHIFT, ImGuiKey_LeftShift, ImGuiKey_RightShift, ImGuiKey(ImGuiMod_Shift)},
    Modifier{GLFW_KEY_LEFT_ALT, GLFW_KEY_RIGHT_ALT, ImGuiKey_LeftAlt, ImGuiKey_RightAlt, ImGuiKey(ImGuiMod_Alt)},
    Modifier{GLFW_KEY_LEFT_SUPER, GLFW_KEY_RIGHT_SUPER, ImGuiKey_LeftSuper, ImGuiKey_RightSuper, ImGuiKey(ImGuiMod_Super)},
};

/// Stands for Tab outside of text fields: a key that Dear ImGui has no use for, and that it is never given.
constexpr ImGuiKey kTabOfViewer = ImGuiKey_ScrollLock;

ImGuiKey namedKey(int key) {
  const auto range = std::ranges::find_if(kRanges, [&](const KeyRange& keys) { return keys.first <= key && key <= keys.last; });
  return range == kRanges.end() ? ImGuiKey_None : ImGuiKey(int(range->named) + key - range->first);
}

ImGuiKey viewerKey(int key) {
  return key == GLFW_KEY_TAB ? kTabOfViewer : namedKey(key);
}

}  // namespace

bool isKeyPressed(int key, bool repeats) {
  return ImGui::IsKeyPressed(viewerKey(key), repeats);
}

bool isKeyDown(int key) {
  return ImGui::IsKeyDown(viewerKey(key));
}

/// Not by the backend, which takes Ctrl, Shift and Alt as they are by now, not as they were when the key was pressed.
void giveKey(GLFWwindow*, int key, bool down) {
  ImGuiIO& io = ImGui::GetIO();
  for (const Modifier& modifier : kModifiers) {
    if (key != modifier.left && key != modifier.right) continue;
    const bool isLeft = key == modifier.left;
    io.AddKeyEvent(isLeft ? modifier.leftNamed : modifier.rightNamed, down);
    io.AddKeyEvent(modifier.either, down || ImGui::IsKeyDown(isLeft ? modifier.rightNamed : modifier.leftNamed));
  }
  if (key == GLFW_KEY_TAB && (!down || !io.WantTextInput)) io.AddKeyEvent(kTabOfViewer, down);
  if (key == GLFW_KEY_TAB && down && !io.WantTextInput) return;
  if (const ImGuiKey named = namedKey(key); named != ImGuiKey_None) io.AddKeyEvent(named, down);
  if (isEnterOfMenus(key, down)) io.AddKeyEvent(ImGuiKey_Space, down);
}

void keepTab() {}  // giveKey() does

#endif

}  // namespace freevoxels
