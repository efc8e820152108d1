#include "diver/hypoxia.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

namespace neritic::diver {
namespace {

constexpr double kFick_mmhg = 863.0;
constexpr double kLungDeadSpace = 0.3;    // as risk_proxies.cpp has it
constexpr double kBloodOxygen_l = 1.0;    // 5 l of blood, saturated
constexpr double kOxygenALitre_l = 0.20;  // of blood: 15 g of haemoglobin a decilitre, 1.34 ml a g
// The heart's output: 5 l a minute at rest and 5 to 6 more for each litre of oxygen (Astrand et al.
// 1964, J. Appl. Physiol. 19, 268).
constexpr double kRestingOutput_l_min = 4.0, kOutputALitre = 5.5;
constexpr double kLongestPart_s = 0.1, kMostParts = 200;
constexpr double kRecovery_s = 20.0;
constexpr double kLeastLungs_l = 0.5;
constexpr double kMostDry_mmhg = 1e6;  // no depth has more

struct TimeAt {
  double mmhg, seconds;
};
constexpr TimeAt kTimes[] = {{8.0, 5.0},    {15.0, 7.0},   {20.0, 12.0},   {25.0, 30.0},
                             {30.4, 180.0}, {32.8, 450.0}, {37.8, 1500.0}, {45.0, 7200.0}};

double dry_mmhg(double ambient_pa) {
  return std::clamp(ambient_pa / kMercury_pa - kLungVapour_mmhg, 0.0, kMostDry_mmhg);
}

double heart_output(double oxygen_l_min) {
  return kRestingOutput_l_min + kOutputALitre * std::max(0.0, oxygen_l_min);
}

void lungs_part(const HypoxiaInputs& in, double dt_s, HypoxiaState& state) {
  const double minutes = dt_s / 60.0, dry = dry_mmhg(in.ambient_pa);
  const double lungs_l = std::max(kLeastLungs_l, 1e3 * in.lungs_m3);
  const double breathed = std::max(0.0, in.ventilation_l_min) * (1.0 - kLungDeadSpace);
  double p = state.oxygen_share * dry;
  const double q = kOxygenALitre_l * heart_output(in.oxygen_l_min) *
                   (oxygen_saturation(p) - state.venous_saturation);
  // Exactly over the part with the flow into the blood as it is: P' = a (P_I - q / b - P).
  const double fresh = breathed * hypoxic_drive(p);
  const double rate = fresh / lungs_l;  // a minute
  const double inspired = std::clamp(in.inspired_share, 0.0, 1.0) * dry;
  if (rate * minutes > 1e-9)
    p += (inspired - q * kFick_mmhg / fresh - p) * -std::expm1(-rate * minutes);
  else
    p -= q * kFick_mmhg / lungs_l * minutes;
  p = std::clamp(p, 0.0, dry);
  state.oxygen_share = dry > 0.0 ? p / dry : state.oxygen_share;
  state.venous_saturation = std::clamp(
      state.venous_saturation + (q - in.oxygen_l_min) / kBloodOxygen_l * minutes, 0.0, 1.0);
  state.pressure_mmhg = p;
  state.saturation = oxygen_saturation(p);
  const double lasts_s = useful_consciousness_s(p);
  if (lasts_s < std::numeric_limits<double>::infinity())
    state.dose = std::min(2.0, state.dose + dt_s / lasts_s);
  else
    state.dose *= std::exp(-dt_s / kRecovery_s);
}

}  // namespace

double oxygen_saturation(double pressure_mmhg) {
  const double p = std::max(pressure_mmhg, 1e-6);
  return 1.0 / (23400.0 / (p * p * p + 150.0 * p) + 1.0);
}

double hypoxic_drive(double pressure_mmhg) {
  constexpr double kMost = 3.0, kFit = 5.9, kFrom_mmhg = 27.1;
  if (pressure_mmhg <= kFrom_mmhg + kFit / (kMost - 1.0)) return kMost;
  return 1.0 + kFit / (pressure_mmhg - kFrom_mmhg);
}

double useful_consciousness_s(double pressure_mmhg) {
  if (pressure_mmhg <= kTimes[0].mmhg) return kTimes[0].seconds;
  for (std::size_t i = 1; i < std::size(kTimes); ++i) {
    const TimeAt &a = kTimes[i - 1], &b = kTimes[i];
    if (pressure_mmhg >= b.mmhg) continue;
    const double share = (pressure_mmhg - a.mmhg) / (b.mmhg - a.mmhg);
    return a.seconds * std::pow(b.seconds / a.seconds, share);
  }
  return std::numeric_limits<double>::infinity();
}

HypoxiaState rested(const HypoxiaInputs& in) {
  HypoxiaState state;
  const double dry = dry_mmhg(in.ambient_pa);
  const double fresh = std::max(1e-3, in.ventilation_l_min * (1.0 - kLungDeadSpace));
  // By turns: the drive depends on the pressure.
  double p = in.inspired_share * dry;
  for (int i = 0; i < 20; ++i)
    p = std::clamp(
        in.inspired_share * dry - kFick_mmhg * in.oxygen_l_min / (fresh * hypoxic_drive(p)), 0.0,
        dry);
  state.oxygen_share = dry > 0.0 ? p / dry : 0.0;
  state.pressure_mmhg = p;
  state.saturation = oxygen_saturation(p);
  state.venous_saturation = std::clamp(
      state.saturation - in.oxygen_l_min / (kOxygenALitre_l * heart_output(in.oxygen_l_min)), 0.0,
      1.0);
  return state;
}

void step_hypoxia(const HypoxiaInputs& in, double dt_s, HypoxiaState& state) {
  if (!(dt_s > 0.0)) return;
  const double parts = std::min(kMostParts, std::ceil(dt_s / kLongestPart_s - 1e-9));
  for (int i = 0; i < static_cast<int>(parts); ++i) lungs_part(in, dt_s / parts, state);
}

}  // namespace neritic::diver
