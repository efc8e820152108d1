// Input as named actions: a program states a table of what its user can do and with which controls
// of which devices; a display gives the values of that table once a frame. Each display chooses the
// library that reads its devices. Plain values; any thread.
//
// A binding is a text: a device and a control ("key W", "mouse wheel", "pad left_x"), with "-" in
// front if it counts the other way, and " while DEVICE CONTROL" behind if another control has to be
// held ("mouse x while mouse right").
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::xr {

enum class ActionKind {
  kPress,   // how often a control went down since the last frame
  kAxis,    // how far controls are held now, -1 to 1
  kMotion,  // how far something moved since the last frame: pixels of the mouse, clicks of its
            // wheel
};

struct ActionDesc {
  std::string name;
  ActionKind kind = ActionKind::kPress;
  std::vector<std::string> bindings;
  std::string help;  // for a list of the controls; empty: not in it
};

// One control of a device. Ids are places in controls().
struct Control {
  std::string device, name;
};
std::span<const Control> controls();
inline constexpr std::size_t kMaxControls = 128;

// The current values of the controls. A display fills it from its devices.
struct DeviceState {
  std::array<double, kMaxControls> value{};  // 1 held; axes -1 to 1; motion since last time
  std::array<std::uint32_t, kMaxControls> presses{};  // since last time
};

// Devices that something else uses at the moment.
struct InputClaims {
  bool keys = false, mouse = false;
};

// Values by an action's place in the table.
class ActionValues {
 public:
  ActionValues() = default;
  explicit ActionValues(std::vector<double> values) : values_(std::move(values)) {}
  // 0 for a display without input.
  template <class Action>
  double operator[](Action action) const {
    const auto i = static_cast<std::size_t>(action);
    return i < values_.size() ? values_[i] : 0.0;
  }

 private:
  std::vector<double> values_;
};

class ActionTable {
 public:
  // kBadInput names the action and the binding that cannot be read or can never act: a press of
  // something that moves or against a direction, a motion of something that is held, a control that
  // two actions would read at once. Sticks and triggers may move several axes.
  static Result<ActionTable> create(std::span<const ActionDesc> actions);
  ActionValues values(const DeviceState& state, const InputClaims& claims = {}) const;
  // Whether the mouse moves something now, so that its cursor should not leave the window.
  bool drags(const DeviceState& state) const;

 private:
  struct Binding {
    std::size_t control = 0;
    double sign = 1.0;
    std::size_t held = kMaxControls;  // the control of "while"; kMaxControls: none
  };
  struct Action {
    ActionKind kind = ActionKind::kPress;
    std::vector<Binding> bindings;
  };
  static Result<Binding> parse(const std::string& text);
  static Status check(const ActionDesc& desc, const std::string& text, const Binding& binding);
  static Status check_alone(std::span<const ActionDesc> actions, const std::vector<Action>& read);
  std::vector<Action> actions_;
};

// The id of "DEVICE NAME"; kBadInput with the known controls of that device.
Result<std::size_t> control_id(const std::string& text);

}  // namespace neritic::xr
