// The numbers that a robot beside a diver may act on: rates of heart and breath, where the diver
// looks, and the risk proxies of that effort and that gas. A value is that of a worn instrument
// (heart_monitor, breath_monitor, gaze_events); without one it follows from the effort. World
// north, east, down. Pure functions over plain bytes; any thread.
#pragma once

#include "diver/breath_rate.hpp"
#include "diver/gaze_events.hpp"
#include "diver/heart_monitor.hpp"
#include "diver/lungs.hpp"
#include "diver/risk_proxies.hpp"

namespace neritic::diver {

// The newest state of each instrument; at first none has a value.
struct Instruments {
  HeartState heart;
  BreathState breath;
  GazeState gaze;  // directions in the world, north, east, down

  static void fields(auto&& field, auto& self) {
    field("heart", self.heart);
    field("breath", self.breath);
    field("gaze", self.gaze);
  }
};

// Takes over what is finite and possible; returns how many of the three were refused: their last
// good value stays.
int take_instruments(const Instruments& said, Instruments& held);

// Bits of VitalState::measured.
inline constexpr std::uint64_t kHeartMeasured = 1, kBreathMeasured = 2, kGazeMeasured = 4;

// Without a burst of sound for so long a diver pauses; between breaths at six a minute it is less.
inline constexpr double kPauseHeard_s = 5.0;

struct VitalState {
  double heart_bpm = 0.0, breath_bpm = 0.0;
  double pause_s = 0.0;  // since the last breath, where it is held or not heard
  Vec3 gaze_ned{1.0, 0.0, 0.0};
  // The values that come from an instrument: the heart if its signal is good, the breath if a
  // rate is known or a pause of five seconds is heard (0 breaths a minute then).
  std::uint64_t measured = 0;
  RiskProxies risk;
  // Since each instrument said something new; and the time of its last word.
  double heart_silent_s = 0.0, breath_silent_s = 0.0, gaze_silent_s = 0.0;
  double heart_time_s = 0.0, breath_time_s = 0.0, gaze_time_s = 0.0;

  static void fields(auto&& field, auto& self) {
    field("heart_bpm", self.heart_bpm);
    field("breath_bpm", self.breath_bpm);
    field("pause_s", self.pause_s);
    field("gaze_ned", self.gaze_ned);
    field("measured", self.measured);
    field("risk", self.risk);
    field("heart_silent_s", self.heart_silent_s);
    field("breath_silent_s", self.breath_silent_s);
    field("gaze_silent_s", self.gaze_silent_s);
    field("heart_time_s", self.heart_time_s);
    field("breath_time_s", self.breath_time_s);
    field("gaze_time_s", self.gaze_time_s);
  }
};

// Beats a minute at this oxygen uptake: the share of the heart's reserve is that of the
// uptake's (Swain and Leutholtz 1997, Med. Sci. Sports Exerc. 29, 410), up to 208 - 0.7 age of a
// person of 35 (Tanaka 2001, J. Am. Coll. Cardiol. 37, 153), from 65 at rest.
double effort_heart_bpm(double oxygen_l_min, double most_oxygen_l_min);

// The motion and breath of the same time.
struct VitalInputs {
  GasMix mix;
  double ambient_pa = 0.0, surface_pa = kSurfacePressure_pa;
  double cns_percent = 0.0;  // as the dive computer has it
  double oxygen_l_min = kRestingOxygen_l_min, most_oxygen_l_min = 0.0;
  double ventilation_l_min = 0.0, breath_bpm = 0.0;  // 0 while the breath is held
  Vec3 face_ned{1.0, 0.0, 0.0};
};

void step_vitals(const Instruments& said, const VitalInputs& in, double dt_s, VitalState& vitals);

}  // namespace neritic::diver
