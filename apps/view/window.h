#pragma once
// The window: GLFW, and Dear ImGui's input from it.

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

struct GLFWwindow;

namespace freevoxels {

/// GLFW as long as it lives. Fails with ExitCode::Device, and names the batch program, where there is no
/// display.
class WindowSystem {
 public:
  WindowSystem();
  ~WindowSystem();
  WindowSystem(const WindowSystem&) = delete;
  WindowSystem& operator=(const WindowSystem&) = delete;

  /// Of the Vulkan instance that draws into windows.
  std::span<const char* const> instanceExtensions() const;
};

class Window {
 public:
  /// `size` in the screen's own units. Makes Dear ImGui's context, which reads this window's input.
  Window(const WindowSystem&, const std::string& title, glm::ivec2 size);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  GLFWwindow* handle() const { return window_; }
  bool wantsToClose() const;
  void setTitle(const std::string& title) const;
  /// Of the framebuffer, in pixels; 0 while it is minimised.
  glm::ivec2 pixels() const;
  /// Pixels to a unit of text: 2 on a screen of twice the usual density.
  float contentScale() const;
  /// Files dropped onto the window since the last call.
  std::vector<std::string> takeDropped();

  /// Handles what has happened; waits for that at most so long.
  static void waitForEvents(double seconds);
  /// Ends such a wait; from any thread.
  static void wake();

 private:
  GLFWwindow* window_ = nullptr;
  std::vector<std::string> dropped_;
};

}  // namespace freevoxels
