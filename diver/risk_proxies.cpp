#include "diver/risk_proxies.hpp"

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "diver/gas_mix.hpp"

namespace neritic::diver {
namespace {

static_assert(std::is_trivially_copyable_v<RiskProxies>);

// CO2 given off to O2 taken up, of mixed diet and moderate effort.
constexpr double kRespiratoryQuotient = 0.85;
// The share of each breath that reaches no alveolus: VD/VT 0.3 at rest, with a regulator's own
// space.
constexpr double kDeadSpaceShare = 0.3;
constexpr double kMetre_pa = 1e4;  // of sea water, as tables for divers count
// Raised, high, severe. Breaths per minute: above 25 is a sign of panic. 80 % of the CNS limit is
// the most by plan (NOAA). Below 0.18 bar oxygen is low, below 0.16 thinking suffers, below 0.10
// consciousness is lost; at altitude the first two limits fall to the oxygen of the air there, but
// not below the last.
constexpr double kFastBreath_bpm[] = {25.0, 30.0, 40.0};
constexpr double kCnsLevels_percent[] = {80.0, 100.0, 150.0};
constexpr double kLittleOxygen_bar[] = {0.18, 0.16, 0.10};
constexpr double kPause_s[] = {5.0, 15.0, 30.0};  // skip breathing: pauses from 5 s
constexpr double kMostCo2_mmhg = 200.0;
// Litres of CO2 that raise its pressure by a mmHg: without breathing it rises by 3.8 mmHg a minute
// of some 0.2 l a minute given off (Eger and Severinghaus 1961, Anesthesiology 22, 419).
constexpr double kCo2Store_l_mmhg = 0.2 / 3.8;

RiskLevel little_oxygen(double oxygen_bar, double surface_pa) {
  const double air_bar = 1e-5 * kAir.oxygen * surface_pa;
  const bool severe = oxygen_bar < kLittleOxygen_bar[2];
  if (severe || oxygen_bar >= air_bar) return severe ? RiskLevel::kSevere : RiskLevel::kLow;
  return oxygen_bar < kLittleOxygen_bar[1]   ? RiskLevel::kHigh
         : oxygen_bar < kLittleOxygen_bar[0] ? RiskLevel::kRaised
                                             : RiskLevel::kLow;
}

RiskLevel level_of(double value, const double (&limits)[3]) {
  int level = 0;
  for (const double limit : limits) level += value > limit;
  return static_cast<RiskLevel>(level);
}

bool is_possible(const RiskInput& in) {
  const auto within = [](double value, double low, double high) {
    return value >= low && value <= high;
  };
  return within(in.ambient_pa, 1e3, 2e7) && within(in.surface_pa, 1e4, 5e5) &&
         within(in.oxygen, 0.0, 1.0) && within(in.helium, 0.0, 1.0) &&
         in.oxygen + in.helium <= 1.0 && within(in.gas_density_kg_m3, 0.0, 400.0) &&
         within(in.oxygen_uptake_l_min, 0.0, 8.0) && within(in.ventilation_l_min, 0.0, 300.0) &&
         within(in.cns_percent, 0.0, 1e9) && within(in.breath_rate_bpm, 0.0, 120.0) &&
         within(in.pause_s, 0.0, 1e12) && in.over_s > 0.0;
}

// P' = (VCO2 - VA P / 863) / store, exactly over the time; the steady state where that is endless.
double co2_after(double before_mmhg, double co2_l_min, double alveolar_l_min, double over_s) {
  const double minutes = over_s / 60.0;
  const double rate = alveolar_l_min / (863.0 * kCo2Store_l_mmhg);  // a minute
  if (rate < 1e-9) {                                                // no breath: it only rises
    const double rise = co2_l_min > 0.0 ? co2_l_min / kCo2Store_l_mmhg * minutes : 0.0;
    return std::min(before_mmhg + rise, kMostCo2_mmhg);
  }
  const double steady = std::min(arterial_co2_mmhg(co2_l_min, alveolar_l_min), kMostCo2_mmhg);
  return steady + (before_mmhg - steady) * std::exp(-rate * minutes);
}

}  // namespace

const char* name_of(RiskLevel level) {
  constexpr const char* kNames[] = {"low", "raised", "high", "severe"};
  return kNames[static_cast<int>(level)];
}

double arterial_co2_mmhg(double co2_l_min, double alveolar_l_min) {
  return 863.0 * co2_l_min / alveolar_l_min;
}

double alveolar_ventilation(double ventilation_l_min, double dead_space_share) {
  return ventilation_l_min * (1.0 - dead_space_share);
}

double swimming_oxygen_l_min(double speed_m_s) {
  const double v = std::clamp(speed_m_s, 0.0, 2.0);
  return 0.25 + 1.03 * v + 1.83 * v * v;
}

RiskProxies assess_risk(const RiskProxies& before, const RiskInput& in) {
  RiskProxies out = before;
  if (!is_possible(in)) {
    ++out.refused;
    return out;
  }
  const double alveolar = alveolar_ventilation(in.ventilation_l_min, kDeadSpaceShare);
  const double co2 = kRespiratoryQuotient * in.oxygen_uptake_l_min;
  out.co2_mmhg = co2_after(before.co2_mmhg, co2, alveolar, in.over_s);
  // (D + 10)(1 - fHe) - 10, by pressure: as narcotic as air of that pressure.
  out.narcotic_depth_m =
      std::max(0.0, (in.ambient_pa * (1.0 - in.helium) - in.surface_pa) / kMetre_pa);
  out.co2 = level_of(out.co2_mmhg, kCo2Levels_mmhg);
  out.narcosis = level_of(out.narcotic_depth_m, kNarcoticLevels_m);
  out.oxygen_bar = 1e-5 * in.oxygen * in.ambient_pa;
  out.oxygen = std::max({level_of(out.oxygen_bar, kOxygenLevels_bar),
                         level_of(in.cns_percent, kCnsLevels_percent),
                         little_oxygen(out.oxygen_bar, in.surface_pa)});
  out.gas_density = level_of(in.gas_density_kg_m3, kDensityLevels_kg_m3);
  out.breathing =
      std::max(level_of(in.breath_rate_bpm, kFastBreath_bpm), level_of(in.pause_s, kPause_s));
  return out;
}

}  // namespace neritic::diver
