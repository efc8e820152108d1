// The task of max_error_m on the ground: a vehicle sinks through a current onto sand, one corner
// first, and is dragged along it, against steps of its own that are neither halved nor extrapolated
// and forty times as short.
#include <gtest/gtest.h>

#include "rov/frames.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr double kLanding_s = 1.5;

std::string landing_text(double max_error_m) {
  return fmt::format("[physics]\nmax_error_m = {}\nwater_kg_m3 = 980\n", max_error_m) +
         "[current]\nkind = \"uniform\"\nvelocity_m_s = [0.4, 0, -0.15]\n"
         "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"box\"\n"
         "size_m = [20, 1, 20]\nposition_m = [0, -20.5, 0]\n" +
         rov_text("position_m = [0, -19.83, 0]\nyaw_deg = 20\nroll_deg = 4\npitch_deg = 3\n");
}

// The vehicle's path in whole steps by RK4: where it is each 0.1 s.
std::vector<Vec3> landing_path_ned_m(const PhysicsWorld& world, double step_s) {
  const PhysicsVehicle& vehicle = world.vehicles().front();
  rov::Inputs inputs;
  inputs.current_ned_m_s = world.current_ned_m_s(vehicle.start.position_ned_m, 0.0);
  rov::State state = vehicle.start;
  sim::ContactMemory memory;
  std::vector<Vec3> path;
  const int steps = static_cast<int>(std::lround(0.1 / step_s));
  for (double t_s = 0.0; t_s < kLanding_s - 0.05; t_s += 0.1) {
    for (int i = 0; i < steps; ++i) {
      const VehicleStep step{vehicle.kind.solid,          vehicle.vehicle, state, inputs, step_s,
                             {rov::Integrator::kRk4, 0.0}};
      state = step_among(world.solid(), step, free_step(step), false, memory);
    }
    path.push_back(state.position_ned_m);
  }
  return path;
}

TEST(ContactError, TenMicrometresAreHeldWhereAVehicleLandsOnSandInACurrent) {
  TestDive dive = dive_of(landing_text(1e-5));
  ASSERT_GT(dive.world->method().contact_error_m, 0.0);
  // Whole steps err in proportion to their length, so that twice the finer less the coarser is
  // better.
  const std::vector<Vec3> fine = landing_path_ned_m(*dive.world, 2.5e-5);
  const std::vector<Vec3> coarse = landing_path_ned_m(*dive.world, 5e-5);
  double farthest_m = 0.0, apart_m = 0.0;
  for (std::size_t i = 0; i < fine.size(); ++i) {
    dive.run(0.1);
    const Vec3 at = dive.vehicle().body.position_ned_m;
    farthest_m = std::max(farthest_m, glm::distance(at, 2.0 * fine[i] - coarse[i]));
    apart_m = std::max(apart_m, glm::distance(fine[i], coarse[i]));
  }
  EXPECT_LT(apart_m, 1e-5);  // the truth is as sure as that
  EXPECT_LE(farthest_m, 1e-5);
  EXPECT_GT(dive.vehicle().contact.touched_steps, 300u);
  EXPECT_GT(fine.back().y - fine.front().y, 0.1);  // it went along the sand
}

// Whole steps, without max_error_m, err by far more there.
TEST(ContactError, WholeStepsErrByMore) {
  std::string text = landing_text(1e-5);
  text.replace(text.find("max_error_m = 1e-05"), 19, "rate_hz = 240");
  TestDive dive = dive_of(text);
  const std::vector<Vec3> fine = landing_path_ned_m(*dive.world, 1e-4);
  double farthest_m = 0.0;
  for (const Vec3& at : fine) {
    dive.run(0.1);
    farthest_m = std::max(farthest_m, glm::distance(at, dive.vehicle().body.position_ned_m));
  }
  EXPECT_GT(farthest_m, 1.5e-5);
}

}  // namespace
}  // namespace neritic::testbed
