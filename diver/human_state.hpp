// The state of a diver as one struct, x = [j, p, l]: joints and their rates, the body's place and
// motion, and what lives (breath and gas, heart and gaze, tissues, risk). Plain bytes that list
// their fields, so that states can be copied, hashed and replayed. And what acts on a diver from
// outside. Any thread.
#pragma once

#include <cstdint>

#include "diver/deco_live.hpp"
#include "diver/jacket.hpp"
#include "diver/motion.hpp"
#include "diver/vitals.hpp"

namespace neritic::diver {

// A step's inputs; each holds until it changes.
struct HumanInputs {
  JointRotations joints = straight_joints();  // where the limbs are wanted or measured
  // The water around the diver (WaterFlow, motion.hpp): at the step's start, how that changes where
  // the diver is, and the water's own acceleration.
  Vec3 current_ned_m_s{0.0}, current_change_ned_m_s2{0.0}, water_acceleration_ned_m_s2{0.0};
  Vec3 waves_ned_m_s{0.0};         // the part of the current that waves make, to and fro
  double other_power_w = 0.0;      // work beside what limbs do to the water
  double ventilation_l_min = 0.0;  // as measured; 0: by effort
  double breath_bias_m3 = 0.0;     // mean lung volume less that at rest
  std::uint64_t hold_breath = 0;   // 1: held
  std::uint64_t buttons = 0;       // kInflate, kDeflate, kDump
  std::uint64_t tank = 0;          // that is breathed from
  Instruments instruments;         // on the body

  static void fields(auto&& field, auto& self) {
    field("joints", self.joints);
    field("current_ned_m_s", self.current_ned_m_s);
    field("current_change_ned_m_s2", self.current_change_ned_m_s2);
    field("water_acceleration_ned_m_s2", self.water_acceleration_ned_m_s2);
    field("waves_ned_m_s", self.waves_ned_m_s);
    field("other_power_w", self.other_power_w);
    field("ventilation_l_min", self.ventilation_l_min);
    field("breath_bias_m3", self.breath_bias_m3);
    field("hold_breath", self.hold_breath);
    field("buttons", self.buttons);
    field("tank", self.tank);
    field("instruments", self.instruments);
  }
};

// The current without waves.
inline Vec3 steady_current_ned_m_s(const HumanInputs& in) {
  return in.current_ned_m_s - in.waves_ned_m_s;
}

// l: breath and gas, heart and gaze, tissues, risk.
struct LifeState {
  LungState lungs;
  TankState tanks;
  double jacket_moles = 0.0;
  double limb_power_w = 0.0;    // mechanical, over the last second or so
  double limb_work_j = 0.0;     // so far
  double moving_power_w = 0.0;  // to speed limbs up (LimbWork), smoothed likewise
  double spent_j = 0.0;         // of the reserve above the critical power (exertion.hpp)
  // Tissues and oxygen of a dive computer with the same breath and depth; step() only copies them,
  // and the owner of the computer steps them (deco_live.hpp).
  DiveComputerState computer;
  VitalState vitals;  // heart, breath, gaze, risk

  static void fields(auto&& field, auto& self) {
    field("lungs", self.lungs);
    field("tanks", self.tanks);
    field("jacket_moles", self.jacket_moles);
    field("limb_power_w", self.limb_power_w);
    field("limb_work_j", self.limb_work_j);
    field("moving_power_w", self.moving_power_w);
    field("spent_j", self.spent_j);
    field("computer", self.computer);
    field("vitals", self.vitals);
  }
};

struct HumanState {
  LimbState limbs;  // j
  RootState root;   // p
  LifeState life;   // l
  // The last good value of each input, how many were refused, and how many joints were ever farther
  // from where they were wanted than limbs move in a step (limb_filter.hpp).
  HumanInputs held;
  std::uint64_t refused_inputs = 0, far_joints = 0;

  static void fields(auto&& field, auto& self) {
    field("limbs", self.limbs);
    field("root", self.root);
    field("life", self.life);
    field("held", self.held);
    field("refused_inputs", self.refused_inputs);
    field("far_joints", self.far_joints);
  }
};

}  // namespace neritic::diver
