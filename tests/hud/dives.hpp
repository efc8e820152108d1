// Divers for the tests of instruments: without stops, in stops, and one for each alarm.
#pragma once

#include <cmath>
#include <limits>

#include "diver/jacket.hpp"
#include "hud/hud.hpp"

namespace neritic::hud {

inline DiveData calm_dive() {
  DiveData d;
  d.time_s = 2000.0;
  d.bar_per_m = diver::bar_per_m_of(1025.0);
  d.dive_min = 33.31;
  d.depth_m = 18.34;
  d.deepest_m = 24.71;
  d.ceiling_m = d.stop_m = d.stop_min = 0.0;
  d.no_stop_min = 41.8;
  d.to_surface_min = 2.1;
  d.ascent_m_min = 4.2;
  d.po2_bar = 0.912;
  d.cns_percent = 12.2;
  for (std::size_t i = 0; i < d.tissues.size(); ++i)
    d.tissues[i] = 0.62 - 0.026 * static_cast<double>(i);
  d.gas_known = true;
  d.gas = {0.32, 0.0};
  d.tank_pa = 128.7e5;
  d.gas_min = 37.9;
  d.needed_l = 220.0;
  d.available_l = 1400.0;
  d.jacket_m3 = 3.24e-3;
  d.jacket_full_m3 = 16e-3;
  d.lift_n = 32.6;
  d.net_weight_n = -4.1;
  d.buttons = diver::kInflate;
  d.heading_rad = radians(217.0);
  d.heart_bpm = 92.0;
  d.breath_bpm = 14.0;
  d.lungs_m3 = 3.1e-3;
  return d;
}

inline DiveData stops_dive() {
  DiveData d = calm_dive();
  d.dive_min = 58.02;
  d.depth_m = 21.4;
  d.deepest_m = 48.2;
  d.ceiling_m = 7.43;
  d.stop_m = 9.0;
  d.stop_min = 2.2;
  d.no_stop_min = 0.0;
  d.to_surface_min = 23.4;
  d.ascent_m_min = -2.0;
  d.gas = {0.18, 0.45};
  return d;
}

inline DiveData alarmed_dive(Alarm alarm, AlarmLevel level) {
  const bool danger = level == AlarmLevel::kDanger;
  DiveData d = alarm == Alarm::kCeiling ? stops_dive() : calm_dive();
  switch (alarm) {
    case Alarm::kLink:
      d = {};
      d.link_lost = true;
      break;
    case Alarm::kGas:
      d.tank_pa = danger ? 1.2e5 : 44.3e5;
      d.gas_min = 0.0;
      d.out_of_gas = danger;
      break;
    case Alarm::kCeiling:
      d.depth_m = 6.9;
      d.ceiling_violated = true;
      break;
    case Alarm::kOxygen:
      d.po2_bar = 1.52;
      d.depth_m = 36.2;
      break;
    case Alarm::kAscent:
      d.ascent_m_min = danger ? 19.3 : 11.2;
      d.ascent_alarm = danger ? diver::AscentAlarm::kDangerous : diver::AscentAlarm::kFast;
      break;
    case Alarm::kNoStop:
      d.no_stop_min = 4.3;
      break;
  }
  return d;
}

struct NamedDive {
  std::string name;
  DiveData data;
};

inline std::vector<NamedDive> all_dives() {
  std::vector<NamedDive> out{{"calm", calm_dive()}, {"stops", stops_dive()}, {"unknown", {}}};
  for (std::size_t i = 0; i < kAlarms; ++i)
    for (const AlarmLevel level : {AlarmLevel::kCaution, AlarmLevel::kDanger}) {
      const auto alarm = static_cast<Alarm>(i);
      const DiveData data = alarmed_dive(alarm, level);
      if (step_alarms({}, data, data.time_s).of(alarm) != level)
        continue;  // the alarm has one level only
      out.push_back({std::string(name_of(alarm)) + "_" + name_of(level), data});
    }
  // At a stop, where up is no way out.
  DiveData at_stop = stops_dive();
  at_stop.depth_m = 9.3, at_stop.tank_pa = 41.0e5, at_stop.gas_min = 0.0;
  at_stop.buttons = diver::kDeflate;
  out.push_back({"gas low at a stop", at_stop});
  at_stop.tank_pa = 1.0e5, at_stop.out_of_gas = true, at_stop.po2_bar = 1.71;
  at_stop.buttons = diver::kInflate | diver::kDeflate | diver::kDump;
  out.push_back({"no gas and much oxygen at a stop", at_stop});
  return out;
}

// A minute of quiet breaths before the instant that the data has.
inline void fill_minute(Hud& hud, const DiveData& last) {
  DiveData d = calm_dive();
  for (int i = 240; i > 0; --i) {
    d.time_s = last.time_s - 0.25 * i;
    const double phase = 2.0 * kPi * d.time_s / 4.3;
    d.lungs_m3 = (3.0 + 0.8 * std::sin(phase)) * 1e-3;
    d.heart_bpm = 92.0 + 6.0 * std::sin(0.1 * d.time_s);
    hud.observe(d, d.time_s);
  }
}

}  // namespace neritic::hud
