#include "engine/xr/window.hpp"

#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/gpu/device.hpp"

namespace neritic::xr {
namespace {

constexpr double kHiddenWait_s = 0.1;  // between looks at a window that is hidden

std::string last_glfw_error() {
  const char* description = nullptr;
  if (glfwGetError(&description) == GLFW_NO_ERROR || !description) return "no reason given";
  return description;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(const std::string& title, std::uint32_t width,
                                               std::uint32_t height, const std::string& hint) {
  if (!glfwInit())
    return failure(ErrorCode::kNoDevice, "no display to open a window on ({}); {}",
                   last_glfw_error(), hint);
  std::unique_ptr<Window> window(new Window());  // ends GLFW from here on
  if (!glfwVulkanSupported())
    return failure(ErrorCode::kNoDevice, "no Vulkan for windows ({}); {}", last_glfw_error(), hint);
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window->window_ = glfwCreateWindow(static_cast<int>(width), static_cast<int>(height),
                                     title.c_str(), nullptr, nullptr);
  if (!window->window_)
    return failure(ErrorCode::kNoDevice, "the window could not be opened ({}); {}",
                   last_glfw_error(), hint);
  glfwSetWindowUserPointer(window->window_, window.get());
  glfwSetKeyCallback(window->window_, on_key);
  glfwSetScrollCallback(window->window_, on_scroll);
  window->poll();
  return window;
}

Window::~Window() {
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
}

std::vector<const char*> Window::instance_extensions() const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  return {names, names + count};
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(instance, window_, nullptr, &surface);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "glfwCreateWindowSurface");
  return surface;
}

WindowState Window::poll() {
  const bool hidden = window_ && width_ == 0;
  if (hidden)
    glfwWaitEventsTimeout(kHiddenWait_s);
  else
    glfwPollEvents();
  int width = 0, height = 0;
  glfwGetFramebufferSize(window_, &width, &height);
  const bool iconified = glfwGetWindowAttrib(window_, GLFW_ICONIFIED) != 0;
  const bool empty = iconified || width <= 0 || height <= 0;
  width_ = empty ? 0 : static_cast<std::uint32_t>(width);
  height_ = empty ? 0 : static_cast<std::uint32_t>(height);
  if (glfwWindowShouldClose(window_)) return WindowState::kClosed;
  return empty ? WindowState::kHidden : WindowState::kVisible;
}

DesktopInput Window::take_input(bool ui_has_mouse, bool ui_has_keys) {
  DesktopInput input = std::exchange(events_, {});
  if (ui_has_mouse) input.wheel = 0.0;
  input.look_px = take_look(ui_has_mouse);
  if (ui_has_keys) return input;
  const auto down = [&](int key) { return glfwGetKey(window_, key) == GLFW_PRESS ? 1.0 : 0.0; };
  input.move.x = down(GLFW_KEY_D) - down(GLFW_KEY_A);
  input.move.y = std::max(down(GLFW_KEY_E), down(GLFW_KEY_SPACE)) - down(GLFW_KEY_Q);
  input.move.z = down(GLFW_KEY_S) - down(GLFW_KEY_W);
  input.turn = down(GLFW_KEY_RIGHT) - down(GLFW_KEY_LEFT);
  input.fast = down(GLFW_KEY_LEFT_SHIFT) + down(GLFW_KEY_RIGHT_SHIFT) > 0.0;
  return input;
}

// The cursor is hidden and free of the screen's edges while the view turns.
Vec2 Window::take_look(bool ui_has_mouse) {
  const bool held = glfwGetMouseButton(window_, GLFW_MOUSE_BUTTON_RIGHT) == GLFW_PRESS;
  Vec2 cursor_px;
  if (held && !looking_ && !ui_has_mouse) {
    looking_ = true;
    glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_DISABLED);
    glfwGetCursorPos(window_, &last_cursor_px_.x, &last_cursor_px_.y);
    return Vec2(0.0);
  }
  if (!looking_) return Vec2(0.0);
  if (!held) {
    looking_ = false;
    glfwSetInputMode(window_, GLFW_CURSOR, GLFW_CURSOR_NORMAL);
    return Vec2(0.0);
  }
  glfwGetCursorPos(window_, &cursor_px.x, &cursor_px.y);
  return cursor_px - std::exchange(last_cursor_px_, cursor_px);
}

void Window::on_key(GLFWwindow* handle, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  auto& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
  switch (key) {
    case GLFW_KEY_ESCAPE:
      glfwSetWindowShouldClose(handle, GLFW_TRUE);
      break;
    case GLFW_KEY_F1:
      window.events_.toggle_help = true;
      break;
    case GLFW_KEY_F2:
      window.events_.toggle_panels = true;
      break;
    case GLFW_KEY_F12:
      window.events_.screenshot = true;
      break;
    case GLFW_KEY_P:
      window.events_.toggle_pilot = true;
      break;
    case GLFW_KEY_HOME:
      window.events_.reset = true;
      break;
    default:
      break;
  }
}

void Window::on_scroll(GLFWwindow* handle, double, double y) {
  static_cast<Window*>(glfwGetWindowUserPointer(handle))->events_.wheel += y;
}

double Window::refresh_hz() const {
  constexpr double kUnknown_hz = 60.0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  return mode && mode->refreshRate > 0 ? mode->refreshRate : kUnknown_hz;
}

float Window::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return x > 0.0f ? x : 1.0f;
}

}  // namespace neritic::xr
