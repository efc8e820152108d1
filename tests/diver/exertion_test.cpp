// The cost of swimming against published energy costs, and how hard work tires a diver.
#include "diver/exertion.hpp"

#include <gtest/gtest.h>

#include "engine/sim/fields.hpp"
#include "engine/sim/state_hash.hpp"
#include "tests/diver/swims.hpp"

namespace neritic::diver {
namespace {

constexpr double kMass_kg = 75.0, kStep_s = 1.0 / 120.0;

SwimmerSettings fast_legs() {
  SwimmerSettings settings;
  settings.kick.amplitude_m = 0.20;
  settings.most_frequency_hz = 3.0;
  return settings;
}

// Swims straight on; means of the last half.
struct Paced {
  double speed_m_s = 0.0, kick_hz = 0.0, metabolic_w = 0.0, moving_w = 0.0, power_w = 0.0;
};
Paced keep_pace(const Body& body, const SwimmerSettings& settings, double speed_m_s, Swim& s,
                double seconds) {
  Paced mean;
  const int steps = static_cast<int>(seconds / kStep_s);
  for (int i = 0; i < steps; ++i) {
    if (i % 2 == 0)
      swim(body, settings, {{1000.0, 0.0, 15.0}, speed_m_s}, s.state, s.swimmer, 2.0 * kStep_s,
           s.inputs);
    s.state = step(body, s.state, s.inputs, kStep_s);
    if (i < steps / 2) continue;
    const LifeState& life = s.state.life;
    const double share = 1.0 / (steps - steps / 2);
    mean.speed_m_s += share * s.state.root.velocity[0];
    mean.kick_hz += share * s.swimmer.frequency_hz;
    mean.metabolic_w += share * metabolic_power_w(life.limb_power_w, life.moving_power_w);
    mean.moving_w += share * life.moving_power_w;
    mean.power_w += share * life.limb_power_w;
  }
  return mean;
}
Paced keep_pace(const Gear& gear, double speed_m_s) {
  const Body body = body_with(gear);
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  return keep_pace(body, fast_legs(), speed_m_s, s, 40.0);
}

// Zamparo et al. 2006: 10.6 +- 1.8 J a metre and kg at 0.8 m/s, at 1.60 +- 0.22 kicks a second;
// fins take 50 to 60 % less. Zamparo et al. 2002: 40 % less; internal power 6.9 W times the cube of
// kicks a second.
TEST(Exertion, BareFeetCostWhatIsPublishedAndFinsHalfOfIt) {
  const Paced bare = keep_pace(no_gear(), 0.8);
  const double cost_j_m_kg = bare.metabolic_w / bare.speed_m_s / kMass_kg;
  EXPECT_NEAR(bare.speed_m_s, 0.8, 0.02);
  EXPECT_NEAR(cost_j_m_kg, 10.6, 1.8);
  EXPECT_NEAR(bare.kick_hz, 1.60, 0.25);
  // Joints are filtered at 6 Hz, which takes speed from a fast kick.
  EXPECT_NEAR(bare.moving_w / std::pow(bare.kick_hz, 3.0), 6.9, 3.0);
  const Paced fins = keep_pace(fins_only(), 0.8);
  EXPECT_NEAR(fins.metabolic_w / bare.metabolic_w, 0.48, 0.14);
}

// Between 0.5 and 0.8 m/s the cost of a metre grows with the speed, and never falls to what a
// muscle's 0.25 of the water's work alone would give.
TEST(Exertion, SlowerBareFeetCostLessAMetreButMoreThanTheWatersWork) {
  double before = 0.0;
  for (const double speed_m_s : {0.4, 0.6}) {
    const Paced bare = keep_pace(no_gear(), speed_m_s);
    const double cost_j_m_kg = bare.metabolic_w / bare.speed_m_s / kMass_kg;
    EXPECT_GT(cost_j_m_kg, before + 0.5);
    EXPECT_GT(bare.metabolic_w, 1.6 * bare.power_w / 0.25);
    before = cost_j_m_kg;
  }
}

// Two-parameter model: W' over the excess, from either step; the rest as an exponential.
TEST(Exertion, WorkAboveTheCriticalPowerEndsWhenTheReserveDoes) {
  Fitness fitness;
  fitness.most_oxygen_l_min = 3.4;
  const double critical_w = critical_power_w(fitness);
  EXPECT_NEAR(oxygen_for_l_min(critical_w), 0.75 * 3.4, 1e-12);
  const double reserve_j = 16e3 / 0.30, excess_w = 200.0;
  for (const double dt_s : {0.01, 1.0}) {
    double spent_j = 0.0, time_s = 0.0;
    while (reserve_share(fitness, spent_j) > 1e-9 && time_s < 1e4) {
      spent_j = spent_after(fitness, spent_j, critical_w + excess_w, dt_s);
      time_s += dt_s;
    }
    EXPECT_NEAR(time_s, reserve_j / excess_w, 1.01 * dt_s);
    for (time_s = 0.0; time_s < 300.0; time_s += dt_s)
      spent_j = spent_after(fitness, spent_j, 0.0, dt_s);
    EXPECT_NEAR(spent_j / reserve_j, std::exp(-critical_w / reserve_j * time_s), 1e-6);
  }
  EXPECT_NEAR(strongest_power_w(fitness, reserve_j), critical_w, 1e-9);
  EXPECT_GT(strongest_power_w(fitness, 0.0), 1.5 * critical_w);
  EXPECT_EQ(spent_after(fitness, 0.0, 0.99 * critical_w, 1e4), 0.0);
  fitness.tires = false;
  EXPECT_EQ(spent_after(fitness, 0.0, 5.0 * critical_w, 1e4), 0.0);
}

// A diver with full gear who asks for 228 W of the legs: within five minutes the pace falls, more
// is breathed and the heart beats faster; a rest restores.
TEST(Exertion, AHardPaceTiresWithinFiveMinutesAndRestRestores) {
  const Body body = body_with(Gear{});
  Swim s = begin(body, {0.0, 0.0, 15.0}, 0.0);
  const SwimmerSettings settings;
  const Paced fresh = keep_pace(body, settings, 0.68, s, 60.0);
  const double fresh_oxygen = s.state.life.lungs.oxygen_l_min;
  const double fresh_heart = s.state.life.vitals.heart_bpm;
  EXPECT_GT(fresh.power_w, 220.0);
  keep_pace(body, settings, 0.68, s, 200.0);
  const Paced tired = keep_pace(body, settings, 0.68, s, 40.0);
  EXPECT_LT(reserve_share(body.fitness, s.state.life.spent_j), 0.5);
  EXPECT_LT(tired.speed_m_s, fresh.speed_m_s - 0.005);
  EXPECT_GT(s.state.life.lungs.oxygen_l_min, fresh_oxygen + 0.2);
  EXPECT_GT(s.state.life.vitals.heart_bpm, fresh_heart + 8.0);
  HumanState rested = s.state;
  rested.life.spent_j = 0.0;
  EXPECT_NE(sim::state_hash(rested), sim::state_hash(s.state));  // saved and hashed
  s.state.life.spent_j *= 10.0;  // exhausted: the critical power is what is left
  const Paced spent = keep_pace(body, settings, 0.68, s, 40.0);
  EXPECT_NEAR(spent.metabolic_w, critical_power_w(body.fitness),
              0.06 * critical_power_w(body.fitness));
  EXPECT_LT(spent.speed_m_s, 0.65);
  EXPECT_GT(spent.speed_m_s, 0.55);
  const double heart = s.state.life.vitals.heart_bpm;
  for (int i = 0; i < 300 * 10; ++i) {
    s.inputs.joints = rotations_of(streamlined(body));
    s.state = step(body, s.state, s.inputs, 0.1, 0.1);
  }
  EXPECT_GT(reserve_share(body.fitness, s.state.life.spent_j), 0.9);
  EXPECT_LT(s.state.life.vitals.heart_bpm, heart - 60.0);
}

// The same pace, tired: the uptake drifts up, never above the most; at rest nothing drifts.
TEST(Exertion, ATiredDiverTakesUpMoreForTheSameWork) {
  Fitness fitness;
  fitness.most_oxygen_l_min = 3.4;
  const double all_j = 16e3 / 0.30;
  for (const double metabolic_w : {0.0, 200.0, 600.0, 900.0, 1e4, 1e9}) {
    const double rested = oxygen_demand_l_min(fitness, metabolic_w, 0.0);
    const double tired = oxygen_demand_l_min(fitness, metabolic_w, all_j);
    EXPECT_LE(tired, 3.4);
    EXPECT_GE(tired, rested);
    EXPECT_EQ(tired > rested, metabolic_w > 0.0 && metabolic_w < 1e3) << metabolic_w;
  }
}

TEST(Exertion, ExtremeWorkLeavesEverythingFinite) {
  for (const double mass_kg : {40.0, 150.0}) {
    BodyParameters p;
    p.build.mass_kg = mass_kg;
    const Body body = make_body(p).value();
    EXPECT_NEAR(body.fitness.most_oxygen_l_min, 0.045 * mass_kg, 1e-12);
    HumanState state = start_at(body, {0.0, 0.0, 15.0}, Quat(1.0, 0.0, 0.0, 0.0));
    HumanInputs inputs;
    inputs.other_power_w = 1e4;
    HumanDraws draws(3);
    for (int i = 0; i < 100; ++i) {
      inputs.joints = rotations_of(draws.angles(1.5));
      state = step(body, state, inputs, 0.1);
    }
    ASSERT_TRUE(sim::all_finite(state));
    EXPECT_EQ(reserve_share(body.fitness, state.life.spent_j), 0.0);
    EXPECT_LE(state.life.lungs.oxygen_l_min, body.fitness.most_oxygen_l_min);
  }
  BodyParameters p;
  p.fitness.most_oxygen_l_min = 0.1;
  EXPECT_FALSE(make_body(p).ok());
  p.fitness = {.reserve_j = std::nan("")};
  EXPECT_FALSE(make_body(p).ok());
}

}  // namespace
}  // namespace neritic::diver
