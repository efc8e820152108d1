#include "hud/shown.hpp"

#include <algorithm>
#include <cmath>

#include "diver/condition.hpp"
#include "diver/gas_label.hpp"
#include "diver/oxygen_exposure.hpp"

namespace neritic::hud {
namespace {

std::uint8_t bar_step(double part) {
  if (!std::isfinite(part)) return kNoStep;
  return static_cast<std::uint8_t>(std::lround(std::clamp(part, 0.0, 1.0) * kBarSteps));
}

std::uint8_t trace_step(double value, const double (&ends)[2]) {
  if (!std::isfinite(value)) return 0;
  const double part = std::clamp((value - ends[0]) / (ends[1] - ends[0]), 0.0, 1.0);
  return static_cast<std::uint8_t>(1 + std::lround(254.0 * part));
}

int steps_of(double m_min) {
  return static_cast<int>(std::ceil(m_min / kAscentStep_m_min - 1e-6));
}

FixedText gas_name(const DiveData& data) {
  return data.gas_known ? FixedText(std::string_view(diver::name_of(data.gas))) : FixedText("--");
}

// Metres of the scene's water, as MOD is one for a diver in it.
FixedText mod_text(const DiveData& data, Units units) {
  if (!data.gas_known) return "--";
  const diver::DecoEnvironment where{data.surface_bar, data.bar_per_m};
  return limit_depth_text(
      standard_depth_m(diver::max_operating_depth_m(data.gas, data.mod_po2_bar, where),
                       data.bar_per_m),
      units);
}

void show_depths(const DiveData& d, Units units, Shown& out) {
  const auto standard = [&](double depth_m) { return standard_depth_m(depth_m, d.bar_per_m); };
  out.depth = depth_text(standard(d.depth_m), units);
  // Above the depth at which a dive begins the computer knows no deepest place yet.
  out.deepest = depth_text(standard(std::max(d.deepest_m, d.depth_m)), units);
  out.in_stops = d.ceiling_m > 0.0;
  out.ceiling = ceiling_text(standard(d.ceiling_m), units);
  out.stop = stop_text(standard(owed_stop_m(d)), units);
  out.stop_min = minutes_owed_text(d.stop_min);
  out.no_stop = minutes_left_text(d.no_stop_min);
  out.to_surface = minutes_owed_text(d.to_surface_min);
  out.dive_time = clock_text(d.dive_min);
}

void show_ascent(const DiveData& d, Units units, Shown& out) {
  out.ascent = rate_text(d.ascent_m_min, units);
  out.fast_steps = steps_of(d.ascent_limits.fast_m_min);
  out.dangerous_steps = steps_of(d.ascent_limits.dangerous_m_min);
  const bool moves = std::isfinite(d.ascent_m_min) && out.ascent.view() != "0";
  if (!moves || out.ascent.view() == "--") return;
  out.rises = d.ascent_m_min > 0.0 ? 1 : -1;
  out.ascent_steps = d.ascent_m_min > 0.0 ? std::min(steps_of(d.ascent_m_min), kAscentSteps + 1)
                                          : std::max(-steps_of(-d.ascent_m_min), -kAscentSteps);
}

void show_gas(const DiveData& d, Units units, Shown& out) {
  out.tank = pressure_text(d.tank_pa, units);
  out.gas_min = minutes_left_text(d.gas_min);
  out.gas = gas_name(d);
  out.mod = mod_text(d, units);
  out.oxygen = oxygen_text(d.po2_bar);
  out.cns = percent_text(d.cns_percent);
  out.cns_level = d.cns_percent >= kFullCns_percent   ? AlarmLevel::kDanger
                  : d.cns_percent >= kMuchCns_percent ? AlarmLevel::kCaution
                                                      : AlarmLevel::kOff;
}

void show_compass_and_tissues(const DiveData& d, Shown& out) {
  out.heading = heading_text(d.heading_rad);
  if (std::isfinite(d.heading_rad)) {
    const double turn_deg = std::fmod(std::round(degrees(d.heading_rad)), 360.0);
    out.heading_deg = static_cast<int>(turn_deg < 0.0 ? turn_deg + 360.0 : turn_deg);
  }
  for (std::size_t i = 0; i < out.tissues.size(); ++i) out.tissues[i] = bar_step(d.tissues[i]);
}

FixedText percent(double share) {
  return std::isnan(share) ? FixedText("--") : FixedText::of("{:.0f}", 100.0 * share);
}

// Saturation and carbon dioxide caution where they begin to slow, narcosis from 30 m on, the core
// below 36 C, oxygen from half of what the diver bears on.
ShownCondition condition_of(const DiveData& d, Units units) {
  ShownCondition out;
  out.known = d.unconscious || std::isfinite(d.slowing);
  if (!out.known) return out;
  const bool feet = units == Units::kImperial;
  out.unconscious = d.unconscious;
  out.saturation = percent(d.saturation);
  out.co2 = std::isnan(d.co2_mmhg) ? FixedText("--") : FixedText::of("{:.0f}", d.co2_mmhg);
  out.narcotic = depth_text(d.narcotic_depth_m, units);
  out.oxygen = percent(d.oxygen_dose);
  if (std::isnan(d.core_c))
    out.core = "--";
  else
    out.core = FixedText::of("{:.1f}", feet ? 32.0 + 1.8 * d.core_c : d.core_c);
  out.slowing = std::isnan(d.slowing) ? FixedText("--") : FixedText::of("{:.2f}", d.slowing);
  out.strength = percent(d.strength);
  const bool low = diver::hypoxia_slowing(d.saturation) > 0.0, cold = d.core_c < 36.0,
             weak = d.strength < 0.9;
  const bool acid = diver::co2_slowing(d.co2_mmhg) > 0.0, narcotic = d.narcotic_depth_m > 30.0;
  const bool toxic = d.oxygen_dose > 0.5, slow = d.slowing >= 1.2;
  const bool cautions[] = {low, acid, narcotic, toxic, cold, slow, weak};
  for (std::size_t i = 0; i < std::size(cautions); ++i)
    if (cautions[i]) out.cautions = static_cast<std::uint8_t>(out.cautions | (1u << i));
  return out;
}

void show_jacket(const DiveData& d, Units units, Shown& out) {
  out.jacket = litres_text(d.jacket_m3, units);
  out.jacket_step = bar_step(d.jacket_full_m3 > 0.0 ? d.jacket_m3 / d.jacket_full_m3 : kUnknown);
  out.lift = weight_text(d.lift_n, units);
  out.buttons = d.buttons;
}

void show_operator(const DiveData& d, Units units, const Minute& minute, const OperatorData& about,
                   Shown& out) {
  out.net = weight_text(d.net_weight_n, units);
  out.net_known = std::isfinite(d.net_weight_n);
  out.sinks = d.net_weight_n > 0.0;
  out.condition = condition_of(d, units);
  out.heart = beats_text(d.heart_bpm);
  out.breath = beats_text(d.breath_bpm);
  for (std::size_t i = 0; i < Minute::kSamples; ++i) {
    out.heart_trace[i] = trace_step(minute.heart_bpm[i], kHeartTrace_bpm);
    out.lungs_trace[i] = trace_step(minute.lungs_l[i], kLungsTrace_l);
  }
  const auto inside = [](double v) { return v >= 0.0 && v <= 1.0; };
  if (about.gaze && inside(about.gaze->x) && inside(about.gaze->y)) {
    out.has_gaze = true;
    out.gaze_x = static_cast<int>(std::lround(1e3 * about.gaze->x));
    out.gaze_y = static_cast<int>(std::lround(1e3 * about.gaze->y));
  }
  out.sonar = about.sonar;
  out.camera = about.camera;
  // The line of those that are left out takes a row of the shorter list.
  const bool both = !about.sonar.empty() && !about.camera.empty();
  const std::size_t most = !both ? kShownStreams
                           : about.streams.size() <= kStreamsBesidePictures
                               ? kStreamsBesidePictures
                               : kStreamsBesidePictures - 1;
  out.stream_count = std::min(about.streams.size(), most);
  out.more_streams = about.streams.size() - out.stream_count;
  std::copy_n(about.streams.begin(), out.stream_count, out.streams.begin());
}

}  // namespace

Shown shown_of(LayoutKind layout, Units units, const DiveData& data, const AlarmState& alarms,
               const Minute& minute, const OperatorData& about, double seen_s) {
  Shown out;
  out.units = units;
  show_depths(data, units, out);
  show_ascent(data, units, out);
  show_gas(data, units, out);
  show_jacket(data, units, out);
  if (layout == LayoutKind::kWrist || layout == LayoutKind::kConsole)
    show_compass_and_tissues(data, out);
  if (layout == LayoutKind::kMask) out.heading = heading_text(data.heading_rad);
  if (layout == LayoutKind::kConsole) show_operator(data, units, minute, about, out);
  out.alarms = alarms.level;
  const double stop_oxygen_bar =
      data.gas.oxygen * (data.surface_bar + data.bar_per_m * owed_stop_m(data));
  const bool too_rich = data.gas_known && stop_oxygen_bar > data.oxygen_limit_bar;
  out.advice = advice_of({alarms.level, room_of(data), data.other_gas, data.leaner_gas, too_rich,
                          FixedText::of("{} {}", out.stop.view(), unit_names(units).depth)});
  if (data.message_age_s >= 0.0 && data.message_age_s <= kMessage_s) {
    out.message = data.message;
    out.message_from = data.message_from;
  }
  const bool danger = std::ranges::any_of(
      alarms.level, [](AlarmLevel level) { return level == AlarmLevel::kDanger; });
  out.flashes = danger || out.condition.unconscious;
  out.flash = out.flashes && flash_at(seen_s);
  return out;
}

bool flash_at(double seen_s) {
  return std::fmod(std::abs(seen_s), kFlash_s) >= 0.5 * kFlash_s;
}

double owed_stop_m(const DiveData& d) {
  constexpr double kStep_m = 3.0;
  return d.stop_m >= d.ceiling_m ? d.stop_m : kStep_m * std::ceil(d.ceiling_m / kStep_m);
}

double tissue_bar(const diver::Buehlmann& model, const diver::TissueState& tissues,
                  std::size_t compartment, double ambient_bar) {
  const double gas = tissues.n2_bar[compartment] + tissues.he_bar[compartment];
  if (!(gas > ambient_bar)) return 0.5 * gas / ambient_bar;
  return 0.5 + 0.5 * diver::gradient_share(model, tissues, compartment, ambient_bar);
}

}  // namespace neritic::hud
