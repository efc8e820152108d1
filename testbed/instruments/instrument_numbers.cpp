#include "testbed/instruments/instrument_numbers.hpp"

#include <array>
#include <cmath>

namespace neritic::testbed {
namespace {

using hud::kUnknown;

// Numbers farther from 0 than this are nobody's: no depth, pressure (Pa) or time comes near.
constexpr double kMost = 1e9;

// Every number of the data under its name: visit(name, number), where number is a double&, or a
// bool&, enum& or whole number& that stands for one. Once for both directions.
template <class Data, class Visit>
void for_each_number(Data& d, Visit&& visit) {
  visit("surface_bar", d.surface_bar);
  visit("bar_per_m", d.bar_per_m);
  visit("dive_min", d.dive_min);
  visit("depth_m", d.depth_m);
  visit("deepest_m", d.deepest_m);
  visit("ceiling_m", d.ceiling_m);
  visit("no_stop_min", d.no_stop_min);
  visit("stop_m", d.stop_m);
  visit("stop_min", d.stop_min);
  visit("to_surface_min", d.to_surface_min);
  visit("ascent_m_min", d.ascent_m_min);
  visit("ascent_fast_m_min", d.ascent_limits.fast_m_min);
  visit("ascent_dangerous_m_min", d.ascent_limits.dangerous_m_min);
  visit("ascent_alarm", d.ascent_alarm);
  visit("ceiling_violated", d.ceiling_violated);
  visit("po2_bar", d.po2_bar);
  visit("cns_percent", d.cns_percent);
  visit("surface_gradient", d.surface_gradient);
  visit("gas_known", d.gas_known);
  visit("oxygen", d.gas.oxygen);
  visit("helium", d.gas.helium);
  visit("mod_po2_bar", d.mod_po2_bar);
  visit("oxygen_limit_bar", d.oxygen_limit_bar);
  visit("tank_pa", d.tank_pa);
  visit("gas_min", d.gas_min);
  visit("needed_l", d.needed_l);
  visit("available_l", d.available_l);
  visit("out_of_gas", d.out_of_gas);
  visit("other_gas", d.other_gas);
  visit("leaner_gas", d.leaner_gas);
  visit("jacket_m3", d.jacket_m3);
  visit("jacket_full_m3", d.jacket_full_m3);
  visit("lift_n", d.lift_n);
  visit("net_weight_n", d.net_weight_n);
  visit("buttons", d.buttons);
  visit("heading_rad", d.heading_rad);
  visit("heart_bpm", d.heart_bpm);
  visit("breath_bpm", d.breath_bpm);
  visit("lungs_m3", d.lungs_m3);
  visit("message_age_s", d.message_age_s);
  visit("saturation", d.saturation);
  visit("co2_mmhg", d.co2_mmhg);
  visit("narcotic_depth_m", d.narcotic_depth_m);
  visit("oxygen_dose", d.oxygen_dose);
  visit("core_c", d.core_c);
  visit("slowing", d.slowing);
  visit("strength", d.strength);
  visit("unconscious", d.unconscious);
  static constexpr std::array<const char*, diver::kCompartments> kTissues{
      "tissue_0",  "tissue_1",  "tissue_2",  "tissue_3", "tissue_4",  "tissue_5",
      "tissue_6",  "tissue_7",  "tissue_8",  "tissue_9", "tissue_10", "tissue_11",
      "tissue_12", "tissue_13", "tissue_14", "tissue_15"};
  for (std::size_t i = 0; i < kTissues.size(); ++i) visit(kTissues[i], d.tissues[i]);
}

// The numbers that others are divided by or compared with: what cannot be leaves them as they are.
void assign_number(double& to, std::string_view name, double value) {
  const auto between = [&](double least, double most) {
    if (value >= least && value <= most) to = value;
  };
  if (name == "surface_bar") return between(0.3, 1.2);
  if (name == "bar_per_m") return between(0.05, 0.2);
  if (name == "oxygen" || name == "helium") return between(0.0, 1.0);
  if (name == "mod_po2_bar" || name == "oxygen_limit_bar") return between(0.1, 3.0);
  if (name == "ascent_fast_m_min" || name == "ascent_dangerous_m_min") return between(1.0, 100.0);
  to = std::isnan(value) || (std::isfinite(value) && std::abs(value) > kMost) ? kUnknown : value;
}
void assign_number(bool& to, std::string_view, double value) {
  to = value > 0.0;
}
void assign_number(diver::AscentAlarm& to, std::string_view, double value) {
  to = value >= 2.0   ? diver::AscentAlarm::kDangerous
       : value >= 1.0 ? diver::AscentAlarm::kFast
                      : diver::AscentAlarm::kNone;
}
void assign_number(std::uint64_t& to, std::string_view, double value) {
  to = value >= 0.0 && value <= 7.0 ? static_cast<std::uint64_t>(value) : 0;
}

}  // namespace

NamedNumbers numbers_of(const hud::DiveData& data) {
  NamedNumbers out;
  for_each_number(data, [&](const char* name, const auto& value) {
    out.emplace_back(name, static_cast<double>(value));
  });
  return out;
}

bool set_number(hud::DiveData& data, std::string_view name, double value) {
  bool known = false;
  for_each_number(data, [&](const char* its_name, auto& to) {
    if (name != its_name) return;
    known = true;
    assign_number(to, name, value);
  });
  return known;
}

}  // namespace neritic::testbed
