// Breath and tanks: how much, how long, what happens at the end of it.
#include <gtest/gtest.h>

#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

double ambient_pa(double depth_m) {
  return kSurfacePressure_pa + kSeaWater_kg_m3 * kGravity_m_s2 * depth_m;
}

// Breathes for a while and returns what the tank lost, in litres of ambient pressure a minute.
struct Minutes {
  LungState lungs;
  TankState tanks;
};
double breathe(const Body& body, Minutes& m, double depth_m, double minutes, BreathInputs in = {},
               double dt_s = 1.0 / 240.0) {
  const double before = m.tanks.moles[0];
  const int steps = static_cast<int>(std::lround(minutes * 60.0 / dt_s));
  for (int i = 0; i < steps; ++i) step_lungs(body, m.lungs, m.tanks, in, ambient_pa(depth_m), dt_s);
  const double moles = before - m.tanks.moles[0];
  return 1e3 * moles * kGasConstant * kTankTemperature_k / ambient_pa(depth_m) / minutes;
}

BreathInputs working(const Body& body, double power_w) {
  return {.oxygen_demand_l_min =
              oxygen_demand_l_min(body.fitness, metabolic_power_w(power_w, 0.0), 0.0)};
}

TEST(Breath, ATankLosesWhatIsBreathed) {
  const Body body = body_with(Gear{});
  Minutes m{{}, full_tanks(body)};
  breathe(body, m, 20.0, 2.0, {.ventilation_l_min = 18.0});
  EXPECT_NEAR(breathe(body, m, 20.0, 10.0, {.ventilation_l_min = 18.0}), 18.0, 0.4);
}

// A 12 litre tank from 200 bar, 17.70 litres a minute at 20 m: 150 bar after ten minutes, real gas.
TEST(Breath, TenMinutesAtTwentyMetresEndAtTheGaugesReading) {
  Gear gear;
  gear.tanks[0].water_volume_m3 = 0.012;
  const Body body = body_with(gear);
  Minutes m{{}, full_tanks(body)};
  EXPECT_NEAR(tank_pressure(body, m.tanks, 0), 200e5, 1.0);
  breathe(body, m, 20.0, 10.0, {.ventilation_l_min = 17.70});
  EXPECT_NEAR(1e-5 * tank_pressure(body, m.tanks, 0), 150.0, 1.0);
}

TEST(Breath, ConsumptionGrowsWithDepthAndEffort) {
  const Body body = body_with(Gear{});
  const auto bar_a_minute = [&](double depth_m, double power_w) {
    Minutes m{{}, full_tanks(body)};
    const BreathInputs in = working(body, power_w);
    breathe(body, m, depth_m, 4.0, in);
    const double before = tank_pressure(body, m.tanks, 0);
    breathe(body, m, depth_m, 2.0, in);
    return 0.5e-5 * (before - tank_pressure(body, m.tanks, 0));
  };
  EXPECT_NEAR(bar_a_minute(20.0, 0.0) / bar_a_minute(0.0, 0.0), 3.0236, 0.15);
  EXPECT_GT(bar_a_minute(10.0, 80.0), 2.5 * bar_a_minute(10.0, 0.0));
}

// Rest 8 to 12 l/min, moderate 20 to 30, heavy 40 to 75 (NOAA, US Navy); 25 times the oxygen.
TEST(Breath, VentilationIsThatOfTheTables) {
  const Body body = body_with(Gear{});
  const auto at = [&](double power_w) {
    return ventilation_l_min(body, working(body, power_w).oxygen_demand_l_min, kAir,
                             ambient_pa(10.0));
  };
  EXPECT_NEAR(at(0.0), 8.0, 0.5);
  EXPECT_GT(at(60.0), 20.0);
  EXPECT_LT(at(60.0), 30.0);
  EXPECT_GT(at(130.0), 38.0);
  EXPECT_LT(at(200.0), 75.0);
  // Dense gas limits: less at 60 m, and helium helps.
  const double hard = 4.0;
  const double air = ventilation_l_min(body, hard, kAir, ambient_pa(60.0));
  EXPECT_LT(air, ventilation_l_min(body, hard, kAir, ambient_pa(0.0)));
  EXPECT_GT(ventilation_l_min(body, hard, {0.18, 0.45}, ambient_pa(60.0)), 1.15 * air);
}

TEST(Breath, TheMiddleOfTheLungsStaysWithEffort) {
  const Body body = body_with(Gear{});
  const auto mean_m3 = [&](double power_w) {
    Minutes m{{}, full_tanks(body)};
    breathe(body, m, 10.0, 4.0, working(body, power_w));
    double sum = 0.0;
    for (int i = 0; i < 120 * 240; ++i) {
      step_lungs(body, m.lungs, m.tanks, working(body, power_w), ambient_pa(10.0), 1.0 / 240.0);
      sum += m.lungs.volume_m3;
    }
    return sum / (120 * 240);
  };
  EXPECT_NEAR(mean_m3(0.0), 2.9e-3, 0.1e-3);
  EXPECT_NEAR(mean_m3(70.0), 2.9e-3, 0.15e-3);
}

// Six litres at the surface: 3.012 at 10 m, 2.011 at 20 m, 1.509 at 30 m.
TEST(Breath, AHeldBreathIsCompressed) {
  const Body body = body_with(Gear{});
  LungState lungs;
  lungs.volume_m3 = 6e-3;
  TankState tanks = full_tanks(body);
  const auto at = [&](double depth_m) {
    step_lungs(body, lungs, tanks, {.hold = true}, ambient_pa(depth_m), 0.01);
    return 1e3 * lungs.volume_m3;
  };
  EXPECT_NEAR(at(0.0), 6.0, 1e-9);
  EXPECT_NEAR(at(10.0), 3.0120, 1e-4);
  EXPECT_NEAR(at(20.0), 2.0107, 1e-4);
  EXPECT_NEAR(at(30.0), 1.5090, 1e-4);
  EXPECT_EQ(lungs.overstretched_s, 0.0);
  EXPECT_NEAR(at(0.0), 6.0, 1e-9);
}

TEST(Breath, HeldOnAnAscentItStretchesTheLungsAndIsCounted) {
  const Body body = body_with(Gear{});
  LungState lungs;
  lungs.volume_m3 = 5e-3;
  TankState tanks = full_tanks(body);
  for (double depth_m = 10.0; depth_m >= 0.0; depth_m -= 0.01)
    step_lungs(body, lungs, tanks, {.hold = true}, ambient_pa(depth_m), 0.05);
  EXPECT_GT(lungs.overstretched_s, 10.0);
  EXPECT_EQ(lungs.volume_m3, body.lungs.total_m3);
  // From a metre, nothing happens.
  lungs = {};
  lungs.volume_m3 = 5e-3;
  for (double depth_m = 1.0; depth_m >= 0.0; depth_m -= 0.01)
    step_lungs(body, lungs, tanks, {.hold = true}, ambient_pa(depth_m), 0.05);
  EXPECT_EQ(lungs.overstretched_s, 0.0);
}

TEST(Breath, LastsAsLongAsItSays) {
  const Body body = body_with(Gear{});
  Minutes m{{}, full_tanks(body)};
  const BreathInputs in{.ventilation_l_min = 25.0};
  breathe(body, m, 18.0, 1.0, in, 1.0 / 60.0);
  const double said_s = remaining_s(body, m.tanks, 0, 25.0, ambient_pa(18.0), 50e5);
  double seconds = 0.0;
  while (tank_pressure(body, m.tanks, 0) > 50e5) {
    step_lungs(body, m.lungs, m.tanks, in, ambient_pa(18.0), 1.0 / 60.0);
    seconds += 1.0 / 60.0;
  }
  EXPECT_NEAR(seconds, said_s, 0.02 * said_s);
  EXPECT_GT(seconds, 15.0 * 60.0);
}

TEST(Breath, AnEmptyTankGivesNothingAndIsNoticed) {
  Gear gear;
  gear.tanks[0].pressure_pa = 5e5;
  const Body body = body_with(gear);
  Minutes m{{}, full_tanks(body)};
  breathe(body, m, 20.0, 5.0);
  EXPECT_NEAR(tank_pressure(body, m.tanks, 0), ambient_pa(20.0), 0.1e5);
  EXPECT_GT(m.lungs.starved_s, 60.0);
  EXPECT_EQ(remaining_s(body, m.tanks, 0, 20.0, ambient_pa(20.0), 50e5), 0.0);
}

// Without gas to breathe the lungs are left with what they hold.
TEST(Breath, LungsWithoutGasFollowBoylesLawAndBreatheOutWhatTheyCannotHold) {
  for (const bool tanks_worn : {true, false}) {
    Gear gear;
    if (tanks_worn)
      gear.tanks[0].pressure_pa = 0.0;
    else
      gear.tanks.clear();
    const Body body = body_with(gear);
    LungState lungs;
    TankState tanks = full_tanks(body);
    const auto at = [&](double depth_m, double dt_s) {
      step_lungs(body, lungs, tanks, {}, ambient_pa(depth_m), dt_s);
      return lungs.volume_m3;
    };
    while (lungs.unfed_s < 20.0) at(30.0, 0.05);  // breathed out, and nothing came
    const double deep_m3 = at(30.0, 1e-6), sunk_m3 = at(60.0, 1e-6);
    EXPECT_NEAR(sunk_m3 * ambient_pa(60.0), deep_m3 * ambient_pa(30.0),
                1e-4 * deep_m3 * ambient_pa(30.0));
    EXPECT_NEAR(at(30.0, 1e-6), deep_m3, 1e-4 * deep_m3);
    // Risen at once, faster than breath flows: no more than the lungs hold, and that under no
    // pressure.
    EXPECT_NEAR(at(0.5, 1e-6), body.lungs.total_m3, 1e-7);
    EXPECT_EQ(lungs.overstretched_s, 0.0);
    EXPECT_LT(lungs.held_moles * kGasConstant * kTankTemperature_k,
              1.001 * body.lungs.total_m3 * ambient_pa(0.5));
  }
}

// A full breath asks for 5 bar over the water; and the water is less on a lake in the mountains.
TEST(Breath, WhichTanksAreEmptyIsSaid) {
  Gear gear;
  gear.tanks.resize(3);
  const double bars[] = {200.0, 7.5, 1.5};
  for (std::size_t i = 0; i < 3; ++i) gear.tanks[i].pressure_pa = 1e5 * bars[i];
  const Body body = body_with(gear);
  const auto empty_at = [&](double depth_m) {
    const std::array<double, 3> all{ambient_pa(depth_m), ambient_pa(depth_m), ambient_pa(depth_m)};
    return empty_tanks(body, full_tanks(body), all);
  };
  EXPECT_EQ(empty_at(0.0), 0b100u);
  EXPECT_EQ(empty_at(10.0), 0b100u);
  EXPECT_EQ(empty_at(20.0), 0b110u);
  EXPECT_EQ(empty_at(1990.0), 0b111u);
}

TEST(Breath, ALakeInTheMountainsHasLessAirOverIt) {
  BodyParameters parameters;
  parameters.surface_pa = 0.845560e5;  // 1500 m
  const Body body = make_body(parameters).value();
  EXPECT_NEAR(pressure_at(body, 0.0), 84556.0, 1e-9);
  EXPECT_NEAR(pressure_at(body, 10.0), 84556.0 + kSeaWater_kg_m3 * kGravity_m_s2 * 10.0, 1e-6);
  const HumanState at_10m = start_at(body, {0.0, 0.0, 10.0}, Quat(1.0, 0.0, 0.0, 0.0));
  EXPECT_NEAR(read_gas(body, at_10m).ambient_pa, pressure_at(body, 10.0), 1.0);
  parameters.surface_pa = 1e3;
  EXPECT_FALSE(make_body(parameters).ok());
}

TEST(Breath, OtherTanksAreBreathedFromWhenTheyAreChosen) {
  Gear gear;
  gear.tanks.resize(2);
  gear.tanks[1].mix = {0.50, 0.0};
  const Body body = body_with(gear);
  HumanState state = start_at(body, {0.0, 0.0, 15.0}, Quat(1.0, 0.0, 0.0, 0.0));
  HumanInputs inputs;
  for (int i = 0; i < 60 * 60; ++i) state = step(body, state, inputs, 1.0 / 60.0);
  EXPECT_LT(state.life.tanks.moles[0], full_tanks(body).moles[0] - 0.3);
  EXPECT_EQ(state.life.tanks.moles[1], full_tanks(body).moles[1]);
  inputs.tank = 1;
  const double first = state.life.tanks.moles[0];
  for (int i = 0; i < 60 * 60; ++i) state = step(body, state, inputs, 1.0 / 60.0);
  EXPECT_EQ(state.life.tanks.moles[0], first);
  EXPECT_LT(state.life.tanks.moles[1], full_tanks(body).moles[1] - 0.3);
}

}  // namespace
}  // namespace neritic::diver
