#include "engine/xr/desktop/window.hpp"

#include <array>
#include <cmath>
#include <utility>

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>

#include "engine/core/check.hpp"

// Declared here: GLFW's header of it needs that of RandR. A GLFW of another window system lacks it.
extern "C" [[gnu::weak]] unsigned long glfwGetX11Window(GLFWwindow* window);

namespace neritic::xr {
namespace {

constexpr double kHiddenWait_s = 0.01;
constexpr double kStickRest = 0.12;  // sticks do not come back to their middle exactly

std::string last_glfw_error() {
  const char* description = nullptr;
  if (glfwGetError(&description) == GLFW_NO_ERROR || !description) return "no reason given";
  return description;
}

std::size_t id_of(const std::string& text) {
  const auto id = control_id(text);
  NERITIC_CHECK(id.ok(), "{}", text);
  return id.value();
}

// A control and GLFW's number for it.
struct Numbered {
  std::size_t control;
  int number;
};

const std::vector<Numbered>& keys() {
  static const std::vector<Numbered> all = [] {
    std::vector<Numbered> out;
    // GLFW numbers letters and digits by their ASCII capitals, function keys in a row.
    for (int c = 'A'; c <= 'Z'; ++c) out.push_back({id_of(fmt::format("key {:c}", c)), c});
    for (int c = '0'; c <= '9'; ++c) out.push_back({id_of(fmt::format("key {:c}", c)), c});
    for (int i = 1; i <= 12; ++i)
      out.push_back({id_of(fmt::format("key F{}", i)), GLFW_KEY_F1 + i - 1});
    constexpr std::pair<const char*, int> kNamed[] = {{"key Space", GLFW_KEY_SPACE},
                                                      {"key Escape", GLFW_KEY_ESCAPE},
                                                      {"key Enter", GLFW_KEY_ENTER},
                                                      {"key Tab", GLFW_KEY_TAB},
                                                      {"key Home", GLFW_KEY_HOME},
                                                      {"key End", GLFW_KEY_END},
                                                      {"key Left", GLFW_KEY_LEFT},
                                                      {"key Right", GLFW_KEY_RIGHT},
                                                      {"key Up", GLFW_KEY_UP},
                                                      {"key Down", GLFW_KEY_DOWN},
                                                      {"key LeftShift", GLFW_KEY_LEFT_SHIFT},
                                                      {"key RightShift", GLFW_KEY_RIGHT_SHIFT},
                                                      {"key LeftControl", GLFW_KEY_LEFT_CONTROL},
                                                      {"key RightControl", GLFW_KEY_RIGHT_CONTROL}};
    for (const auto& [name, number] : kNamed) out.push_back({id_of(name), number});
    return out;
  }();
  return all;
}

const std::vector<Numbered>& buttons() {
  static const std::vector<Numbered> all{{id_of("mouse left"), GLFW_MOUSE_BUTTON_LEFT},
                                         {id_of("mouse right"), GLFW_MOUSE_BUTTON_RIGHT},
                                         {id_of("mouse middle"), GLFW_MOUSE_BUTTON_MIDDLE}};
  return all;
}

const std::vector<Numbered>& pad_buttons() {
  static const std::vector<Numbered> all{
      {id_of("pad a"), GLFW_GAMEPAD_BUTTON_A},
      {id_of("pad b"), GLFW_GAMEPAD_BUTTON_B},
      {id_of("pad x"), GLFW_GAMEPAD_BUTTON_X},
      {id_of("pad y"), GLFW_GAMEPAD_BUTTON_Y},
      {id_of("pad left_bumper"), GLFW_GAMEPAD_BUTTON_LEFT_BUMPER},
      {id_of("pad right_bumper"), GLFW_GAMEPAD_BUTTON_RIGHT_BUMPER},
      {id_of("pad back"), GLFW_GAMEPAD_BUTTON_BACK},
      {id_of("pad start"), GLFW_GAMEPAD_BUTTON_START},
      {id_of("pad up"), GLFW_GAMEPAD_BUTTON_DPAD_UP},
      {id_of("pad right"), GLFW_GAMEPAD_BUTTON_DPAD_RIGHT},
      {id_of("pad down"), GLFW_GAMEPAD_BUTTON_DPAD_DOWN},
      {id_of("pad left"), GLFW_GAMEPAD_BUTTON_DPAD_LEFT}};
  return all;
}

const std::vector<Numbered>& pad_axes() {
  static const std::vector<Numbered> all{
      {id_of("pad left_x"), GLFW_GAMEPAD_AXIS_LEFT_X},
      {id_of("pad left_y"), GLFW_GAMEPAD_AXIS_LEFT_Y},
      {id_of("pad right_x"), GLFW_GAMEPAD_AXIS_RIGHT_X},
      {id_of("pad right_y"), GLFW_GAMEPAD_AXIS_RIGHT_Y},
      {id_of("pad left_trigger"), GLFW_GAMEPAD_AXIS_LEFT_TRIGGER},
      {id_of("pad right_trigger"), GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER}};
  return all;
}

bool is_trigger(int axis) {
  return axis == GLFW_GAMEPAD_AXIS_LEFT_TRIGGER || axis == GLFW_GAMEPAD_AXIS_RIGHT_TRIGGER;
}

const Numbered* find(const std::vector<Numbered>& all, int number) {
  for (const Numbered& one : all)
    if (one.number == number) return &one;
  return nullptr;
}

}  // namespace

Result<std::unique_ptr<Window>> Window::create(const WindowOptions& options) {
  NERITIC_TRY(ActionTable actions, ActionTable::create(options.actions));
  if (!glfwInit())
    return failure(ErrorCode::kNoDevice, "no display to open a window on ({}); {}",
                   last_glfw_error(), options.hint);
  std::unique_ptr<Window> window(new Window(std::move(actions)));  // ends GLFW from here on
  if (!glfwVulkanSupported())
    return failure(ErrorCode::kNoDevice, "no Vulkan for windows ({}); {}", last_glfw_error(),
                   options.hint);
  glfwWindowHint(GLFW_CLIENT_API, GLFW_NO_API);
  window->window_ =
      glfwCreateWindow(static_cast<int>(options.width), static_cast<int>(options.height),
                       options.title.c_str(), nullptr, nullptr);
  if (!window->window_)
    return failure(ErrorCode::kNoDevice, "the window could not be opened ({}); {}",
                   last_glfw_error(), options.hint);
  glfwSetWindowUserPointer(window->window_, window.get());
  glfwSetKeyCallback(window->window_, on_key);
  glfwSetMouseButtonCallback(window->window_, on_button);
  glfwSetScrollCallback(window->window_, on_scroll);
  window->poll();
  return window;
}

Window::~Window() {
  if (window_) glfwDestroyWindow(window_);
  glfwTerminate();
}

void Window::require(gpu::DeviceOptions& options) const {
  std::uint32_t count = 0;
  const char** names = glfwGetRequiredInstanceExtensions(&count);
  options.instance_extensions.insert(options.instance_extensions.end(), names, names + count);
  options.device_extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
}

Result<VkSurfaceKHR> Window::create_surface(VkInstance instance) const {
  VkSurfaceKHR surface = VK_NULL_HANDLE;
  const VkResult result = glfwCreateWindowSurface(instance, window_, nullptr, &surface);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "glfwCreateWindowSurface");
  return surface;
}

WindowState Window::poll(bool may_wait) {
  const bool hidden = may_wait && window_ && width_ == 0;
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

ActionValues Window::take_actions(const InputClaims& claims) {
  read_held();
  read_gamepad();
  read_mouse(claims.mouse);
  ActionValues values = actions_.values(state_, claims);
  state_ = {};
  return values;
}

void Window::read_held() {
  for (const Numbered& key : keys())
    state_.value[key.control] = glfwGetKey(window_, key.number) == GLFW_PRESS;
  for (const Numbered& button : buttons())
    state_.value[button.control] = glfwGetMouseButton(window_, button.number) == GLFW_PRESS;
}

// The first gamepad that GLFW knows the layout of.
void Window::read_gamepad() {
  GLFWgamepadstate pad;
  int joystick = GLFW_JOYSTICK_1;
  while (joystick <= GLFW_JOYSTICK_LAST && !glfwGetGamepadState(joystick, &pad)) ++joystick;
  if (joystick > GLFW_JOYSTICK_LAST) return;
  for (const Numbered& axis : pad_axes()) {
    const double value = pad.axes[axis.number];
    if (is_trigger(axis.number))
      state_.value[axis.control] = 0.5 * (value + 1.0);
    else
      state_.value[axis.control] = std::abs(value) > kStickRest ? value : 0.0;
  }
  for (const Numbered& button : pad_buttons()) {
    const bool held = pad.buttons[button.number] == GLFW_PRESS;
    state_.value[button.control] = held;
    state_.presses[button.control] = held && !pad_held_[button.control];
    pad_held_[button.control] = held;
  }
}

// While the mouse moves something, its cursor is hidden and free of the screen's edges.
void Window::read_mouse(bool claimed) {
  static const std::size_t x = id_of("mouse x"), y = id_of("mouse y");
  const bool drags = actions_.drags(state_) && (dragging_ || !claimed);
  if (drags != dragging_) {
    dragging_ = drags;
    glfwSetInputMode(window_, GLFW_CURSOR, drags ? GLFW_CURSOR_DISABLED : GLFW_CURSOR_NORMAL);
    glfwGetCursorPos(window_, &last_cursor_px_.x, &last_cursor_px_.y);
  }
  Vec2 cursor_px;
  glfwGetCursorPos(window_, &cursor_px.x, &cursor_px.y);
  state_.value[x] = cursor_px.x - last_cursor_px_.x;
  state_.value[y] = cursor_px.y - last_cursor_px_.y;
  last_cursor_px_ = cursor_px;
}

void Window::on_key(GLFWwindow* handle, int key, int, int action, int) {
  if (action != GLFW_PRESS) return;
  auto& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
  if (const Numbered* known = find(keys(), key)) ++window.state_.presses[known->control];
}

void Window::on_button(GLFWwindow* handle, int button, int action, int) {
  if (action != GLFW_PRESS) return;
  auto& window = *static_cast<Window*>(glfwGetWindowUserPointer(handle));
  if (const Numbered* known = find(buttons(), button)) ++window.state_.presses[known->control];
}

void Window::on_scroll(GLFWwindow* handle, double, double y) {
  static const std::size_t wheel = id_of("mouse wheel");
  static_cast<Window*>(glfwGetWindowUserPointer(handle))->state_.value[wheel] += y;
}

double Window::refresh_hz() const {
  constexpr double kUnknown_hz = 60.0;
  GLFWmonitor* monitor = glfwGetPrimaryMonitor();
  const GLFWvidmode* mode = monitor ? glfwGetVideoMode(monitor) : nullptr;
  return mode && mode->refreshRate > 0 ? mode->refreshRate : kUnknown_hz;
}

std::optional<std::uint32_t> Window::x_window() const {
  const unsigned long number = glfwGetX11Window ? glfwGetX11Window(window_) : 0;
  return number != 0 ? std::optional(static_cast<std::uint32_t>(number)) : std::nullopt;
}

float Window::content_scale() const {
  float x = 1.0f, y = 1.0f;
  glfwGetWindowContentScale(window_, &x, &y);
  return x > 0.0f ? x : 1.0f;
}

}  // namespace neritic::xr
