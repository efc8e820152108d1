#include "engine/xr/actions.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::xr {
namespace {

std::vector<Control> make_controls() {
  std::vector<Control> all;
  const auto add = [&](const char* device, std::initializer_list<const char*> names) {
    for (const char* name : names) all.push_back({device, name});
  };
  for (char c = 'A'; c <= 'Z'; ++c) all.push_back({"key", std::string(1, c)});
  for (char c = '0'; c <= '9'; ++c) all.push_back({"key", std::string(1, c)});
  for (int i = 1; i <= 12; ++i) all.push_back({"key", fmt::format("F{}", i)});
  add("key", {"Space", "Escape", "Enter", "Tab", "Home", "End", "Left", "Right", "Up", "Down",
              "LeftShift", "RightShift", "LeftControl", "RightControl"});
  add("mouse", {"left", "right", "middle", "x", "y", "wheel"});
  // Axes: right and down are positive, triggers go from 0 to 1.
  add("pad",
      {"left_x", "left_y", "right_x", "right_y", "left_trigger", "right_trigger", "a", "b", "x",
       "y", "left_bumper", "right_bumper", "back", "start", "up", "right", "down", "left"});
  // The controllers in the hands: x is "lower" and y "upper" on the left one of some.
  for (const char* hand : {"left", "right"})
    add(hand, {"stick_x", "stick_y", "stick", "trigger", "squeeze", "lower", "upper", "menu"});
  NERITIC_CHECK(all.size() <= kMaxControls, "{} controls", all.size());
  return all;
}

}  // namespace

std::span<const Control> controls() {
  static const std::vector<Control> all = make_controls();
  return all;
}

Result<std::size_t> control_id(const std::string& text) {
  const auto all = controls();
  std::string device, known;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (text == all[i].device + " " + all[i].name) return i;
    if (all[i].device != device) known += (device.empty() ? "" : ", ") + all[i].device;
    device = all[i].device;
  }
  const std::string wanted = text.substr(0, text.find(' '));
  std::string names;
  for (const Control& control : all)
    if (control.device == wanted) names += " " + control.name;
  if (names.empty()) return bad_input("control '{}': accepted devices are {}", text, known);
  return bad_input("control '{}': {} has{}", text, wanted, names);
}

Result<ActionTable::Binding> ActionTable::parse(const std::string& text) {
  static const std::string kWhile = " while ";
  Binding binding;
  std::string control = text;
  if (const auto at = control.find(kWhile); at != std::string::npos) {
    NERITIC_TRY(binding.held, control_id(control.substr(at + kWhile.size())));
    control.resize(at);
  }
  if (control.starts_with('-')) {
    binding.sign = -1.0;
    control.erase(0, 1);
  }
  NERITIC_TRY(binding.control, control_id(control));
  return binding;
}

Result<ActionTable> ActionTable::create(std::span<const ActionDesc> actions) {
  ActionTable table;
  for (const ActionDesc& desc : actions) {
    Action action{desc.kind, {}};
    for (const std::string& text : desc.bindings) {
      const auto binding = parse(text);
      if (!binding.ok()) return bad_input("action {}: {}", desc.name, binding.error().message);
      action.bindings.push_back(binding.value());
    }
    table.actions_.push_back(std::move(action));
  }
  return table;
}

ActionValues ActionTable::values(const DeviceState& state, const InputClaims& claims) const {
  const auto all = controls();
  const auto claimed = [&](const Binding& binding) {
    const std::string& device = all[binding.control].device;
    return (claims.keys && device == "key") || (claims.mouse && device == "mouse");
  };
  std::vector<double> values;
  for (const Action& action : actions_) {
    double value = 0.0;
    for (const Binding& binding : action.bindings) {
      if (claimed(binding)) continue;
      if (binding.held < kMaxControls && state.value[binding.held] <= 0.5) continue;
      value += binding.sign * (action.kind == ActionKind::kPress ? state.presses[binding.control]
                                                                 : state.value[binding.control]);
    }
    values.push_back(action.kind == ActionKind::kAxis ? std::clamp(value, -1.0, 1.0) : value);
  }
  return ActionValues(std::move(values));
}

bool ActionTable::drags(const DeviceState& state) const {
  for (const Action& action : actions_)
    for (const Binding& binding : action.bindings)
      if (binding.held < kMaxControls && state.value[binding.held] > 0.5 &&
          controls()[binding.held].device == "mouse")
        return true;
  return false;
}

}  // namespace neritic::xr
