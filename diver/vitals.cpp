#include "diver/vitals.hpp"

#include <cmath>

#include "diver/oxygen_exposure.hpp"
#include "engine/sim/fields.hpp"

namespace neritic::diver {
namespace {

constexpr double kRestingHeart_bpm = 65.0, kMostHeart_bpm = 208.0 - 0.7 * 35.0;
constexpr double kMostHeard_bpm = 300.0, kMostBreaths_bpm = 120.0;
// An instrument that says nothing new for so long is not believed any longer: a strap speaks each
// second, breath is analysed in blocks of ten seconds, eyes are seen many times a second.
constexpr double kHeartSilence_s = 10.0, kBreathSilence_s = 30.0, kGazeSilence_s = 1.0;
constexpr double kMostWordTime_s = 1e12;

bool possible(const HeartState& heart) {
  return sim::all_finite(heart) && std::abs(heart.time_s) <= kMostWordTime_s &&
         heart.rate_bpm >= 0.0 && heart.rate_bpm <= kMostHeard_bpm;
}

bool possible(const BreathState& breath) {
  return sim::all_finite(breath) && std::abs(breath.time_s) <= kMostWordTime_s &&
         breath.estimate.rate_bpm >= 0.0 && breath.estimate.rate_bpm <= kMostBreaths_bpm &&
         breath.quiet_s >= 0.0;
}

bool possible(const GazeState& gaze) {
  const double length = glm::length(gaze.direction);
  return sim::all_finite(gaze) && std::abs(gaze.time_s) <= kMostWordTime_s && length > 0.5 &&
         length < 2.0;
}

template <class T>
int take_word(const T& said, T& held) {
  if (!possible(said)) return 1;
  held = said;
  return 0;
}

// Whether an instrument speaks: its word's time was another not long ago.
bool speaks(double time_s, double longest_s, double dt_s, double& last_time_s, double& silent_s) {
  if (time_s == 0.0) return false;  // nothing yet
  silent_s = time_s == last_time_s ? silent_s + dt_s : 0.0;
  last_time_s = time_s;
  return silent_s <= longest_s;
}

}  // namespace

int take_instruments(const Instruments& said, Instruments& held) {
  return take_word(said.heart, held.heart) + take_word(said.breath, held.breath) +
         take_word(said.gaze, held.gaze);
}

double effort_heart_bpm(double oxygen_l_min, double most_oxygen_l_min) {
  const double share =
      (oxygen_l_min - kRestingOxygen_l_min) / (most_oxygen_l_min - kRestingOxygen_l_min);
  return kRestingHeart_bpm + glm::clamp(share, 0.0, 1.0) * (kMostHeart_bpm - kRestingHeart_bpm);
}

void step_vitals(const Instruments& said, const VitalInputs& in, double dt_s, VitalState& vitals) {
  const bool heart = speaks(said.heart.time_s, kHeartSilence_s, dt_s, vitals.heart_time_s,
                            vitals.heart_silent_s) &&
                     said.heart.rate_bpm > 0.0 && said.heart.quality == SignalQuality::kGood;
  // No rate known is not no breath.
  const bool breath = speaks(said.breath.time_s, kBreathSilence_s, dt_s, vitals.breath_time_s,
                             vitals.breath_silent_s) &&
                      (said.breath.estimate.breathing != 0 || said.breath.quiet_s >= kPauseHeard_s);
  const bool gaze =
      speaks(said.gaze.time_s, kGazeSilence_s, dt_s, vitals.gaze_time_s, vitals.gaze_silent_s) &&
      said.gaze.now != GazeClass::kLost;
  vitals.measured =
      (heart ? kHeartMeasured : 0) | (breath ? kBreathMeasured : 0) | (gaze ? kGazeMeasured : 0);
  vitals.heart_bpm =
      heart ? said.heart.rate_bpm : effort_heart_bpm(in.oxygen_l_min, in.most_oxygen_l_min);
  vitals.breath_bpm = breath ? said.breath.estimate.rate_bpm : in.breath_bpm;
  if (breath)
    vitals.pause_s = said.breath.quiet_s;
  else
    vitals.pause_s = in.ventilation_l_min > 0.0 ? 0.0 : vitals.pause_s + dt_s;
  vitals.gaze_ned = gaze ? glm::normalize(said.gaze.direction) : in.face_ned;

  RiskInput risk;
  risk.ambient_pa = in.ambient_pa;
  risk.surface_pa = in.surface_pa;
  risk.cns_percent = in.cns_percent;
  risk.oxygen = in.mix.oxygen;
  risk.helium = in.mix.helium;
  risk.gas_density_kg_m3 = gas_density_g_l(in.mix, 1e-5 * in.ambient_pa);
  risk.oxygen_uptake_l_min = in.oxygen_l_min;
  risk.ventilation_l_min = in.ventilation_l_min;
  risk.breath_rate_bpm = vitals.breath_bpm;
  risk.pause_s = vitals.pause_s;
  risk.over_s = dt_s;
  vitals.risk = assess_risk(vitals.risk, risk);
}

}  // namespace neritic::diver
