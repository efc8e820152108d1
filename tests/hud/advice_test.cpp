// The advice to a diver, in every combination of alarms, gases and places to a ceiling: read
// as the diver would read it, by rules that know nothing of how the words are chosen.
#include <gtest/gtest.h>

#include "tests/hud/dives.hpp"

namespace neritic::hud {
namespace {

enum class Place { kFree, kDeep, kAtStop, kJustAbove, kAbove, kUnknown };

struct Case {
  Place place = Place::kFree;
  AlarmLevel gas = AlarmLevel::kOff, ascent = AlarmLevel::kOff;
  bool oxygen = false, no_stop = false, link = false, other = false, leaner = false;
};

// A dive with just these alarms; depths in stops are given, ceilings and stops are 7.43 and 9 m.
DiveData data_of(const Case& c) {
  DiveData d = c.place == Place::kFree ? calm_dive() : stops_dive();
  if (c.place == Place::kAtStop) d.depth_m = 9.2;
  if (c.place == Place::kJustAbove) d.depth_m = 7.3;
  if (c.place == Place::kAbove) d.depth_m = 6.9, d.ceiling_violated = true;
  if (c.gas == AlarmLevel::kCaution) d.tank_pa = 44e5;
  if (c.gas == AlarmLevel::kDanger) d.tank_pa = 1e5, d.out_of_gas = true;
  if (c.ascent == AlarmLevel::kCaution) d.ascent_alarm = diver::AscentAlarm::kFast;
  if (c.ascent == AlarmLevel::kDanger) d.ascent_alarm = diver::AscentAlarm::kDangerous;
  if (c.ascent != AlarmLevel::kOff) d.ascent_m_min = c.ascent == AlarmLevel::kDanger ? 19.0 : 11.0;
  if (c.oxygen) d.po2_bar = 1.7;
  if (c.no_stop) d.no_stop_min = 3.0;
  d.link_lost = c.link;
  d.other_gas = c.other, d.leaner_gas = c.leaner;
  return d;
}

std::vector<Case> all_cases() {
  std::vector<Case> out;
  const AlarmLevel levels[] = {AlarmLevel::kOff, AlarmLevel::kCaution, AlarmLevel::kDanger};
  for (const Place place : {Place::kFree, Place::kDeep, Place::kAtStop, Place::kJustAbove,
                            Place::kAbove, Place::kUnknown})
    for (const AlarmLevel gas : levels)
      for (const AlarmLevel ascent : levels)
        for (int bits = 0; bits < 32; ++bits) {
          const auto bit = [&](int i) { return (bits >> i & 1) != 0; };
          out.push_back({place, gas, ascent, bit(0), bit(1), bit(2), bit(3), bit(4)});
        }
  return out;
}

struct Told {
  AlarmState alarms;
  Advice advice;
};

// The alarms begin where the numbers are known. In kUnknown these are lost, and the alarms stay.
Told told_in(const Case& c) {
  DiveData d = data_of(c);
  AlarmState alarms = step_alarms({}, d, d.time_s);
  if (c.place == Place::kUnknown) {
    d.depth_m = d.ceiling_m = d.no_stop_min = d.stop_m = kUnknown;
    alarms = step_alarms(alarms, d, d.time_s);
  }
  return {alarms, shown_of(LayoutKind::kMask, Units::kMetric, d, alarms, {}, {}, d.time_s).advice};
}

std::string name_in(const Case& c, const Advice& advice) {
  return fmt::format(
      "place {} gas {} ascent {} oxygen {} no-stop {} link {} other {} leaner {}: "
      "{}: {}",
      static_cast<int>(c.place), name_of(c.gas), name_of(c.ascent), c.oxygen, c.no_stop, c.link,
      c.other, c.leaner, advice.what.view(), advice.act.view());
}

TEST(HudAdvice, NoWordsSendADiverIntoAnotherAlarmInAnyCombination) {
  std::size_t seen = 0, ups = 0, downs = 0;
  for (const Case& c : all_cases()) {
    const auto [alarms, advice] = told_in(c);
    const std::string text(advice.act.view()), named = name_in(c, advice);
    const auto says = [&](const char* word) { return text.find(word) != std::string::npos; };
    if (!alarms.any()) {
      EXPECT_TRUE(text.empty()) << named;
      continue;
    }
    ++seen;
    ASSERT_FALSE(text.empty()) << named;
    const bool up = says("GO UP") || says("UP TO"), down = says("GO DOWN");
    const bool slows = says("SLOW") || says("STOP RISING");
    ups += up, downs += down;
    // Up: only where the way is free, or as far as the stop, or slowly while the ascent is fast.
    if (up) {
      EXPECT_TRUE(c.place == Place::kFree || c.place == Place::kDeep) << named;
      EXPECT_FALSE(alarms.on(Alarm::kCeiling)) << named;
      if (c.place == Place::kDeep) {
        EXPECT_TRUE(says("UP TO 9.1 m")) << named;
      }
      if (alarms.on(Alarm::kAscent)) {
        EXPECT_TRUE(says("SLOWLY")) << named;
      }
    }
    // Down: only below a broken ceiling, with something to breathe, and not into more oxygen.
    if (down) {
      EXPECT_TRUE(alarms.on(Alarm::kCeiling)) << named;
      if (alarms.on(Alarm::kOxygen)) {
        EXPECT_TRUE(says("CHANGE GAS")) << named;
      }
      if (alarms.of(Alarm::kGas) == AlarmLevel::kDanger) {
        EXPECT_TRUE(says("CHANGE GAS") || says("BUDDY'S GAS")) << named;
      }
    }
    // Another gas is named only where it is there, and what is said of gas goes before the rest.
    if (says("CHANGE GAS")) {
      EXPECT_TRUE(c.other || c.leaner) << named;
    }
    if (says("BUDDY'S GAS")) {
      EXPECT_FALSE(c.other && c.leaner) << named;
    }
    if (slows && !up) {
      EXPECT_TRUE(alarms.on(Alarm::kAscent)) << named;
    }
    EXPECT_FALSE(up && down) << named;
  }
  EXPECT_GT(seen, 1500u);
  EXPECT_GT(ups, 100u);
  EXPECT_GT(downs, 50u);
}

// The most pressing alarm gets what ends it, unless something else forbids that.
TEST(HudAdvice, TheWordsEndTheAlarmThatTheyStandUnder) {
  for (const Case& c : all_cases()) {
    const auto [alarms, advice] = told_in(c);
    const std::string what(advice.what.view()), act(advice.act.view()), named = name_in(c, advice);
    const auto says = [&](const char* word) { return act.find(word) != std::string::npos; };
    if (c.link) {
      EXPECT_EQ(what, "CONNECTION LOST") << named;
    }
    if (what == "NO GAS") {
      EXPECT_TRUE(c.other ? act == "CHANGE GAS" : says("BUDDY'S GAS")) << named;
    }
    if (what == "OXYGEN HIGH" && c.place != Place::kUnknown) {
      EXPECT_TRUE(c.leaner ? act == "CHANGE GAS" : says("UP") || says("BUDDY'S GAS")) << named;
    }
    if (what == "ABOVE CEILING" && c.place == Place::kAbove && !c.oxygen) {
      EXPECT_EQ(act, "GO DOWN TO 9.1 m") << named;
    }
    if (what == "GAS LOW" && c.place == Place::kAtStop) {
      EXPECT_TRUE(says("HOLD STOP")) << named;
    }
    if (what == "TOO FAST" || what == "MUCH TOO FAST") {
      EXPECT_TRUE(act == "SLOW DOWN" || act == "STOP RISING") << named;
    }
    if (what == "NO-STOP TIME LOW") {
      EXPECT_EQ(act, c.place == Place::kUnknown ? "USE OWN GAUGES" : "GO UP");
    }
    const auto on =
        std::ranges::count_if(alarms.level, [](AlarmLevel l) { return l != AlarmLevel::kOff; });
    EXPECT_EQ(advice.others, std::max<std::ptrdiff_t>(0, on - 1)) << named;
  }
}

TEST(HudAdvice, AfterTheCeilingIsLeftTheDiverIsKeptBelowIt) {
  Hud hud(LayoutKind::kMask, Units::kMetric, 140);
  Case c{.place = Place::kAbove};
  hud.update(data_of(c), 2000.0);
  DiveData d = stops_dive();
  d.time_s += 1.0;
  hud.update(d, d.time_s);
  ASSERT_TRUE(hud.alarms().on(Alarm::kCeiling));
  EXPECT_EQ(hud.shown().advice.act.view(), "STAY BELOW 9.1 m");
  d.time_s += 1.0, d.depth_m = 9.1;
  hud.update(d, d.time_s);
  EXPECT_EQ(hud.shown().advice.act.view(), "HOLD STOP");
}

TEST(HudAdvice, FeetWhereUnitsAreImperial) {
  Hud hud(LayoutKind::kMask, Units::kImperial, 140);
  hud.update(data_of({.place = Place::kAbove}), 0.0);
  EXPECT_EQ(hud.shown().advice.act.view(),
            "GO DOWN TO 31 ft");  // 29.67, and half a foot
}

// At 6 m oxygen has 1.6 bar, at the stop of 9 m 1.9: below it is no place for that gas.
TEST(HudAdvice, AboveACeilingAGasThatIsTooRichAtTheStopIsChangedFirst) {
  DiveData d = stops_dive();
  d.depth_m = 6.0, d.ceiling_m = 8.9, d.stop_m = 9.0, d.ceiling_violated = true;
  const auto act = [&](double oxygen, bool leaner) {
    d.gas = {oxygen, 0.0}, d.oxygen_limit_bar = kDecoOxygen_bar, d.po2_bar = 1.62 * oxygen;
    d.leaner_gas = leaner;
    const AlarmState alarms = step_alarms({}, d, d.time_s);
    EXPECT_FALSE(alarms.on(Alarm::kOxygen));
    return std::string(
        shown_of(LayoutKind::kMask, Units::kMetric, d, alarms, {}, {}, d.time_s).advice.act.view());
  };
  EXPECT_EQ(act(1.0, true), "CHANGE GAS, GO DOWN");
  EXPECT_EQ(act(1.0, false), "BUDDY'S GAS, GO DOWN");
  EXPECT_EQ(act(0.5, true), "GO DOWN TO 9.1 m");
}

// The computer's stop clears on the way up: where the ceiling still lies deeper the step of 3 m at
// or below it is owed.
TEST(HudAdvice, AStopIsAStepOfThreeMetres) {
  DiveData d = stops_dive();
  d.stop_m = 12.0, d.ceiling_m = 12.64;
  EXPECT_EQ(owed_stop_m(d), 15.0);
  d.ceiling_m = 12.0;
  EXPECT_EQ(owed_stop_m(d), 12.0);
  d.ceiling_m = 0.0, d.stop_m = 0.0;
  EXPECT_EQ(owed_stop_m(d), 0.0);
}

TEST(HudAdvice, TheOxygenClockColoursItsNumber) {
  DiveData d = calm_dive();
  const auto level = [&](double percent) {
    d.cns_percent = percent;
    return shown_of(LayoutKind::kWrist, Units::kMetric, d, {}, {}, {}, d.time_s).cns_level;
  };
  EXPECT_EQ(level(79.9), AlarmLevel::kOff);
  EXPECT_EQ(level(80.0), AlarmLevel::kCaution);
  EXPECT_EQ(level(812.0), AlarmLevel::kDanger);
  EXPECT_EQ(level(kUnknown), AlarmLevel::kOff);
}

}  // namespace
}  // namespace neritic::hud
