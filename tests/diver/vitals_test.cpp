// Heart, breath, gaze and risk of the diver that the simulation has: as instruments say where they
// speak, else by effort and gas; nothing that is no number gets in.
#include "diver/vitals.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "diver/heart_monitor.hpp"
#include "diver/human_step.hpp"
#include "engine/sim/fields.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

constexpr double kVitalStep_s = 1.0 / 60.0;

HumanState diver_at(const Body& body, double depth_m) {
  return start_at(body, {0.0, 0.0, depth_m}, Quat(1.0, 0.0, 0.0, 0.0),
                  rotations_of(streamlined(body)));
}

void live_for(const Body& body, HumanState& state, const HumanInputs& inputs, double seconds) {
  const double depth_m = state.root.position_ned_m.z;
  for (double t = 0.0; t < seconds - 1e-9; t += kVitalStep_s) {
    state = step(body, state, inputs, kVitalStep_s);
    state.root.position_ned_m.z = depth_m;
  }
}

HumanInputs still_inputs(const Body& body) {
  HumanInputs inputs;
  inputs.joints = rotations_of(streamlined(body));
  return inputs;
}

TEST(Vitals, AHeartFollowsEffortAndRest) {
  EXPECT_NEAR(effort_heart_bpm(kRestingOxygen_l_min, 3.4), 65.0, 1e-12);
  EXPECT_NEAR(effort_heart_bpm(3.4, 3.4), 183.5, 1e-12);
  const Body body = body_with(Gear{});
  HumanState state = diver_at(body, 10.0);
  HumanInputs inputs = still_inputs(body);
  live_for(body, state, inputs, 30.0);
  const VitalState rested = state.life.vitals;
  EXPECT_NEAR(rested.heart_bpm, 65.0, 3.0);
  EXPECT_GT(rested.breath_bpm, 5.0);
  EXPECT_EQ(rested.measured, 0u);
  EXPECT_NEAR(rested.risk.co2_mmhg, 42.0, 2.0);
  inputs.other_power_w = 120.0;  // 1.5 l/min of oxygen
  live_for(body, state, inputs, 180.0);
  EXPECT_GT(state.life.vitals.heart_bpm, 95.0);
  EXPECT_LT(state.life.vitals.heart_bpm, 130.0);
  EXPECT_GT(state.life.vitals.breath_bpm, rested.breath_bpm);
  inputs.other_power_w = 0.0;
  live_for(body, state, inputs, 300.0);
  EXPECT_NEAR(state.life.vitals.heart_bpm, 65.0, 3.0);
}

TEST(Vitals, WhatAnInstrumentSaysIsTakenUntilItFallsSilent) {
  const Body body = body_with(Gear{});
  HumanState state = diver_at(body, 10.0);
  HumanInputs inputs = still_inputs(body);
  HeartMonitor strap;
  for (int i = 0; i < 20; ++i) strap.push_interval(0.5);
  inputs.instruments.heart = strap.state();
  inputs.instruments.breath.time_s = 20.0;
  inputs.instruments.breath.estimate = {14.5, 0.9, 6.0, 1};
  inputs.instruments.gaze.time_s = 3.0;
  inputs.instruments.gaze.now = GazeClass::kFixation;
  inputs.instruments.gaze.direction = {0.6, 0.0, 0.8};
  state = step(body, state, inputs, kVitalStep_s);
  EXPECT_EQ(state.life.vitals.measured, kHeartMeasured | kBreathMeasured | kGazeMeasured);
  EXPECT_NEAR(state.life.vitals.heart_bpm, 120.0, 1e-9);
  EXPECT_EQ(state.life.vitals.breath_bpm, 14.5);
  EXPECT_NEAR(glm::distance(state.life.vitals.gaze_ned, Vec3(0.6, 0.0, 0.8)), 0.0, 1e-12);
  live_for(body, state, inputs, 2.0);  // eyes would have been seen again by now
  EXPECT_EQ(state.life.vitals.measured, kHeartMeasured | kBreathMeasured);
  live_for(body, state, inputs, 10.0);
  EXPECT_EQ(state.life.vitals.measured, kBreathMeasured);
  EXPECT_NEAR(state.life.vitals.heart_bpm, 65.0, 3.0);
  strap.push_interval(0.5);
  inputs.instruments.heart = strap.state();
  live_for(body, state, inputs, 1.0);
  EXPECT_EQ(state.life.vitals.measured & kHeartMeasured, kHeartMeasured);
  live_for(body, state, inputs, 30.0);
  EXPECT_EQ(state.life.vitals.measured, 0u);
}

// An instrument that hears nothing it knows says nothing of the diver: a robot is not told of one
// who does not breathe, nor of noise as a heart.
TEST(Vitals, AnInstrumentThatKnowsNothingMeasuresNothing) {
  const Body body = body_with(Gear{});
  HumanState state = diver_at(body, 10.0);
  HumanInputs inputs = still_inputs(body);
  inputs.instruments.breath.time_s = 10.0;
  inputs.instruments.breath.estimate = {0.0, 0.5, 6.0, 0};
  inputs.instruments.breath.quiet_s = 2.0;
  inputs.instruments.heart.time_s = 10.0;
  inputs.instruments.heart.rate_bpm = 186.0;
  inputs.instruments.heart.quality = SignalQuality::kPoor;
  live_for(body, state, inputs, 5.0);
  EXPECT_EQ(state.life.vitals.measured, 0u);
  EXPECT_GT(state.life.vitals.breath_bpm, 5.0);
  EXPECT_NEAR(state.life.vitals.heart_bpm, 65.0, 5.0);
  EXPECT_EQ(state.life.vitals.pause_s, 0.0);
  inputs.instruments.breath.time_s = 20.0;
  inputs.instruments.breath.quiet_s = 8.0;  // a pause is something known
  state = step(body, state, inputs, kVitalStep_s);
  EXPECT_EQ(state.life.vitals.measured, kBreathMeasured);
  EXPECT_EQ(state.life.vitals.breath_bpm, 0.0);
  EXPECT_EQ(state.life.vitals.pause_s, 8.0);
}

TEST(Vitals, ASwimmerLooksAheadAndTheHeadTurnsTheGaze) {
  const Body body = body_with(Gear{});
  HumanState state = diver_at(body, 10.0);
  HumanInputs inputs = still_inputs(body);
  live_for(body, state, inputs, 0.5);
  const Vec3 ahead = state.life.vitals.gaze_ned;
  EXPECT_GT(ahead.x, 0.5);
  EXPECT_GT(ahead.z, 0.3);  // ahead and below
  EXPECT_NEAR(ahead.y, 0.0, 0.05);
  JointAngles turned = streamlined(body);
  turned[joint_of(kHead)].x = radians(-50.0);  // twist about the body's forward axis
  inputs.joints = rotations_of(turned);
  live_for(body, state, inputs, 2.0);
  EXPECT_GT(state.life.vitals.gaze_ned.y, 0.3);
  EXPECT_NEAR(glm::length(state.life.vitals.gaze_ned), 1.0, 1e-12);
}

TEST(Vitals, WhatIsNoNumberIsRefusedCountedAndTheLastGoodWordHeld) {
  const Body body = body_with(Gear{});
  HumanInputs good = still_inputs(body);
  good.instruments.heart.time_s = 4.0;
  good.instruments.heart.rate_bpm = 90.0;
  good.instruments.heart.quality = SignalQuality::kGood;
  const HumanState before = step(body, diver_at(body, 10.0), good, kVitalStep_s);
  ASSERT_EQ(before.refused_inputs, 0u);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(),
                           std::numeric_limits<double>::infinity(), -1e300}) {
    HumanInputs inputs = good;
    inputs.instruments.heart.rate_bpm = bad;
    inputs.instruments.breath.estimate.rate_bpm = bad;
    inputs.instruments.gaze.direction.y = bad;
    const HumanState after = step(body, before, inputs, kVitalStep_s);
    EXPECT_EQ(after.refused_inputs, 3u) << bad;
    EXPECT_EQ(after.life.vitals.heart_bpm, 90.0);
    EXPECT_TRUE(sim::all_finite(after));
    HumanState as_good = step(body, before, good, kVitalStep_s);
    as_good.refused_inputs = after.refused_inputs;
    EXPECT_TRUE(sim::same_bits(after, as_good)) << bad;
  }
}

// CO2 comes to the alveolar equation's steady state, and rises by some mmHg a minute without
// breath.
TEST(VitalRisk, Co2RisesWithoutBreathAndSettlesWithIt) {
  RiskInput in;
  in.over_s = 10.0;
  in.oxygen_uptake_l_min = 1.2;
  in.ventilation_l_min = 20.0;
  RiskProxies risk;
  for (int i = 0; i < 400; ++i) risk = assess_risk(risk, in);
  EXPECT_NEAR(risk.co2_mmhg, arterial_co2_mmhg(0.85 * 1.2, 0.7 * 20.0), 1e-6);
  // As long steps as one likes.
  RiskProxies at_once;
  in.over_s = 4000.0;
  EXPECT_NEAR(assess_risk(at_once, in).co2_mmhg, risk.co2_mmhg, 1e-6);

  const Body body = body_with(Gear{});
  HumanState state = diver_at(body, 10.0);
  HumanInputs inputs = still_inputs(body);
  live_for(body, state, inputs, 60.0);
  const double before_mmhg = state.life.vitals.risk.co2_mmhg;
  EXPECT_EQ(state.life.vitals.risk.breathing, RiskLevel::kLow);
  inputs.hold_breath = 1;
  live_for(body, state, inputs, 60.0);
  EXPECT_GT(state.life.vitals.risk.co2_mmhg, before_mmhg + 3.0);
  EXPECT_LT(state.life.vitals.risk.co2_mmhg, before_mmhg + 8.0);
  EXPECT_NEAR(state.life.vitals.pause_s, 60.0, 0.1);
  EXPECT_EQ(state.life.vitals.risk.breathing, RiskLevel::kSevere);
  inputs.hold_breath = 0;
  live_for(body, state, inputs, 600.0);
  EXPECT_NEAR(state.life.vitals.risk.co2_mmhg, 42.0, 1.5);
  EXPECT_EQ(state.life.vitals.risk.breathing, RiskLevel::kLow);
}

TEST(VitalRisk, AnEmptyTankIsNoBreath) {
  Gear gear;
  gear.tanks[0].pressure_pa = 0.0;
  const Body body = body_with(gear);
  HumanState state = diver_at(body, 30.0);
  live_for(body, state, still_inputs(body), 90.0);
  EXPECT_GT(state.life.lungs.unfed_s, 75.0);
  EXPECT_GT(state.life.vitals.pause_s, 75.0);
  EXPECT_GT(state.life.vitals.risk.co2_mmhg, 46.0);
  EXPECT_EQ(state.life.vitals.risk.breathing, RiskLevel::kSevere);
}

TEST(VitalRisk, WorkInDenseGasIsMoreCo2AndDepthIsMoreNarcosis) {
  const auto working = [](double depth_m, const GasMix& mix) {
    Gear gear;
    gear.tanks[0].mix = mix;
    gear.tanks[0].water_volume_m3 = 0.024;
    const Body body = body_with(gear);
    HumanState state = diver_at(body, depth_m);
    HumanInputs inputs = still_inputs(body);
    inputs.other_power_w = 230.0;
    live_for(body, state, inputs, 240.0);
    EXPECT_GT(tank_pressure(body, state.life.tanks, 0), 20e5);
    return state.life.vitals.risk;
  };
  const RiskProxies shallow = working(5.0, kAir), deep = working(60.0, kAir),
                    trimix = working(60.0, {0.18, 0.45});
  EXPECT_EQ(shallow.co2, RiskLevel::kLow);
  EXPECT_EQ(shallow.narcosis, RiskLevel::kLow);
  EXPECT_GE(deep.co2, RiskLevel::kHigh);
  EXPECT_EQ(deep.gas_density, RiskLevel::kSevere);
  EXPECT_GE(deep.narcosis, RiskLevel::kHigh);
  EXPECT_LT(trimix.co2_mmhg, deep.co2_mmhg - 3.0);
  EXPECT_EQ(trimix.narcosis, RiskLevel::kLow);
  EXPECT_NEAR(trimix.narcotic_depth_m, 29.0, 2.0);
}

TEST(Vitals, TheStateNamesEveryByte) {
  sim::check_fields_cover(HumanState{});
  sim::check_fields_cover(HumanInputs{});
  sim::check_fields_cover(Instruments{});
  sim::check_fields_cover(VitalState{});
}

}  // namespace
}  // namespace neritic::diver
