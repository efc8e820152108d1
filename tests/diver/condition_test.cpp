// A diver who does not notice: oxygen in lungs and blood, heat, and what both do, against closed
// forms and published tables.
#include "diver/condition.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "engine/sim/fields.hpp"

namespace neritic::diver {
namespace {

HypoxiaInputs at(double mmhg, double oxygen = 0.21, double ventilation_l_min = 8.0) {
  return {oxygen, mmhg * kMercury_pa, ventilation_l_min, 0.32, 3e-3};
}

// Seconds until thought is lost, in steps of dt_s.
double lasts_s(HypoxiaState state, const HypoxiaInputs& in, double dt_s = 0.05) {
  double t = 0.0;
  for (; state.dose < 1.0 && t < 6000.0; t += dt_s) step_hypoxia(in, dt_s, state);
  return t;
}

TEST(Hypoxia, SaturationIsThatOfThePublishedCurve) {
  // Severinghaus 1979, table of the standard curve: P50 26.9, and 40, 60, 100 mmHg.
  EXPECT_NEAR(oxygen_saturation(26.86), 0.500, 0.002);
  EXPECT_NEAR(oxygen_saturation(40.0), 0.7496, 0.003);
  EXPECT_NEAR(oxygen_saturation(60.0), 0.90, 0.01);
  EXPECT_NEAR(oxygen_saturation(100.0), 0.9772, 0.002);
}

TEST(Hypoxia, ARestedLungIsInTheSteadyStateOfItsEquation) {
  HypoxiaState state = rested(at(760.0));
  const double steady =
      0.21 * (760.0 - 47.0) - 863.0 * 0.32 / (5.6 * hypoxic_drive(state.pressure_mmhg));
  EXPECT_NEAR(state.pressure_mmhg, steady, 1e-6);
  EXPECT_NEAR(state.pressure_mmhg, 102.0, 4.0);  // people's: 100
  const double before = state.pressure_mmhg;
  for (int i = 0; i < 2400; ++i) step_hypoxia(at(760.0), 0.1, state);
  EXPECT_NEAR(state.pressure_mmhg, before, 0.2);
  EXPECT_EQ(state.dose, 0.0);
}

TEST(Hypoxia, AltitudesTakeThoughtInTheTabledTimes) {
  // FAA AC 61-107B, seated, breathing air: pressure in mmHg of the standard atmosphere, seconds.
  struct Row {
    double mmhg, least_s, most_s;
  };
  const Row rows[] = {{379.4, 1200, 1800}, {321.5, 300, 600}, {282.4, 180, 300}, {246.8, 150, 180},
                      {225.6, 60, 120},    {178.7, 30, 60},   {140.7, 15, 20},   {87.5, 6, 12}};
  double last_s = 1e9;
  for (const Row& row : rows) {
    const double found_s = lasts_s(rested(at(760.0)), at(row.mmhg));
    EXPECT_GE(found_s, row.least_s / 1.6) << row.mmhg;
    EXPECT_LE(found_s, row.most_s * 1.6) << row.mmhg;
    EXPECT_LT(found_s, last_s);
    last_s = found_s;
  }
  EXPECT_EQ(lasts_s(rested(at(760.0)), at(564.0)),
            lasts_s(rested(at(760.0)), at(760.0)));  // 8000 ft
}

TEST(Hypoxia, AHeldBreathSpendsExactlyWhatItHolds) {
  HypoxiaState state = rested(at(1520.0));
  const HypoxiaInputs held = at(1520.0, 0.21, 0.0);
  const auto store_l = [&] { return state.pressure_mmhg * 3.0 / 863.0 + state.venous_saturation; };
  const double before_l = store_l();
  for (int i = 0; i < 240 * 90; ++i) step_hypoxia(held, 1.0 / 240.0, state);
  EXPECT_NEAR(before_l - store_l(), 0.32 * 1.5, 1e-6);
}

TEST(Hypoxia, ABreathHeldFromDepthFaintsNearTheSurface) {
  HypoxiaState deep = rested(at(1520.0));  // 10 m
  for (int i = 0; i < 240 * 190; ++i) step_hypoxia(at(1520.0, 0.21, 0.0), 1.0 / 240.0, deep);
  EXPECT_LT(deep.dose, 0.2);
  HypoxiaState up = deep;
  for (int i = 0; i < 240 * 20; ++i) step_hypoxia(at(1520.0, 0.21, 0.0), 1.0 / 240.0, deep);
  for (int i = 0; i < 240 * 20; ++i) step_hypoxia(at(760.0, 0.21, 0.0), 1.0 / 240.0, up);
  EXPECT_LT(deep.dose, 1.0);
  EXPECT_GE(up.dose, 1.0);
}

TEST(Hypoxia, TheStepHardlyChangesTheResult) {
  const double fine_s = lasts_s(rested(at(760.0)), at(760.0, 0.05), 1.0 / 1000.0);
  EXPECT_NEAR(lasts_s(rested(at(760.0)), at(760.0, 0.05), 1.0 / 240.0), fine_s, 0.01 * fine_s);
  EXPECT_NEAR(lasts_s(rested(at(760.0)), at(760.0, 0.05), 2.0), fine_s, 0.03 * fine_s + 2.0);
}

ColdSettings bare(double water_c) {
  return {.water_c = water_c, .mass_kg = 75.0, .height_m = 1.78, .suit_m = 0.0};
}

TEST(Cold, WithoutShiveringItIsTheSolutionOfItsTwoEquations) {
  // Vessels wide and skin warm all the time.
  const ColdSettings settings = bare(36.0);
  const ColdInputs in{.heat_w = 230.0, .ventilation_l_min = 10.0};
  ColdState once{.core_c = 38.5, .shell_c = 37.5, .skin_c = 36.5};
  ColdState often = once;
  step_cold(settings, in, 1800.0, once);
  for (int i = 0; i < 1800; ++i) step_cold(settings, in, 1.0, often);
  // By small steps of the equations themselves.
  const double area = 0.202 * std::pow(75.0, 0.425) * std::pow(1.78, 0.725);
  const double breath_w = 10e-3 / 60.0 * (1.2 * 1005.0 * (34.0 - 36.0) + 2.43e6 * 0.0376);
  double core_c = 38.5, shell_c = 37.5;
  constexpr double kStep_s = 0.01;
  for (int i = 0; i < 180000; ++i) {
    const double inner_w = (core_c - shell_c) * area / (0.3 * 0.03);
    const double outer_w = (shell_c - 36.0) * area / (0.7 * 0.03 + 1.0 / 230.0);
    core_c += kStep_s * (230.0 - breath_w - inner_w) / (3470.0 * 75.0 * 0.75);
    shell_c += kStep_s * (inner_w - outer_w) / (3470.0 * 75.0 * 0.25);
  }
  EXPECT_NEAR(once.core_c, core_c, 1e-5);
  EXPECT_NEAR(once.shell_c, shell_c, 1e-5);
  EXPECT_NEAR(often.core_c, once.core_c, 1e-9);
  EXPECT_NEAR(often.shell_c, once.shell_c, 1e-9);
  EXPECT_EQ(often.shiver_w, 0.0);
  // Any step ends where it ends.
  step_cold(settings, in, 1e9, once);
  EXPECT_NEAR(once.shell_c, 36.0 + (230.0 - breath_w) / area * (0.7 * 0.03 + 1.0 / 230.0), 1e-9);
}

// Hayward et al. 1975: for 15 minutes the core stays, then it cools by 0.0785 - 0.0034 T a minute.
TEST(Cold, PeopleInColdWaterCoolAsMeasured) {
  for (const double water_c : {5.0, 10.0, 15.0}) {
    const double a_minute = 0.0785 - 0.0034 * water_c;
    ColdState state;
    double minutes = 0.0;
    while (state.core_c > 30.0 && minutes < 2000.0) {
      step_cold(bare(water_c), {.heat_w = 122.0, .ventilation_l_min = 9.0}, 60.0, state);
      minutes += 1.0;
      if (minutes == 15.0 || minutes == 30.0 || minutes == 60.0) {
        EXPECT_NEAR(state.core_c, 37.0 - a_minute * (minutes - 15.0), 0.3)
            << water_c << " C, " << minutes << " min";
      }
    }
    const double measured = 15.0 + 7.0 / a_minute;
    EXPECT_GT(minutes, measured / 1.2) << water_c;
    EXPECT_LT(minutes, measured * 1.2) << water_c;
  }
}

TEST(Cold, AShortDiveInASuitHardlyCoolsTheCore) {
  const ColdSettings suit{.water_c = 4.0};
  ColdState state;
  for (int i = 0; i < 900; ++i)
    step_cold(suit,
              {.heat_w = 200.0,
               .ventilation_l_min = 15.0,
               .gas_density_kg_m3 = 6.6,
               .ambient_pa = 5.5 * 101325.0,
               .speed_m_s = 0.2},
              1.0, state);
  EXPECT_GT(state.core_c, 36.6);
  EXPECT_LT(state.skin_c, 25.0);
}

TEST(Cold, ASuitKeepsWarmLessSoDeeper) {
  const ColdSettings suit{.water_c = 10.0};
  ColdInputs shallow, deep;
  deep.ambient_pa = 5.0 * 101325.0;
  // A suit of 5 mm, 0.65 gas, at a fifth of its volume; k 0.054.
  EXPECT_NEAR(suit_resistance(suit, shallow) - 1.0 / 230.0, 0.005 / 0.054, 1e-12);
  EXPECT_NEAR(suit_resistance(suit, deep) - 1.0 / 230.0, 0.005 * 0.48 / 0.054, 1e-12);
  ColdState none, worn, down;
  step_cold(bare(10.0), shallow, 1800.0, none);
  step_cold(suit, shallow, 1800.0, worn);
  step_cold(suit, deep, 1800.0, down);
  EXPECT_LT(none.core_c, down.core_c);
  EXPECT_LT(down.core_c, worn.core_c);
}

TEST(Condition, OxygensRiskIsThePublishedNormalDistribution) {
  ConditionState state;
  ConditionInputs in;
  in.breath = at(1.6 * 760.0, 1.0);
  const ConditionSettings settings{.effects = kOxygenToxicity};
  for (int i = 0; i < 45 * 60; ++i) step_condition(settings, in, 1.0, state);
  EXPECT_NEAR(state.oxygen_dose, 45.0 * std::pow(1.6, 3.38), 1e-9 * state.oxygen_dose + 0.01);
  // Z = [ln t - 9.63 + 3.38 ln p] / 2.02 = -2.0960 (t 45, p 1.6): 0.01804.
  EXPECT_NEAR(oxygen_risk(state.oxygen_dose), 0.01804, 2e-4);
  EXPECT_EQ(state.lost, 0u);
  EXPECT_NEAR(oxygen_risk(oxygen_limit(-1.2816)), 0.1, 1e-4);
  // On air its square falls to half in ln 2 / 0.079 = 8.77 minutes.
  in.breath = at(760.0);
  const double before = state.oxygen_dose;
  step_condition(settings, in, 60.0 * std::log(2.0) / 0.079, state);
  EXPECT_NEAR(state.oxygen_dose * state.oxygen_dose, 0.5 * before * before, 1e-6 * before * before);
}

TEST(Condition, AConvulsionHoldsTheBreathAndPasses) {
  ConditionState state;
  ConditionInputs in;
  in.breath = at(4.0 * 760.0, 1.0);
  const ConditionSettings settings{.effects = kOxygenToxicity, .oxygen_tolerance = -1.28};
  double t = 0.0;
  while (state.lost == 0 && t < 7200.0) step_condition(settings, in, 1.0, state), t += 1.0;
  EXPECT_NEAR(t / 60.0, std::exp(9.63 - 1.28 * 2.02) / std::pow(4.0, 3.38), 0.1);  // 10.5 minutes
  EXPECT_EQ(state.lost, kOxygenToxicity);
  EXPECT_TRUE(holds_breath(state));
  in.breath = at(760.0);
  for (int i = 0; i < 90; ++i) step_condition(settings, in, 1.0, state);
  EXPECT_FALSE(holds_breath(state));
  EXPECT_EQ(state.lost, kOxygenToxicity);
  for (int i = 0; i < 120; ++i) step_condition(settings, in, 1.0, state);
  EXPECT_EQ(state.lost, 0u);
}

// Muscles let go, and take hold again, over two seconds.
TEST(Condition, MusclesGoSlackByAndBy) {
  ConditionState state;
  ConditionInputs in;
  const ConditionSettings settings{.effects = kCarbonDioxide};
  state.co2_dose = 1.0, in.co2_mmhg = 100.0;
  double last = 0.0, most = 0.0;
  for (int i = 0; i < 120; ++i) {
    step_condition(settings, in, 1.0 / 60.0, state);
    most = std::max(most, state.slack - last);
    last = state.slack;
  }
  ASSERT_EQ(state.lost, kCarbonDioxide);
  EXPECT_NEAR(state.slack, 1.0 - std::exp(-2.0 / kSlackLag_s), 1e-9);
  EXPECT_LT(most, 0.03);
  state.co2_dose = 0.0, in.co2_mmhg = 40.0;
  step_condition(settings, in, 1.0 / 60.0, state);
  ASSERT_EQ(state.lost, 0u);
  EXPECT_GT(state.slack, 0.9);
  for (int i = 0; i < 60 * 20; ++i) step_condition(settings, in, 1.0 / 60.0, state);
  EXPECT_EQ(state.slack, 0.0);
}

TEST(Condition, SlowingIsThatOfThePublishedExperiments) {
  EXPECT_NEAR(narcosis_slowing(30.0), 0.209, 1e-12);
  EXPECT_EQ(co2_slowing(45.0), 0.0);
  EXPECT_NEAR(co2_slowing(60.0), 0.30, 1e-12);
  EXPECT_NEAR(cold_slowing(34.5), 1.75, 1e-12);
  ConditionState state;
  ConditionInputs in;
  in.breath = at(4.0 * 760.0, 0.21);
  in.narcotic_depth_m = 30.0;
  step_condition({.effects = kNarcosis}, in, 1.0, state);
  EXPECT_NEAR(state.slowing, 1.209, 1e-12);
  EXPECT_EQ(state.strength, 1.0);
}

TEST(Condition, NoOxygenTakesConsciousnessAndAirGivesItBack) {
  ConditionInputs in;
  in.breath = at(760.0);
  const ConditionSettings settings{.effects = kHypoxia};
  ConditionState state = rested(settings, in);
  in.breath = at(760.0, 0.0);
  double t = 0.0;
  while (state.lost == 0 && t < 300.0) step_condition(settings, in, 0.1, state), t += 0.1;
  EXPECT_GT(t, 10.0);
  EXPECT_LT(t, 60.0);  // of helium or nitrogen, breathed at rest
  EXPECT_LT(state.strength, 0.6);
  in.breath = at(760.0);
  for (int i = 0; i < 600; ++i) step_condition(settings, in, 0.1, state);
  EXPECT_EQ(state.lost, 0u);
  EXPECT_GT(state.strength, 0.97);
}

TEST(Condition, ExtremesStayFiniteAndInBounds) {
  const double tiny = std::numeric_limits<double>::denorm_min();
  for (const double pa : {0.0, tiny, 1e3, 1e5, 2e7, 1e300})
    for (const double ventilation : {0.0, tiny, 8.0, 1e6})
      for (const double dt_s : {0.0, tiny, 1.0 / 240.0, 10.0, 1e9}) {
        ConditionInputs in;
        in.breath = {0.21, pa, ventilation, 8.0, 0.0};
        in.heat = {1e5, ventilation, 1e3, pa, 1e5, 1e9};
        in.co2_mmhg = 200.0, in.narcotic_depth_m = 1e6;
        ConditionSettings settings;
        settings.cold.water_c = -2.0;
        ConditionState state = rested(settings, in);
        for (int i = 0; i < 3; ++i) step_condition(settings, in, dt_s, state);
        ASSERT_TRUE(sim::all_finite(state)) << pa << " " << ventilation << " " << dt_s;
        ASSERT_LE(state.hypoxia.saturation, 1.0);
        ASSERT_GE(state.hypoxia.venous_saturation, 0.0);
        ASSERT_GE(state.cold.core_c, -2.0);
        ASSERT_GT(state.strength, 0.0);
      }
}

}  // namespace
}  // namespace neritic::diver
