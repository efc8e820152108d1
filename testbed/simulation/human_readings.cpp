#include "testbed/simulation/human_readings.hpp"

#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "diver/gas_plan.hpp"

namespace neritic::testbed {
namespace {

constexpr double kNoEnd = -1.0;

double finite_or_no_end(double minutes) {
  return std::isfinite(minutes) ? minutes : kNoEnd;
}

// The quality of a value that an instrument may measure, and else the model of a diver has.
ValueQuality quality_of(const GroupState& group, bool measured) {
  if (measured) return ValueQuality::kGood;
  switch (group.phase) {
    case GroupPhase::kChosen:
      return ValueQuality::kModelled;
    case GroupPhase::kWaiting:
    case GroupPhase::kLost:
      return ValueQuality::kLost;
    case GroupPhase::kLive:
      return ValueQuality::kPoor;  // it speaks, but not so that its words could be used
  }
  return ValueQuality::kMissing;
}

}  // namespace

diver::AscentGas gas_for_ascent(const PhysicsHuman& human, const HumanPhysics& state) {
  const double now_l_min = diver::read_gas(human.body, state.human).ventilation_l_min;
  return diver::ascent_gas(*human.computer, state.human.life.computer, human.body,
                           state.human.life.tanks,
                           std::max(now_l_min, diver::PlanBreathing{}.ascent_l_min));
}

DiverMotion motion_reading(const PhysicsHuman& human, const HumanPhysics& state) {
  const diver::RootState& root = state.human.root;
  const diver::GasReading gas = diver::read_gas(human.body, state.human);
  const diver::VitalState& vitals = state.human.life.vitals;
  return {.world_from_body = world_pose(root.position_ned_m, root.attitude),
          .velocity_m_s = root.velocity.linear(),
          .angular_rad_s = root.velocity.angular(),
          .gaze = world_from_ned(vitals.gaze_ned),
          .heart_bpm = vitals.heart_bpm,
          .breath_bpm = vitals.breath_bpm,
          .ventilation_l_min = gas.ventilation_l_min,
          .tank_pa = gas.tank_pa,
          .jacket_m3 = gas.jacket_m3,
          .lungs_m3 = state.human.life.lungs.volume_m3,
          .tank = state.human.held.tank,
          .buttons = state.human.held.buttons};
}

HumanReading human_reading(const PhysicsHuman& human, const HumanPhysics& state,
                           const GazeTargets::Seen& seen) {
  const diver::VitalState& vitals = state.human.life.vitals;
  const diver::HeartState& heart = state.human.held.instruments.heart;
  const auto quality = [&](DiverGroup group, std::uint64_t bit) {
    return quality_of(state.groups[static_cast<std::size_t>(group)], (vitals.measured & bit) != 0);
  };
  HumanReading out{.gaze_object = seen.object,
                   .gaze_off_rad = seen.off_rad,
                   .gaze_distance_m = seen.distance_m,
                   .breath_bpm = vitals.breath_bpm,
                   .heart_bpm = vitals.heart_bpm,
                   .depth_m = state.human.life.computer.last.depth_m,
                   .ascent_m_min = state.human.life.computer.ascent.rate_m_min,
                   .gas_pa = diver::read_gas(human.body, state.human).tank_pa,
                   .gaze_quality = quality(DiverGroup::kGaze, diver::kGazeMeasured),
                   .breath_quality = quality(DiverGroup::kBreath, diver::kBreathMeasured),
                   .heart_quality = quality(DiverGroup::kHeart, diver::kHeartMeasured)};
  // A source that only says how deep the diver breathes has no monitor that could be poor.
  if (out.breath_quality == ValueQuality::kPoor &&
      state.human.held.instruments.breath.time_s == 0.0)
    out.breath_quality = ValueQuality::kModelled;
  if (out.gaze_quality == ValueQuality::kGood && seen.doubtful)
    out.gaze_quality = ValueQuality::kPoor;
  // A model's heart beats without variation.
  if ((vitals.measured & diver::kHeartMeasured) != 0 && heart.over_five_minutes.pairs > 0) {
    out.sdnn_ms = heart.over_five_minutes.sdnn_ms;
    out.rmssd_ms = heart.over_five_minutes.rmssd_ms;
    out.variability_quality = ValueQuality::kGood;
  }
  return out;
}

ComputerReading computer_reading(const PhysicsHuman& human, const HumanPhysics& state) {
  const diver::DiveComputerView view = gas_for_ascent(human, state).view;
  const diver::DiveComputerState& computer = state.human.life.computer;
  return {.depth_m = computer.last.depth_m,
          .ceiling_m = view.ceiling_m,
          .stop_m = view.stop_m,
          .no_stop_min = finite_or_no_end(view.no_stop_min),
          .stop_min = finite_or_no_end(view.stop_min),
          .to_surface_min = finite_or_no_end(view.to_surface_min),
          .po2_bar = view.po2_bar,
          .ascent_m_min = view.ascent_m_min,
          .cns_percent = computer.oxygen.cns_percent,
          .gas = computer.last.gas,
          .alarm = static_cast<std::uint64_t>(view.alarm)};
}

}  // namespace neritic::testbed
