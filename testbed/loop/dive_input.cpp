#include "testbed/loop/dive_input.hpp"

namespace neritic::testbed {
namespace {

// In the order of dive_actions().
enum class Action {
  kAstern,
  kStarboard,
  kUp,
  kFast,
  kWheel,
  kLookX,
  kLookY,
  kLookRateX,
  kLookRateY,
  kPilot,
  kTurn,
  kReset,
  kHelp,
  kPanels,
  kScreenshot,
  kQuit,
};

}  // namespace

std::vector<xr::ActionDesc> dive_actions() {
  using enum xr::ActionKind;
  return {
      {"move_astern", kAxis, {"-key W", "key S", "pad left_y"}, "ahead, astern"},
      {"move_starboard", kAxis, {"-key A", "key D", "pad left_x"}, "port, starboard"},
      {"move_up",
       kAxis,
       {"key E", "key Space", "-key Q", "pad right_trigger", "-pad left_trigger"},
       "up (E, Space), down"},
      {"fast", kAxis, {"key LeftShift", "key RightShift", "pad left_bumper"}, "four times as fast"},
      {"speed", kMotion, {"mouse wheel"}, "faster, slower"},
      {"look_x", kMotion, {"mouse x while mouse right"}, "look around"},
      {"look_y", kMotion, {"mouse y while mouse right"}, ""},
      {"look_rate_x", kAxis, {"pad right_x"}, ""},
      {"look_rate_y", kAxis, {"pad right_y"}, ""},
      {"pilot", kPress, {"key P", "pad y"}, "fly a vehicle with physics by hand, and back"},
      {"turn", kAxis, {"-key Left", "key Right", "pad right_x"}, "turn that vehicle"},
      {"reset", kPress, {"key Home", "pad back"}, "back to where the dive began"},
      {"help", kPress, {"key F1", "pad start"}, "this list"},
      {"panels", kPress, {"key F2", "pad x"}, "panels on or off"},
      {"screenshot", kPress, {"key F12"}, "screenshot to the current folder"},
      {"quit", kPress, {"key Escape"}, "end the dive"},
  };
}

DiveInput read_input(const xr::ActionValues& values) {
  const auto pressed = [&](Action action) { return values[action] > 0.0; };
  return {.move = {values[Action::kStarboard], values[Action::kUp], values[Action::kAstern]},
          .turn = values[Action::kTurn],
          .fast = values[Action::kFast] > 0.5,
          .look_px = {values[Action::kLookX], values[Action::kLookY]},
          .look_rate = {values[Action::kLookRateX], values[Action::kLookRateY]},
          .wheel = values[Action::kWheel],
          .toggle_help = pressed(Action::kHelp),
          .toggle_panels = pressed(Action::kPanels),
          .screenshot = pressed(Action::kScreenshot),
          .reset = pressed(Action::kReset),
          .toggle_pilot = pressed(Action::kPilot),
          .quit = pressed(Action::kQuit)};
}

}  // namespace neritic::testbed
