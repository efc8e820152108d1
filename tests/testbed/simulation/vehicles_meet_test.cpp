// Vehicles that meet: neither gets into the other, and both fly on.
#include "engine/sim/convex_query.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

double depth_between(const TestDive& dive) {
  double deepest_m = 0.0;
  const auto& vehicles = dive.world->vehicles();
  const Pose a_from_b = inverse(dive.pose(0)) * dive.pose(1);
  for (const sim::ConvexPart& pa : vehicles[0].kind.solid.shape.parts())
    for (const sim::ConvexPart& pb : vehicles[1].kind.solid.shape.parts()) {
      std::vector<Vec3> points_b;
      for (const Vec3& p : pb.core_m) points_b.push_back(a_from_b * p);
      const auto found = sim::convex_distance(pa.core_m, points_b);
      if (found) deepest_m = std::max(deepest_m, pa.radius_m + pb.radius_m - found->distance_m);
    }
  return deepest_m;
}

std::string two_vehicles() {
  return "[physics]\n" + rov_text("position_m = [-1.5, -6, 0]\nyaw_deg = -90\n", "one") +
         rov_text("position_m = [1.5, -6.05, 0.1]\nyaw_deg = 90\n", "other");
}

TEST(VehiclesMeet, AtFullThrustAgainstEachOtherNeitherGetsIn) {
  TestDive dive = dive_of(two_vehicles());
  Piloting ahead;
  ahead.piloted = 1;
  ahead.pilot[0] = 400.0;
  pilot(dive, 0, ahead);
  pilot(dive, 1, ahead);
  dive.run(20.0, [&] { ASSERT_LT(depth_between(dive), 0.01) << dive.time_s(); });
  EXPECT_GT(dive.vehicle(0).contact.touched_steps, 100u);
  EXPECT_EQ(dive.vehicle(0).contact.touched_steps, dive.vehicle(1).contact.touched_steps);
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
}

TEST(VehiclesMeet, OneIsPushedAlongAndAllRunsAgree) {
  const auto fly = [] {
    TestDive dive = dive_of(two_vehicles());
    Piloting ahead;
    ahead.piloted = 1;
    ahead.pilot[0] = 40.0;
    pilot(dive, 0, ahead);
    dive.run(15.0);
    EXPECT_LT(depth_between(dive), 0.01);
    EXPECT_GT(dive.pose(1).position_m.x, 1.8);  // it lies adrift, and is pushed
    return dive.simulation->log().hashes;
  };
  EXPECT_EQ(fly(), fly());
}

}  // namespace
}  // namespace neritic::testbed
