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

using Forces = std::array<double, kMaxThrusters>;

TEST(RovThrustPriority, APushThatFitsIsGivenInFullAndALargerOneToTheThrustersLimit) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  const Vec6 holding = vec6(Vec3(0.0, 0.0, -10.0), Vec3(2.0, -3.0, 1.0));
  const Forces held_n = allocator.allocate(holding).force_n;
  const auto given = [&](const Vec6& push) {
    return allocator.wrench_of(allocator.allocate(push, Saturation::kScale, held_n).force_n) -
           holding;
  };
  const Vec6 small = vec6(Vec3(5.0, 2.0, 0.0), Vec3(0.0));
  EXPECT_LT(glm::distance(given(small).linear(), small.linear()), 1e-12);
  const Vec6 huge = given(vec6(Vec3(4000.0, -1000.0, 500.0), Vec3(0.0)));
  EXPECT_NEAR(busiest(vehicle, allocator, holding + huge), 1.0, 1e-9);
  EXPECT_NEAR(huge[0] / huge[1], -4.0, 1e-12);  // its direction is kept
  EXPECT_NEAR(huge[0] / huge[2], 8.0, 1e-12);
  EXPECT_LT(glm::length(huge.angular()), 1e-12);
}

TEST(RovThrustPriority, NothingIsPushedWhereHoldingAloneIsTooMuch) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  const Forces held_n = allocator.allocate(vec6(Vec3(1e5, 0.0, 0.0), Vec3(0.0))).force_n;
  const Allocation pushed =
      allocator.allocate(vec6(Vec3(10.0, 0.0, 0.0), Vec3(0.0)), Saturation::kScale, held_n);
  EXPECT_EQ(pushed.scale, 0.0);
  EXPECT_EQ(pushed.force_n, held_n);
}

// The moments, with the Munk moment on top, are given in full beside any force; so are the forces
// across the path beside any push along it.
TEST(RovThrustPriority, MomentsComeBeforeForcesAndForcesAcrossThePathBeforeThoseAlong) {
  const Vehicle vehicle = heavy();
  const Allocator allocator(vehicle);
  const ControlGains gains = default_gains();
  State state;
  state.velocity = vec6(Vec3(1.2, 0.4, -0.3), Vec3(0.0));
  Setpoint setpoint;
  setpoint.position_ned_m = {0.0, 0.3, 0.2};
  setpoint.velocity_ned_m_s = {30.0, 0.0, 0.0};
  setpoint.attitude = heading_attitude(0.05);
  ControlState control;
  const Vec6 wrench = control_wrench(vehicle, gains, setpoint, state, control, Clip::kDirection);
  control = {};
  const WrenchParts parts = parted_wrench(vehicle, gains, setpoint, state, control);
  const Vec3 munk = glm::cross(state.velocity.linear(), (vehicle.mass * state.velocity).linear());
  ASSERT_GT(glm::length(munk), 0.5);
  const Vec6 sum = parts.level + parts.hold + parts.push;
  EXPECT_LT(glm::distance(sum.linear(), wrench.linear()), 1e-9);
  EXPECT_LT(glm::distance(sum.angular(), wrench.angular() + munk), 1e-12);
  EXPECT_EQ(parts.hold[0], 0.0);
  EXPECT_EQ(parts.push[1], 0.0);
  EXPECT_EQ(parts.push[2], 0.0);
  for (const Saturation saturation : {Saturation::kScale, Saturation::kRedistribute}) {
    ControlGains as = gains;
    as.saturation = saturation;
    control = {};
    const Vec6 given = allocator.wrench_of(
        level_inputs(vehicle, allocator, as, setpoint, state, control).thruster_n);
    EXPECT_LT(glm::distance(given.angular(), sum.angular()), 1e-9);
    EXPECT_NEAR(given[1], wrench[1], 1e-9);
    EXPECT_NEAR(given[2], wrench[2], 1e-9);
    EXPECT_LT(given[0], 0.5 * wrench[0]);
    EXPECT_GT(given[0], 0.0);
  }
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
