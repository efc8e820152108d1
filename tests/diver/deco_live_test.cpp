// The dive computer sample by sample: the reference dives as logs, what it shows against plans,
// inputs that make no sense.
#include "diver/deco_live.hpp"

#include <gtest/gtest.h>

#include <random>

#include "tests/diver/deco_cases.hpp"
#include "tests/sim/plain_inbox.hpp"
#include "tests/sim/replay.hpp"

namespace neritic::diver {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

DiveComputer computer_for(const DivePlanRequest& request) {
  auto computer = DiveComputer::create(
      {request.conventions, request.gf_low, request.gf_high, request.gases, {}});
  EXPECT_TRUE(computer.ok()) << computer.error().message;
  return std::move(*computer);
}

// Dives a plan's segments in steps of at most step_s, and calls seen(state) after each.
template <class Seen>
DiveComputerState dive(const DiveComputer& computer, const DivePlan& plan, double step_s,
                       const Seen& seen) {
  DiveComputerState state = computer.start(plan.start.tissues);
  for (const PlanSegment& s : plan.segments) {
    state = computer.step(state, {s.from_m, s.gas}, 0.0);
    const int parts = static_cast<int>(std::ceil(60.0 * s.minutes / step_s - 1e-9));
    for (int i = 1; i <= parts; ++i) {
      state = computer.step(state, {s.from_m + (s.to_m - s.from_m) * i / parts, s.gas},
                            60.0 * s.minutes / parts);
      seen(state);
    }
  }
  return state;
}

double worst_difference(const TissueState& a, const TissueState& b) {
  double worst = 0.0;
  for (std::size_t i = 0; i < kCompartments; ++i)
    worst =
        std::max({worst, std::abs(a.n2_bar[i] - b.n2_bar[i]), std::abs(a.he_bar[i] - b.he_bar[i])});
  return worst;
}

TEST(DecoLive, LogsOfTheReferenceDivesGiveTheirTissuesAndOxygen) {
  for (const DecoCase& one : deco_cases("deco_vectors.json").dives) {
    const DiveComputer computer = computer_for(one.request);
    const DivePlan plan = plan_dive(one.request).value();
    for (const double step_s : {1.0, 10.0, 60.0}) {
      const DiveComputerState end = dive(computer, plan, step_s, [](const auto&) {});
      EXPECT_LT(worst_difference(end.tissues, *one.expected.surfacing->tissues), 1e-6) << one.id;
      EXPECT_NEAR(end.oxygen.otu, plan.oxygen.otu, 1e-6 * (1.0 + plan.oxygen.otu)) << one.id;
      EXPECT_NEAR(end.oxygen.cns_percent, plan.oxygen.cns_percent,
                  1e-3 * (1.0 + plan.oxygen.cns_percent))  // the last half metre is the surface
          << one.id;
      EXPECT_EQ(end.refused, 0u);
    }
  }
}

TEST(DecoLive, AtTheBottomItShowsThePlansAscent) {
  for (const DecoCase& one : deco_cases("deco_vectors.json").dives) {
    const DiveComputer computer = computer_for(one.request);
    const DivePlan plan = plan_dive(one.request).value();
    DiveComputerState state = computer.start(plan.end_of_bottom.tissues);
    state.last = {plan.end_of_bottom.depth_m, 0};
    const DiveComputerView view = computer.view(state);
    EXPECT_NEAR(view.to_surface_min, plan.ascent_min(), 1e-9) << one.id;
    EXPECT_EQ(view.stop_m, plan.stops.empty() ? 0.0 : plan.stops.front().depth_m) << one.id;
    EXPECT_EQ(view.no_stop_min > 0.0, plan.no_stops) << one.id;
    EXPECT_EQ(view.ceiling_m > 0.0, !plan.no_stops) << one.id;
  }
}

// Gas that is carried and no longer there: the ascent shown is the plan of one who has not got it.
TEST(DecoLive, GasesThatAreUsedUpDoNotShortenTheAscent) {
  int shown = 0;
  for (const DecoCase& one : deco_cases("deco_vectors.json").dives) {
    if (one.request.gases.size() < 2 || one.request.gases.back().role != GasRole::kDeco) continue;
    const DiveComputer computer = computer_for(one.request);
    const DivePlan plan = plan_dive(one.request).value();
    DiveComputerState state = computer.start(plan.end_of_bottom.tissues);
    std::uint64_t bottom = 0, deco = 0;
    for (std::size_t i = 0; i < one.request.gases.size(); ++i)
      (one.request.gases[i].role == GasRole::kDeco ? deco : bottom) |= std::uint64_t{1} << i;
    state.last = {plan.end_of_bottom.depth_m, 0};
    for (std::size_t i = 0; i < one.request.gases.size(); ++i)
      if (one.request.gases[i].role == GasRole::kBottom) state.last.gas = i;
    DivePlanRequest bare = one.request;
    std::erase_if(bare.gases, [](const PlanGas& gas) { return gas.role == GasRole::kDeco; });
    const double with_min = computer.view(state).to_surface_min,
                 without_min = computer.view(state, deco).to_surface_min;
    EXPECT_NEAR(without_min, plan_dive(bare).value().ascent_min(), 1e-9) << one.id;
    EXPECT_GE(without_min, with_min) << one.id;
    if (!plan.stops.empty()) {
      EXPECT_GT(without_min, with_min + 1.0) << one.id;
    }
    // Pressure times time of the way up, as the plan has it, on each gas.
    const DiveComputerView view = computer.view(state);
    double run_min = 0.0;
    std::array<double, kToldGases> bar_min{};
    for (const PlanSegment& s : plan.segments) {
      if (run_min > plan.end_of_bottom.run_min - 1e-9 && s.gas < kToldGases)
        bar_min[s.gas] +=
            s.minutes * one.request.conventions.environment.pressure_bar(0.5 * (s.from_m + s.to_m));
      run_min += s.minutes;
    }
    for (std::size_t i = 0; i < kToldGases; ++i)
      EXPECT_NEAR(view.to_surface_bar_min[i], bar_min[i], 1e-9) << one.id;
    // The gas in use counts as available: its bit changes nothing.
    EXPECT_EQ(computer.view(state, bottom).to_surface_min, with_min) << one.id;
    ++shown;
  }
  EXPECT_GT(shown, 4);
}

TEST(DecoLive, FollowingAPlanTheTimeToTheSurfaceCountsDownAndNoCeilingIsBroken) {
  for (const DecoCase& one : deco_cases("deco_vectors.json").dives) {
    const DiveComputer computer = computer_for(one.request);
    const DivePlan plan = plan_dive(one.request).value();
    double run_s = 0.0;
    dive(computer, plan, 10.0, [&](const DiveComputerState& state) {
      run_s = 60.0 * state.dive_min;
      const DiveComputerView view = computer.view(state);
      const double left_min = plan.run_min() - run_s / 60.0;
      // A plan waits for whole minutes, at least one a stop; a computer sees when a ceiling clears.
      if (left_min < plan.ascent_min()) {
        EXPECT_LE(view.to_surface_min, left_min + 1.5) << one.id << " at " << run_s;
        EXPECT_GE(view.to_surface_min, left_min - 3.0) << one.id << " at " << run_s;
      }
      EXPECT_LE(view.ceiling_m, state.last.depth_m + 0.2) << one.id << " at " << run_s;
      EXPECT_LE(view.gradient, one.request.gf_high + 0.02) << one.id;
    });
  }
}

// Each set of conventions has its own slope of gradient factors and its own first stop: who follows
// the plan of a set sees it on a computer of that set, stop by stop.
TEST(DecoLive, FollowingAPlanOfAnySetTheComputerHasThePlansSlope) {
  for (const NamedConventions& set : convention_sets()) {
    double most = 0.0, least = 0.0;
    for (const DecoCase& one : deco_cases("deco_vectors.json").dives) {
      DivePlanRequest request = one.request;
      request.start.reset();
      request.conventions = set.conventions;
      const DivePlan plan = plan_dive(request).value();
      if (plan.stops.empty() || plan.above_ceiling) continue;
      const DiveComputer computer = computer_for(request);
      double run_min = 0.0;
      DiveComputerState state = computer.start(plan.start.tissues);
      for (const PlanSegment& s : plan.segments) {
        state = computer.step(state, {s.from_m, s.gas}, 0.0);
        const int parts = static_cast<int>(std::ceil(60.0 * s.minutes - 1e-9));
        for (int i = 1; i <= parts; ++i) {
          state = computer.step(state, {s.from_m + (s.to_m - s.from_m) * i / parts, s.gas},
                                60.0 * s.minutes / parts);
          const double left_min = plan.run_min() - run_min - s.minutes * i / parts;
          if (left_min >= plan.ascent_min() - 1e-6) continue;
          const DiveComputerView view = computer.view(state);
          most = std::max(most, view.to_surface_min - left_min);
          least = std::min(least, view.to_surface_min - left_min);
        }
        run_min += s.minutes;
      }
    }
    // A minute that has begun, and a sample; the first set's plans have a whole one at each stop.
    EXPECT_LT(most, 1.02) << set.name;
    EXPECT_GT(least, set.conventions.stop_end == StopEnd::kWholeStop ? -2.01 : -1.0) << set.name;
  }
}

// Wrist computers above the ceiling: the stops begin below, the way
// down to them counts, and it is said.
TEST(DecoLive, AboveABrokenCeilingTheStopsBeginBelowItAndItIsSaid) {
  for (const char* set : {"stop-minutes", "run-minutes", "msw"}) {
    DivePlanRequest request = square_dive(45.0, 30.0, kAir, set);
    request.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
    const DiveComputer computer = computer_for(request);
    const DecoConventions& c = request.conventions;
    DiveComputerState state = computer.start();
    const auto go = [&](double to_m, double minutes, std::uint64_t gas) {
      const double from_m = state.last.depth_m;
      const int samples = static_cast<int>(60.0 * minutes);
      for (int i = 1; i <= samples; ++i)
        state = computer.step(state, {from_m + (to_m - from_m) * i / samples, gas}, 1.0);
      return computer.view(state);
    };
    go(45.0, 2.25, 0);
    go(45.0, 27.75, 0);
    const DiveComputerView kept = go(21.0, 2.4, 0);
    EXPECT_FALSE(kept.ceiling_violated) << set;
    for (const bool oxygen : {false, true}) {
      const DiveComputerView broken = go(5.0, oxygen ? 1.0 : 1.6, oxygen ? 1 : 0);
      EXPECT_TRUE(broken.ceiling_violated) << set;
      EXPECT_GT(broken.ceiling_m, 6.0) << set;
      EXPECT_GE(broken.stop_m, broken.ceiling_m) << set;
      EXPECT_LT(broken.stop_m, broken.ceiling_m + 3.0) << set;
      EXPECT_GT(broken.stop_min, 0.0) << set;
      // As it is for one who goes down there at once, on the gas that may be breathed there.
      DiveComputerState down = computer.step(state, {5.0, 0}, 0.0);
      const double way_min = (broken.stop_m - 5.0) / c.descent_m_min;
      down = computer.step(down, {broken.stop_m, 0}, 60.0 * way_min);
      const DiveComputerView there = computer.view(down);
      EXPECT_FALSE(there.ceiling_violated) << set;
      EXPECT_NEAR(broken.to_surface_min, way_min + there.to_surface_min, 1.001) << set;
    }
    // The surface does not end it.
    const DiveComputerView up = go(0.0, 0.5, 0);
    EXPECT_TRUE(up.ceiling_violated) << set;
    EXPECT_GE(up.stop_m, up.ceiling_m) << set;
    EXPECT_GT(up.stop_min, 0.0) << set;
    EXPECT_GT(up.to_surface_min, 20.0) << set;
    const DiveComputerView later = go(0.0, 24.0 * 60.0, 0);
    EXPECT_FALSE(later.ceiling_violated) << set;
    EXPECT_EQ(later.stop_m, 0.0) << set;
    EXPECT_EQ(later.to_surface_min, 0.0) << set;
  }
}

// A hand's breadth above a stop is no violation, and the stop stays where stops are.
TEST(DecoLive, ALittleAboveAStopTheStopStaysWhereItIs) {
  const DivePlanRequest request = square_dive(45.0, 30.0);
  const DiveComputer computer = computer_for(request);
  DivePlan plan = plan_dive(request).value();
  const double stop_m = plan.stops.back().depth_m;
  plan.segments.resize(plan.segments.size() - 2);  // as far as the last stop
  const DiveComputerState state = dive(computer, plan, 1.0, [](const auto&) {});
  ASSERT_EQ(state.last.depth_m, stop_m);
  const DiveComputerView at_stop = computer.view(state);
  const DiveComputerView above = computer.view(computer.step(state, {stop_m - 0.2, 0}, 0.0));
  EXPECT_FALSE(above.ceiling_violated);
  EXPECT_EQ(at_stop.stop_m, stop_m);
  EXPECT_EQ(above.stop_m, stop_m);
  EXPECT_NEAR(above.to_surface_min, at_stop.to_surface_min, 0.5);
}

// Hands hold a stop within some decimetres. The stop that is shown lies where stops are, and each
// is done with once: it never goes back to the one below.
TEST(DecoLive, AWaveringDiverIsToldEachStopOnce) {
  for (const char* set : {"stop-minutes", "run-minutes", "msw"}) {
    for (const double period_s : {5.0, 17.0, 61.0}) {
      const DivePlanRequest request = square_dive(40.0, 20.0, kAir, set);
      const DiveComputer computer = computer_for(request);
      const DecoConventions& c = request.conventions;
      const int stops = static_cast<int>(plan_dive(request).value().stops.size());
      DiveComputerState state = computer.start();
      double held_m = 40.0, told_m = 0.0, time_s = 0.0;
      int told = 0;
      const auto breathe_at = [&](double depth_m) {
        state = computer.step(state, {depth_m, 0}, 1.0);
        time_s += 1.0;
      };
      for (int i = 0; i < 20 * 60; ++i) breathe_at(held_m);
      while (time_s < 3 * 3600.0) {
        const double depth_m =
            held_m + (held_m < 40.0 ? 0.35 * std::sin(2.0 * kPi * time_s / period_s) : 0.0);
        breathe_at(depth_m);
        const DiveComputerView view = computer.view(state);
        if (view.ceiling_m <= 0.0 && held_m < 40.0) break;
        // Rises as fast as computers let, to what is shown.
        const bool rising = held_m > view.stop_m;
        held_m = std::max(view.stop_m, held_m - 9.0 / 60.0);
        if (rising || state.anchor_m <= 0.0) continue;
        EXPECT_NEAR(std::remainder(view.stop_m, c.stop_step_m), 0.0, 1e-9) << set << " " << time_s;
        EXPECT_GT(view.stop_min, 0.0) << set << " " << time_s;
        if (told > 0) {
          EXPECT_LE(view.stop_m, told_m) << set << " " << period_s << " " << time_s;
        }
        told += told == 0 || view.stop_m != told_m;
        told_m = view.stop_m;
      }
      EXPECT_EQ(told_m, c.last_stop_m) << set << " " << period_s;
      EXPECT_GE(told, 3) << set << " " << period_s;
      EXPECT_LE(told, stops + 1) << set << " " << period_s;
    }
  }
}

// Nothing comes to breathe for ten minutes at 40 m, then gas again: as if these were not.
TEST(DecoLive, WithoutGasTissuesAndOxygenStayAsTheyAre) {
  const DiveComputer computer = computer_for(square_dive(40.0, 20.0));
  const DiveComputerState bottom = computer.step(computer.start(), {40.0, 0, 0}, 0.0);
  EXPECT_EQ(bottom.refused, 0u);
  DiveComputerState unfed = bottom;
  for (int i = 0; i < 600; ++i) unfed = computer.step(unfed, {40.0, 0, 0}, 1.0);
  EXPECT_TRUE(sim::same_bits(unfed.tissues, bottom.tissues));
  EXPECT_TRUE(sim::same_bits(unfed.oxygen, bottom.oxygen));
  EXPECT_NEAR(unfed.dive_min, 10.0, 1e-9);  // time and depth go on
  const DiveComputerState fed =
      computer.step(computer.step(unfed, {40.0, 0, 1}, 0.0), {40.0, 0, 1}, 600.0);
  const DiveComputerState usual =
      computer.step(computer.step(bottom, {40.0, 0, 1}, 0.0), {40.0, 0, 1}, 600.0);
  EXPECT_TRUE(sim::same_bits(fed.tissues, usual.tissues));
  EXPECT_GT(fed.tissues.n2_bar[0], unfed.tissues.n2_bar[0] + 1.0);
  EXPECT_GT(fed.oxygen.cns_percent, unfed.oxygen.cns_percent);
}

TEST(DecoLive, WhatMakesNoSenseIsRefusedCountedAndTheLastGoodHeld) {
  const DiveComputer computer = computer_for(square_dive(40.0, 20.0));
  DiveComputerState good = computer.start(), bad = computer.start();
  good = computer.step(good, {40.0, 0}, 120.0);
  bad = computer.step(bad, {40.0, 0}, 120.0);
  std::uint64_t refused = 0;
  for (const DiveSample& sample :
       {DiveSample{kNan, 0}, {-1e9, 0}, {HUGE_VAL, 0}, {3000.0, 0}, {5.0, 7}, {5.0, 0, 2}}) {
    good = computer.step(good, {40.0, 0}, 10.0);
    bad = computer.step(bad, sample, 10.0);
    EXPECT_EQ(bad.refused, ++refused);
  }
  for (const double dt : {kNan, -1.0, HUGE_VAL}) {
    bad = computer.step(bad, {20.0, 0}, dt);
    EXPECT_EQ(bad.refused, ++refused);
  }
  bad.refused = good.refused;
  EXPECT_TRUE(sim::same_bits(good, bad));
}

TEST(DecoLive, ExtremesStayFinite) {
  DivePlanRequest request = square_dive(40.0, 20.0);
  request.gases.push_back({{1.0, 0.0}, 6.0, GasRole::kDeco});
  const DiveComputer computer = computer_for(request);
  const auto expect_sane = [&](const DiveComputerState& state, const char* what) {
    EXPECT_TRUE(sim::all_finite(state)) << what;
    for (std::size_t i = 0; i < kCompartments; ++i) {
      EXPECT_GE(state.tissues.n2_bar[i], 0.0) << what;
      EXPECT_LT(state.tissues.n2_bar[i], 200.0) << what;
    }
    const DiveComputerView view = computer.view(state);
    EXPECT_TRUE(std::isfinite(view.ceiling_m) && view.ceiling_m >= 0.0) << what;
    EXPECT_FALSE(std::isnan(view.to_surface_min)) << what;
  };
  constexpr double kYear_s = 365.25 * 86400.0;
  // Ten years at the surface, in one step and in days, make a diver as fresh as another.
  DiveComputerState years = computer.step(computer.start(), {0.0, 0}, 10.0 * kYear_s);
  expect_sane(years, "ten years");
  DiveComputerState days = computer.start();
  for (int i = 0; i < 3653; ++i) days = computer.step(days, {0.0, 0}, 86400.0);
  EXPECT_LT(worst_difference(years.tissues, days.tissues), 1e-12);
  EXPECT_EQ(computer.view(years).to_surface_min, 0.0);
  // Saturated at 300 m, then at the surface in no time: the ceiling is far down.
  DiveComputerState deep = computer.step(computer.start(), {300.0, 0}, 600.0);
  deep = computer.step(deep, {300.0, 0}, 30.0 * 86400.0);
  expect_sane(deep, "saturated at 300 m");
  deep = computer.step(deep, {0.0, 0}, 0.0);
  expect_sane(deep, "jumped to the surface");
  EXPECT_GT(computer.view(deep).ceiling_m, 150.0);
  EXPECT_GT(computer.view(deep).gradient, 5.0);
  // A kilometre down, and pure oxygen there.
  DiveComputerState kilometre = computer.step(computer.start(), {1000.0, 0}, 60.0);
  expect_sane(computer.step(kilometre, {1000.0, 1}, 3600.0), "1000 m");
  kilometre = computer.step(kilometre, {1000.0, 1}, 0.0);
  kilometre = computer.step(kilometre, {1000.0, 1}, 86400.0);
  expect_sane(kilometre, "oxygen at 1000 m");
  EXPECT_GT(kilometre.oxygen.cns_percent, 1e5);
  // Steps of no time change nothing but the depth.
  DiveComputerState none = computer.step(computer.start(), {30.0, 0}, 0.0);
  for (int i = 0; i < 100; ++i) none = computer.step(none, {30.0, 0}, 0.0);
  EXPECT_EQ(none.tissues, computer.start().tissues);
  // A sensor that teleports.
  std::mt19937 random(5);
  DiveComputerState wild = computer.start();
  for (int i = 0; i < 2000; ++i)
    wild = computer.step(
        wild, {std::uniform_real_distribution<double>(-20.0, 2100.0)(random), random() % 3},
        std::uniform_real_distribution<double>(-1.0, 30.0)(random));
  expect_sane(wild, "teleports");
  EXPECT_GT(wild.refused, 500u);
  // And it recovers.
  wild = computer.step(wild, {0.0, 0}, 0.0);
  for (int i = 0; i < 60; ++i) wild = computer.step(wild, {0.0, 0}, 86400.0);
  EXPECT_EQ(computer.view(wild).ceiling_m, 0.0);
  EXPECT_EQ(wild.ascent.rate_m_min, 0.0);
}

TEST(DecoLive, AHundredRunsHaveTheSameHash) {
  const DivePlanRequest request = square_dive(45.0, 25.0);
  const DiveComputer computer = computer_for(request);
  const DivePlan plan = plan_dive(request).value();
  const auto hash = [&] { return sim::state_hash(dive(computer, plan, 3.0, [](const auto&) {})); };
  const auto first = hash();
  for (int i = 0; i < 100; ++i) ASSERT_EQ(hash(), first);
}

TEST(DecoLive, ASimulationOfAComputerReplaysToTheSameBits) {
  DivePlanRequest request = square_dive(40.0, 20.0);
  request.gases.push_back({{0.5, 0.0}, 21.0, GasRole::kDeco});
  const DiveComputer computer = computer_for(request);
  const auto step = [&](const DiveComputerState& state, const DiveSample& sample, double dt_s) {
    return computer.step(state, sample, dt_s);
  };
  auto simulation =
      sim::test::plain_simulation({.step_s = 0.05}, computer.start(), DiveSample{}, step);
  std::mt19937 random(9);
  for (int second = 0; second < 600; ++second) {
    const double depth_m =
        std::max(40.0 * std::sin(second / 200.0), 0.0) + 1e-4 * (random() % 1000);
    simulation.inbox().push({depth_m, depth_m < 21.0 && second > 300 ? 1u : 0u});
    simulation.advance(20);
  }
  EXPECT_GT(simulation.newest().state.deepest_m, 39.0);
  EXPECT_EQ(simulation.newest().state.last.gas, 1u);
  const sim::ReplayReport again = sim::test::replay(simulation.log(), computer.start(), step,
                                                    sim::test::apply_whole<DiveSample>);
  EXPECT_EQ(again.steps, 12000u);
  EXPECT_FALSE(again.first_difference.has_value());
}

TEST(DecoLive, StatesArePlainBytesWithoutPadding) {
  sim::check_fields_cover(DiveComputerState{});
  sim::check_fields_cover(DiveSample{});
  sim::check_fields_cover(AscentRateState{});
}

TEST(DecoLive, SurfaceTimeEndsADive) {
  const DiveComputer computer = computer_for(square_dive(20.0, 30.0));
  DiveComputerState state = computer.step(computer.start(), {20.0, 0}, 60.0);
  state = computer.step(state, {20.0, 0}, 1740.0);
  state = computer.step(state, {0.0, 0}, 120.0);
  EXPECT_NEAR(state.dive_min, 32.0, 1e-9);
  EXPECT_EQ(state.deepest_m, 20.0);
  state = computer.step(state, {0.0, 0}, 300.0);  // too short
  state = computer.step(state, {5.0, 0}, 60.0);
  EXPECT_NEAR(state.dive_min, 33.0, 1e-9);
  state = computer.step(state, {0.0, 0}, 60.0);
  const double cns = state.oxygen.cns_percent;
  EXPECT_GT(cns, 1.0);
  state = computer.step(state, {0.0, 0}, 3600.0);
  EXPECT_NEAR(state.surface_min, 60.0, 1e-9);
  EXPECT_NEAR(state.oxygen.cns_percent, cns_after(cns, 60.0), 1e-12);
  state = computer.step(state, {3.0, 0}, 60.0);
  EXPECT_NEAR(state.dive_min, 1.0, 1e-9);
}

TEST(AscentRate, IsThePublishedLine) {
  AscentRateState state;
  const AscentRateLimits limits;
  for (int i = 0; i <= 10; ++i) state = observe(state, 20.0 - 0.3 * i, i > 0 ? 1.0 : 0.0, limits);
  EXPECT_NEAR(state.rate_m_min, 18.0, 1e-9);
}

// Two samples far apart that lie a rise apart are a rise that lasted as long.
TEST(AscentRate, ARiseBetweenTwoSamplesIsOne) {
  const AscentRateLimits limits;
  const auto alarm_after = [&](double rise_m, double dt_s) {
    AscentRateState state;
    for (int i = 0; i < 3; ++i) state = observe(state, 40.0, i > 0 ? 60.0 : 0.0, limits);
    return alarm_of(observe(state, 40.0 - rise_m, dt_s, limits), limits);
  };
  EXPECT_EQ(alarm_after(40.0, 60.0), AscentAlarm::kDangerous);
  EXPECT_EQ(alarm_after(12.0, 60.0), AscentAlarm::kFast);
  EXPECT_EQ(alarm_after(8.0, 60.0), AscentAlarm::kNone);
  EXPECT_EQ(alarm_after(0.6, 2.0), AscentAlarm::kNone);  // too short to be said
}

// 5 cm of noise: by the line's theory 0.286 m/min at 1 Hz over eleven samples; two points have 4.2.
TEST(AscentRate, NoiseDoesNotAlarmAndARiseDoes) {
  std::mt19937 random(3);
  std::normal_distribution<double> noise(0.0, 0.05);
  for (const double hz : {0.5, 1.0, 4.0, 100.0}) {
    AscentRateState state;
    const AscentRateLimits limits;
    double squares = 0.0, alarm_s = -1.0;
    int counted = 0;
    const auto seconds = [&](double s) { return static_cast<int>(s * hz); };
    for (int i = 0; i < seconds(2000.0); ++i) {
      state = observe(state, 20.0 + noise(random), 1.0 / hz, limits);
      EXPECT_EQ(alarm_of(state, limits), AscentAlarm::kNone) << hz;
      if (i > seconds(20.0)) squares += state.rate_m_min * state.rate_m_min, ++counted;
    }
    const double deviation = std::sqrt(squares / counted);
    EXPECT_LT(deviation, hz < 1.0 ? 0.45 : 0.32) << hz;
    if (hz == 1.0) {
      EXPECT_NEAR(deviation, 0.286, 0.03);
    }
    // Fast: said within some 15 s, and dangerous later or never.
    for (int i = 0; i < seconds(40.0); ++i) {
      state = observe(state, 20.0 - 12.0 / 60.0 * (i + 1) / hz + noise(random), 1.0 / hz, limits);
      if (alarm_s < 0.0 && alarm_of(state, limits) == AscentAlarm::kFast) alarm_s = i / hz;
      EXPECT_NE(alarm_of(state, limits), AscentAlarm::kDangerous) << hz;
    }
    EXPECT_GT(alarm_s, 5.0) << hz;
    EXPECT_LT(alarm_s, 20.0) << hz;
    for (int i = 0; i < seconds(25.0); ++i)
      state = observe(state, 12.0 - 25.0 / 60.0 * (i + 1) / hz + noise(random), 1.0 / hz, limits);
    EXPECT_EQ(alarm_of(state, limits), AscentAlarm::kDangerous) << hz;
    for (int i = 0; i < seconds(30.0); ++i) state = observe(state, 1.6, 1.0 / hz, limits);
    EXPECT_EQ(alarm_of(state, limits), AscentAlarm::kNone) << hz;
  }
}

}  // namespace
}  // namespace neritic::diver
