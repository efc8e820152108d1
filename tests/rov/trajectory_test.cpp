// Trajectories of an accurate integrator, reproduced with fixed steps. trajectories.json: DOP853 at
// 3e-13 over the Newton-Euler form, von Benzon et al. 2022 and Wu 2018 parameters;
// trajectories_more.json: the matrix form in absolute velocity, RK4 at 4 kHz, in another program.
#include <gtest/gtest.h>

#include <cmath>

#include "rov/trajectory_check.hpp"
#include "tests/rov/cases.hpp"

namespace neritic::rov {
namespace {

std::string said(const CaseResult& result) {
  std::string text = result.id;
  for (const CheckedError& e : result.errors)
    text += fmt::format(", {} {} of {}", e.what, e.error, e.tolerance);
  return text;
}

TEST(RovTrajectory, EveryOneHoldsAt240Hz) {
  std::size_t count = 0;
  for (const char* file : {"trajectories.json", "trajectories_more.json"})
    for (const TrajectoryCase& one : trajectories(file)) {
      const CaseResult result = check_trajectory(one);
      EXPECT_TRUE(result.ok()) << said(result);
      EXPECT_LE(result.errors[0].tolerance, kPositionBar) << one.id;
      ++count;
    }
  EXPECT_EQ(count, 23u);
}

TEST(RovTrajectory, LongerStepsHoldWhatTheFilePromises) {
  for (const Integrator integrator :
       {Integrator::kGuarded, Integrator::kRk4, Integrator::kSemiImplicit})
    for (const double hz : {60.0, 120.0, 1000.0})
      for (const TrajectoryCase& one : trajectories()) {
        const CaseResult result = check_trajectory(one, {integrator, hz});
        EXPECT_TRUE(result.ok()) << name_of(integrator) << " " << hz << " Hz: " << said(result);
      }
}

TEST(RovTrajectory, TheGuardHoldsTheBarsAtAnyStep) {
  // 50 ms is longer than the third-order lag's fastest time by a factor of five.
  for (const double hz : {4.0, 20.0})
    for (const TrajectoryCase& one : trajectories()) {
      const std::vector<CheckedError> errors =
          check_trajectory(one, {Integrator::kGuarded, hz}).errors;
      const double bar = one.id == "lossless_kirchhoff" ? 2e-5 : 1e-6;  // ten turns, no drag
      EXPECT_LE(errors[0].error, bar) << one.id << " " << hz;
      EXPECT_LE(errors[1].error, bar) << one.id << " " << hz;
    }
}

// The error in position at the end, with plain steps.
double end_error(const TrajectoryCase& one, Integrator integrator, double hz) {
  const State end = run_trajectory(one, {integrator, hz}).back();
  return glm::distance(end.position_ned_m, *one.samples.back().position_ned_m);
}

TEST(RovTrajectory, OrdersOfConvergenceAreFourAndOne) {
  // Cases without a sign change of any velocity, where |nu| nu has no kink; from a step at which
  // the reference's own error does not show.
  const auto order = [](const char* id, Integrator integrator, double hz) {
    const TrajectoryCase one = trajectory(id);
    return std::log2(end_error(one, integrator, hz) / end_error(one, integrator, 2.0 * hz));
  };
  EXPECT_NEAR(order("surge_step", Integrator::kRk4, 15.0), 4.0, 0.3);
  EXPECT_NEAR(order("heave_step_up", Integrator::kRk4, 15.0), 4.0, 0.3);
  EXPECT_NEAR(order("lossless_kirchhoff", Integrator::kRk4, 60.0), 4.0, 0.4);
  // At rates where the guard takes one substep.
  EXPECT_NEAR(order("surge_step", Integrator::kGuarded, 60.0), 4.0, 0.3);
  EXPECT_NEAR(order("heave_step_up", Integrator::kGuarded, 60.0), 4.0, 0.3);
  for (const char* id : {"surge_step", "coupled_coriolis_free", "current_drift_rest"})
    EXPECT_NEAR(order(id, Integrator::kSemiImplicit, 120.0), 1.0, 0.1) << id;
}

TEST(RovTrajectory, AWrongSampleDoesNotHold) {
  TrajectoryCase one = trajectory("mission_40s");
  one.samples[7].position_ned_m->y += 2e-6;
  const CaseResult off = check_trajectory(one);
  EXPECT_FALSE(off.ok());
  EXPECT_EQ(off.worst().what, "position");
  EXPECT_DOUBLE_EQ(off.worst().time_s, one.samples[7].t_s);
  one.reference_error = 3e-6;  // the file knows no better
  EXPECT_TRUE(check_trajectory(one).ok());
  one = trajectory("vb_poly_vb3_lag");
  one.samples[3].thruster_n[5] += 1e-3;
  EXPECT_FALSE(check_trajectory(one).ok());
  one = trajectory("thr_surge");
  *one.samples.back().attitude = -*one.samples.back().attitude;  // the same attitude
  EXPECT_TRUE(check_trajectory(one).ok());
}

// The Munk moment: what an equation without M_A nu_c' or with C_A of nu would miss.
TEST(RovTrajectory, AtRestInACurrentItYawsAndDriftsWithTheWater) {
  const TrajectoryCase one = trajectory("current_drift_rest");
  const std::vector<State> states = run_trajectory(one);
  const Vec3 end = states.back().attitude * states.back().velocity.linear();
  EXPECT_NEAR(end.x, 0.5, 0.02);
  EXPECT_NEAR(end.y, 0.2, 0.02);
  EXPECT_GT(std::abs(states.back().attitude.z), 0.05);
}

TEST(RovTrajectory, LosslessMotionKeepsEnergyAndMomentum) {
  const TrajectoryCase one = trajectory("lossless_kirchhoff");
  const std::vector<State> states = run_trajectory(one, {Integrator::kGuarded, 240.0});
  const Vec3 momentum(11.916, -8.248, 9.654);  // closed form: R (M nu)_1 is constant
  for (const State& state : states) {
    EXPECT_NEAR(kinetic_energy(one.vehicle, state, Vec3(0.0)), 7.006845, 1e-7);
    const Vec3 now = state.attitude * (one.vehicle.mass * state.velocity).linear();
    EXPECT_LT(glm::distance(now, momentum), 1e-7);
  }
}

TEST(RovTrajectory, CoastingFollowsTheClosedForm) {
  const TrajectoryCase one = trajectory("coast_surge");
  const std::vector<State> states = run_trajectory(one);
  const double a = 13.7, b = 141.0, m = 19.86;
  for (std::size_t i = 0; i < states.size(); ++i) {
    const double decay = std::exp(-a * one.samples[i].t_s / m);
    const double u = a * decay / (a + b * (1.0 - decay));
    const double x = m / b * std::log((a + b * (1.0 - decay)) / a);
    EXPECT_NEAR(states[i].velocity[0], u, 1e-8);
    EXPECT_NEAR(states[i].position_ned_m.x, x, 1e-8);
  }
}

}  // namespace
}  // namespace neritic::rov
