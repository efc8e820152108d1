#include "diver/condition.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr double kAtmosphere_pa = 101325.0;
constexpr double kOxygenPower = 3.38, kOxygenMean = 9.63, kOxygenSpread = 2.02;
constexpr double kToxicFrom_bar = 0.5, kOxygenRecovery_min = 2.0 / 0.079;
constexpr double kMostDose = 1e9, kMostOxygen_pa = 1e8;
constexpr double kConvulsion_s = 180.0, kBreathHeld_s = 60.0;
constexpr double kLostCo2_mmhg = 80.0, kLostNarcosis_m = 120.0, kOverMost_s = 60.0;
constexpr double kLostCore_c = 30.0;
constexpr double kMetresABar = 10.0;  // of narcotic depth
constexpr double kStrongCore_c = 37.0, kWeakerADegree = 0.05, kRestedSaturation = 0.97;
constexpr double kLeastStrength = 0.05;

// The share of a minute beyond the most; it goes back as it came.
void count_over(bool over, double dt_s, double& dose) {
  dose = std::clamp(dose + (over ? dt_s : -dt_s) / kOverMost_s, 0.0, 1.0);
}

void step_oxygen(const ConditionSettings& settings, const HypoxiaInputs& breath, double dt_s,
                 ConditionState& state) {
  const double po2_pa = std::clamp(breath.inspired_share * breath.ambient_pa, 0.0, kMostOxygen_pa);
  const bool breathes = breath.ventilation_l_min > 0.0;
  const double minutes = dt_s / 60.0;
  if (breathes && po2_pa > 1e5 * kToxicFrom_bar)
    state.oxygen_dose += minutes * std::pow(po2_pa / kAtmosphere_pa, kOxygenPower);
  else
    state.oxygen_dose *= std::exp(-minutes / kOxygenRecovery_min);
  state.oxygen_dose = std::min(state.oxygen_dose, kMostDose);
  state.convulses_s = std::max(0.0, state.convulses_s - dt_s);
  if (state.oxygen_dose >= oxygen_limit(settings.oxygen_tolerance)) {
    // Again only after a dose as large as half of the first.
    state.convulses_s = kConvulsion_s;
    state.oxygen_dose *= 0.5;
  }
}

// As good as none: so little of a joint's way is less than limbs feel.
constexpr double kHardlySlack = 1e-6;

}  // namespace

const char* name_of_effect(std::size_t bit) {
  constexpr const char* kNames[kEffects] = {"hypoxia", "carbon_dioxide", "oxygen", "narcosis",
                                            "cold"};
  return kNames[std::min(bit, kEffects - 1)];
}

double oxygen_risk(double dose) {
  if (!(dose > 0.0)) return 0.0;
  const double z = (std::log(dose) - kOxygenMean) / kOxygenSpread;
  return 0.5 * std::erfc(-z / std::sqrt(2.0));
}

double oxygen_limit(double tolerance) {
  return std::exp(kOxygenMean + kOxygenSpread * tolerance);
}

double narcosis_slowing(double narcotic_depth_m) {
  return 0.209 / 3.0 * std::max(0.0, narcotic_depth_m) / kMetresABar;
}

double co2_slowing(double co2_mmhg) {
  return 0.30 / 9.0 * std::clamp(co2_mmhg - 51.0, 0.0, 150.0);
}

double cold_slowing(double core_c) {
  return 1.75 / 2.2 * std::clamp(36.7 - core_c, 0.0, 7.0);
}

double hypoxia_slowing(double saturation) {
  return 2.0 * std::clamp(0.82 - saturation, 0.0, 0.82);
}

double slack_share(double dt_s) {
  return -std::expm1(-dt_s / kSlackLag_s);
}

ConditionState rested(const ConditionSettings& settings, const ConditionInputs& in) {
  ConditionState state;
  if ((settings.effects & kHypoxia) != 0) state.hypoxia = rested(in.breath);
  if ((settings.effects & kCold) != 0) {
    state.cold.skin_c = skin_temperature_c(settings.cold, in.heat, state.cold);
  }
  return state;
}

void step_condition(const ConditionSettings& settings, const ConditionInputs& in, double dt_s,
                    ConditionState& state) {
  if (!(dt_s > 0.0)) return;
  const auto models = [&](std::uint64_t effect) { return (settings.effects & effect) != 0; };
  double slowing = 1.0, strength = 1.0;
  std::uint64_t lost = 0;
  if (models(kHypoxia)) {
    step_hypoxia(in.breath, dt_s, state.hypoxia);
    slowing += hypoxia_slowing(state.hypoxia.saturation);
    strength *= std::min(1.0, state.hypoxia.saturation / kRestedSaturation);
    // Awake again below half a dose.
    const double most = (state.lost & kHypoxia) != 0 ? 0.5 : 1.0;
    if (state.hypoxia.dose >= most) lost |= kHypoxia;
  }
  if (models(kCarbonDioxide)) {
    slowing += co2_slowing(in.co2_mmhg);
    count_over(in.co2_mmhg > kLostCo2_mmhg, dt_s, state.co2_dose);
    if (state.co2_dose >= ((state.lost & kCarbonDioxide) != 0 ? 0.5 : 1.0)) lost |= kCarbonDioxide;
  }
  if (models(kOxygenToxicity)) {
    step_oxygen(settings, in.breath, dt_s, state);
    if (state.convulses_s > 0.0) lost |= kOxygenToxicity;
  }
  if (models(kNarcosis)) {
    slowing += narcosis_slowing(in.narcotic_depth_m);
    count_over(in.narcotic_depth_m > kLostNarcosis_m, dt_s, state.narcosis_dose);
    if (state.narcosis_dose >= ((state.lost & kNarcosis) != 0 ? 0.5 : 1.0)) lost |= kNarcosis;
  }
  if (models(kCold)) {
    step_cold(settings.cold, in.heat, dt_s, state.cold);
    slowing += cold_slowing(state.cold.core_c);
    strength *= 1.0 - kWeakerADegree * std::clamp(kStrongCore_c - state.cold.core_c, 0.0, 19.0);
    if (state.cold.core_c < kLostCore_c) lost |= kCold;
  }
  state.slowing = slowing;
  state.strength = std::clamp(strength, kLeastStrength, 1.0);
  state.lost = lost;
  state.slack += ((lost != 0 ? 1.0 : 0.0) - state.slack) * slack_share(dt_s);
  if (lost == 0 && state.slack < kHardlySlack) state.slack = 0.0;
  if (lost != 0) state.lost_s += dt_s;
}

bool holds_breath(const ConditionState& state) {
  return state.convulses_s > kConvulsion_s - kBreathHeld_s;
}

}  // namespace neritic::diver
