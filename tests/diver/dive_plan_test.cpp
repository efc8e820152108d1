// The planner: what every plan keeps, sets of conventions, gases on the way down and up, what is
// refused.
#include "diver/dive_plan.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <random>

#include "diver/deco_live.hpp"
#include "diver/deco_ndl.hpp"
#include "tests/diver/deco_cases.hpp"

namespace neritic::diver {
namespace {

using ::testing::HasSubstr;

DivePlan planned(const DivePlanRequest& request) {
  auto plan = plan_dive(request);
  EXPECT_TRUE(plan.ok()) << plan.error().message;
  return plan.ok() ? *plan : DivePlan();
}

// Random dives under each set: no stop breaks the ceiling that it was left under, segments join,
// and replaying them gives the same tissues.
TEST(DivePlan, EveryPlanKeepsItsCeilingsAndItsSums) {
  std::mt19937 random(11);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  for (int i = 0; i < 300; ++i) {
    const NamedConventions& set = convention_sets()[static_cast<std::size_t>(i) % 3];
    DivePlanRequest r = square_dive(number(5.0, 90.0), 0.0);
    r.conventions = set.conventions;
    r.levels[0].leave_min = r.levels[0].depth_m / 20.0 + number(1.0, 60.0);
    r.gf_high = number(0.5, 1.0);
    r.gf_low = number(0.1, r.gf_high);
    if (i % 2) r.gases[0].mix = {0.18, number(0.0, 0.6)};
    if (i % 5) r.gases.push_back({{0.5, 0.0}, std::floor(number(9.0, 22.0)), GasRole::kDeco});
    if (i % 7) r.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
    const DivePlan plan = planned(r);
    const Buehlmann model = r.conventions.model();
    const DecoEnvironment& where = r.conventions.environment;
    TissueState now = plan.start.tissues;
    double run_min = 0.0, depth_m = 0.0;
    std::size_t stop = 0;
    for (const PlanSegment& s : plan.segments) {
      EXPECT_EQ(s.from_m, depth_m);
      now = load(model, now, where.pressure_bar(s.from_m), where.pressure_bar(s.to_m), s.minutes,
                 r.gases[s.gas].mix);
      run_min += s.minutes;
      depth_m = s.to_m;
      if (s.phase != PlanPhase::kStop) continue;
      ASSERT_LT(stop, plan.stops.size());
      EXPECT_NEAR(plan.stops[stop].leave_min, run_min, 1e-6);
      if (r.conventions.leaving == LeavingTrial::kTissuesAtStop) {
        const double next = stop + 1 < plan.stops.size() ? plan.stops[stop + 1].depth_m : 0.0;
        EXPECT_LE(ceiling(model, now, plan.stops[stop].gf_next).pressure_bar,
                  where.pressure_bar(next) + 1e-9);
      }
      ++stop;
    }
    EXPECT_EQ(stop, plan.stops.size());
    EXPECT_EQ(depth_m, 0.0);
    EXPECT_NEAR(run_min, plan.run_min(), 1e-6);
    for (std::size_t c = 0; c < kCompartments; ++c)
      EXPECT_NEAR(now.n2_bar[c] + now.he_bar[c],
                  plan.surfacing.tissues.n2_bar[c] + plan.surfacing.tissues.he_bar[c], 1e-9);
    EXPECT_LE(ceiling(model, now, r.gf_high).pressure_bar, where.surface_bar + 1e-9) << set.name;
    EXPECT_GE(plan.oxygen.otu, 0.0);
  }
}

// Random levels, deep and shallow, under each set: a plan that is accepted is not above its ceiling
// for a second, as the dive computer sees it; one that is not says a level that is accepted
// instead.
TEST(DivePlan, LevelsAboveTheirCeilingAreRefusedAndAllOthersKeepIt) {
  std::mt19937 random(23);
  const auto number = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  int refused = 0, kept_stops = 0;
  for (int i = 0; i < 240; ++i) {
    DivePlanRequest r = square_dive(number(25.0, 70.0), number(8.0, 35.0), {0.21, i % 2 ? 0.3 : 0});
    r.conventions = convention_sets()[static_cast<std::size_t>(i) % 3].conventions;
    if (i % 4 == 0) r.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
    for (int k = 0; k < 2; ++k)
      r.levels.push_back({number(4.0, 45.0), r.levels.back().leave_min + number(8.0, 25.0)});
    DivePlan plan = planned(r);
    for (int tries = 0; plan.above_ceiling && tries < 3; ++tries, ++refused) {
      const LevelAboveCeiling above = *plan.above_ceiling;
      PlanLevel& level = r.levels[above.level];
      EXPECT_FALSE(check_ceilings(r, plan).ok());
      EXPECT_GT(above.least_m, level.depth_m) << i;
      // A hand above what is accepted is not.
      level.depth_m = above.least_m - 0.05;
      const DivePlan nearly = planned(r);
      ASSERT_TRUE(nearly.above_ceiling.has_value()) << i;
      EXPECT_EQ(nearly.above_ceiling->level, above.level) << i;
      level.depth_m = above.least_m;
      plan = planned(r);
    }
    ASSERT_TRUE(check_ceilings(r, plan).ok()) << i;
    auto computer = DiveComputer::create({r.conventions, r.gf_low, r.gf_high, r.gases, {}});
    ASSERT_TRUE(computer.ok());
    DiveComputerState state = computer->start();
    double run_min = 0.0;
    for (const PlanSegment& s : plan.segments) {
      state = computer->step(state, {s.from_m, s.gas}, 0.0);
      const int parts = static_cast<int>(std::ceil(6.0 * s.minutes));
      for (int k = 1; k <= parts && run_min < plan.end_of_bottom.run_min - 1e-6; ++k) {
        state = computer->step(state, {s.from_m + (s.to_m - s.from_m) * k / parts, s.gas},
                               60.0 * s.minutes / parts);
        const DiveComputerView view = computer->view(state);
        EXPECT_FALSE(view.ceiling_violated)
            << i << " at " << state.last.depth_m << " m, " << view.ceiling_m;
      }
      run_min += s.minutes;
    }
    kept_stops += plan.no_stops ? 0 : 1;
  }
  EXPECT_GT(refused, 40);
  EXPECT_GT(kept_stops, 150);
}

// Up to 3 m out of 60, where the ceiling is ten storeys below; and down to 3 m out of the boat with
// tissues that are still full.
TEST(DivePlan, ALevelAboveItsCeilingIsOneLine) {
  DivePlanRequest r = square_dive(60.0, 30.0);
  r.levels.push_back({3.0, 60.0});
  DivePlan plan = planned(r);
  EXPECT_EQ(check_ceilings(r, plan).error().message,
            "found 3 m until 60 min, above the ceiling, which is at 29.39 m on the way there; "
            "accepted: 29.4 m or deeper");
  r.start = plan.end_of_bottom.tissues;
  r.levels = {{5.0, 30.0}};
  plan = planned(r);
  ASSERT_TRUE(plan.above_ceiling.has_value());
  r.levels[0].depth_m = plan.above_ceiling->least_m;
  EXPECT_FALSE(planned(r).above_ceiling.has_value());
  // Within the time without stops any level may be come up to.
  r = square_dive(30.0, 8.0);
  r.gf_low = 0.05;
  r.levels.push_back({2.0, 20.0});
  EXPECT_TRUE(check_ceilings(r, planned(r)).ok());
}

TEST(DivePlan, TheLastStopIsWhereItIsAskedFor) {
  DivePlanRequest r = square_dive(24.0, 120.0, {0.4, 0.0});
  r.conventions.table = BuehlmannTable::kC;
  r.conventions.first_compartment = FirstCompartment::k4Min;
  r.gf_low = 0.8;
  r.gf_high = 0.95;
  ASSERT_EQ(planned(r).stops.front().depth_m, 3.0);  // where the first stop would be
  r.conventions.last_stop_m = 6.0;
  const DivePlan plan = planned(r);
  ASSERT_EQ(plan.stops.size(), 1u);
  EXPECT_EQ(plan.stops[0].depth_m, 6.0);
  EXPECT_EQ(plan.stops[0].gf_next, 0.95);
}

TEST(DivePlan, MoreDepthTimeAndCautionNeverGiveShorterAscents) {
  double before = 0.0;
  for (double depth = 20.0; depth <= 60.0; depth += 5.0) {
    const double ascent = planned(square_dive(depth, 30.0)).ascent_min();
    EXPECT_GE(ascent, before) << depth;
    before = ascent;
  }
  before = 0.0;
  for (double minutes = 5.0; minutes <= 80.0; minutes += 5.0) {
    const double ascent = planned(square_dive(40.0, minutes)).ascent_min();
    EXPECT_GE(ascent, before) << minutes;
    before = ascent;
  }
  DivePlanRequest cautious = square_dive(40.0, 30.0);
  const double plain = planned(cautious).ascent_min();
  cautious.conventions.saturation = 1.1;
  cautious.conventions.desaturation = 0.9;
  EXPECT_GT(planned(cautious).ascent_min(), plain + 5.0);
  cautious.conventions.saturation = cautious.conventions.desaturation = 1.0;
  cautious.conventions.environment.surface_bar = surface_bar_at(3000.0);
  EXPECT_GT(planned(cautious).ascent_min(), plain);
}

TEST(DivePlan, TravelGasIsBreathedUntilTheBottomGasBegins) {
  DivePlanRequest r = square_dive(75.0, 20.0, {0.15, 0.55});
  r.gases[0].switch_depth_m = 30.0;
  r.gases.push_back({{0.5, 0.0}, 0.0, GasRole::kTravel});
  r.gases.push_back({{0.35, 0.25}, 15.0, GasRole::kTravel});
  r.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  const DivePlan plan = planned(r);
  ASSERT_GE(plan.segments.size(), 4u);
  const std::tuple<double, double, std::size_t> down[] = {{0, 15, 1}, {15, 30, 2}, {30, 75, 0}};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(std::tuple(plan.segments[i].from_m, plan.segments[i].to_m, plan.segments[i].gas),
              down[i]);
    EXPECT_EQ(plan.segments[i].phase, PlanPhase::kDescent);
  }
  for (const PlanStop& stop : plan.stops)
    EXPECT_EQ(stop.gas, stop.depth_m <= 21.0 ? 3u : 0u) << stop.depth_m;
}

// The plan of one gas is not the plan of another.
TEST(DivePlan, ABottomGasThatIsNotBreathedAtTheBottomIsRefused) {
  DivePlanRequest r = square_dive(60.0, 20.0, {0.10, 0.70});
  r.gases.push_back({{0.32, 0.0}, 0.0, GasRole::kTravel});
  EXPECT_FALSE(plan_dive(r).ok());
  EXPECT_FALSE(check_request(r).ok());
  std::swap(r.gases[0], r.gases[1]);  // in any order
  EXPECT_FALSE(plan_dive(r).ok());
  r.gases[1].switch_depth_m = 61.0;
  EXPECT_FALSE(plan_dive(r).ok());
  r.gases[1].switch_depth_m = 60.0;
  EXPECT_TRUE(plan_dive(r).ok());
  r.levels = {{20.0, 10.0}, {60.0, 20.0}, {30.0, 40.0}};  // it is the deepest that counts
  EXPECT_TRUE(plan_dive(r).ok());
}

TEST(DivePlan, ExtremesArePlannedOrRefused) {
  // A kilometre down on heliox: days of stops, and no tissue is infinite.
  DivePlanRequest deep = square_dive(1000.0, 70.0, {0.01, 0.97});
  deep.gases.push_back({{0.2, 0.3}, 60.0, GasRole::kDeco});
  deep.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  const DivePlan days = planned(deep);
  EXPECT_GT(days.run_min(), 1000.0);
  EXPECT_TRUE(std::isfinite(days.oxygen.cns_percent));
  // Saturated on air at 50 m, and on pure oxygen at 100 m.
  EXPECT_GT(planned(square_dive(50.0, 20000.0)).stop_min(), 1000.0);
  const DivePlan oxygen = planned(square_dive(100.0, 60.0, {1.0, 0.0}));
  EXPECT_TRUE(oxygen.no_stops);
  EXPECT_GT(oxygen.oxygen.cns_percent, 5000.0);
  // The surface never clears where tissues stay above what they tolerate there: 2 bar of surface
  // pressure left for 0.2.
  DivePlanRequest never = square_dive(10.0, 10.0);
  never.conventions.environment.surface_bar = 0.2;
  never.conventions.stop_step_m = never.conventions.last_stop_m = 100.0;
  never.gf_low = never.gf_high = 0.01;
  never.levels = {{120.0, 30000.0}};
  const auto refused = plan_dive(never);
  ASSERT_FALSE(refused.ok());
  EXPECT_THAT(refused.error().message, HasSubstr("its ceiling never clears"));
}

TEST(DivePlan, WhatIsWrongIsSaidInOneLine) {
  const auto fault = [](auto change) {
    DivePlanRequest r = square_dive(30.0, 25.0);
    change(r);
    const auto plan = plan_dive(r);
    return plan.ok() ? std::string("planned") : plan.error().message;
  };
  EXPECT_EQ(fault([](auto&) {}), "planned");
  EXPECT_THAT(fault([](auto& r) { r.gf_low = 0.9; }), HasSubstr("gradient factors 0.9/0.85"));
  EXPECT_THAT(fault([](auto& r) { r.gf_high = std::nan(""); }), HasSubstr("gradient factors"));
  EXPECT_THAT(fault([](auto& r) { r.levels.clear(); }), HasSubstr("found no depth"));
  EXPECT_THAT(fault([](auto& r) { r.levels[0].leave_min = 1.0; }),
              HasSubstr("found 30 m until 1 min, though it is reached after 1.5 min"));
  EXPECT_THAT(fault([](auto& r) { r.levels[0].depth_m = std::nan(""); }), HasSubstr("m until"));
  EXPECT_THAT(fault([](auto& r) { r.gases.clear(); }), HasSubstr("found 0 gases"));
  EXPECT_THAT(fault([](auto& r) { r.gases.push_back({}); }), HasSubstr("found 2 bottom gases"));
  EXPECT_THAT(fault([](auto& r) { r.gases[0].mix = {0.6, 0.6}; }), HasSubstr("gas of 0.6 oxygen"));
  EXPECT_THAT(fault([](auto& r) { r.conventions.last_stop_m = 4.0; }),
              HasSubstr("a multiple of 3 m"));
  EXPECT_THAT(fault([](auto& r) { r.conventions.ascent_m_min = 0.0; }), HasSubstr("rates of"));
  EXPECT_THAT(fault([](auto& r) { r.conventions.environment.surface_bar = 0.0; }),
              HasSubstr("surface pressure 0"));
  EXPECT_THAT(fault([](auto& r) {
                r.start = TissueState{};
                r.start->n2_bar[3] = -1.0;
              }),
              HasSubstr("-1 bar in a tissue"));
}

TEST(DecoConventions, SetsHaveNamesAndDiffer) {
  ASSERT_EQ(convention_sets().size(), 3u);
  EXPECT_EQ(convention_sets()[0].name, "stop-minutes");
  const auto run = planned(square_dive(35.0, 40.0, kAir, "run-minutes"));
  const auto stop = planned(square_dive(35.0, 40.0));
  EXPECT_EQ(stop.stop_min(), 44.0);
  EXPECT_NEAR(run.stop_min(), 54.8, 3.0);
  for (const PlanStop& s : run.stops) EXPECT_NEAR(s.leave_min, std::round(s.leave_min), 1e-9);
  for (const PlanStop& s : stop.stops) EXPECT_EQ(s.minutes, std::round(s.minutes));
  EXPECT_EQ(conventions_of("guess").error().message,
            "found convention 'guess'; accepted: stop-minutes, run-minutes, msw");
}

TEST(DecoNdl, ClosedFormIsThePublishedTable) {
  const Buehlmann model = buehlmann(BuehlmannTable::kB, FirstCompartment::k5Min, 0.0627);
  const std::pair<double, double> table[] = {{12, 238.8}, {15, 106.3}, {18, 66.0}, {21, 41.0},
                                             {24, 29.0},  {27, 21.7},  {30, 16.6}, {33, 13.6},
                                             {36, 11.2},  {39, 9.35},  {42, 8.10}};
  for (const auto& [depth, minutes] : table)
    EXPECT_NEAR(closed_form_ndl(model, {}, 0.7902, depth, kAir, 1.0).minutes, minutes, 0.05)
        << depth;
  EXPECT_EQ(closed_form_ndl(model, {}, 0.7902, 3.0, kAir, 1.0).minutes, kNoLimit_min);
}

TEST(DecoNdl, ADiveIsWithoutStopsUntilItAndNotAfter) {
  for (const double depth : {9.0, 18.0, 30.0, 45.0}) {
    DivePlanRequest r = square_dive(depth, depth / 20.0);
    const auto run = run_time_without_stops(r);
    ASSERT_TRUE(run.ok() && run->has_value());
    r.levels[0].leave_min = **run - 1e-5;
    EXPECT_TRUE(planned(r).no_stops) << depth;
    r.levels[0].leave_min = **run + 1e-4;
    EXPECT_FALSE(planned(r).no_stops) << depth;
  }
  EXPECT_EQ(**run_time_without_stops(square_dive(3.0, 1.0)), 0.15 + kNoLimit_min);
  EXPECT_FALSE(run_time_without_stops(square_dive(75.0, 20.0, {0.15, 0.55}))->has_value());
}

}  // namespace
}  // namespace neritic::diver
