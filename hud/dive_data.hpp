// The data of a diver that instruments show. A number that is not known is NaN: it is shown as
// dashes and neither begins nor ends an alarm. Plain values; any thread. SI units, but minutes and
// bar as dive computers have them.
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "diver/deco_ascent_rate.hpp"
#include "diver/deco_tissues.hpp"
#include "diver/gas_switch.hpp"
#include "engine/core/math.hpp"
#include "hud/fixed_text.hpp"

namespace neritic::hud {

inline constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();

// Oxygen of a bottom gas (NOAA Diving Manual, 4th ed., 2001), and of a deco gas at rest. The
// deco gas's limit leaves room for a diver a little below the switch depth (diver/gas_switch.hpp).
inline constexpr double kBottomOxygen_bar = 1.4;
inline constexpr double kDecoOxygen_bar = diver::kMostOxygen_bar + 0.05;

// The pressure of the gas in a tank from which an ascent begins at the latest.
inline constexpr double kReserve_pa = 50e5;

struct DiveData {
  double time_s = 0.0;     // of the scene; the last minute goes by it
  bool link_lost = false;  // they came from elsewhere, and come no longer

  // The dive computer. Depths are metres of the scene's water, as bar_per_m says.
  double surface_bar = diver::kStandardSurface_bar, bar_per_m = kUnknown;
  double dive_min = kUnknown, depth_m = kUnknown, deepest_m = kUnknown;
  double ceiling_m = kUnknown;    // 0: none
  double no_stop_min = kUnknown;  // infinite: no limit
  double stop_m = kUnknown, stop_min = kUnknown;
  double to_surface_min = kUnknown;  // infinite: the ceiling never clears
  double ascent_m_min = kUnknown;    // upwards is positive
  diver::AscentRateLimits ascent_limits;
  diver::AscentAlarm ascent_alarm = diver::AscentAlarm::kNone;
  bool ceiling_violated = false;
  double po2_bar = kUnknown, cns_percent = kUnknown, surface_gradient = kUnknown;
  // Inert gas of each compartment: to 0.5 its share of ambient pressure, from there on how far it
  // is on the way to its M-value at 1 (tissue_bar).
  std::array<double, diver::kCompartments> tissues = filled_tissues();

  // Gas. oxygen_limit_bar: above it is too much; mod_po2_bar: the most at the gas's deepest place.
  bool gas_known = false;
  diver::GasMix gas;
  double mod_po2_bar = kBottomOxygen_bar, oxygen_limit_bar = kBottomOxygen_bar;
  double tank_pa = kUnknown, gas_min = kUnknown;       // minutes until the reserve at this rate
  double needed_l = kUnknown, available_l = kUnknown;  // for the ascent, and in the tank
  bool out_of_gas = false;
  bool other_gas = false;  // another of the diver's tanks has gas that can be breathed here
  // The same with less oxygen than now, and no more than that tank's own limit.
  bool leaner_gas = false;

  // Jacket and body. buttons: diver::kInflate, kDeflate, kDump.
  double jacket_m3 = kUnknown, jacket_full_m3 = kUnknown;
  double lift_n = kUnknown;        // of the jacket's gas
  double net_weight_n = kUnknown;  // of the whole diver, positive sinks
  std::uint64_t buttons = 0;
  double heading_rad = kUnknown;  // from north towards east
  double heart_bpm = kUnknown, breath_bpm = kUnknown;
  double lungs_m3 = kUnknown;

  // The newest words that came by the diver's modem, who sent them, and seconds since they came.
  LongText message;
  FixedText message_from;
  double message_age_s = kUnknown;  // none came

  // The condition as the scene models it (diver/condition.hpp), each part where the scene names it.
  // For an operator: the diver does not notice it. oxygen_dose: share of what this diver bears;
  // slowing: times as long as when rested; strength: share of the work.
  double saturation = kUnknown, co2_mmhg = kUnknown, narcotic_depth_m = kUnknown;
  double oxygen_dose = kUnknown, core_c = kUnknown, slowing = kUnknown, strength = kUnknown;
  bool unconscious = false;

  static constexpr std::array<double, diver::kCompartments> filled_tissues() {
    std::array<double, diver::kCompartments> out{};
    for (double& bar : out) bar = kUnknown;
    return out;
  }
};

// The depth of the stop that is owed: the computer's next one, or where the ceiling lies deeper (it
// clears on the way up) the step of 3 m at or below that.
double owed_stop_m(const DiveData& data);

// A compartment as DiveData::tissues has it, at an ambient pressure.
double tissue_bar(const diver::Buehlmann& model, const diver::TissueState& tissues,
                  std::size_t compartment, double ambient_bar);

}  // namespace neritic::hud
