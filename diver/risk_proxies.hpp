// Numbers a robot can be careful by: carbon dioxide, narcosis, oxygen. RISK PROXIES, NOT
// MEASUREMENTS and not a diagnosis: no validated algorithm exists, whatever shows them says so
// (kRiskNote). Pure functions; any thread.
#pragma once

#include <cstdint>
#include <limits>

namespace neritic::diver {

inline constexpr const char* kRiskNote = "risk proxy, not a measurement";

enum class RiskLevel : std::uint64_t { kLow, kRaised, kHigh, kSevere };
const char* name_of(RiskLevel level);

// From where a risk is raised, high, severe. CO2: hypercapnia from 45 mmHg, impaired from 50,
// narcosis from 60 (Cherry 2009, J. Appl. Physiol. 106, 316, and textbooks). Narcotic depth: 30 m
// is the usual limit by plan, 40 m that of recreational diving, beyond 60 m air takes judgement
// away. Density: 5.2 and 6.2 g/L (Anthony and Mitchell 2016), severe a third above. Oxygen: 1.4 bar
// is the limit by plan, 1.6 that at rest (NOAA Diving Manual, 4th ed., 2001), above which no time
// is tabled.
inline constexpr double kCo2Levels_mmhg[] = {45.0, 50.0, 60.0};
inline constexpr double kNarcoticLevels_m[] = {30.0, 40.0, 60.0};
inline constexpr double kDensityLevels_kg_m3[] = {5.2, 6.2, 8.3};
inline constexpr double kOxygenLevels_bar[] = {1.4, 1.6, 1.8};

// Arterial CO2 in mmHg in the steady state: 863 VCO2 / VA, VCO2 in litres a minute STPD, VA (the
// alveolar ventilation) in litres a minute BTPS. Not finite for VA = 0.
double arterial_co2_mmhg(double co2_l_min, double alveolar_l_min);
// The part of the ventilation beyond the dead space: VE (1 - VD / VT).
double alveolar_ventilation(double ventilation_l_min, double dead_space_share);
// Oxygen uptake of a diver who fins at v m/s: 0.25 + 1.03 v + 1.83 v^2 (Pendergast 2003, average
// fins), litres a minute; v is bounded to 0 to 2.
double swimming_oxygen_l_min(double speed_m_s);

// Pressures in pascal, gas by shares.
struct RiskInput {
  double ambient_pa = 101325.0;
  double surface_pa = 101325.0;
  double oxygen = 0.21, helium = 0.0;
  double gas_density_kg_m3 = 1.2;    // of the gas breathed, at depth
  double oxygen_uptake_l_min = 0.3;  // by effort (rest: 0.25 to 0.3)
  double ventilation_l_min = 8.0;    // at depth; measured, or breath rate times tidal volume
  double cns_percent = 0.0;          // of the limit for the central nervous system
  double breath_rate_bpm = 0.0;      // 0: not known
  double pause_s = 0.0;              // since the last breath
  // So long after what was before: CO2 follows as the body's stores fill or empty. Infinite: the
  // steady state.
  double over_s = std::numeric_limits<double>::infinity();
};

struct RiskProxies {
  double co2_mmhg = 40.0;
  double narcotic_depth_m = 0.0;  // the depth of air that would be as narcotic, O2 counted as N2
  double oxygen_bar = 0.21;       // partial pressure of what is breathed
  RiskLevel co2 = RiskLevel::kLow, narcosis = RiskLevel::kLow, gas_density = RiskLevel::kLow,
            breathing = RiskLevel::kLow;
  RiskLevel oxygen = RiskLevel::kLow;  // too much now or so far, or too little
  std::uint64_t refused = 0;

  static void fields(auto&& field, auto& self) {
    field("co2_mmhg", self.co2_mmhg);
    field("narcotic_depth_m", self.narcotic_depth_m);
    field("oxygen_bar", self.oxygen_bar);
    field("co2", self.co2);
    field("narcosis", self.narcosis);
    field("gas_density", self.gas_density);
    field("breathing", self.breathing);
    field("oxygen", self.oxygen);
    field("refused", self.refused);
  }
};

// Holds the last good proxies: input that is no number, or that no diver has, is refused and
// counted. Trivially copyable; a step is a pure function.
RiskProxies assess_risk(const RiskProxies& before, const RiskInput& input);

}  // namespace neritic::diver
