// One window of the desktop and what its user does with keyboard and mouse. Owns GLFW: one Window
// at a time. Main thread (GLFW's rule), which is also the rendering thread.
#pragma once

#include <volk.h>

#include <memory>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

struct GLFWwindow;

namespace neritic::xr {

// What happened since the last take_input.
struct DesktopInput {
  Vec3 move{0.0};      // held keys: x starboard, y up, z backwards; each -1, 0 or 1
  double turn = 0.0;   // held keys: to starboard 1, to port -1
  bool fast = false;   // shift is held
  Vec2 look_px{0.0};   // mouse movement while the right button is held; x to the right, y down
  double wheel = 0.0;  // clicks, positive away from the user
  // Keys that went down.
  bool toggle_help = false, toggle_panels = false, screenshot = false, reset = false;
  bool toggle_pilot = false;
};

enum class WindowState {
  kVisible,
  kHidden,  // minimised, or of no size
  kClosed,  // the user closed it, or pressed Esc
};

class Window {
 public:
  // kNoDevice where there is no display to open a window on; hint completes that sentence.
  static Result<std::unique_ptr<Window>> create(const std::string& title, std::uint32_t width,
                                                std::uint32_t height, const std::string& hint);
  ~Window();
  Window(const Window&) = delete;
  Window& operator=(const Window&) = delete;

  // The instance extensions that a surface needs, for gpu::DeviceOptions.
  std::vector<const char*> instance_extensions() const;
  Result<VkSurfaceKHR> create_surface(VkInstance instance) const;

  // Handles the events that wait. Where the window is hidden, first waits a little for one.
  WindowState poll();
  // ui_has_mouse, ui_has_keys: the panels use them now, so the camera does not.
  DesktopInput take_input(bool ui_has_mouse, bool ui_has_keys);

  // Pixels; 0 while minimised.
  std::uint32_t width() const { return width_; }
  std::uint32_t height() const { return height_; }
  double refresh_hz() const;    // of the monitor
  float content_scale() const;  // of text and panels: 2 on a dense screen
  GLFWwindow* handle() const { return window_; }

 private:
  Window() = default;
  static void on_key(GLFWwindow* window, int key, int scancode, int action, int mods);
  static void on_scroll(GLFWwindow* window, double x, double y);
  Vec2 take_look(bool ui_has_mouse);
  GLFWwindow* window_ = nullptr;
  std::uint32_t width_ = 0, height_ = 0;
  DesktopInput events_;  // gathered by the callbacks
  bool looking_ = false;
  Vec2 last_cursor_px_{0.0};
};

}  // namespace neritic::xr
