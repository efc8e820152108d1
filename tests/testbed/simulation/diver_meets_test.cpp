// A diver and a vehicle, or another diver, that meet: neither gets into the other, what one gives
// the other takes, and both go on.
#include "engine/sim/convex_query.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

std::string hovering(const std::string& name, const std::string& position) {
  const std::string assets = (test::source_dir() / "assets").string();
  return "[[objects]]\nname = \"" + name + "\"\nclass = \"diver\"\nmodel = \"" + assets +
         "/models/diver.glb\"\nhuman = \"" + assets +
         "/divers/recreational.toml\"\npitch_deg = -90\nposition_m = " + position + "\n";
}

Pose human_pose(const PhysicsState& state, std::size_t i) {
  const diver::RootState& root = state.humans()[i].human.root;
  return world_pose(root.position_ned_m, root.attitude);
}

double depth_of(const sim::BodyShape& a, const Pose& world_from_a, const sim::BodyShape& b,
                const Pose& world_from_b) {
  double deepest_m = 0.0;
  const Pose a_from_b = inverse(world_from_a) * world_from_b;
  for (const sim::ConvexPart& pa : a.parts())
    for (const sim::ConvexPart& pb : b.parts()) {
      std::vector<Vec3> points_b;
      for (const Vec3& p : pb.core_m) points_b.push_back(a_from_b * p);
      const auto found = sim::convex_distance(pa.core_m, points_b);
      deepest_m = std::max(deepest_m, found ? pa.radius_m + pb.radius_m - found->distance_m : 1.0);
    }
  return deepest_m;
}

// From the side, at the chest.
TestDive meeting() {
  return dive_of("title = \"they meet\"\n[physics]\n" + hovering("diver", "[0, -12, 0]") +
                 rov_text("position_m = [-1.6, -12, -0.3]\nyaw_deg = -90\n"));
}

Piloting ahead_by(double newton) {
  Piloting ahead;
  ahead.piloted = 1;
  ahead.pilot[0] = newton;
  return ahead;
}

double rov_in_diver_m(const TestDive& dive) {
  return depth_of(dive.world->vehicles()[0].kind.solid.shape, dive.pose(),
                  dive.world->humans()[0].shape, human_pose(dive.state(), 0));
}

TEST(DiverMeets, AVehicleAtFullThrustDoesNotGetIntoADiverAndPushes) {
  TestDive dive = meeting();
  pilot(dive, 0, ahead_by(400.0));
  dive.run(12.0, [&] { ASSERT_LT(rov_in_diver_m(dive), 0.02) << dive.time_s(); });
  const HumanPhysics& human = dive.state().humans()[0];
  EXPECT_GT(human.contact.touched_steps, 50u);
  EXPECT_EQ(human.contact.touched_steps, dive.vehicle().contact.touched_steps);
  EXPECT_GT(human_pose(dive.state(), 0).position_m.x, 0.5);
  EXPECT_EQ(dive.simulation->refused_states(), 0u);
}

TEST(DiverMeets, RunsAgree) {
  const auto hashes = [] {
    TestDive dive = meeting();
    pilot(dive, 0, ahead_by(60.0));
    dive.run(6.0);
    EXPECT_GT(dive.state().humans()[0].contact.touched_steps, 0u);
    return dive.simulation->log().hashes;
  };
  EXPECT_EQ(hashes(), hashes());
}

// Impulse and its moment about a point, of a change of velocity: world north, east, down.
struct Blow {
  Vec3 impulse_n_s{0.0}, moment_n_m_s{0.0};
};
// attitude: that of the step's end as if alone, in whose axes the velocities are.
Blow blow_of(const Mat6& mass, const Quat& attitude, const Vec3& at_ned_m, const Vec6& change) {
  const Vec6 p = mass * change;
  const Vec3 impulse = attitude * p.linear();
  return {impulse, attitude * p.angular() + glm::cross(at_ned_m, impulse)};
}

// In each step in which they touch, against the same step of each with the other far away.
TEST(DiverMeets, WhatTheVehicleLosesTheDiverTakes) {
  TestDive dive = meeting();
  PhysicsInputs inputs = dive.world->start_inputs();
  inputs.vehicles()[0] = held(ahead_by(60.0));
  PhysicsState state = dive.world->start();
  const double dt_s = 1.0 / 240.0;
  int hits = 0;
  for (std::uint64_t i = 0; i < 240 * 6; ++i) {
    const sim::StepTime time{i, dt_s};
    const PhysicsState next = dive.world->step(state, inputs, time);
    if (next.humans()[0].contact.touched_steps > state.humans()[0].contact.touched_steps) {
      PhysicsState no_diver = state, no_vehicle = state;
      no_diver.humans()[0].human.root.position_ned_m.x += 500.0;
      no_vehicle.vehicles()[0].body.position_ned_m.x += 500.0;
      const PhysicsState vehicle_alone = dive.world->step(no_diver, inputs, time);
      const PhysicsState diver_alone = dive.world->step(no_vehicle, inputs, time);
      const PhysicsHuman& human = dive.world->humans()[0];
      const rov::State& body = vehicle_alone.vehicles()[0].body;
      const diver::HumanState& alone = diver_alone.humans()[0].human;
      const Vec3 apart_m =
          state.vehicles()[0].body.position_ned_m - state.humans()[0].human.root.position_ned_m;
      const Blow rov = blow_of(dive.world->vehicles()[0].vehicle.mass, body.attitude, apart_m,
                               next.vehicles()[0].body.velocity - body.velocity);
      const Mat6 mass = diver::matrix_of(
          diver::momentum_of(human.body, diver::posture_of(human.body, alone.limbs.rotation, {}),
                             diver::gas_load(human.body, alone))
              .mass);
      const Blow diver = blow_of(mass, alone.root.attitude, Vec3(0.0),
                                 next.humans()[0].human.root.velocity - alone.root.velocity);
      const double size = glm::length(rov.impulse_n_s);
      if (size > 1e-3) {
        ++hits;
        EXPECT_LT(glm::length(rov.impulse_n_s + diver.impulse_n_s), 1e-9 * size) << i;
        EXPECT_LT(glm::length(rov.moment_n_m_s + diver.moment_n_m_s), 1e-6 * size) << i;
        EXPECT_LT(rov.impulse_n_s.y, 0.0);  // east is ahead
      }
    }
    state = next;
  }
  EXPECT_GT(hits, 3);
}

TEST(DiverMeets, ADiverWhoSwimsAtAnotherDoesNotGetIn) {
  TestDive dive = dive_of("title = \"they meet\"\n[physics]\n" + hovering("one", "[0, -12, 0]") +
                          "swim = { waypoints_m = [[0, -12, -8]], speed_m_s = 0.5 }\n" +
                          hovering("other", "[0.1, -12, -3]"));
  const auto& humans = dive.world->humans();
  dive.run(15.0, [&] {
    ASSERT_LT(depth_of(humans[0].shape, human_pose(dive.state(), 0), humans[1].shape,
                       human_pose(dive.state(), 1)),
              0.02)
        << dive.time_s();
  });
  EXPECT_GT(dive.state().humans()[0].contact.touched_steps, 20u);
  EXPECT_EQ(dive.state().humans()[0].contact.touched_steps,
            dive.state().humans()[1].contact.touched_steps);
}

}  // namespace
}  // namespace neritic::testbed
