#include "testbed/view/dive_input.hpp"

#include "diver/jacket.hpp"

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
  kInflate,
  kDeflate,
  kNextView,
  kPreviousView,
  kReset,
  kHelp,
  kPanels,
  kHud,
  kTimes,
  kNextSonar,
  kSonarRange,
  kLouder,
  kQuieter,
  kMap,
  kGraphs,
  kInset,
  kLamps,
  kPause,
  kStepFrame,
  kSlower,
  kFaster,
  kSave,
  kGoBack,
  kRecord,
  kScreenshot,
  kPanelScreenshot,
  kQuit,
};

}  // namespace

std::vector<xr::ActionDesc> dive_actions() {
  using enum xr::ActionKind;
  return {
      {"move_astern",
       kAxis,
       {"-key W", "key S", "pad left_y", "left stick_y", "-right trigger"},
       "ahead, astern"},
      {"move_starboard",
       kAxis,
       {"-key A", "key D", "pad left_x", "left stick_x"},
       "port, starboard"},
      {"move_up",
       kAxis,
       {"key E", "key Space", "-key Q", "pad right_trigger", "-pad left_trigger", "-right stick_y"},
       "down, up"},
      {"fast",
       kAxis,
       {"key LeftShift", "key RightShift", "pad left_bumper", "right squeeze"},
       "four times as fast"},
      {"speed", kMotion, {"mouse wheel"}, "faster, slower"},
      {"look_x", kMotion, {"mouse x while mouse right"}, "look around"},
      {"look_y", kMotion, {"mouse y while mouse right"}, ""},
      {"look_rate_x", kAxis, {"pad right_x", "right stick_x"}, ""},
      {"look_rate_y", kAxis, {"pad right_y"}, ""},
      {"pilot", kPress, {"key P", "pad y"}, "fly a vehicle or swim the diver, and back"},
      {"turn",
       kAxis,
       {"-key Left", "key Right", "pad right_x", "right stick_x"},
       "turn the one that you steer"},
      {"inflate",
       kAxis,
       {"key I", "pad a", "left trigger", "left upper"},
       "a diver's jacket: gas in"},
      {"deflate", kAxis, {"key K", "pad b", "left squeeze", "left lower", "right menu"}, "gas out"},
      {"next_view",
       kPress,
       {"key V", "pad right_bumper", "right lower"},
       "next view: cameras, chases, free"},
      {"previous_view", kPress, {"key C"}, "view before"},
      {"reset", kPress, {"key Home", "pad back", "right upper"}, "back to the first view"},
      {"help", kPress, {"key F1", "pad start"}, "this list"},
      {"panels", kPress, {"key F2", "pad x"}, "panels on or off"},
      {"hud", kPress, {"key H", "left menu"}, "instruments: each, none, as at first"},
      {"times", kPress, {"key F3"}, "times of the GPU's passes"},
      {"next_sonar", kPress, {"key Tab"}, "next sonar first"},
      {"sonar_range", kPress, {"key R", "pad right"}, "sonars: 100, 50, 25 % of the range"},
      {"louder", kPress, {"key Up", "pad up"}, "sonars brighter by 3 dB"},
      {"quieter", kPress, {"key Down", "pad down"}, "sonars darker by 3 dB"},
      {"map", kPress, {"key M"}, "map"},
      {"graphs", kPress, {"key G"}, "graphs of any number"},
      {"inset", kPress, {"key N"}, "inset: next camera, none"},
      {"lamps", kPress, {"key L"}, "lamps of the flown vehicle: off, half, full"},
      {"pause", kPress, {"key Enter"}, "pause, go on"},
      {"step_frame", kPress, {"key F6"}, "while paused: one frame on"},
      {"slower", kPress, {"key F7"}, "time slower, down to 0.1"},
      {"faster", kPress, {"key F8"}, "time faster, up to 10"},
      {"save", kPress, {"key F5"}, "save the run's state"},
      {"go_back", kPress, {"key F9"}, "back to the saved state"},
      {"record", kPress, {"key F4"}, "record the run, stop recording"},
      {"screenshot", kPress, {"key F12"}, "screenshot"},
      {"panel_screenshot", kPress, {"key F11"}, "screenshot of the panel under the cursor"},
      {"quit", kPress, {"key Escape"}, "end the dive"},
  };
}

DiveInput read_input(const xr::ActionValues& values) {
  const auto pressed = [&](Action action) { return values[action] > 0.0; };
  return {.move = {values[Action::kStarboard], values[Action::kUp], values[Action::kAstern]},
          .jacket = (values[Action::kInflate] > 0.5 ? diver::kInflate : 0) |
                    (values[Action::kDeflate] > 0.5 ? diver::kDeflate : 0),
          .turn = values[Action::kTurn],
          .fast = values[Action::kFast] > 0.5,
          .look_px = {values[Action::kLookX], values[Action::kLookY]},
          .look_rate = {values[Action::kLookRateX], values[Action::kLookRateY]},
          .wheel = values[Action::kWheel],
          .toggle_help = pressed(Action::kHelp),
          .toggle_panels = pressed(Action::kPanels),
          .screenshot = pressed(Action::kScreenshot),
          .reset = pressed(Action::kReset),
          .cycle_hud = pressed(Action::kHud),
          .toggle_times = pressed(Action::kTimes),
          .next_sonar = pressed(Action::kNextSonar),
          .toggle_pilot = pressed(Action::kPilot),
          .quit = pressed(Action::kQuit),
          .toggle_pause = pressed(Action::kPause),
          .step_frame = pressed(Action::kStepFrame),
          .faster =
              static_cast<int>(values[Action::kFaster]) - static_cast<int>(values[Action::kSlower]),
          .save = pressed(Action::kSave),
          .go_back = pressed(Action::kGoBack),
          .record = pressed(Action::kRecord),
          .toggle_graphs = pressed(Action::kGraphs),
          .toggle_map = pressed(Action::kMap),
          .next_inset = pressed(Action::kInset),
          .next_lamps = pressed(Action::kLamps),
          .panel_screenshot = pressed(Action::kPanelScreenshot),
          .next_range = pressed(Action::kSonarRange),
          .gain_step = static_cast<int>(values[Action::kLouder]) -
                       static_cast<int>(values[Action::kQuieter]),
          .view_step = static_cast<int>(values[Action::kNextView]) -
                       static_cast<int>(values[Action::kPreviousView])};
}

DiveInput with_commands(DiveInput input, const DiveInput& beside) {
  for (bool DiveInput::*command :
       {&DiveInput::toggle_help, &DiveInput::toggle_panels, &DiveInput::screenshot,
        &DiveInput::cycle_hud, &DiveInput::toggle_times, &DiveInput::next_sonar,
        &DiveInput::toggle_pilot, &DiveInput::quit, &DiveInput::toggle_pause,
        &DiveInput::step_frame, &DiveInput::save, &DiveInput::go_back, &DiveInput::record,
        &DiveInput::toggle_graphs, &DiveInput::toggle_map, &DiveInput::next_inset,
        &DiveInput::next_lamps, &DiveInput::panel_screenshot, &DiveInput::next_range})
    input.*command |= beside.*command;
  input.faster += beside.faster;
  input.gain_step += beside.gain_step;
  return input;
}

}  // namespace neritic::testbed
