// Numbers as instruments show them: rounded to the diver's safe side, metric or imperial, dashes
// for what is not known or beyond the instrument's range. Depths are those of EN 13319: metres of
// water of 1020 kg/m3 that the measured pressure stands for, in steps of 0.1 m up to 99.9 m and of
// 1 m from there on. Pure functions without allocation; any thread.
#pragma once

#include "hud/fixed_text.hpp"

namespace neritic::hud {

enum class Units : std::uint8_t { kMetric, kImperial };

inline constexpr double kStandardWater_kg_m3 = 1020.0;  // EN 13319

// Metres that the standard has for a depth in water of bar_per_m.
double standard_depth_m(double depth_m, double bar_per_m);

// Metres as the standard has them. The depth goes to the nearest step: neither side is the safe
// one.
FixedText depth_text(double depth_m, Units units);
// The same, never shallower.
FixedText ceiling_text(double depth_m, Units units);
// In the depth's steps: where the depth's text is this one, the diver is not shallower than the
// stop.
FixedText stop_text(double depth_m, Units units);
// The deepest place for a gas: whole metres or feet, never deeper.
FixedText limit_depth_text(double depth_m, Units units);
// Whole minutes. Down: time that is left; up: time that is owed. No limit and more than the most
// that is shown are "99+" for time that is left, "999+" for time that is owed.
FixedText minutes_left_text(double minutes);
FixedText minutes_owed_text(double minutes);
// "34:07", down to the second; from 1000 minutes on "17h05", down to the minute.
FixedText clock_text(double minutes);
// Metres or feet a minute, with its size never smaller than it is.
FixedText rate_text(double m_min, Units units);
// Down to a bar, or to 10 psi.
FixedText pressure_text(double pa, Units units);
FixedText oxygen_text(double bar);                  // "1.32", up; "9.9+"
FixedText percent_text(double percent);             // "14", up; "999+"
FixedText heading_text(double rad);                 // "007"
FixedText litres_text(double m3, Units units);      // "3.2" litres, or pints
FixedText weight_text(double newton, Units units);  // "1.4" kg or lb, size only
FixedText beats_text(double bpm);

// Exact, but for the last digits of the pound-force.
inline constexpr double kFoot_m = 0.3048, kCubicFoot_l = 28.316846592;
inline constexpr double kPsi_pa = 6894.757293168, kPoundForce_n = 4.4482216152605;
inline constexpr double kPint_l = 0.473176473;

struct UnitNames {
  const char *depth, *pressure, *rate, *volume, *weight;
};
UnitNames unit_names(Units units);

}  // namespace neritic::hud
