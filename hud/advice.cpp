#include "hud/advice.hpp"

#include <cmath>

namespace neritic::hud {
namespace {

bool may_rise(const Situation& s) {
  return s.room == Room::kFree || s.room == Room::kBelowStop;
}

// Up as far as the stops let, and no faster than the ascent's alarm.
FixedText go_up(const Situation& s) {
  const bool slowly = s.on(Alarm::kAscent);
  if (s.room == Room::kFree) return slowly ? "GO UP SLOWLY" : "GO UP";
  return slowly ? FixedText::of("SLOWLY UP TO {}", s.stop.view())
                : FixedText::of("GO UP TO {}", s.stop.view());
}

// For a diver who may not rise.
FixedText stay_with(const char* gas, const Situation& s) {
  return FixedText::of("{}, {}", gas, s.room == Room::kAboveCeiling ? "STAY HERE" : "HOLD STOP");
}

FixedText without_gas(const Situation& s) {
  if (s.other_gas) return "CHANGE GAS";
  switch (s.room) {
    case Room::kUnknown:
      return "BUDDY'S GAS";
    case Room::kFree:
      return s.on(Alarm::kAscent) ? "BUDDY'S GAS OR GO UP SLOWLY" : "BUDDY'S GAS OR GO UP";
    case Room::kBelowStop:
      if (s.on(Alarm::kAscent)) return "BUDDY'S GAS, SLOW DOWN";
      return FixedText::of("BUDDY'S GAS, UP TO {}", s.stop.view());
    case Room::kAtStop:
    case Room::kAboveCeiling:
      break;
  }
  const bool down = s.room == Room::kAboveCeiling && s.on(Alarm::kCeiling) && !s.on(Alarm::kOxygen);
  return down ? "BUDDY'S GAS, GO DOWN" : stay_with("BUDDY'S GAS", s);
}

FixedText little_gas(const Situation& s) {
  if (s.room == Room::kUnknown) return "USE OWN GAUGES";
  if (may_rise(s)) return go_up(s);
  return stay_with(s.other_gas ? "CHANGE GAS" : "TELL BUDDY", s);
}

FixedText too_much_oxygen(const Situation& s) {
  if (s.leaner_gas) return "CHANGE GAS";
  if (s.room == Room::kUnknown) return "USE OWN GAUGES";
  return may_rise(s) ? go_up(s) : stay_with("BUDDY'S GAS", s);
}

// The alarm stays a while after the diver went down again.
FixedText above_ceiling(const Situation& s) {
  if (s.room == Room::kUnknown) return "USE OWN GAUGES";
  if (s.on(Alarm::kOxygen)) {
    const bool leaner_below = s.leaner_gas && s.room == Room::kAboveCeiling;
    return leaner_below ? "CHANGE GAS, GO DOWN" : too_much_oxygen(s);
  }
  switch (s.room) {
    case Room::kAboveCeiling:
      if (s.too_rich) return s.leaner_gas ? "CHANGE GAS, GO DOWN" : "BUDDY'S GAS, GO DOWN";
      return FixedText::of("GO DOWN TO {}", s.stop.view());
    case Room::kAtStop:
      return "HOLD STOP";
    case Room::kBelowStop:
      return FixedText::of("STAY BELOW {}", s.stop.view());
    default:
      return "GO UP SLOWLY";  // the stops are over
  }
}

// STOP RISING where nothing else asks for a way up.
FixedText too_fast(const Situation& s) {
  const bool danger = s.alarms[static_cast<std::size_t>(Alarm::kAscent)] == AlarmLevel::kDanger;
  if (s.room == Room::kAtStop || s.room == Room::kAboveCeiling) return "STOP RISING";
  const bool wants_up = s.on(Alarm::kGas) || s.on(Alarm::kOxygen) || s.on(Alarm::kNoStop);
  return danger && !wants_up ? "STOP RISING" : "SLOW DOWN";
}

FixedText little_no_stop(const Situation& s) {
  if (s.room == Room::kUnknown) return "USE OWN GAUGES";
  return may_rise(s) ? go_up(s) : "HOLD STOP";
}

FixedText act_of(Alarm alarm, AlarmLevel level, const Situation& s) {
  switch (alarm) {
    case Alarm::kLink:
      return "USE OWN GAUGES";
    case Alarm::kGas:
      return level == AlarmLevel::kDanger ? without_gas(s) : little_gas(s);
    case Alarm::kCeiling:
      return above_ceiling(s);
    case Alarm::kOxygen:
      return too_much_oxygen(s);
    case Alarm::kAscent:
      return too_fast(s);
    case Alarm::kNoStop:
      return little_no_stop(s);
  }
  return {};
}

const char* what_of(Alarm alarm, AlarmLevel level) {
  const bool danger = level == AlarmLevel::kDanger;
  switch (alarm) {
    case Alarm::kLink:
      return "CONNECTION LOST";
    case Alarm::kGas:
      return danger ? "NO GAS" : "GAS LOW";
    case Alarm::kCeiling:
      return "ABOVE CEILING";
    case Alarm::kOxygen:
      return "OXYGEN HIGH";
    case Alarm::kAscent:
      return danger ? "MUCH TOO FAST" : "TOO FAST";
    case Alarm::kNoStop:
      return "NO-STOP TIME LOW";
  }
  return "";
}

}  // namespace

Room room_of(const DiveData& d) {
  if (std::isnan(d.depth_m) || std::isnan(d.ceiling_m)) return Room::kUnknown;
  if (!(d.ceiling_m > 0.0)) return Room::kFree;
  if (d.depth_m < d.ceiling_m) return Room::kAboveCeiling;
  return d.depth_m <= owed_stop_m(d) + kStopReach_m ? Room::kAtStop : Room::kBelowStop;
}

Advice advice_of(const Situation& s) {
  std::size_t first = kAlarms;
  std::uint8_t count = 0;
  for (std::size_t i = 0; i < kAlarms; ++i) {
    if (s.alarms[i] == AlarmLevel::kOff) continue;
    ++count;
    if (first == kAlarms || s.alarms[i] > s.alarms[first]) first = i;
  }
  if (count == 0) return {};
  const auto alarm = static_cast<Alarm>(first);
  const AlarmLevel level = s.alarms[first];
  return {what_of(alarm, level), act_of(alarm, level, s), level,
          static_cast<std::uint8_t>(count - 1)};
}

}  // namespace neritic::hud
