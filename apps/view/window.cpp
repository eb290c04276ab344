#include "apps/view/window.h"

#include <volk.h>
// volk declares what GLFW's Vulkan functions take.
#include <GLFW/glfw3.h>
#include <backends/imgui_impl_glfw.h>
#include <imgui.h>

#include <utility>

#include "engine/core/error.h"

namespace freevoxels {

namespace {

std::string lastProblem() {
  const char* text = nullptr;
  glfwGetError(&text);
  return text != nullptr ? text : "GLFW does not say why";
}

}  // namespace

WindowSystem::WindowSystem() {
  if (glfwInit() == GLFW_FALSE)
    fail(ExitCode::Device, "no window can be opened ({}): 'freevoxels render' draws without a display",
         lastProblem());
  if (glfwVulkanSupported() == GLFW_FALSE) {
    glfwTerminate();
    fail(ExitCode::Device,
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
    fail(ExitCode::Device,
         "the Vulkan driver cannot draw into windows ({}): 'freevoxels render' draws without a display",
         lastProblem());
  return {names, count};
}

Window::Window(const WindowSystem&, const std::string& title, glm::ivec2 size) {
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  glfwWindowHint(GLFW_SCALE_TO_MONITOR, GLFW_TRUE);
  window_ = glfwCreateWindow(size.x, size.y, title.c_str(), nullptr, nullptr);
  if (window_ == nullptr)
    fail(ExitCode::Device, "no window can be opened ({}): 'freevoxels render' draws without a display",
         lastProblem());
  glfwSetWindowUserPointer(window_, this);
  glfwSetDropCallback(window_, [](GLFWwindow* handle, int count, const char** files) {
    auto& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
    window.dropped_.insert(window.dropped_.end(), files, files + count);
  });
  ImGui::CreateContext();
  ImGui_ImplGlfw_InitForVulkan(window_, true);
}

Window::~Window() {
  ImGui_ImplGlfw_Shutdown();
  ImGui::DestroyContext();
  glfwDestroyWindow(window_);
}

bool Window::wantsToClose() const {
  return glfwWindowShouldClose(window_) != GLFW_FALSE;
}

void Window::setTitle(const std::string& title) const {
  glfwSetWindowTitle(window_, title.c_str());
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
