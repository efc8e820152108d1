// Velocities from states against differences of poses.
#include "testbed/simulation/object_motion.hpp"

#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// The rate of change from a to b, dt_s apart, seen from b: linear, and as a turn.
void expect_rates(const Motion& a, const Motion& b, double dt_s) {
  const Vec3 velocity = (b.pose.position_m - a.pose.position_m) / dt_s;
  Quat turn = b.pose.rotation * glm::conjugate(a.pose.rotation);
  if (turn.w < 0.0) turn = -turn;
  const Vec3 angular = 2.0 / dt_s * Vec3(turn.x, turn.y, turn.z);
  const auto mean = [](const Vec3& p, const Vec3& q) { return 0.5 * (p + q); };
  EXPECT_LT(glm::distance(velocity, mean(a.velocity_m_s, b.velocity_m_s)), 2e-3);
  EXPECT_LT(glm::distance(angular, mean(a.angular_velocity_rad_s, b.angular_velocity_rad_s)), 2e-2);
}

TEST(ObjectMotion, VelocitiesAreTheRatesOfThePosesDrawn) {
  TestDive dive = dive_of(std::string(kStillWater) +
                          rov_text("position_m = [4, -9, 3]\nyaw_deg = 40\n"
                                   "mission = { waypoints = [ { position_m = [9, -7, -4] } ] }\n") +
                          diver_text(std::string("position_m = [0, -10, 0]\n") + kProne +
                                     "swim = { waypoints_m = [[6, -10, -6]] }\n"));
  dive.run(5.0);
  Motion rov = motion_of(dive.vehicle()), diver = motion_of(dive.state().humans()[0]);
  double fastest_m_s = 0.0;
  for (int i = 0; i < 480; ++i) {
    dive.simulation->advance(1);
    const Motion next_rov = motion_of(dive.vehicle()),
                 next_diver = motion_of(dive.state().humans()[0]);
    expect_rates(rov, next_rov, dive.world->step_s());
    expect_rates(diver, next_diver, dive.world->step_s());
    fastest_m_s =
        std::max({fastest_m_s, glm::length(rov.velocity_m_s), glm::length(diver.velocity_m_s)});
    rov = next_rov;
    diver = next_diver;
  }
  EXPECT_GT(fastest_m_s, 0.3);
  EXPECT_EQ(diver.pose.rotation, drawn_pose(dive.state().humans()[0]).rotation);
}

TEST(ObjectMotion, APointOffTheOriginIsCarriedAround) {
  Motion motion;
  motion.pose.position_m = {1.0, 2.0, 3.0};
  motion.velocity_m_s = {0.5, 0.0, 0.0};
  motion.angular_velocity_rad_s = {0.0, 2.0, 0.0};  // about up: z turns towards x
  const Motion point = motion * Motion{.pose = {.position_m = {0.0, 0.0, 1.0}}};
  EXPECT_EQ(point.pose.position_m, Vec3(1.0, 2.0, 4.0));
  EXPECT_EQ(point.velocity_m_s, Vec3(2.5, 0.0, 0.0));
}

}  // namespace
}  // namespace neritic::testbed
