// A dive computer's alarms. Each begins at one limit and ends at another, a step safer, and then
// stays for at least kLeastOn_s, so that it can neither be missed nor flicker. These seconds are
// the viewer's, however fast the scene runs. A number that is not known leaves its alarm as it is.
// Pure functions over plain bytes; any thread.
#pragma once

#include <array>
#include <cstdint>

#include "hud/dive_data.hpp"

namespace neritic::hud {

// The most pressing first.
// kLink: the numbers come from elsewhere, and come no longer.
enum class Alarm : std::uint8_t { kLink, kGas, kCeiling, kOxygen, kAscent, kNoStop };
inline constexpr std::size_t kAlarms = 6;
enum class AlarmLevel : std::uint8_t { kOff, kCaution, kDanger };

inline constexpr double kLeastOn_s = 5.0;
// A danger changes its colours twice in this time. More than three flashes a second are a hazard
// (WCAG 2.2, 2.3.1).
inline constexpr double kFlash_s = 1.0;
// Little no-stop time, and where it is enough again; as computers on wrists come set.
inline constexpr double kLittleNoStop_min = 5.0, kEnoughNoStop_min = 7.0;
// Where an alarm ends, against its limit.
inline constexpr double kCalmAscent = 0.8;       // of the fast and the dangerous rate
inline constexpr double kCalmOxygen_bar = 0.05;  // below the limit
inline constexpr double kCalmReserve_pa = 5e5;   // over the reserve
inline constexpr double kCalmNeeded = 1.1;       // times the gas that the ascent takes

struct AlarmState {
  std::array<AlarmLevel, kAlarms> level{};
  // When the level was last raised: for the viewer, and in the scene.
  std::array<double, kAlarms> since_s{}, scene_since_s{};
  bool on(Alarm alarm) const { return of(alarm) != AlarmLevel::kOff; }
  AlarmLevel of(Alarm alarm) const { return level[static_cast<std::size_t>(alarm)]; }
  bool any() const;
  bool operator==(const AlarmState&) const = default;
};

// The alarms in a picture that is seen at seen_s, on a clock of the viewer. A scene's time before
// that of an alarm is a new start for it: an earlier state was restored.
AlarmState step_alarms(const AlarmState& before, const DiveData& data, double seen_s);

const char* name_of(Alarm alarm);       // "link", "gas", "ceiling", "oxygen", "ascent", "no_stop"
const char* name_of(AlarmLevel level);  // "off", "caution", "danger"

}  // namespace neritic::hud
