#include "hud/numbers.hpp"

#include <cmath>
#include <numbers>

#include "diver/deco_environment.hpp"

namespace neritic::hud {
namespace {

constexpr double kFeet = 1.0 / kFoot_m, kPound_kg = 0.45359237;
// Rounding errors of summed steps are no reason to round away.
constexpr double kDust = 1e-6;
constexpr double kDeepest_m = 999.0, kMostMinutes = 999.0, kMostLeft_min = 99.0;
constexpr double kMostHours = 999.0;
constexpr int kHoursFrom_min = 1000;

double down(double v) {
  return std::floor(v + kDust);
}
double up(double v) {
  return std::ceil(v - kDust) + 0.0;  // 0, not -0
}

bool is_depth(double depth_m) {
  return depth_m > -0.05 && depth_m <= kDeepest_m;
}
double positive(double v) {
  return v > 0.0 ? v : 0.0;
}

// round: to whole numbers.
template <class Round>
FixedText depth_with(double depth_m, Units units, Round round) {
  if (!is_depth(depth_m)) return "--.-";
  const double shown = positive(depth_m);
  if (units == Units::kImperial) return FixedText::of("{:.0f}", round(shown * kFeet));
  const double tenths = round(10.0 * shown);
  if (tenths < 1000.0) return FixedText::of("{:.1f}", 0.1 * tenths);
  return FixedText::of("{:.0f}", round(shown));
}

template <class Round>
FixedText whole_depth(double depth_m, Units units, Round round) {
  if (!is_depth(depth_m)) return "--";
  const double shown = positive(depth_m);
  return FixedText::of("{:.0f}", round(units == Units::kImperial ? shown * kFeet : shown));
}

}  // namespace

double standard_depth_m(double depth_m, double bar_per_m) {
  return depth_m * bar_per_m / diver::bar_per_m_of(kStandardWater_kg_m3);
}

FixedText depth_text(double depth_m, Units units) {
  return depth_with(depth_m, units, [](double v) { return std::floor(v + 0.5); });
}

FixedText ceiling_text(double depth_m, Units units) {
  return depth_with(depth_m, units, up);
}

FixedText stop_text(double depth_m, Units units) {
  // The depth goes to the nearest step, so that a text stands for half a step less.
  return depth_with(depth_m, units, [](double v) { return v > 0.0 ? up(v + 0.5) : 0.0; });
}

FixedText limit_depth_text(double depth_m, Units units) {
  return whole_depth(depth_m, units, down);
}

FixedText minutes_left_text(double minutes) {
  if (!(minutes >= 0.0)) return "--";
  if (minutes > kMostLeft_min) return "99+";
  return FixedText::of("{:.0f}", down(minutes));
}

FixedText minutes_owed_text(double minutes) {
  if (!(minutes >= 0.0)) return "--";
  if (up(minutes) > kMostMinutes) return "999+";
  return FixedText::of("{:.0f}", up(minutes));
}

FixedText clock_text(double minutes) {
  if (!(minutes >= 0.0 && std::isfinite(minutes))) return "--:--";
  if (minutes >= kMostHours * 60.0) return "999h+";
  const auto seconds = static_cast<int>(down(60.0 * minutes));
  if (seconds >= kHoursFrom_min * 60)
    return FixedText::of("{}h{:02}", seconds / 3600, seconds / 60 % 60);
  return FixedText::of("{}:{:02}", seconds / 60, seconds % 60);
}

FixedText rate_text(double m_min, Units units) {
  const double shown = units == Units::kImperial ? m_min * kFeet : m_min;
  if (!(std::abs(shown) < 1000.0)) return "--";
  // A diver who holds the depth as well as hands can is not told to rise.
  const double size = std::abs(shown) < 0.5 ? 0.0 : up(std::abs(shown));
  return FixedText::of("{:.0f}", size);
}

FixedText pressure_text(double pa, Units units) {
  if (!(pa >= 0.0 && pa <= 1000e5)) return "---";
  if (units == Units::kImperial) return FixedText::of("{:.0f}", 10.0 * down(0.1 * pa / kPsi_pa));
  return FixedText::of("{:.0f}", down(1e-5 * pa));
}

FixedText oxygen_text(double bar) {
  if (!(bar >= 0.0 && std::isfinite(bar))) return "-.--";
  if (up(100.0 * bar) > 999.0) return "9.9+";
  return FixedText::of("{:.2f}", 0.01 * up(100.0 * bar));
}

FixedText percent_text(double percent) {
  if (!(percent >= 0.0 && std::isfinite(percent))) return "--";
  if (up(percent) > 999.0) return "999+";
  return FixedText::of("{:.0f}", up(percent));
}

FixedText heading_text(double rad) {
  if (!std::isfinite(rad)) return "---";
  const double degrees = std::fmod(std::round(rad * 180.0 / std::numbers::pi), 360.0);
  // A sum with 0 has no sign where it is 0.
  return FixedText::of("{:03.0f}", degrees < 0.0 ? degrees + 360.0 : degrees + 0.0);
}

FixedText litres_text(double m3, Units units) {
  const double litres = 1e3 * m3;
  if (!(litres >= -kDust && litres <= 99.0)) return "-.-";
  const double shown = positive(units == Units::kImperial ? litres / kPint_l : litres);
  return FixedText::of("{:.1f}", shown);
}

FixedText weight_text(double newton, Units units) {
  const double kg = std::abs(newton) / diver::kStandardGravity_m_s2;
  const double shown = units == Units::kImperial ? kg / kPound_kg : kg;
  if (!(shown < 999.0)) return "-.-";
  return FixedText::of("{:.1f}", shown);
}

FixedText beats_text(double bpm) {
  if (!(bpm >= 0.0 && bpm <= 300.0)) return "--";
  return FixedText::of("{:.0f}", std::round(bpm));
}

UnitNames unit_names(Units units) {
  return units == Units::kImperial ? UnitNames{"ft", "psi", "ft/min", "pt", "lb"}
                                   : UnitNames{"m", "bar", "m/min", "l", "kg"};
}

}  // namespace neritic::hud
