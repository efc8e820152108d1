#include "rov/thrust_priority.hpp"

#include <gtest/gtest.h>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "rov/control_cases.hpp"
#include "rov/control_check.hpp"

namespace neritic::rov {
namespace {

Vehicle heavy() {
  return make_vehicle(bluerov2_heavy(1028.0)).value();
}

// The share of its limit that the busiest thruster gives for a wrench.
double busiest(const Vehicle& vehicle, const Allocator& allocator, const Vec6& wrench) {
  const auto wanted_n = allocator.allocate(wrench).wanted_n;
  double most = 0.0;
  for (std::size_t i = 0; i < vehicle.thruster_count; ++i)
    most = std::max(most, wanted_n[i] / (wanted_n[i] > 0.0 ? vehicle.thrusters[i].max_n
                                                           : vehicle.thrusters[i].min_n));
  return most;
}

TEST(RovThrustPriority, APushThatFitsIsGivenInFullAndALargerOneToTheThrustersLimit) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  const Vec6 holding = vec6(Vec3(0.0, 0.0, -10.0), Vec3(2.0, -3.0, 1.0));
  const Vec6 small = vec6(Vec3(5.0, 2.0, 0.0), Vec3(0.0));
  EXPECT_EQ(with_room(vehicle, allocator, holding, small), small);
  const Vec6 huge = vec6(Vec3(4000.0, -1000.0, 500.0), Vec3(0.0));
  const Vec6 given = with_room(vehicle, allocator, holding, huge);
  EXPECT_NEAR(busiest(vehicle, allocator, holding + given), 1.0, 1e-9);
  EXPECT_NEAR(given[0] / given[1], -4.0, 1e-12);  // its direction is kept
  EXPECT_NEAR(given[0] / given[2], 8.0, 1e-12);
}

TEST(RovThrustPriority, NothingIsPushedWhereHoldingAloneIsTooMuch) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  const Vec6 holding = vec6(Vec3(1e5, 0.0, 0.0), Vec3(0.0));
  EXPECT_EQ(with_room(vehicle, allocator, holding, vec6(Vec3(10.0, 0.0, 0.0), Vec3(0.0))), Vec6{});
}

// The moments, with the Munk moment on top, are given in full beside any force.
TEST(RovThrustPriority, MomentsComeBeforeForces) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  State state;
  state.velocity = vec6(Vec3(1.2, 0.4, -0.3), Vec3(0.0));
  const Vec6 wrench = vec6(Vec3(900.0, 300.0, -200.0), Vec3(1.0, -2.0, 0.5));
  const Vec3 munk = glm::cross(state.velocity.linear(), (vehicle.mass * state.velocity).linear());
  ASSERT_GT(glm::length(munk), 0.5);
  const Vec6 given = level_first(vehicle, allocator, wrench, state);
  EXPECT_LT(glm::distance(given.angular(), wrench.angular() + munk), 1e-12);
  EXPECT_LT(given[0], 0.5 * wrench[0]);
  EXPECT_GT(given[0], 0.0);
  EXPECT_LE(busiest(vehicle, allocator, given), 1.0 + 1e-9);
  // One factor for all leaves a small part of the moments.
  const Vec6 cut = allocator.wrench_of(allocator.allocate(wrench).force_n);
  EXPECT_LT(std::abs(cut[4]), 0.5 * std::abs(wrench[4]));
}

// To a setpoint far away, at full thrust.
TEST(RovThrustPriority, KeepsAVehicleUprightAtFullThrust) {
  const Vehicle vehicle = heavy();
  ControlGains gains = default_gains();
  for (std::size_t i = 0; i < 3; ++i) gains.axes[i].u_max = 200.0;
  State start;
  start.position_ned_m = {0.0, 0.0, 10.0};
  Setpoint far = stay(start);
  far.position_ned_m += Vec3(40.0, 0.0, 15.0);
  const auto guide = [&](const State&, double) { return far; };
  const LoopRun cut = fly(vehicle, gains, start, guide, 20.0, {5, Integrator::kGuarded, false});
  const LoopRun level = fly(vehicle, gains, start, guide, 20.0, {5, Integrator::kGuarded, true});
  EXPECT_LT(level.largest_tilt_rad, radians(40.0));
  EXPECT_LT(level.largest_tilt_rad, cut.largest_tilt_rad);
}

TEST(RovThrustPriority, CheckControlFliesItWhereAFileAsksForIt) {
  const auto text = [](const char* priority) {
    return fmt::format(R"({{"closed_loop": {{"gains": {{"KP": [8,8,10,30,30,12],
      "KI": [0.8,0.8,1.2,2,2,0.6], "KD": [4,4,5,7,7,5], "umax": [9.5,9.5,11,40,40,40],
      "imax": [1,1,1,3,3,1], "izone": [0.15,0.15,0.15,0.3,0.3,0.3]}},
      "plant": "Fossen + thruster lag 0.1 s, force limits +51.5/-40 N", "results":
      {{"neutral/surge_2m": {{"t90": 3.08, {}"overshoot_pct": 0.4}}}}}}}})",
                       priority);
  };
  const auto plain = read_control_cases(text(""), "cases.json");
  ASSERT_TRUE(plain.ok()) << plain.error().message;
  EXPECT_FALSE(plain->loops.at(0).level_first);
  const auto level = read_control_cases(text("\"priority\": \"level\", "), "cases.json");
  ASSERT_TRUE(level.ok()) << level.error().message;
  EXPECT_TRUE(level->loops.at(0).level_first);
  EXPECT_EQ(check_control(*level).size(), 1u);
  const auto wrong = read_control_cases(text("\"priority\": \"first\", "), "cases.json");
  ASSERT_FALSE(wrong.ok());
  EXPECT_NE(wrong.error().message.find("accepted: none or level"), std::string::npos)
      << wrong.error().message;
}

}  // namespace
}  // namespace neritic::rov
