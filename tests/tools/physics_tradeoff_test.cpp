// `neritic tradeoff physics`: the reference integrator against closed forms, what the curves say,
// and the rates that a vehicle's error is turned into.
#include "tools/tradeoff/physics_tradeoff.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "engine/core/files.hpp"
#include "rov/step_choice.hpp"
#include "tests/support/support.hpp"
#include "tools/tradeoff/extrapolation.hpp"
#include "tools/tradeoff/mission_flights.hpp"
#include "tools/tradeoff/physics_flights.hpp"

namespace neritic::tools {
namespace {

using rov::Integrator;

TEST(Extrapolation, FollowsClosedFormsToItsTolerance) {
  // A swing, and a fall against quadratic drag.
  const auto swing = extrapolate(
      [](double, const Vector& y) {
        return Vector{y[1], -9.0 * y[0]};
      },
      0.0, 10.0, {1.0, 0.0}, 1e-13);
  EXPECT_TRUE(swing.converged);
  EXPECT_NEAR(swing.y[0], std::cos(30.0), 1e-11);
  EXPECT_NEAR(swing.y[1], -3.0 * std::sin(30.0), 1e-11);
  const auto fall = extrapolate(
      [](double, const Vector& y) { return Vector{9.82 - 0.5 * std::abs(y[0]) * y[0]}; }, 0.0, 3.0,
      {0.0}, 1e-13);
  const double terminal = std::sqrt(9.82 / 0.5);
  EXPECT_NEAR(fall.y[0], terminal * std::tanh(3.0 * 9.82 / terminal), 1e-11);
  // Time-dependent, and stiff enough to need many steps.
  const auto forced =
      extrapolate([](double t, const Vector& y) { return Vector{-200.0 * (y[0] - std::cos(t))}; },
                  0.0, 2.0, {0.0}, 1e-12);
  const double k = 200.0, a = k * k / (k * k + 1.0), b = k / (k * k + 1.0);
  EXPECT_NEAR(forced.y[0], a * std::cos(2.0) + b * std::sin(2.0), 1e-10);
  EXPECT_GT(forced.steps, 3);
}

TEST(Extrapolation, SaysSoWhereThereIsNoSolution) {
  const auto pole = extrapolate([](double, const Vector& y) { return Vector{y[0] * y[0]}; }, 0.0,
                                2.0, {1.0}, 1e-10);  // 1 / (1 - t)
  EXPECT_FALSE(pole.converged);
}

const PhysicsPoint& point(const PhysicsTradeoff& t, const std::string& flight,
                          Integrator integrator, double step_ms) {
  for (const PhysicsPoint& p : t.points)
    if (p.flight == flight && p.integrator == integrator &&
        std::abs(1e3 * p.step_s - step_ms) < 1e-6)
      return p;
  ADD_FAILURE() << flight << " " << step_ms;
  return t.points.front();
}

TEST(PhysicsTradeoff, ErrorsFallWithTheStepAndTheGuardHoldsAtAny) {
  const auto measured = run_physics_tradeoff(
      {.quick = true, .scene = test::source_dir() / "assets/scenes/mission.toml"});
  ASSERT_TRUE(measured.ok()) << measured.error().message;
  const PhysicsTradeoff& t = *measured;
  EXPECT_EQ(t.points.size(), 13u * 3u * 6u);
  EXPECT_LT(t.truth_error_m.at("lag"), 1e-9);
  EXPECT_LT(t.truth_error_m.at("no lag"), 1e-9);
  for (const char* vehicle : {"lag", "no lag"}) {
    for (const double step_ms : {1.0, 5.0, 10.0, 25.0, 50.0}) {
      EXPECT_LT(point(t, vehicle, Integrator::kGuarded, step_ms).error_m, 5e-6) << step_ms;
      EXPECT_GT(point(t, vehicle, Integrator::kSemiImplicit, step_ms).error_m, 1e-5) << step_ms;
    }
    EXPECT_LT(point(t, vehicle, Integrator::kRk4, 1.0).error_m, 1e-8);
    EXPECT_NEAR(point(t, vehicle, Integrator::kSemiImplicit, 2.0).order, 1.0, 0.15);
  }
  // Plain RK4 over a lag that is four times as fast as the step.
  EXPECT_FALSE(point(t, "lag", Integrator::kRk4, 50.0).error_m < 0.01);
  // Contacts in whole steps are of first order, whatever integrates the rest.
  for (const char* flight : {"contact, lag", "contact, no lag", "bounce"}) {
    const double at_1_ms = point(t, flight, Integrator::kGuarded, 1.0).error_m;
    EXPECT_LT(at_1_ms, 5e-3) << flight;
    EXPECT_GT(point(t, flight, Integrator::kGuarded, 25.0).error_m, 5.0 * at_1_ms) << flight;
  }
  ASSERT_EQ(t.halved.size(), 27u);
  for (const PhysicsPoint& p : t.halved) EXPECT_LE(p.error_m, 20.0 * p.within_m) << p.flight;
  const PhysicsPoint* best = cheapest(t, 1e-5);
  ASSERT_NE(best, nullptr);
  EXPECT_LE(best->error_m, 1e-5);
  EXPECT_EQ(cheapest(t, 0.0), nullptr);
  ASSERT_NE(knee(t, "lag"), nullptr);

  const test::ScratchFolder folder;
  ASSERT_TRUE(write_physics_tradeoff(folder / "out", t).ok());
  for (const char* name :
       {"physics.csv", "physics.md", "physics.json", "physics.plot.json", "physics.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
}

// Coulomb's law: what slides stops where it says, half a step's way off, and a ball rolls with 5/7
// of its speed, turned as far as that takes. Nothing of the solver is in these truths.
TEST(PhysicsTradeoff, SlidingAndRollingEndWhereTheirClosedFormsSay) {
  const Flight slide = slide_flight(5.0), roll = roll_flight(5.0);
  EXPECT_NEAR(slide.truth.back().position_ned_m.x, 1.0 / 0.6, 1e-12);
  EXPECT_NEAR(roll.truth.back().position_ned_m.x - roll.truth[79].position_ned_m.x, 5.0 / 7.0,
              1e-12);  // the last second's way
  for (const double step_s : {0.001, 0.01, 0.05}) {
    const FlownError slid = flown_error(slide, step_s, {}), rolled = flown_error(roll, step_s, {});
    EXPECT_NEAR(slid.m, 0.5 * step_s, 0.01 * step_s) << step_s;
    EXPECT_LT(slid.rad, 1e-9) << step_s;
    EXPECT_LT(rolled.m, 0.15 * step_s) << step_s;
    EXPECT_LT(rolled.rad, 2.5 * step_s) << step_s;
  }
}

// With a controller in the loop, in water that changes with place and time, against an
// extrapolation of high order; with pulses in whole microseconds too.
TEST(PhysicsTradeoff, WhatAnErrorChoosesHoldsUnderControlInACurrent) {
  for (const bool pulses : {false, true}) {
    const Flight flight = mission_flight(pulses, 8.0).value();
    EXPECT_LT(flight.truth_error_m, 1e-8);
    for (const double asked_m : {1e-3, 1e-5, 1.2e-7}) {
      const auto choice = rov::cheapest_step(asked_m, rov::Touchable::kNothing);
      ASSERT_TRUE(choice.ok()) << choice.error().message;
      EXPECT_LE(flown_error(flight, 1.0 / choice->hz, {}).m, asked_m) << flight.name;
    }
  }
}

// The step that max_error_m selects keeps every flight within that error.
TEST(PhysicsTradeoff, WhatAnErrorChoosesHoldsOnEveryFlight) {
  std::vector<Flight> flights;
  flights.push_back(square_flight(true, 5.0).value());
  flights.push_back(contact_flight(true, 3.4));  // a corner first onto the sand, and along it
  flights.push_back(contact_mission_flight(3.4));
  flights.push_back(landing_flight(false, 2.0));
  flights.push_back(bounce_flight(5.0));
  flights.push_back(slide_flight(5.0));
  flights.push_back(roll_flight(5.0));
  for (const double asked_m : {3.5e-2, 1e-3, 1e-5}) {
    const auto choice = rov::cheapest_step(asked_m, rov::Touchable::kEven);
    ASSERT_TRUE(choice.ok()) << choice.error().message;
    for (const Flight& flight : flights)
      EXPECT_LE(
          flown_error(flight, 1.0 / choice->hz, {Integrator::kGuarded, choice->contact_error_m}).m,
          asked_m)
          << flight.name;
  }
}

// So it does on uneven ground and along a mesh, where a body hits each inner edge that it slides
// over; the least that can be asked there is larger.
TEST(PhysicsTradeoff, WhatAnErrorChoosesHoldsOnUnevenGroundAndAtTheWreck) {
  EXPECT_FALSE(rov::cheapest_step(1e-5, rov::Touchable::kUneven).ok());
  const double least_m = rov::measured_contacts().back().uneven_error_m;
  const auto choice = rov::cheapest_step(least_m, rov::Touchable::kUneven).value();
  std::vector<Flight> flights;
  flights.push_back(landing_flight(true, 2.0));
  flights.push_back(wreck_flight(test::source_dir() / "assets/scenes/mission.toml", 1.0).value());
  for (const Flight& flight : flights) {
    EXPECT_LT(flight.truth_error_m, 0.5 * least_m) << flight.name;
    EXPECT_LE(
        flown_error(flight, 1.0 / choice.hz, {Integrator::kGuarded, choice.contact_error_m}).m,
        least_m)
        << flight.name;
  }
}

// Whole missions of other vehicles, currents, speeds and ways than those of the sweep, under
// control by pulses in whole microseconds.
TEST(PhysicsTradeoff, WhatAnErrorChoosesHoldsOnMissionsThatItWasNotMeasuredOn) {
  const auto assets = test::source_dir() / "assets";
  std::vector<MissionFlight> missions;
  // An orbit on which 80 Hz, which 1e-3 picked, is 1.2e-3 m off, and 240 Hz 1.5e-3.
  missions.push_back(mission_flights(5)[5]);
  for (const std::size_t i : {1, 3, 9, 10}) missions.push_back(mission_flights(77)[i]);
  std::set<double> rates;
  for (const MissionFlight& mission : missions) {
    const bool orbit = &mission == &missions.front();
    const auto path = [&](const MissionStep& step) {
      const auto flown = flown_path(mission, assets, orbit ? 20.0 : 8.0, step);
      EXPECT_TRUE(flown.ok()) << (flown.ok() ? "" : flown.error().message);
      return flown.ok() ? *flown : std::vector<Vec3>();
    };
    const std::vector<Vec3> truth = path({.hz = 4000.0, .rk4 = true});
    ASSERT_GE(truth.size(), 80u);
    for (const double asked_m : {3e-3, 2e-3, 1e-3, rov::kTurnedPulse_m}) {
      rates.insert(rov::cheapest_step(asked_m, rov::Touchable::kNothing)->hz);
      EXPECT_LE(most_apart_m(path({.max_error_m = asked_m}), truth), asked_m) << mission.name;
    }
    if (orbit) {
      EXPECT_GT(most_apart_m(path({.hz = 80.0}), truth), 1e-3);
    }
  }
  EXPECT_EQ(rates.size(), 4u);
}

TEST(PhysicsTradeoff, AnErrorBecomesTheCheapestRateThatHoldsIt) {
  using enum rov::Touchable;
  EXPECT_EQ(rov::cheapest_step(3e-3, kNothing)->hz, 80.0);
  EXPECT_EQ(rov::cheapest_step(2e-3, kNothing)->hz, 240.0);
  EXPECT_EQ(rov::cheapest_step(1e-3, kNothing)->hz, 500.0);
  EXPECT_EQ(rov::cheapest_step(1e-5, kNothing)->hz, 1000.0);
  EXPECT_EQ(rov::cheapest_step(1.2e-7, kNothing)->hz, 1000.0);
  EXPECT_FALSE(rov::cheapest_step(5e-8, kNothing).ok());
  EXPECT_EQ(rov::cheapest_step(5e-2, kEven)->contact_error_m, 0.0);
  EXPECT_EQ(rov::cheapest_step(1e-2, kEven)->contact_error_m, 1e-4);
  EXPECT_EQ(rov::cheapest_step(1e-2, kNothing)->contact_error_m, 0.0);
  EXPECT_TRUE(rov::cheapest_step(1e-5, kEven).ok());
  EXPECT_FALSE(rov::cheapest_step(1e-12, kNothing).ok());
  EXPECT_FALSE(rov::cheapest_step(1e-6, kEven).ok());
  EXPECT_FALSE(rov::cheapest_step(std::nan(""), kEven).ok());
  const auto rates = rov::measured_rates();
  for (std::size_t i = 1; i < rates.size(); ++i) {
    EXPECT_GT(rates[i].hz, rates[i - 1].hz);
    EXPECT_LT(rates[i].error_m, rates[i - 1].error_m);
    EXPECT_GT(rates[i].us_a_second, rates[i - 1].us_a_second);
  }
  const auto contacts = rov::measured_contacts();
  for (std::size_t i = 1; i < contacts.size(); ++i) {
    EXPECT_GT(contacts[i].within_m, 0.0);
    if (i > 1) {
      EXPECT_LT(contacts[i].within_m, contacts[i - 1].within_m);
    }
    EXPECT_LT(contacts[i].error_m, contacts[i - 1].error_m);
    EXPECT_LT(contacts[i].uneven_error_m, contacts[i - 1].uneven_error_m);
    EXPECT_GT(contacts[i].uneven_error_m, contacts[i].error_m);
  }
}

}  // namespace
}  // namespace neritic::tools
