// A dive with every mistake, recorded from a real dive computer and walked through second by
// second: each alarm's times against a reading of the record that knows nothing of the alarms' own
// steps.
#include <gtest/gtest.h>

#include "diver/deco_live.hpp"
#include "tests/hud/dives.hpp"

namespace neritic::hud {
namespace {

struct Leg {
  double minutes, to_m;
};

// On nitrox 32: too deep for it, past the no-stop time, up too fast, above the ceiling, out of gas.
std::vector<DiveData> recorded_dive() {
  diver::DiveComputerSettings settings;
  settings.conventions.environment = {diver::kStandardSurface_bar, diver::bar_per_m_of(1025.0)};
  settings.gases[0].mix = {0.32, 0.0};
  const diver::DiveComputer computer = diver::DiveComputer::create(settings).value();
  const Leg legs[] = {{2.2, 44.0}, {1.0, 44.0}, {1.0, 34.0}, {24.0, 34.0}, {1.5, 9.5},
                      {1.5, 9.5},  {0.4, 1.0},  {0.5, 1.0},  {0.5, 7.0},   {14.0, 7.0},
                      {1.0, 3.5},  {9.0, 3.5},  {1.0, 0.0},  {1.0, 0.0}};
  std::vector<DiveData> record;
  diver::DiveComputerState state = computer.start();
  double depth_m = 0.0, time_s = 0.0;
  for (const Leg& leg : legs) {
    const double from_m = depth_m;
    const int seconds = static_cast<int>(std::lround(60.0 * leg.minutes));
    for (int i = 1; i <= seconds; ++i) {
      depth_m = from_m + (leg.to_m - from_m) * i / seconds;
      time_s += 1.0;
      state = computer.step(state, {depth_m, 0, 1}, 1.0);
      const diver::DiveComputerView view = computer.view(state);
      DiveData d;
      d.time_s = time_s;
      d.bar_per_m = settings.conventions.environment.bar_per_m;
      d.dive_min = state.dive_min;
      d.depth_m = state.last.depth_m;
      d.deepest_m = state.deepest_m;
      d.ceiling_m = view.ceiling_m;
      d.ceiling_violated = view.ceiling_violated;
      d.no_stop_min = view.no_stop_min;
      d.stop_m = view.stop_m;
      d.stop_min = view.stop_min;
      d.to_surface_min = view.to_surface_min;
      d.ascent_m_min = view.ascent_m_min;
      d.ascent_alarm = view.alarm;
      d.po2_bar = view.po2_bar;
      d.cns_percent = state.oxygen.cns_percent;
      // A breath's pull on the gauge trembles around the reserve.
      d.tank_pa = (200.0 - 0.045 * time_s + 1.5 * std::sin(time_s)) * 1e5;
      d.out_of_gas = time_s > 2900.0 && time_s < 2902.5;
      record.push_back(d);
    }
  }
  return record;
}

// From when to when, seconds; the level is the highest reached within.
struct Stretch {
  double from_s = 0.0, to_s = 0.0;
  bool operator==(const Stretch&) const = default;
};

// Read off the record as a person would: it begins where on holds, and ends at the first row at
// least five seconds after the last row where it was raised at which stay does not hold.
std::vector<Stretch> read_off(const std::vector<DiveData>& record, auto on, auto stay) {
  std::vector<Stretch> out;
  for (std::size_t i = 0; i < record.size(); ++i) {
    if (!on(record[i])) continue;
    std::size_t j = i + 1;
    while (j < record.size() &&
           (stay(record[j]) || on(record[j]) || record[j].time_s < record[i].time_s + 5.0))
      ++j;
    out.push_back({record[i].time_s, j < record.size() ? record[j].time_s : 1e9});
    i = j;
  }
  return out;
}

std::vector<Stretch> shown(const std::vector<DiveData>& record, Alarm alarm) {
  std::vector<Stretch> out;
  Hud hud(LayoutKind::kMask, Units::kMetric, 70);
  bool before = false;
  for (const DiveData& d : record) {
    hud.observe(d, d.time_s);
    const bool now = hud.alarms().on(alarm);
    if (now && !before) out.push_back({d.time_s, 1e9});
    if (!now && before) out.back().to_s = d.time_s;
    before = now;
  }
  return out;
}

TEST(HudWalk, EveryAlarmOfARecordedDiveBeginsAndEndsWhereTheRecordSaysSo) {
  const std::vector<DiveData> record = recorded_dive();
  using D = const DiveData&;
  const auto check = [&](Alarm alarm, std::size_t least, auto on, auto stay) {
    const auto wanted = read_off(record, on, stay);
    EXPECT_GE(wanted.size(), least) << name_of(alarm);
    const auto found = shown(record, alarm);
    ASSERT_EQ(found.size(), wanted.size()) << name_of(alarm);
    for (std::size_t i = 0; i < found.size(); ++i) {
      EXPECT_EQ(found[i].from_s, wanted[i].from_s) << name_of(alarm);
      EXPECT_EQ(found[i].to_s, wanted[i].to_s) << name_of(alarm);
      EXPECT_GE(found[i].to_s - found[i].from_s, 5.0) << name_of(alarm);
    }
  };
  check(
      Alarm::kOxygen, 1, [](D d) { return 0.32 * (1.01325 + d.depth_m * 0.10052) > 1.4 + 1e-4; },
      [](D d) { return 0.32 * (1.01325 + d.depth_m * 0.10052) > 1.35 + 1e-4; });
  check(
      Alarm::kNoStop, 1, [](D d) { return d.no_stop_min <= 5.0 && d.ceiling_m == 0.0; },
      [](D d) { return d.no_stop_min < 7.0 && d.ceiling_m == 0.0; });
  check(
      Alarm::kCeiling, 1, [](D d) { return d.ceiling_m - d.depth_m > 0.3; },
      [](D d) { return d.depth_m < d.ceiling_m; });
  check(
      Alarm::kAscent, 1, [](D d) { return d.ascent_alarm != diver::AscentAlarm::kNone; },
      [](D d) { return d.ascent_m_min > 7.2; });
  check(
      Alarm::kGas, 1, [](D d) { return d.tank_pa < 50e5 || d.out_of_gas; },
      [](D d) { return d.tank_pa < 55e5; });
}

TEST(HudWalk, NothingToBreatheIsADangerForAtLeastFiveSeconds) {
  const std::vector<DiveData> record = recorded_dive();
  Hud hud(LayoutKind::kMask, Units::kMetric, 70);
  double from_s = 0.0, to_s = 0.0;
  for (const DiveData& d : record) {
    const bool before = hud.alarms().of(Alarm::kGas) == AlarmLevel::kDanger;
    hud.observe(d, d.time_s);
    const bool now = hud.alarms().of(Alarm::kGas) == AlarmLevel::kDanger;
    if (now && !before) from_s = d.time_s;
    if (before && !now) to_s = d.time_s;
  }
  EXPECT_EQ(from_s, 2901.0);
  EXPECT_EQ(to_s, 2906.0);
}

// Each second's texts, read back as numbers, against the state: no further off than their step.
TEST(HudWalk, TheNumbersShownAreThoseOfTheState) {
  const auto number = [](FixedText text) {
    EXPECT_EQ(text.view().find('-'), std::string_view::npos) << text.view();
    return std::atof(std::string(text.view()).c_str());
  };
  int stops = 0, rows = 0;
  for (const DiveData& d : recorded_dive()) {
    const Shown s = shown_of(LayoutKind::kWrist, Units::kMetric, d, {}, {}, {}, d.time_s);
    const double gauge_m = d.depth_m * 1025.0 / 1020.0;
    EXPECT_NEAR(number(s.depth), gauge_m, 0.05 + 1e-9);
    EXPECT_EQ(number(s.tank), std::floor(1e-5 * d.tank_pa));
    EXPECT_NEAR(number(s.oxygen), d.po2_bar + 0.005, 0.0051);
    EXPECT_NEAR(number(s.to_surface), d.to_surface_min + 0.5, 0.501);
    EXPECT_EQ(s.in_stops, d.ceiling_m > 0.0);
    const int minutes = static_cast<int>(d.dive_min + 1e-9);
    EXPECT_EQ(std::stoi(std::string(s.dive_time.view())), minutes);
    if (s.in_stops) {
      ++stops;
      EXPECT_NEAR(number(s.ceiling), d.ceiling_m * 1025.0 / 1020.0 + 0.05, 0.0501);
      // Where the gauge has the stop's text the diver is at the stop or below, by a step at most. A
      // ceiling a little below the plan's stop counts.
      EXPECT_NEAR(number(s.stop),
                  (d.stop_m >= d.ceiling_m ? d.stop_m : 3.0 * std::ceil(d.ceiling_m / 3.0)) *
                          1025.0 / 1020.0 +
                      0.1,
                  0.0501);
      EXPECT_GE(number(s.stop), number(s.ceiling));
      EXPECT_NEAR(number(s.stop_min), d.stop_min + 0.5, 0.501);
      EXPECT_EQ(s.no_stop.view(), "0");
    } else if (d.no_stop_min <= 99.0) {
      EXPECT_EQ(number(s.no_stop), std::floor(d.no_stop_min + 1e-6));
    }
    ++rows;
  }
  EXPECT_GT(stops, 300);
  EXPECT_GT(rows, 3000);
}

}  // namespace
}  // namespace neritic::hud
