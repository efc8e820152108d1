// Control, allocation and guidance, against published sequences and closed-loop figures.
#include <gtest/gtest.h>

#include "rov/bluerov2.hpp"
#include "rov/closed_loop.hpp"
#include "rov/control_check.hpp"
#include "rov/guidance.hpp"
#include "tests/rov/cases.hpp"
#include "tests/rov/random_vehicle.hpp"

namespace neritic::rov {
namespace {

// The plant of the published figures.
Vehicle plant(double water_kg_m3 = 0.0) {
  VehicleParameters p = bluerov2_heavy(water_kg_m3);
  if (water_kg_m3 == 0.0) p.buoyancy_n = p.weight_n;
  p.lag = {ThrusterLag::Kind::kFirstOrder, 0.1};
  return make_vehicle(p).value();
}

State at_ten_metres() {
  State state;
  state.position_ned_m = {0.0, 0.0, 10.0};
  return state;
}

ControlCases cases() {
  auto read = read_control_cases(data_text("control.json"), "control.json");
  EXPECT_TRUE(read.ok()) << read.error().message;
  return read.ok() ? *read : ControlCases();
}

TEST(RovControl, EveryPublishedCaseHolds) {
  const auto results = check_control(cases());
  EXPECT_EQ(results.size(), 19u);
  for (const CaseResult& one : results)
    EXPECT_TRUE(one.ok()) << one.id << ": " << one.worst().what << " " << one.worst().error;
}

TEST(RovControl, AWrongCaseDoesNotHold) {
  ControlCases wrong = cases();
  wrong.pid->steps[9].output[1] += 1e-8;
  wrong.allocation->cases[6].force_n[3] += 1e-6;
  wrong.allocation->singular_values[2] += 1e-6;
  for (LoopCase& loop : wrong.loops) {
    if (loop.id == "sea/surge_2m") loop.figures["t90"] += 0.03;
    if (loop.id == "neutral/sway_1m") loop.end_state[1] += 2e-6;
    if (loop.id == "sea/square") loop.arrivals_s[2] -= 0.1;
  }
  std::vector<std::string> failed;
  for (const CaseResult& one : check_control(wrong))
    if (!one.ok()) failed.push_back(one.id);
  EXPECT_EQ(failed, (std::vector<std::string>{"pid_sequence", "allocation", "allocation/6",
                                              "neutral/sway_1m", "sea/square", "sea/surge_2m"}));
}

struct Published {
  std::size_t axis;
  double amount, t90_s, overshoot;
};

// rov: surge 2 m, sway 1 m, depth 1 m, yaw 90 degrees.
constexpr Published kPublished[] = {{0, 2.0, 3.08, 0.0043},
                                    {1, 1.0, 2.48, 0.012},
                                    {2, 1.0, 2.52, 0.0107},
                                    {5, kPi / 2.0, 1.44, 0.0168}};

StepResponse respond(const ControlGains& gains, const Published& p) {
  Setpoint s = stay(at_ten_metres());
  if (p.axis < 3)
    s.position_ned_m[static_cast<int>(p.axis)] += p.amount;
  else
    s.attitude = heading_attitude(p.amount);
  const LoopRun run = fly(
      plant(), gains, at_ten_metres(), [&](const State&, double) { return s; }, 15.0);
  std::vector<double> values;
  for (const State& state : run.states)
    values.push_back(
        p.axis < 3 ? (state.position_ned_m - Vec3(0, 0, 10))[static_cast<int>(p.axis)] / p.amount
                   : heading_of(state.attitude) / p.amount);
  return step_response(values, run.period_s);
}

TEST(RovControl, StepsReachThePublishedFigures) {
  for (const Published& p : kPublished) {
    const StepResponse r = respond(default_gains(), p);
    EXPECT_LE(r.t90_s, p.t90_s + 1e-9) << p.axis;
    EXPECT_LE(r.overshoot, p.overshoot + 5e-5) << p.axis;
    EXPECT_LE(std::abs(r.final_error), 0.0024) << p.axis;
  }
}

TEST(RovControl, RedistributedThrustBeatsThePublishedSurge) {
  // The one published step whose thrusters saturate.
  ControlGains gains = default_gains();
  gains.saturation = Saturation::kRedistribute;
  const StepResponse r = respond(gains, kPublished[0]);
  EXPECT_LT(r.t90_s, 3.04);
  EXPECT_LT(r.overshoot, 0.005);
}

TEST(RovControl, IntegralDoesNotWindUp) {
  // Against a wall of current that it cannot beat for 20 s; then it ends.
  const Vehicle vehicle = plant();
  const Allocator allocator(vehicle);
  const ControlGains gains = default_gains();
  State state = at_ten_metres();
  ControlState control;
  const Setpoint s = stay(state);
  double overshoot = 0.0;
  for (int k = 0; k < 3000; ++k) {
    Inputs inputs = control_inputs(vehicle, allocator, gains, s, state, control);
    inputs.wrench[0] = k < 1000 ? -400.0 : 0.0;
    for (int i = 0; i < 5; ++i) state = step(vehicle, state, inputs, 0.004);
    ASSERT_LE(std::abs(control.integral[0]), gains.axes[0].i_max);
    if (k > 1000) overshoot = std::max(overshoot, state.position_ned_m.x);
  }
  EXPECT_LT(overshoot, 0.05);
  EXPECT_LT(glm::distance(state.position_ned_m, s.position_ned_m), 0.01);
}

TEST(RovAllocation, InverseIsMoorePenroseForAnyPlacement) {
  for (std::uint64_t index = 0; index < 50; ++index) {
    Draws draws(index);
    const auto n = static_cast<std::size_t>(draws.uniform(1.0, 16.99));
    std::vector<Vec6> columns(n);
    for (Vec6& c : columns) c = vec6(draws.vec3(1.0), draws.vec3(0.3));
    if (n > 3) columns[2] = columns[1];  // not of full rank
    const PseudoInverse inverse = pseudo_inverse(columns);
    EXPECT_EQ(inverse.rank, static_cast<int>(std::min<std::size_t>(6, n > 3 ? n - 1 : n)));
    // B B^+ B = B, and B B^+ symmetric.
    Mat6 projector;
    for (std::size_t i = 0; i < 6; ++i)
      for (std::size_t j = 0; j < 6; ++j)
        for (std::size_t k = 0; k < n; ++k) projector(i, j) += columns[k][i] * inverse.rows[k][j];
    for (const Vec6& c : columns) {
      const Vec6 off = projector * c - c;
      EXPECT_LT(dot(off, off), 1e-22) << index;
    }
    for (std::size_t i = 0; i < 36; ++i)
      EXPECT_NEAR(projector.m[i], transpose(projector).m[i], 1e-11);
  }
}

TEST(RovAllocation, SaturationKeepsTheDirection) {
  const Allocator allocator(plant());
  for (std::uint64_t index = 0; index < 100; ++index) {
    Draws draws(index);
    const Vec6 wrench = 300.0 * vec6(draws.vec3(1.0), draws.vec3(0.3));
    double before = 0.0;
    for (const Saturation saturation : {Saturation::kScale, Saturation::kRedistribute}) {
      const Allocation a = allocator.allocate(wrench, saturation);
      const Vec6 off = allocator.wrench_of(a.force_n) - a.scale * wrench;
      EXPECT_LT(std::sqrt(dot(off, off)), 1e-9 * std::sqrt(dot(wrench, wrench)));
      for (std::size_t i = 0; i < 8; ++i) {
        EXPECT_LE(a.force_n[i], kT200Max16V);
        EXPECT_GE(a.force_n[i], kT200Min16V);
      }
      EXPECT_GE(a.scale, before);  // redistribution never gives less
      before = a.scale;
    }
  }
}

TEST(RovAllocation, AFailedThrusterIsFlownWithout) {
  const Vehicle vehicle = plant(kSeaDensity);
  for (std::size_t failed = 0; failed < 8; ++failed) {
    const std::uint64_t mask = std::uint64_t{1} << failed;
    const Allocator allocator(vehicle, mask);
    EXPECT_EQ(allocator.inverse().rank, 6);
    State state = at_ten_metres();
    Setpoint s = stay(state);
    s.position_ned_m += Vec3(1.0, 0.5, -0.5);
    ControlState control;
    for (int k = 0; k < 1500; ++k) {
      Inputs inputs = control_inputs(vehicle, allocator, default_gains(), s, state, control);
      inputs.failed_thrusters = mask;
      EXPECT_EQ(inputs.thruster_n[failed], 0.0);
      for (int i = 0; i < 5; ++i) state = step(vehicle, state, inputs, 0.004);
    }
    EXPECT_LT(glm::distance(state.position_ned_m, s.position_ned_m), 0.02) << failed;
    EXPECT_EQ(thruster_forces(vehicle, state, state.held)[failed], 0.0);
  }
}

TEST(RovAllocation, AThrusterThatFailsRunsDownWithItsLag) {
  const Vehicle vehicle = plant();
  Inputs inputs;
  inputs.thruster_n[4] = 20.0;
  State state = at_ten_metres();
  for (int i = 0; i < 1000; ++i) state = step(vehicle, state, inputs, 0.001);
  EXPECT_NEAR(thruster_forces(vehicle, state, state.held)[4], 20.0, 1e-3);
  inputs.failed_thrusters = 1u << 4;
  for (int i = 0; i < 100; ++i) state = step(vehicle, state, inputs, 0.001);
  EXPECT_NEAR(thruster_forces(vehicle, state, state.held)[4], 20.0 / std::exp(1.0), 1e-3);
}

}  // namespace
}  // namespace neritic::rov
