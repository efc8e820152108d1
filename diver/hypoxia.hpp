// Oxygen from a breath to the brain: a lung and the blood behind it, and how long thought lasts on
// what they hold. Pure functions over plain bytes; any thread. Pressures in mmHg (133.322 Pa).
//
// Model. The gas in the lungs is one well stirred volume V_L, the blood one store of 1 l of oxygen
// when saturated (5 l at 0.2 l a litre). With the alveolar pressure P, the arterial saturation S(P)
// and the venous one S_v:
//   V_L / 863 dP/dt = V_A h(P) (P_I - P) / 863 - q,   q = 0.2 Q (S(P) - S_v),   dS_v/dt = q - VO2
// (litres, minutes; q and VO2 at standard conditions; 863 mmHg is Fick's factor). V_A is the
// alveolar ventilation, which low oxygen raises by h; Q the heart's output. The share of oxygen in
// the gas is the state, so that its pressure falls on the way up: a breath held from depth faints
// near the surface. Not modelled: rising acidity, carbon monoxide, habituation.
#pragma once

namespace neritic::diver {

inline constexpr double kMercury_pa = 133.322;
inline constexpr double kLungVapour_mmhg = 47.0;  // at 37 C

struct HypoxiaState {
  double oxygen_share = 0.14;       // of the dry gas in the lungs
  double venous_saturation = 0.70;  // of the blood that comes back
  double pressure_mmhg = 100.0;     // alveolar
  double saturation = 0.97;         // arterial
  double dose = 0.0;                // of the time of useful consciousness that has passed; 1: lost

  static void fields(auto&& field, auto& self) {
    field("oxygen_share", self.oxygen_share);
    field("venous_saturation", self.venous_saturation);
    field("pressure_mmhg", self.pressure_mmhg);
    field("saturation", self.saturation);
    field("dose", self.dose);
  }
};

struct HypoxiaInputs {
  double inspired_share = 0.21;  // of oxygen in the dry gas that is breathed
  double ambient_pa = 101325.0;
  double ventilation_l_min = 0.0;  // of ambient pressure; 0: nothing is breathed
  double oxygen_l_min = 0.32;      // uptake, at standard conditions
  double lungs_m3 = 3e-3;
};

// Share of haemoglobin that carries oxygen (Severinghaus 1979, J. Appl. Physiol. 46, 599).
double oxygen_saturation(double pressure_mmhg);
// How many times as much low oxygen makes people breathe: 1 + 5.9 / (P - 27.1), at most 3. Fitted
// to alveolar pressures at 18 000 to 25 000 ft (37.8, 32.8, 30.4 mmHg: Boothby 1954, "Handbook of
// Respiratory Physiology in Aviation").
double hypoxic_drive(double pressure_mmhg);
// Seconds in which useful consciousness ends while the alveolar pressure stays there: from the
// times at 18 000, 22 000 and 25 000 ft (FAA AC 61-107B: 20 to 30, 5 to 10, 3 to 5 minutes) at
// Boothby's pressures there; below, chosen so that the model gives the same table's times up to 50
// 000 ft, where the pressure never settles. Infinite from 45 mmHg on.
double useful_consciousness_s(double pressure_mmhg);

// In the steady state of that breath, where nothing has been lost yet.
HypoxiaState rested(const HypoxiaInputs& inputs);
// dt_s later; stable for any dt_s. Regained consciousness: the dose decays in 20 s of good gas.
void step_hypoxia(const HypoxiaInputs& inputs, double dt_s, HypoxiaState& state);

}  // namespace neritic::diver
