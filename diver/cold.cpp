#include "diver/cold.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr double kBodyHeat_j_kg_k = 3470.0, kCoreShare = 0.75;
// The share of the tissue's resistance that lies between core and shell.
constexpr double kWithin = 0.3;
constexpr double kNarrow_m2_k_w = 0.12, kWide_m2_k_w = 0.03, kNarrow_c = 36.8, kWide_c = 37.4;
constexpr double kNarrowSkin_c = 31.0, kWideSkin_c = 34.0;
constexpr double kNeoprene_w_m_k = 0.054;
constexpr double kFilmAtRest = 230.0, kFilmSwimming = 580.0, kSwimming_m_s = 0.5;
constexpr double kBreathOut_c = 34.0, kAirHeat_j_kg_k = 1005.0;
constexpr double kVapourAt34_kg_m3 = 0.0376, kVapourHeat_j_kg = 2.43e6;
constexpr double kMostShivering_w_m2 = 50.0, kShiversFrom_c = 32.0, kShiversTo_c = 30.0;
constexpr double kColdest_c = -2.0, kHottest_c = 44.0;  // no water is colder, no body lives hotter

}  // namespace

double skin_area_m2(double mass_kg, double height_m) {
  return 0.202 * std::pow(mass_kg, 0.425) * std::pow(height_m, 0.725);
}

double tissue_resistance(double core_c, double skin_c) {
  const double wide =
      std::clamp((core_c - kNarrow_c) / (kWide_c - kNarrow_c), 0.0, 1.0) *
      std::clamp((skin_c - kNarrowSkin_c) / (kWideSkin_c - kNarrowSkin_c), 0.0, 1.0);
  return kNarrow_m2_k_w + wide * (kWide_m2_k_w - kNarrow_m2_k_w);
}

double suit_resistance(const ColdSettings& s, const ColdInputs& in) {
  const double thick =
      1.0 - s.suit_gas_share * (1.0 - in.surface_pa / std::max(in.surface_pa, in.ambient_pa));
  const double moves = std::clamp(in.speed_m_s / kSwimming_m_s, 0.0, 1.0);
  return s.suit_m * thick / kNeoprene_w_m_k +
         1.0 / (kFilmAtRest + moves * (kFilmSwimming - kFilmAtRest));
}

double skin_temperature_c(const ColdSettings& s, const ColdInputs& in, const ColdState& state) {
  const double suit = suit_resistance(s, in);
  const double outer = (1.0 - kWithin) * tissue_resistance(state.core_c, state.skin_c) + suit;
  return std::lerp(s.water_c, state.shell_c, suit / outer);
}

double breath_heat_w(const ColdSettings& s, const ColdInputs& in) {
  const double flow_m3_s = 1e-3 / 60.0 * std::max(0.0, in.ventilation_l_min);
  return flow_m3_s * (in.gas_density_kg_m3 * kAirHeat_j_kg_k * (kBreathOut_c - s.water_c) +
                      kVapourHeat_j_kg * kVapourAt34_kg_m3);
}

double shivering_w(const ColdSettings& s, double core_c, double skin_c) {
  const double core = std::max(0.0, 37.0 - core_c), skin = std::clamp(33.0 - skin_c, 0.0, 15.0);
  const double w_m2 = (155.5 * core + 47.0 * skin - 1.57 * skin * skin) /
                      std::sqrt(100.0 * std::max(0.02, s.fat_share));
  const double fades =
      std::clamp((core_c - kShiversTo_c) / (kShiversFrom_c - kShiversTo_c), 0.0, 1.0);
  return fades * std::clamp(w_m2, 0.0, kMostShivering_w_m2) * skin_area_m2(s.mass_kg, s.height_m);
}

void step_cold(const ColdSettings& s, const ColdInputs& in, double dt_s, ColdState& state) {
  if (!(dt_s > 0.0)) return;
  const double area = skin_area_m2(s.mass_kg, s.height_m);
  const double tissue = tissue_resistance(state.core_c, state.skin_c),
               suit = suit_resistance(s, in);
  const double outer = (1.0 - kWithin) * tissue + suit;
  const auto skin_at = [&](double shell_c) { return std::lerp(s.water_c, shell_c, suit / outer); };
  state.shiver_w = shivering_w(s, state.core_c, skin_at(state.shell_c));
  const double heat_w = in.heat_w + state.shiver_w - breath_heat_w(s, in);
  const double inner_w_k = area / (kWithin * tissue), outer_w_k = area / outer;
  const double core_j_k = kBodyHeat_j_kg_k * s.mass_kg * kCoreShare,
               shell_j_k = kBodyHeat_j_kg_k * s.mass_kg * (1.0 - kCoreShare);
  // Where both would end, and how far from there they are.
  const double shell_end_c = s.water_c + heat_w / outer_w_k,
               core_end_c = shell_end_c + heat_w / inner_w_k;
  const double core = state.core_c - core_end_c, shell = state.shell_c - shell_end_c;
  // d' = [-a a; c -b] d by its two real eigenvalues m +- w, both negative.
  const double a = inner_w_k / core_j_k, c = inner_w_k / shell_j_k, b = c + outer_w_k / shell_j_k;
  const double m = -0.5 * (a + b), w = std::sqrt(0.25 * (a - b) * (a - b) + a * c);
  const double slow = std::exp((m + w) * dt_s), fast = std::exp((m - w) * dt_s);
  const double even = 0.5 * (slow + fast), odd = 0.5 * (slow - fast) / w;
  const auto bounded = [](double celsius) { return std::clamp(celsius, kColdest_c, kHottest_c); };
  state.core_c = bounded(core_end_c + even * core + odd * ((-a - m) * core + a * shell));
  state.shell_c = bounded(shell_end_c + even * shell + odd * (c * core + (-b - m) * shell));
  state.skin_c = std::lerp(s.water_c, state.shell_c, suit / outer);
}

}  // namespace neritic::diver
