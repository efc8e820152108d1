// The propellers of a drawn vehicle against the thrust of its thrusters: T = C_T rho D^4 n |n|,
// summed up by the test, and the hands of the blades that tools/assets/rov.py builds.
#include "engine/sim/state_hash.hpp"
#include "testbed/motion/motion_history.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string drawn_rov(const std::string& keys) {
  return "[[vehicles]]\nname = \"rov\"\nmodel = \"" +
         (test::source_dir() / "assets/models/rov.glb").string() + "\"\ndynamics = \"" +
         vehicles_folder() + "/bluerov2_heavy_dynamics.toml\"\nposition_m = [0, -10, 0]\n" + keys;
}

class Propellers : public ::testing::Test {
 protected:
  void start(const std::string& keys) {
    dive_ = dive_of(kStillWater + drawn_rov(keys));
    history_.emplace(moved_objects(*dive_.world));
    history_->add(motion_of(*dive_.world, dive_.simulation->newest()));
  }
  const PhysicsVehicle& vehicle() const { return dive_.world->vehicles()[0]; }
  // Revolutions a second of a T200 that gives this thrust.
  double speed_hz(std::size_t thruster) const {
    const rov::State& body = dive_.vehicle().body;
    const double force_n = rov::thruster_forces(vehicle().vehicle, body, body.held)[thruster];
    const double squared = force_n / (0.44 * vehicle().water.water_kg_m3 * std::pow(0.076, 4));
    return squared < 0.0 ? -std::sqrt(-squared) : std::sqrt(squared);
  }
  void step() {
    dive_.simulation->advance(1);
    history_->add(motion_of(*dive_.world, dive_.simulation->newest()));
    for (std::size_t i = 0; i < 8; ++i) turned_[i] += speed_hz(i) * dive_.world->step_s();
  }
  // Of propeller i, in its thruster, in revolutions.
  double drawn(std::size_t i, double time_s) const {
    const scene::Object& object = dive_.scene.objects[vehicle().object];
    const scene::Model& model = *dive_.scene.models[static_cast<std::size_t>(object.model)];
    const scene::ModelPose pose =
        scene::MotionSource(dive_.scene, &*history_).model_pose(vehicle().object, model, time_s);
    const auto node = [&](const char* kind) {
      const auto name = fmt::format("{}_{}", kind, i);
      const auto at = std::ranges::find(model.nodes, name, &scene::Node::name);
      return pose.model_from_node[static_cast<std::size_t>(at - model.nodes.begin())];
    };
    const Mat4 turn = glm::inverse(node("thruster")) * node("propeller");
    return std::atan2(turn[0].y, turn[0].x) / (2.0 * kPi);
  }
  static double sense(std::size_t i) { return i % 2 == 0 ? 1.0 : -1.0; }
  void expect_drawn(std::size_t i, double revolutions, double time_s) const {
    EXPECT_NEAR(std::remainder(drawn(i, time_s) - sense(i) * revolutions, 1.0), 0.0, 1e-9)
        << i << " at " << time_s;
  }

  TestDive dive_;
  std::optional<MotionHistory> history_;
  std::array<double, 8> turned_{};
};

constexpr const char* kAhead =
    "mission = { waypoints = [ { position_m = [0, -10, -8] } ] }\nfailed_thrusters = [2]\n";

TEST_F(Propellers, TurnAsTheirThrustersPush) {
  start(kAhead);
  double fastest_hz = 0.0, slowest_hz = 0.0;
  for (int k = 0; k < 480; ++k) {
    const double before_s = dive_.time_s();
    const auto before = turned_;
    step();
    const double half_s = 0.5 * (before_s + dive_.time_s()), later_s = dive_.time_s() + 0.01;
    for (const std::size_t i : {0u, 1u, 2u, 3u, 4u, 7u}) {
      expect_drawn(i, turned_[i], dive_.time_s());
      expect_drawn(i, 0.5 * (before[i] + turned_[i]), half_s);
      expect_drawn(i, turned_[i] + 0.01 * speed_hz(i), later_s);
      fastest_hz = std::max(fastest_hz, speed_hz(i));
      slowest_hz = std::min(slowest_hz, speed_hz(i));
    }
  }
  EXPECT_GT(fastest_hz, 20.0);
  EXPECT_LT(slowest_hz, -5.0);
  EXPECT_EQ(drawn(1, dive_.time_s()), 0.0);  // it failed
}

TEST_F(Propellers, ChangeNoHashAndGoOnFromASavedState) {
  start(kAhead);
  for (int k = 0; k < 100; ++k) step();
  PhysicsState other = dive_.state();
  ASSERT_EQ(other.propellers().size(), 1u);
  EXPECT_GT(std::ranges::max(other.propellers()[0].revolutions), 1.0);
  const StateFormat format = dive_.world->state_format();
  const auto bytes = encode_state(format, saved_state(*dive_.simulation, format));
  const auto saved = parse_state(format, bytes, "state");
  ASSERT_TRUE(saved.ok());
  EXPECT_EQ(saved->state.propellers()[0].revolutions, other.propellers()[0].revolutions);
  other.propellers()[0].revolutions[0] += 0.25;
  EXPECT_EQ(sim::state_hash(other), sim::state_hash(dive_.state()));
}

TEST_F(Propellers, OfABoxAreNoState) {
  const TestDive dive = dive_of(kStillWater + rov_text("position_m = [0, -10, 0]\n"));
  EXPECT_TRUE(dive.state().propellers().empty());
}

}  // namespace
}  // namespace neritic::testbed
