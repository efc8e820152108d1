// The controls of actions in words, as they are bound: for the list of keys and for sentences that
// name one. A keyboard's and mouse's controls come first; another device's stand where those lack.
// Pure functions; any thread.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "engine/xr/actions.hpp"

namespace neritic::testbed {

// "W / S", "Q / E  Space", "mouse wheel": a direction that counts down before one that counts up.
// Empty: the action has no control.
std::string control_words(const xr::ActionDesc& action);
// "F1": the first control of the action of that name. Empty: it has none. Precondition: the table
// has that action.
std::string key_of(std::span<const xr::ActionDesc> actions, std::string_view name);
// "F9: TEXT"; TEXT alone where the action has no control.
std::string with_key(std::span<const xr::ActionDesc> actions, std::string_view name,
                     std::string_view text);
// How a diver is swum, with the controls that are bound.
std::string swim_words(std::span<const xr::ActionDesc> actions);
// The first controls to know: the list of keys, then the view's and the steering's where asked.
std::string first_keys(std::span<const xr::ActionDesc> actions, bool view, bool steer);

}  // namespace neritic::testbed
