// The condition of a diver who does not notice it: too little oxygen, too much, carbon dioxide,
// narcosis, cold; how much slower and weaker the diver gets by them, and when consciousness goes.
// A model of people on average for experiments, not a prediction for a person. Pure functions over
// plain bytes; any thread.
#pragma once

#include <cstdint>

#include "diver/cold.hpp"
#include "diver/gas_mix.hpp"
#include "diver/hypoxia.hpp"

namespace neritic::diver {

// Bits of what is modelled, and of what took consciousness away.
inline constexpr std::uint64_t kHypoxia = 1, kCarbonDioxide = 2, kOxygenToxicity = 4, kNarcosis = 8,
                               kCold = 16, kAllEffects = 31;
inline constexpr std::size_t kEffects = 5;
const char* name_of_effect(std::size_t bit);  // "hypoxia", "carbon_dioxide", "oxygen", ...

struct ConditionSettings {
  std::uint64_t effects = kAllEffects;
  ColdSettings cold;
  // How much oxygen the diver bears: standard deviations of the logarithm of the dose in
  // oxygen_risk(). At -1.28 nine in ten bear more.
  double oxygen_tolerance = 0.0;
};

struct ConditionInputs {
  HypoxiaInputs breath;  // what is breathed now
  ColdInputs heat;
  double co2_mmhg = 40.0;         // arterial (risk_proxies.hpp)
  double narcotic_depth_m = 0.0;  // as narcotic as air there (risk_proxies.hpp)
};

struct ConditionState {
  HypoxiaState hypoxia;
  ColdState cold;
  double oxygen_dose = 0.0;  // integral of (pO2 / atm)^3.38 over minutes
  // Shares of a minute beyond what anybody bears; at 1 consciousness is lost.
  double co2_dose = 0.0, narcosis_dose = 0.0;
  double convulses_s = 0.0;  // more to go
  double slowing = 1.0;      // of reactions and decisions: times as long as when rested
  double strength = 1.0;     // share of the work that the diver can do
  double slack = 0.0;        // of the muscles: 0 they hold the limbs, 1 they hang
  std::uint64_t lost = 0;    // bits of what takes consciousness away now; 0: conscious
  double lost_s = 0.0;       // altogether

  static void fields(auto&& field, auto& self) {
    field("hypoxia", self.hypoxia);
    field("cold", self.cold);
    field("oxygen_dose", self.oxygen_dose);
    field("co2_dose", self.co2_dose);
    field("narcosis_dose", self.narcosis_dose);
    field("convulses_s", self.convulses_s);
    field("slowing", self.slowing);
    field("strength", self.strength);
    field("slack", self.slack);
    field("lost", self.lost);
    field("lost_s", self.lost_s);
  }
};

// The share of active divers whom oxygen has made convulse by that dose: the normal distribution of
// [ln dose - 9.63] / 2.02 (Arieli, Yalov, Goldenshluger 2002, J. Appl. Physiol. 92, 248: t in
// minutes, pO2 in atmospheres, Z = [ln t - 9.63 + 3.38 ln pO2] / 2.02). Below 0.5 bar the square of
// the dose decays by 0.079 a minute (the same).
double oxygen_risk(double dose);
double oxygen_limit(double tolerance);  // the dose of a diver who bears so much

// Slower by narcosis: 20.9 % at 4 bar of air (choice reactions, Kiessling and Maag 1962, J. Appl.
// Psychol. 46, 91), in proportion to the pressure over 1 bar. By carbon dioxide: from 51 mmHg on,
// 30 % at 60 (reasoning, Sayers et al. 1987, J. Appl. Physiol. 63, 25). By cold: from 36.7 C of the
// core on, 175 % at 34.5 (Coleshaw et al. 1983, Clin. Sci. 65, 93). By too little oxygen: below a
// saturation of 0.82 (Fowler et al. 1985, Aviat. Space Environ. Med. 56, 551), 2 % a percent: an
// assumption. They add up.
double narcosis_slowing(double narcotic_depth_m);
double co2_slowing(double co2_mmhg);
double cold_slowing(double core_c);
double hypoxia_slowing(double saturation);

// Muscles go slack, and take hold again, with this lag: 94 % of the way in 2 s (an assumption).
inline constexpr double kSlackLag_s = 0.7;
// The share of the way in a step.
double slack_share(double dt_s);

// The start of a dive: rested, warm, breathing so.
ConditionState rested(const ConditionSettings& settings, const ConditionInputs& inputs);
// dt_s later. Consciousness goes: without oxygen by useful_consciousness_s(); with oxygen by a
// convulsion, 180 s with what follows, in the first 60 s of which the breath is held (US Navy
// Diving Manual, rev. 7, 3-9.2); by more than 80 mmHg of carbon dioxide or a narcotic depth of more
// than 120 m, within a minute each (assumptions: the manual's 3-5.2 and 3-9.1 give 76 mmHg breathed
// in, and stupor from 90 m on); below 30 C of the core (Danzl and Pozos 1994, N. Engl. J. Med. 331,
// 1756). Strength: as the saturation, and 5 % a degree of the core (Bergh and Ekblom 1979, Acta
// Physiol. Scand. 107, 33).
void step_condition(const ConditionSettings& settings, const ConditionInputs& inputs, double dt_s,
                    ConditionState& state);
bool holds_breath(const ConditionState& state);  // in a convulsion

}  // namespace neritic::diver
