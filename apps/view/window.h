#pragma once
// The window: GLFW, and Dear ImGui's input from it.

#include <array>
#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "apps/view/input_queue.h"

struct GLFWwindow;

namespace freevoxels {

/// Initialises GLFW as long as it exists. Fails with ErrorKind::Device, and names the batch program, if there
/// is no display.
class WindowSystem {
 public:
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;

  /// Extensions of a Vulkan instance that draws into windows.
  std::span<const char* const> instanceExtensions() const;
};

class Window {
 public:
  /// `size` is in screen units. Creates Dear ImGui's context, which reads this window's input.
  Window(const WindowSystem&, const std::string& title, glm::ivec2 size, bool visible = true);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  bool wantsToClose() const;
  /// Closes the window, as its button does.
  void close() const;
  void setTitle(const std::string& title) const;
  /// Hides the window before its GPU resources are destroyed.
  void hide() const;
  /// Size of the framebuffer in pixels; 0 while minimised.
  glm::ivec2 pixels() const;
  /// Pixels per unit of text: 2 on a screen with twice the usual density.
  float contentScale() const;
  /// Begins a frame of Dear ImGui with the input since the last one.
  void beginFrame();
  /// Whether another frame is needed soon to show the results of input.
  bool inputWaits() const { return !input_.settled(); }
  /// Files dropped onto the window since the last call.
  std::vector<std::string> takeDropped();

  /// Processes events; waits for them at most this long.
  static void waitForEvents(double seconds);
  /// Ends such a wait; may be called by any thread.
  static void wake();

 private:
  void listen();
  void give(const InputEvent& event);

  GLFWwindow* window_ = nullptr;
  InputQueue input_;
  glm::vec2 cursor_{0.0f};
  std::array<bool, 3> buttons_{};
  std::vector<std::string> dropped_;
};

}  // namespace freevoxels
