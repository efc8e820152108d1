// Alarms: limits, hysteresis, the least time on, and what is not known.
#include <gtest/gtest.h>

#include "tests/hud/dives.hpp"

namespace neritic::hud {
namespace {

// The times at which the alarm's level changed, while change(d, t) makes the data of each tenth of
// a second.
std::vector<std::pair<double, AlarmLevel>> changes(Alarm alarm, double seconds, auto change,
                                                   double step_s = 0.1) {
  std::vector<std::pair<double, AlarmLevel>> out;
  AlarmState state;
  for (int i = 0; i * step_s < seconds; ++i) {
    DiveData d = calm_dive();
    d.time_s = i * step_s;
    change(d, d.time_s);
    const AlarmLevel before = state.of(alarm);
    state = step_alarms(state, d, d.time_s);
    if (state.of(alarm) != before) out.emplace_back(d.time_s, state.of(alarm));
  }
  return out;
}

TEST(HudAlarms, ACalmDiveHasNone) {
  EXPECT_FALSE(step_alarms({}, calm_dive(), 0.0).any());
  EXPECT_FALSE(step_alarms({}, stops_dive(), 0.0).any());
}

TEST(HudAlarms, ANumberThatTremblesAtTheLimitDoesNotFlicker) {
  const auto low = [](DiveData& d, double t) {
    d.tank_pa = (50.0 - 0.02 * t + 0.3 * std::sin(20.0 * t)) * 1e5;
  };
  const auto gas = changes(Alarm::kGas, 60.0, low);
  ASSERT_EQ(gas.size(), 1u);
  EXPECT_EQ(gas[0].second, AlarmLevel::kCaution);
  const auto oxygen = changes(Alarm::kOxygen, 60.0, [](DiveData& d, double t) {
    d.po2_bar = 1.40 + 0.02 * std::sin(7.0 * t);
  });
  EXPECT_EQ(oxygen.size(), 1u);
  const auto ceiling = changes(Alarm::kCeiling, 60.0, [](DiveData& d, double t) {
    d.ceiling_m = 6.0;
    d.depth_m = 5.7 + 0.1 * std::sin(5.0 * t);
    d.ceiling_violated = d.depth_m < 5.7;
  });
  EXPECT_EQ(ceiling.size(), 1u);
  const auto no_stop = changes(Alarm::kNoStop, 60.0, [](DiveData& d, double t) {
    d.no_stop_min = 5.0 + 1.5 * std::sin(3.0 * t);
  });
  EXPECT_EQ(no_stop.size(), 1u);
}

TEST(HudAlarms, OneThatLastsAnInstantIsOnForFiveSeconds) {
  const auto on = changes(Alarm::kOxygen, 20.0, [](DiveData& d, double t) {
    d.po2_bar = std::abs(t - 3.0) < 0.05 ? 1.45 : 1.0;
  });
  ASSERT_EQ(on.size(), 2u);
  EXPECT_NEAR(on[0].first, 3.0, 1e-9);
  EXPECT_NEAR(on[1].first, 8.0, 0.11);
}

TEST(HudAlarms, AnAscentEndsBelowFourFifthsOfTheRateThatItBeganWith) {
  using diver::AscentAlarm;
  const auto on = changes(Alarm::kAscent, 60.0, [](DiveData& d, double t) {
    d.ascent_m_min = t < 10.0 ? 20.0 : 20.0 - 0.5 * (t - 10.0);
    d.ascent_alarm = d.ascent_m_min > 18.0  ? AscentAlarm::kDangerous
                     : d.ascent_m_min > 9.0 ? AscentAlarm::kFast
                                            : AscentAlarm::kNone;
  });
  ASSERT_EQ(on.size(), 3u);
  EXPECT_EQ(on[0].second, AlarmLevel::kDanger);
  EXPECT_EQ(on[1].second, AlarmLevel::kCaution);
  EXPECT_NEAR(on[1].first, 10.0 + (20.0 - 14.4) / 0.5, 0.11);
  EXPECT_EQ(on[2].second, AlarmLevel::kOff);
  EXPECT_NEAR(on[2].first, 10.0 + (20.0 - 7.2) / 0.5, 0.11);
}

TEST(HudAlarms, GasIsLowWhereItDoesNotReachForTheAscentAndGoneWhereNothingComes) {
  DiveData d = calm_dive();
  d.needed_l = 1401.0;
  EXPECT_EQ(step_alarms({}, d, d.time_s).of(Alarm::kGas), AlarmLevel::kCaution);
  d.out_of_gas = true;
  EXPECT_EQ(step_alarms({}, d, d.time_s).of(Alarm::kGas), AlarmLevel::kDanger);
}

TEST(HudAlarms, ADiverWithoutGasIsToldToChangeItOnlyWhereThereIsAnother) {
  DiveData d = alarmed_dive(Alarm::kGas, AlarmLevel::kDanger);
  Hud hud(LayoutKind::kMask, Units::kMetric, 140);
  hud.update(d, d.time_s);
  EXPECT_EQ(hud.shown().advice.act.view(), "BUDDY'S GAS OR GO UP");
  const ImageU8 without = hud.picture();
  d.other_gas = true;
  EXPECT_TRUE(hud.update(d, d.time_s));
  EXPECT_EQ(hud.shown().advice.act.view(), "CHANGE GAS");
  EXPECT_NE(without.data, hud.picture().data);
}

TEST(HudAlarms, WhatIsUnknownNeitherBeginsNorEndsAnAlarm) {
  for (std::size_t i = 0; i < kAlarms; ++i) {
    const auto alarm = static_cast<Alarm>(i);
    DiveData on = alarmed_dive(alarm, AlarmLevel::kCaution);
    on.time_s = 0.0;
    const AlarmState state = step_alarms({}, on, on.time_s);
    ASSERT_TRUE(state.on(alarm)) << name_of(alarm);
    DiveData unknown;
    unknown.time_s = 100.0;
    EXPECT_EQ(step_alarms(state, unknown, unknown.time_s).of(alarm), state.of(alarm))
        << name_of(alarm);
    EXPECT_FALSE(step_alarms({}, unknown, unknown.time_s).on(alarm)) << name_of(alarm);
    DiveData calm = calm_dive();
    calm.time_s = 100.0;
    EXPECT_FALSE(step_alarms(state, calm, calm.time_s).on(alarm)) << name_of(alarm);
  }
}

// A Hud's alarm while the scene's time goes from scene_from_s on at a speed: when it was on, in the
// viewer's seconds from the start, and how often the picture went over to a danger's other colours.
struct Watched {
  double on_s = 0.0;
  int flashes = 0;
};
Watched watch(double speed, double seconds, auto change) {
  constexpr double kFrame_s = 1.0 / 50.0;
  Hud hud(LayoutKind::kMask, Units::kMetric, 35);
  Watched out;
  bool lit = false;
  for (int i = 0; i * kFrame_s < seconds; ++i) {
    DiveData d = calm_dive();
    d.time_s = 2000.0 + speed * i * kFrame_s;
    change(d, i * kFrame_s);
    hud.update(d, 7.0 + i * kFrame_s);
    if (hud.alarms().any()) out.on_s += kFrame_s;
    out.flashes += hud.shown().flash && !lit;
    lit = hud.shown().flash;
  }
  return out;
}

TEST(HudAlarms, ADangerFlashesOnceASecondOfTheViewerAtAnySpeedOfTheScene) {
  for (const double speed : {0.0, 0.1, 1.0, 10.0, 100.0}) {
    const Watched seen = watch(speed, 20.0, [](DiveData& d, double) { d.out_of_gas = true; });
    EXPECT_EQ(seen.flashes, 20) << speed;
  }
}

TEST(HudAlarms, TheLeastFiveSecondsAreTheViewersAtAnySpeedOfTheScene) {
  for (const double speed : {0.0, 0.1, 1.0, 10.0, 100.0}) {
    const Watched seen = watch(speed, 20.0, [](DiveData& d, double t) { d.out_of_gas = t < 0.1; });
    EXPECT_NEAR(seen.on_s, 5.0, 0.05) << speed;
  }
}

TEST(HudAlarms, AStateFromBeforeTheAlarmEndsIt) {
  AlarmState state = step_alarms({}, alarmed_dive(Alarm::kOxygen, AlarmLevel::kDanger), 50.0);
  DiveData before = calm_dive();
  before.time_s = 10.0;
  EXPECT_FALSE(step_alarms(state, before, 50.1).any());
  before.time_s = 2000.1;
  EXPECT_TRUE(step_alarms(state, before, 50.1).any());
}

// A server that answers again tells an earlier time than the one that the listener counted on.
TEST(HudAlarms, AConnectionThatComesBackIsNoRestoredState) {
  const AlarmState lost = step_alarms({}, alarmed_dive(Alarm::kLink, AlarmLevel::kDanger), 50.0);
  DiveData back = calm_dive();
  back.time_s = -1.0;
  EXPECT_TRUE(step_alarms(lost, back, 51.0).on(Alarm::kLink));
  EXPECT_FALSE(step_alarms(lost, back, 55.0).on(Alarm::kLink));
}

}  // namespace
}  // namespace neritic::hud
