#include "engine/xr/actions.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"

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

bool is_motion(std::size_t control) {
  const Control& at = controls()[control];
  return at.device == "mouse" && (at.name == "x" || at.name == "y" || at.name == "wheel");
}

// Takes values between its ends: sticks, triggers, a squeezed grip.
bool is_analog(std::size_t control) {
  const std::string& name = controls()[control].name;
  return name.ends_with("_x") || name.ends_with("_y") || name.ends_with("trigger") ||
         name == "squeeze";
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
  if (names.empty()) return refusal("", fmt::format("control '{}'", text), "one of " + known);
  return refusal("", fmt::format("control '{}'", text), wanted + " with one of" + names);
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

Status ActionTable::check(const ActionDesc& desc, const std::string& text, const Binding& binding) {
  const bool moves = is_motion(binding.control);
  const std::string where = "action " + desc.name;
  if (desc.kind == ActionKind::kMotion && !moves)
    return refusal(where, fmt::format("'{}', which is held and does not move", text),
                   "mouse x, mouse y, mouse wheel");
  if (desc.kind != ActionKind::kMotion && moves)
    return refusal(
        where,
        fmt::format("'{}', which moves and is never {}", text,
                    desc.kind == ActionKind::kPress ? "pressed" : "held"),
        desc.kind == ActionKind::kPress ? "keys, buttons" : "keys, buttons, sticks, triggers");
  if (desc.kind == ActionKind::kPress && binding.sign < 0.0)
    return refusal(where, fmt::format("'{}', which is pressed and has no direction", text),
                   fmt::format("'{}'", text.substr(1)));
  return {};
}

// Refuses two bindings of one control, unless they have different conditions.
Status ActionTable::check_alone(std::span<const ActionDesc> actions,
                                const std::vector<Action>& read) {
  struct Use {
    std::size_t action;
    const Binding* binding;
  };
  std::vector<Use> uses;
  for (std::size_t i = 0; i < read.size(); ++i)
    for (std::size_t k = 0; k < read[i].bindings.size(); ++k) {
      const Binding& binding = read[i].bindings[k];
      for (const Use& use : uses) {
        const Binding& other = *use.binding;
        const bool both = binding.held == other.held || binding.held == kMaxControls ||
                          other.held == kMaxControls;
        const bool axes =
            read[i].kind == ActionKind::kAxis && read[use.action].kind == ActionKind::kAxis;
        if (binding.control != other.control || !both) continue;
        const Control& control = controls()[binding.control];
        if (use.action == i)
          return refusal("action " + actions[i].name,
                         fmt::format("{} {} twice", control.device, control.name),
                         "one binding of a control");
        if (!(axes && is_analog(binding.control)))
          return refusal(
              "action " + actions[i].name,
              fmt::format("{} {}, which is also that of {}", control.device, control.name,
                          actions[use.action].name),
              fmt::format("one action a control (give {0} another one, or none: {0} = [])",
                          actions[use.action].name));
      }
      uses.push_back({i, &binding});
    }
  return {};
}

Result<ActionTable> ActionTable::create(std::span<const ActionDesc> actions) {
  ActionTable table;
  for (const ActionDesc& desc : actions) {
    Action action{desc.kind, {}};
    for (const std::string& text : desc.bindings) {
      const auto binding = parse(text);
      if (!binding.ok()) return bad_input("action {}: {}", desc.name, binding.error().message);
      NERITIC_TRY_STATUS(check(desc, text, binding.value()));
      action.bindings.push_back(binding.value());
    }
    table.actions_.push_back(std::move(action));
  }
  NERITIC_TRY_STATUS(check_alone(actions, table.actions_));
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
