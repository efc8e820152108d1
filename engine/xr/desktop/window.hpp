// One window of the desktop and the state of keyboard, mouse and gamepad. Owns GLFW: one Window at
// a time. Main thread (GLFW's rule), which is also the rendering thread.
#pragma once

#include <volk.h>

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/xr/actions.hpp"

struct GLFWwindow;

namespace neritic::xr {

enum class WindowState {
  kVisible,
  kHidden,  // minimised, or of no size
  kClosed,  // the user closed it
};

struct WindowOptions {
  std::string title;
  std::uint32_t width = 1280, height = 720;
  std::vector<ActionDesc> actions;
  std::string hint;  // ends the error line of a machine without a screen
};

class Window {
 public:
  // kNoDevice if there is no screen to open a window on; kBadInput for an action's binding.
  static Result<std::unique_ptr<Window>> create(const WindowOptions& options);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // Adds what a device needs to show pictures in this window.
  void require(gpu::DeviceOptions& options) const;
  Result<VkSurfaceKHR> create_surface(VkInstance instance) const;

  // Handles pending events. While the window is hidden, waits up to 0.01 s for one, if it may: the
  // program's other work goes on.
  WindowState poll(bool may_wait = true);
  // See Display::take_actions.
  ActionValues take_actions(const InputClaims& claims);

  // Pixels; 0 while minimised.
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  double refresh_hz() const;    // of the monitor
  float content_scale() const;  // of text and panels: 2 on a dense screen
  GLFWwindow* handle() const { return window_; }
  // Its number at the X server; absent: it is no X window.
  std::optional<std::uint32_t> x_window() const;

 private:
  explicit Window(ActionTable actions) : actions_(std::move(actions)) {}
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void on_button(GLFWwindow* window, int button, int action, int mods);
  static void on_scroll(GLFWwindow* window, double x, double y);
  void read_held();
  void read_gamepad();
  void read_mouse(bool claimed);
  GLFWwindow* window_ = nullptr;
  ActionTable actions_;
  std::uint32_t width_ = 0, height_ = 0;
  DeviceState state_;  // presses and motion add up until they are taken
  std::array<bool, kMaxControls> pad_held_{};
  bool dragging_ = false;
  Vec2 last_cursor_px_{0.0};
};

}  // namespace neritic::xr
