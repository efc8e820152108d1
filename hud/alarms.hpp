// A dive computer's alarms. Each begins at one limit and ends at another, a step safer, and then
// stays for at least kLeastOn_s, so that it can neither be missed nor flicker. A number that is not
// known leaves its alarm as it is. Pure functions over plain bytes; any thread.
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
// Little no-stop time, and where it is enough again; as computers on wrists come set.
inline constexpr double kLittleNoStop_min = 5.0, kEnoughNoStop_min = 7.0;
// Where an alarm ends, against its limit.
inline constexpr double kCalmAscent = 0.8;       // of the fast and the dangerous rate
inline constexpr double kCalmOxygen_bar = 0.05;  // below the limit
inline constexpr double kCalmReserve_pa = 5e5;   // over the reserve
inline constexpr double kCalmNeeded = 1.1;       // times the gas that the ascent takes

struct AlarmState {
  std::array<AlarmLevel, kAlarms> level{};
  std::array<double, kAlarms> since_s{};  // when the level was last raised
  bool on(Alarm alarm) const { return of(alarm) != AlarmLevel::kOff; }
  AlarmLevel of(Alarm alarm) const { return level[static_cast<std::size_t>(alarm)]; }
  bool any() const;
  bool operator==(const AlarmState&) const = default;
};

// The alarms at data.time_s. A time before the last one is a new start.
AlarmState step_alarms(const AlarmState& before, const DiveData& data);

const char* name_of(Alarm alarm);       // "link", "gas", "ceiling", "oxygen", "ascent", "no_stop"
const char* name_of(AlarmLevel level);  // "off", "caution", "danger"

}  // namespace neritic::hud
