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
  /// As its own button does.
  void close() const;
  void setTitle(const std::string& title) const;
  /// It is gone for those who look, before what is behind it ends.
  void hide() const;
  /// Of the framebuffer, in pixels; 0 while it is minimised.
  glm::ivec2 pixels() const;
  /// Pixels to a unit of text: 2 on a screen of twice the usual density.
  float contentScale() const;
  /// Begins a frame of Dear ImGui, with what hands did since the last.
  void beginFrame();
  /// Whether the next frame has to show more of that, soon.
  bool inputWaits() const { return !input_.settled(); }
  /// Files dropped onto the window since the last call.
  std::vector<std::string> takeDropped();

  /// Handles what has happened; waits for that at most so long.
  static void waitForEvents(double seconds);
  /// Ends such a wait; from any thread.
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
