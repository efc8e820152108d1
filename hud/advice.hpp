// The advice about the alarms that are on: one line for all of them together. It never sends a
// diver above a ceiling, deeper while there is too much oxygen, or faster while the ascent is too
// fast. Pure functions; any thread.
//
// The remedies are those that dive computers tell (Suunto D6i user guide, table 5.3; Garmin
// Descent, "Dive Alerts"): too much oxygen: go up or change to a leaner gas; above the ceiling: go
// down to it; too fast: slow down. At a ceiling a diver with little gas takes the buddy's and stays
// until the stop is over.
#pragma once

#include "hud/alarms.hpp"
#include "hud/fixed_text.hpp"

namespace neritic::hud {

// Where a diver is to the stops that are owed. kBelowStop: there is a way up to the stop; kAtStop:
// none deeper than kStopReach_m below it; kAboveCeiling: less deep than the ceiling.
enum class Room : std::uint8_t { kUnknown, kFree, kBelowStop, kAtStop, kAboveCeiling };
// A hand's breadth of swell and breathing around a stop is no way up.
inline constexpr double kStopReach_m = 1.0;
Room room_of(const DiveData& data);

struct Situation {
  std::array<AlarmLevel, kAlarms> alarms{};
  Room room = Room::kUnknown;
  bool other_gas = false, leaner_gas = false;  // as in DiveData
  bool too_rich = false;                       // the gas has too much oxygen at the stop
  FixedText stop;                              // its depth with the unit
  bool on(Alarm alarm) const { return alarms[static_cast<std::size_t>(alarm)] != AlarmLevel::kOff; }
};

// "ASCENT TOO FAST", what to do, and how many other alarms are on.
struct Advice {
  FixedText what, act;
  AlarmLevel level = AlarmLevel::kOff;  // kOff: no alarm is on, and there are no words
  std::uint8_t others = 0;
  bool operator==(const Advice&) const = default;
};
Advice advice_of(const Situation& situation);

}  // namespace neritic::hud
