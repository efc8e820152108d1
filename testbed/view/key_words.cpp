#include "testbed/view/key_words.hpp"

#include <algorithm>
#include <vector>

#include "engine/core/check.hpp"

namespace neritic::testbed {
namespace {

constexpr std::string_view kWhile = " while ";

const xr::ActionDesc& action_named(std::span<const xr::ActionDesc> actions, std::string_view name) {
  const auto found = std::ranges::find(actions, name, &xr::ActionDesc::name);
  NERITIC_CHECK(found != actions.end(), "no action '{}'", name);
  return *found;
}

bool is_desktops(std::string_view control) {
  return control.starts_with("key ") || control.starts_with("mouse ");
}

// Of one direction: the desktop's, or where both directions have none those of other devices.
std::vector<std::string> controls_of(const xr::ActionDesc& action, bool down) {
  const auto bare = [](std::string_view binding) {
    return binding.substr(binding.starts_with('-') ? 1 : 0);
  };
  const bool desktop = std::ranges::any_of(
      action.bindings, [&](const std::string& binding) { return is_desktops(bare(binding)); });
  std::vector<std::string> out;
  for (const std::string& binding : action.bindings)
    if (binding.starts_with('-') == down && is_desktops(bare(binding)) == desktop)
      out.emplace_back(bare(binding));
  return out;
}

std::string short_name(std::string control) {
  if (control.starts_with("key ")) control.erase(0, 4);
  return control;
}

// "hold mouse right": what moves while that is held needs no other word.
std::string listed(const std::string& control) {
  const auto at = control.find(kWhile);
  if (at == std::string::npos) return short_name(control);
  return "hold " + short_name(control.substr(at + kWhile.size()));
}

// ", also the mouse with its right button"; empty: the mouse does not turn the view.
std::string mouse_words(const xr::ActionDesc& look) {
  for (const std::string& binding : look.bindings) {
    if (!binding.starts_with("mouse ")) continue;
    const auto at = binding.find(kWhile);
    if (at == std::string::npos) return ", also the mouse";
    std::string held = binding.substr(at + kWhile.size());
    if (!held.starts_with("mouse ")) return ", also the mouse with " + short_name(held);
    return fmt::format(", also the mouse with its {} button", held.substr(6));
  }
  return {};
}

std::string first_of(const std::vector<std::string>& controls) {
  return controls.empty() ? std::string() : short_name(controls.front());
}

std::string joined(std::vector<std::string> parts, const char* between) {
  std::erase(parts, "");
  return fmt::format("{}", fmt::join(parts, between));
}

// "F1 does"; empty without keys.
std::string said(const std::string& keys, const char* does) {
  return keys.empty() ? keys : fmt::format("{} {}", keys, does);
}

}  // namespace

std::string control_words(const xr::ActionDesc& action) {
  std::vector<std::string> directions;
  for (const bool down : {true, false}) {
    std::vector<std::string> names;
    for (const std::string& control : controls_of(action, down)) names.push_back(listed(control));
    directions.push_back(joined(std::move(names), "  "));
  }
  return joined(std::move(directions), " / ");
}

std::string key_of(std::span<const xr::ActionDesc> actions, std::string_view name) {
  const xr::ActionDesc& action = action_named(actions, name);
  const std::string up = first_of(controls_of(action, false));
  return up.empty() ? first_of(controls_of(action, true)) : up;
}

std::string with_key(std::span<const xr::ActionDesc> actions, std::string_view name,
                     std::string_view text) {
  const std::string key = key_of(actions, name);
  return key.empty() ? std::string(text) : fmt::format("{}: {}", key, text);
}

std::string swim_words(std::span<const xr::ActionDesc> actions) {
  const auto keys = [&](const char* name, std::initializer_list<bool> directions) {
    std::vector<std::string> out;
    for (const bool down : directions)
      out.push_back(first_of(controls_of(action_named(actions, name), down)));
    return joined(std::move(out), " ");
  };
  std::string turns = said(keys("move_starboard", {true, false}), "turn");
  if (!turns.empty()) turns += mouse_words(action_named(actions, "look_x"));
  const std::string jacket = joined({key_of(actions, "inflate"), key_of(actions, "deflate")}, " ");
  const std::string moves =
      joined({said(keys("move_astern", {true}), "ahead"),
              said(keys("move_up", {false, true}), "up and down"), said(jacket, "the jacket")},
             ", ");
  return "you swim the diver: " +
         joined({turns, moves, said(key_of(actions, "pilot"), "lets go")}, "; ");
}

std::string first_keys(std::span<const xr::ActionDesc> actions, bool view, bool steer) {
  return joined({said(key_of(actions, "help"), " keys"),
                 view ? said(key_of(actions, "next_view"), " view") : "",
                 steer ? said(key_of(actions, "pilot"), " steer") : ""},
                "   ");
}

}  // namespace neritic::testbed
