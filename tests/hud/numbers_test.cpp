// Numbers as instruments show them: EN 13319, the safe side, units, and what lies out of range.
#include <gtest/gtest.h>

#include "tests/hud/dives.hpp"

namespace neritic::hud {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

TEST(HudNumbers, DepthIsThatOfWaterOf1020KilogramsPerCubicMetre) {
  // 40 m of 1025 kg/m3 and 30 m of fresh water, by pressure over rho g.
  EXPECT_NEAR(standard_depth_m(40.0, 1025.0 * 9.80665e-5), 40.0 * 1025.0 / 1020.0, 1e-12);
  EXPECT_EQ(depth_text(standard_depth_m(40.0, 1025.0 * 9.80665e-5), Units::kMetric).view(), "40.2");
  EXPECT_EQ(depth_text(standard_depth_m(30.0, 1000.0 * 9.80665e-5), Units::kMetric).view(), "29.4");
}

TEST(HudNumbers, DepthHasTenthsTo99_9AndMetresFromThere) {
  const auto text = [](double m) { return std::string(depth_text(m, Units::kMetric).view()); };
  EXPECT_EQ(text(0.0), "0.0");
  EXPECT_EQ(text(-0.04), "0.0");
  EXPECT_EQ(text(18.34), "18.3");
  EXPECT_EQ(text(18.36), "18.4");
  EXPECT_EQ(text(99.94), "99.9");
  EXPECT_EQ(text(99.96), "100");
  EXPECT_EQ(text(300.0), "300");
  EXPECT_EQ(depth_text(18.34, Units::kImperial).view(), "60");
}

// Each number goes through many values: what is shown is never on the dangerous side, and less
// than a step away.
TEST(HudNumbers, EachIsRoundedToTheSafeSideByLessThanAStep) {
  const auto value = [](FixedText text) { return std::stod(std::string(text.view())); };
  for (double v = 0.0; v < 98.0; v += 0.0137) {
    const auto down = [&](double shown, double truth, double step) {
      EXPECT_LE(shown, truth + 1e-5 * step) << v;
      EXPECT_GT(shown, truth - step) << v;
    };
    const auto up = [&](double shown, double truth, double step) {
      EXPECT_GE(shown, truth - 1e-5 * step) << v;
      EXPECT_LT(shown, truth + step) << v;
    };
    down(value(minutes_left_text(v)), v, 1.0);
    up(value(minutes_owed_text(v)), v, 1.0);
    // The shallowest depth that has this text too is no shallower.
    if (v > 0.0) up(value(stop_text(v, Units::kMetric)) - 0.05, v, 0.1 + 1e-9);
    if (v > 0.0) up(value(stop_text(v, Units::kImperial)) - 0.5, v / 0.3048, 1.0);
    EXPECT_GE(value(stop_text(v, Units::kMetric)), value(ceiling_text(v, Units::kMetric)));
    EXPECT_GE(value(stop_text(v, Units::kImperial)), value(ceiling_text(v, Units::kImperial)));
    up(value(ceiling_text(v, Units::kMetric)), v, 0.1 + 1e-9);
    up(value(ceiling_text(v, Units::kImperial)), v / 0.3048, 1.0);
    down(value(limit_depth_text(v, Units::kMetric)), v, 1.0);
    down(value(limit_depth_text(v, Units::kImperial)), v / 0.3048, 1.0);
    down(value(pressure_text(2e5 * v, Units::kMetric)), 2.0 * v, 1.0);
    down(value(pressure_text(2e5 * v, Units::kImperial)), 2e5 * v / 6894.757293168, 10.0);
    up(value(percent_text(v)), v, 1.0);
    up(value(oxygen_text(0.02 * v)), 0.02 * v, 0.01 + 1e-9);
    if (v > 0.5) up(value(rate_text(v, Units::kMetric)), v, 1.0);
    up(value(rate_text(v + 1.0, Units::kImperial)), (v + 1.0) / 0.3048, 1.0);
  }
}

TEST(HudNumbers, SumsOfStepsAreNoReasonToRoundAway) {
  EXPECT_EQ(minutes_left_text(12.0 - 1e-12).view(), "12");
  EXPECT_EQ(minutes_owed_text(3.0 + 1e-12).view(), "3");
  EXPECT_EQ(stop_text(5.95 + 1e-12, Units::kMetric).view(), "6.0");
  EXPECT_EQ(stop_text(6.0, Units::kImperial).view(), "21");
  EXPECT_EQ(clock_text(34.0 + 7.0 / 60.0 - 1e-12).view(), "34:07");
}

TEST(HudNumbers, WhatIsUnknownOrOutOfRangeIsDashes) {
  for (const Units units : {Units::kMetric, Units::kImperial}) {
    for (const double depth_m : {kNan, kInf, -kInf, -1.0, 1e4}) {
      EXPECT_EQ(depth_text(depth_m, units).view(), "--.-");
      EXPECT_EQ(ceiling_text(depth_m, units).view(), "--.-");
      EXPECT_EQ(stop_text(depth_m, units).view(), "--.-");
      EXPECT_EQ(limit_depth_text(depth_m, units).view(), "--");
    }
    EXPECT_EQ(pressure_text(kNan, units).view(), "---");
    EXPECT_EQ(pressure_text(-1.0, units).view(), "---");
    EXPECT_EQ(pressure_text(0.0, units).view(), "0");
    EXPECT_EQ(rate_text(kNan, units).view(), "--");
    EXPECT_EQ(rate_text(1e9, units).view(), "--");
    EXPECT_EQ(litres_text(kNan, units).view(), "-.-");
    EXPECT_EQ(weight_text(kInf, units).view(), "-.-");
  }
  for (const double minutes : {kNan, -1.0, -kInf}) {
    EXPECT_EQ(minutes_left_text(minutes).view(), "--");
    EXPECT_EQ(minutes_owed_text(minutes).view(), "--");
    EXPECT_EQ(clock_text(minutes).view(), "--:--");
  }
  EXPECT_EQ(minutes_left_text(kInf).view(), "99+");
  EXPECT_EQ(oxygen_text(kNan).view(), "-.--");
  EXPECT_EQ(percent_text(kNan).view(), "--");
  EXPECT_EQ(heading_text(kInf).view(), "---");
  EXPECT_EQ(beats_text(kNan).view(), "--");
}

TEST(HudNumbers, NoObligationAndNoDoseVanishesWhereItIsBeyondWhatIsShown) {
  EXPECT_EQ(minutes_owed_text(999.0).view(), "999");
  for (const double minutes : {999.1, 1e12, kInf})
    EXPECT_EQ(minutes_owed_text(minutes).view(), "999+");
  EXPECT_EQ(clock_text(999.99).view(), "999:59");
  EXPECT_EQ(clock_text(1000.0).view(), "16h40");
  EXPECT_EQ(clock_text(1025.9).view(), "17h05");
  EXPECT_EQ(clock_text(1e12).view(), "999h+");
  EXPECT_EQ(clock_text(kInf).view(), "--:--");
  EXPECT_EQ(oxygen_text(9.99).view(), "9.99");
  EXPECT_EQ(oxygen_text(31.0).view(), "9.9+");
  EXPECT_EQ(percent_text(999.0).view(), "999");
  EXPECT_EQ(percent_text(1e6).view(), "999+");
}

// A diver in sea water: all depths on one scale, that of the gauge.
TEST(HudNumbers, TheStopIsOnTheDepthsScaleAndNeverAboveTheCeiling) {
  DiveData d = stops_dive();
  d.stop_m = 3.0, d.ceiling_m = 2.99;
  for (const Units units : {Units::kMetric, Units::kImperial})
    for (double depth_m = 2.5; depth_m < 3.5; depth_m += 0.001) {
      d.depth_m = depth_m;
      const Shown shown = shown_of(LayoutKind::kCorner, units, d, {}, {}, {}, d.time_s);
      if (shown.depth == shown.stop) {
        EXPECT_GE(depth_m, d.stop_m) << shown.depth.view();
      }
      EXPECT_GE(std::stod(std::string(shown.stop.view())),
                std::stod(std::string(shown.ceiling.view())));
    }
  d.ceiling_m = 4.0;  // while the plan for the stop is older
  const Shown shown = shown_of(LayoutKind::kCorner, Units::kMetric, d, {}, {}, {}, d.time_s);
  EXPECT_GE(std::stod(std::string(shown.stop.view())),
            std::stod(std::string(shown.ceiling.view())));
}

TEST(HudNumbers, TheDeepestPlaceIsNeverAboveTheDepth) {
  DiveData d = calm_dive();
  d.depth_m = 0.3, d.deepest_m = 0.0;  // the dive has not begun
  const Shown shown = shown_of(LayoutKind::kWrist, Units::kMetric, d, {}, {}, {}, d.time_s);
  EXPECT_EQ(shown.deepest.view(), "0.3");
}

// A tank of 150 bar over the reserve, breathed in breaths of different size at rest.
TEST(HudNumbers, TheGasLastsByTheBreathingOfAMinuteNotByABreath) {
  Hud hud(LayoutKind::kCorner, Units::kMetric, 75);
  DiveData d = calm_dive();
  double least = 1e9, most = 0.0, left_min = 58.0;
  for (int i = 0; i < 5 * 60 * 5; ++i) {  // five minutes, five times a second
    d.time_s = 0.2 * i;
    left_min -= 0.2 / 60.0;
    d.tank_pa = (50.0 + 150.0 * left_min / 58.0) * 1e5;
    const double breath = 0.1 * std::sin(1.3 * std::floor(d.time_s / 4.0));
    d.gas_min = left_min / (1.0 + breath);
    hud.update(d, d.time_s);
    if (d.time_s < 180.0) continue;  // two minutes follow
    const double off = std::stod(std::string(hud.shown().gas_min.view())) - left_min;
    least = std::min(least, off), most = std::max(most, off);
  }
  EXPECT_GT(least, -2.5);
  EXPECT_LT(most, 1.0);
  // At twice the pressure it lasts half as long at once, and nothing is nothing at once.
  const double before = std::stod(std::string(hud.shown().gas_min.view()));
  d.depth_m = 2.0 * d.depth_m + d.surface_bar / d.bar_per_m, d.gas_min *= 0.5, d.time_s += 0.2;
  hud.update(d, d.time_s);
  EXPECT_NEAR(std::stod(std::string(hud.shown().gas_min.view())), 0.5 * before, 1.0);
  d.gas_min = 0.0, d.time_s += 0.2;
  hud.update(d, d.time_s);
  EXPECT_EQ(hud.shown().gas_min.view(), "0");
}

TEST(HudNumbers, HeadingIsThreeDigitsBelow360) {
  EXPECT_EQ(heading_text(radians(7.4)).view(), "007");
  EXPECT_EQ(heading_text(radians(359.6)).view(), "000");
  EXPECT_EQ(heading_text(radians(-90.0)).view(), "270");
  EXPECT_EQ(heading_text(radians(-0.4)).view(), "000");
  EXPECT_EQ(heading_text(radians(720.0)).view(), "000");
}

TEST(HudNumbers, AnExtremeStateShowsDashesAndAnEmptyTankZero) {
  DiveData d = calm_dive();
  d.depth_m = d.no_stop_min = d.to_surface_min = d.heading_rad = kNan;
  d.tank_pa = d.gas_min = 0.0;
  d.dive_min = 1e9;
  const Shown shown = shown_of(LayoutKind::kConsole, Units::kMetric, d, {}, {}, {}, d.time_s);
  EXPECT_EQ(shown.depth.view(), "--.-");
  EXPECT_EQ(shown.no_stop.view(), "--");
  EXPECT_EQ(shown.to_surface.view(), "--");
  EXPECT_EQ(shown.heading.view(), "---");
  EXPECT_EQ(shown.heading_deg, -1);
  EXPECT_EQ(shown.dive_time.view(), "999h+");
  EXPECT_EQ(shown.tank.view(), "0");
  EXPECT_EQ(shown.gas_min.view(), "0");
}

TEST(HudNumbers, TissueBarsAreHalfAtAmbientPressureAndFullAtTheirLimit) {
  const diver::Buehlmann model =
      diver::buehlmann(diver::BuehlmannTable::kC, diver::FirstCompartment::k4Min, 0.0627);
  diver::TissueState tissues;
  tissues.n2_bar.fill(0.79);
  EXPECT_NEAR(tissue_bar(model, tissues, 3, 2.0), 0.5 * 0.79 / 2.0, 1e-12);
  tissues.n2_bar.fill(2.0);
  EXPECT_NEAR(tissue_bar(model, tissues, 3, 2.0), 0.5, 1e-12);
  // M = a + p / b.
  const double most = model.n2.a_bar[3] + 1.0 / model.n2.b[3];
  tissues.n2_bar.fill(most);
  EXPECT_NEAR(tissue_bar(model, tissues, 3, 1.0), 1.0, 1e-12);
}

}  // namespace
}  // namespace neritic::hud
