#include "apps/view/window.h"

#include <volk.h>
// volk declares what GLFW's Vulkan functions take.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <limits>
#include <utility>

#include "apps/view/keys.h"
#include "engine/core/error.h"

namespace freevoxels {

namespace {

constexpr glm::dvec2 kNowhere(-std::numeric_limits<float>::max());  // as Dear ImGui has it

Window& windowOf(GLFWwindow* handle) {
  return *static_cast<Window*>(glfwGetWindowUserPointer(handle));
}

std::string lastProblem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "GLFW does not say why";
}

}  // namespace

WindowSystem::WindowSystem() {
#ifdef GLFW_PLATFORM  // since 3.4, which tries Wayland first, whose library writes to stderr where it does not run
  if (std::getenv("WAYLAND_DISPLAY") == nullptr && std::getenv("WAYLAND_SOCKET") == nullptr)
    glfwInitHint(GLFW_PLATFORM, GLFW_PLATFORM_X11);
#endif
  if (glfwInit() == GLFW_FALSE)
    fail(ErrorKind::Device, "no window can be opened ({}): 'freevoxels render' draws without a display",
         lastProblem());
  if (glfwVulkanSupported() == GLFW_FALSE) {
    glfwTerminate();
    fail(ErrorKind::Device,
         "no Vulkan driver was found that draws into windows: install mesa-vulkan-drivers, or draw with "
         "'freevoxels render'");
  }
}

WindowSystem::~WindowSystem() {
  glfwTerminate();
}

std::span<const char* const> WindowSystem::instanceExtensions() const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  if (names == nullptr)
    fail(ErrorKind::Device,
         "the Vulkan driver cannot draw into windows ({}): 'freevoxels render' draws without a display",
         lastProblem());
  return {names, count};
}

Window::Window(const WindowSystem&, const std::string& title, glm::ivec2 size, bool visible) {
  glfwWindowHint(GLFW_VISIBLE, visible ? GLFW_TRUE : GLFW_FALSE);
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr)
    fail(ErrorKind::Device, "no window can be opened ({}): 'freevoxels render' draws without a display",
         lastProblem());
  ImGui::CreateContext();
  ImGui_ImplGlfw_InitForVulkan(window_, false);
  listen();
}

void Window::listen() {
  glfwSetWindowUserPointer(window_, this);
  glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** files) {
    Window& window = windowOf(handle);
    window.dropped_.insert(window.dropped_.end(), files, files + count);
  });
  glfwSetCursorPosCallback(window_, [](GLFWwindow* handle, double x, double y) {
    windowOf(handle).input_.add({.kind = InputEvent::Kind::Move, .value = {x, y}});
  });
  glfwSetCursorEnterCallback(window_, [](GLFWwindow* handle, int entered) {
    Window& window = windowOf(handle);
    if (entered == GLFW_FALSE && std::ranges::none_of(window.buttons_, std::identity()))
      window.input_.add({.kind = InputEvent::Kind::Move, .value = kNowhere});
  });
  glfwSetMouseButtonCallback(window_, [](GLFWwindow* handle, int button, int action, int) {
    windowOf(handle).input_.add(
        {.kind = InputEvent::Kind::Button, .code = button, .down = action == GLFW_PRESS});
  });
  glfwSetScrollCallback(window_, [](GLFWwindow* handle, double x, double y) {
    windowOf(handle).input_.add({.kind = InputEvent::Kind::Wheel, .value = {x, y}});
  });
  glfwSetKeyCallback(window_, [](GLFWwindow* handle, int key, int, int action, int) {
    if (action != GLFW_REPEAT)  // Dear ImGui repeats by itself
      windowOf(handle).input_.add({.kind = InputEvent::Kind::Key, .code = key, .down = action == GLFW_PRESS});
  });
  glfwSetCharCallback(window_, [](GLFWwindow* handle, unsigned int character) {
    windowOf(handle).input_.add({.kind = InputEvent::Kind::Character, .code = int(character)});
  });
  glfwSetWindowFocusCallback(window_, ImGui_ImplGlfw_WindowFocusCallback);
}

void Window::give(const InputEvent& event) {
  ImGuiIO& io = ImGui::GetIO();
  switch (event.kind) {
    case InputEvent::Kind::Move:
      cursor_ = event.value;
      break;
    case InputEvent::Kind::Button:
      if (std::size_t(event.code) < buttons_.size()) buttons_[std::size_t(event.code)] = event.down;
      break;
    case InputEvent::Kind::Wheel:
      ImGui_ImplGlfw_ScrollCallback(window_, event.value.x, event.value.y);
      break;
    case InputEvent::Kind::Key:
      giveKey(window_, keyOfLayout(event.code), event.down);
      break;
    case InputEvent::Kind::Character:
      io.AddInputCharacter(static_cast<unsigned int>(event.code));
      break;
  }
}

void Window::beginFrame() {
  keepTab();
  for (const InputEvent& event : input_.nextFrame()) give(event);
  ImGui_ImplGlfw_NewFrame();
  ImGuiIO& io = ImGui::GetIO();  // not the mouse as it is by now
#if IMGUI_VERSION_NUM < 18700
  io.MousePos = {cursor_.x, cursor_.y};
  std::ranges::copy(buttons_, io.MouseDown);
#else
  io.ConfigInputTrickleEventQueue = false;  // input_ has chosen what one frame has
  io.AddMousePosEvent(cursor_.x, cursor_.y);
  for (std::size_t i = 0; i < buttons_.size(); ++i) io.AddMouseButtonEvent(int(i), buttons_[i]);
#endif
  ImGui::NewFrame();
}

Window::~Window() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
}

bool Window::wantsToClose() const {
  return glfwWindowShouldClose(window_) != GLFW_FALSE;
}

void Window::close() const {
  glfwSetWindowShouldClose(window_, GLFW_TRUE);
}

void Window::setTitle(const std::string& title) const {
  glfwSetWindowTitle(window_, title.c_str());
}

void Window::hide() const {
  glfwHideWindow(window_);
}

glm::ivec2 Window::pixels() const {
  glm::ivec2 size(0);
  glfwGetFramebufferSize(window_, &size.x, &size.y);
  return size;
}

float Window::contentScale() const {
  glm::vec2 scale(1.0f);
  glfwGetWindowContentScale(window_, &scale.x, &scale.y);
  return scale.x;
}

std::vector<std::string> Window::takeDropped() {
  return std::exchange(dropped_, {});
}

void Window::waitForEvents(double seconds) {
  if (seconds > 0.0)
    glfwWaitEventsTimeout(seconds);
  else
    glfwPollEvents();
}

void Window::wake() {
  glfwPostEmptyEvent();
}

}  // namespace freevoxels
