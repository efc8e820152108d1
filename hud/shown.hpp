// All that a layout shows at an instant, as texts and steps: two equal ones are one picture. Made
// without allocation. Plain values; any thread.
#pragma once

#include <optional>
#include <span>

#include "hud/advice.hpp"
#include "hud/layout.hpp"
#include "hud/minute.hpp"
#include "hud/numbers.hpp"

namespace neritic::hud {

enum class Health : std::uint8_t { kGood, kWaiting, kLost };

// A stream of samples as an operator reads it: "diver/heart", "live from strap".
struct StreamHealth {
  FixedText name, note;
  Health health = Health::kGood;
  bool operator==(const StreamHealth&) const = default;
};

// The data of the operator's console beside the diver's.
struct OperatorData {
  // Where the diver looks: in the view, 0 to 1 from its left and its top.
  std::optional<Vec2> gaze;
  std::span<const StreamHealth> streams;
  // Names of the sonar and the camera whose pictures are laid over the console (draw.hpp); empty:
  // the scene has none, and there is no place for it.
  FixedText sonar, camera;
};

inline constexpr std::size_t kShownStreams = 12;
inline constexpr std::size_t kStreamsBesidePictures = 5;  // over both pictures
inline constexpr std::uint8_t kNoStep = 255;              // of a bar whose number is not known
inline constexpr int kBarSteps = 60;                      // of tissues and jacket
inline constexpr double kAscentStep_m_min = 3.0;
inline constexpr int kAscentSteps = 6;

// The diver's condition, where it is known: texts, and which of them slow the diver (bits, in their
// order).
struct ShownCondition {
  bool known = false, unconscious = false;
  FixedText saturation, co2, narcotic, oxygen, core, slowing, strength;
  std::uint8_t cautions = 0;
  bool operator==(const ShownCondition&) const = default;
};

struct Shown {
  Units units = Units::kMetric;
  FixedText depth, deepest, dive_time, no_stop, ceiling, stop, stop_min, to_surface;
  FixedText ascent, tank, gas_min, gas, mod, oxygen, cns, heading;
  FixedText jacket, lift, net, heart, breath;
  bool in_stops = false, sinks = false, net_known = false;
  // Begun steps of kAscentStep_m_min, up positive, at most kAscentSteps + 1; the bar's marks of the
  // two limits.
  int ascent_steps = 0, fast_steps = 3, dangerous_steps = 6;
  int rises = 0;  // -1 sinks, 1 rises, 0 neither, as far as the rate's text says
  int heading_deg = -1;
  std::array<std::uint8_t, diver::kCompartments> tissues{};
  std::uint8_t jacket_step = kNoStep;
  std::uint64_t buttons = 0;
  ShownCondition condition;
  std::array<AlarmLevel, kAlarms> alarms{};
  AlarmLevel cns_level = AlarmLevel::kOff;  // the colour of its number; it has no band
  Advice advice;
  // In the band while no alarm is on; on the console beside it. Empty: none.
  LongText message;
  FixedText message_from;
  // Whether a danger is shown, and whether this is the half of a second of its other colours.
  bool flashes = false, flash = false;
  // 0: not known; 1 to 255 from a trace's lower to its upper end.
  std::array<std::uint8_t, Minute::kSamples> heart_trace{}, lungs_trace{};
  bool has_gaze = false;
  int gaze_x = 0, gaze_y = 0;  // thousandths of the view
  std::array<StreamHealth, kShownStreams> streams{};
  std::size_t stream_count = 0, more_streams = 0;
  FixedText sonar, camera;

  bool operator==(const Shown&) const = default;
};

// The oxygen clock: where its number is a caution, and where a danger.
inline constexpr double kMuchCns_percent = 80.0, kFullCns_percent = 100.0;

// So long a message stays, by the scene's time.
inline constexpr double kMessage_s = 15.0;

// The ends of the traces.
inline constexpr double kHeartTrace_bpm[2] = {40.0, 180.0}, kLungsTrace_l[2] = {0.0, 7.0};

// Fields that the layout does not draw stay as in an empty Shown, so that they cost no new picture.
// seen_s: when the picture is seen, as in step_alarms.
Shown shown_of(LayoutKind layout, Units units, const DiveData& data, const AlarmState& alarms,
               const Minute& minute, const OperatorData& about, double seen_s);
// Half of kFlash_s: whether a danger is drawn in its other colours.
bool flash_at(double seen_s);

}  // namespace neritic::hud
