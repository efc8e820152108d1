// Extremes of whole dives among things: messages and inputs that are no numbers,
// ten kilonewton, steps of a second, a thousandth of the mass. Nothing that leaves is not finite,
// energy stays bounded, nobody gets into what is solid, and afterwards it flies as before.
#include <limits>

#include "rov/step.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();

// Sand at 12 m and a block as high as wide; a vehicle over the sand beside the block.
std::string scene_text(const std::string& dynamics = "bluerov2_heavy_dynamics.toml",
                       const std::string& keys = "") {
  return std::string(R"([physics]
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [200, 200]
position_m = [0, -12, 0]
[[objects]]
name = "block"
class = "structure"
shape = "box"
size_m = [4, 4, 4]
position_m = [0, -10, -4]
)") + rov_text("position_m = [0, -10, 2]\n" + keys, "rov", dynamics);
}

// How far the vehicle's origin is inside the block, or under the sand; its own half height keeps it
// 0.1 m off either.
double depth_inside(const Pose& pose) {
  const Vec3 off = glm::abs(pose.position_m - Vec3(0.0, -10.0, -4.0)) - Vec3(2.0);
  return std::max(-std::max({off.x, off.y, off.z}), -12.0 - pose.position_m.y);
}

TEST(PhysicsExtremes, EveryNumberOfAMessageIsRefusedWhereItIsNone) {
  TestDive dive = dive_of(
      scene_text("bluerov2_heavy_dynamics.toml",
                 "mission = { speed_m_s = 0.6, waypoints = [ { position_m = [1, -10, 2] } ] }"));
  dive.run(10.0);
  std::uint64_t refused = 0;
  for (std::size_t i = 0; i < 6; ++i)
    for (const double value : {kNan, kInf, -kInf}) {
      Piloting inputs;
      inputs.piloted = 1;
      inputs.pilot[i] = value;
      EXPECT_FALSE(pilot(dive, 0, inputs));
      ++refused;
    }
  TestDive other = dive_of(dive.scene);
  other.run(10.0);
  dive.run(5.0);
  other.run(5.0);
  EXPECT_EQ(dive.simulation->inbox().counts(1).refused(), refused);
  EXPECT_EQ(dive.simulation->newest().hash, other.simulation->newest().hash);  // the last good held
}

// Finite, but no wrench of this world; and inputs handed to the pure step past the inbox.
TEST(PhysicsExtremes, WrenchesOfAnySizeAndInputsThatAreNoNumbersLeaveFiniteStates) {
  for (const double value : {1e4, 1e9, 1e30, 1e300, -1e308, kNan, kInf})
    for (std::size_t axis = 0; axis < 6; ++axis) {
      const TestDive dive = dive_of(scene_text());
      PhysicsState state = dive.world->start();
      PhysicsInputs inputs = dive.world->start_inputs();
      inputs.vehicles()[0] = held({.piloted = 1});
      inputs.vehicles()[0].wrench.wrench[axis] = value;
      std::uint64_t i = 0;
      for (; i < 480; ++i) {
        state = dive.world->step(state, inputs, {i, dive.world->step_s()});
        ASSERT_TRUE(sim::all_finite(state)) << value << " " << axis << " " << i;
      }
      const rov::State& body = state.vehicles()[0].body;
      EXPECT_LT(glm::length(body.velocity.linear()), 5.0) << value << " " << axis;
      if (!std::isfinite(value)) {
        EXPECT_GT(body.refused_inputs, 0u) << value << " " << axis;
      }
      // And it comes to rest when the pilot lets go.
      inputs.vehicles()[0].wrench = {};
      for (; i < 480 + 10 * 240; ++i)
        state = dive.world->step(state, inputs, {i, dive.world->step_s()});
      EXPECT_LT(glm::length(state.vehicles()[0].body.velocity.linear()), 0.3)
          << value << " " << axis;
    }
}

// A BlueROV2 Heavy whose thrusters push ten kilonewton together, of its mass or of a thousandth.
std::string strong_vehicle(const test::ScratchFolder& folder, double mass_share) {
  std::string text = fmt::format(
      "mass_kg = {}\nbuoyancy_n = {}\nweight_n = {}\ninertia_kg_m2 = [{}, {}, {}]\n"
      "added_mass = [{}, {}, {}, {}, {}, {}]\nlinear_damping = [13.7, 0, 33, 0, 0.8, 0]\n"
      "quadratic_damping = [141, 217, 190, 1.19, 0.47, 1.5]\n",
      13.5 * mass_share, 132.57 * mass_share, 132.57 * mass_share, 0.26 * mass_share,
      0.23 * mass_share, 0.37 * mass_share, 6.36 * mass_share, 7.12 * mass_share,
      18.68 * mass_share, 0.189 * mass_share, 0.135 * mass_share, 0.222 * mass_share);
  for (const char* place : {"0, 0.1, 0", "0, -0.1, 0"})
    text += fmt::format(
        "[[thrusters]]\nposition_m = [{}]\ndirection = [1, 0, 0]\nmin_n = -5000\nmax_n = 5000\n",
        place);
  EXPECT_TRUE(write_text(folder / "strong.toml", text).ok());
  return (folder / "strong.toml").string();
}

TEST(PhysicsExtremes, TenKilonewtonIntoABlockNeverGetInsideAtAnyMassAndStep) {
  for (const double mass_share : {1.0, 1e-3})
    for (const double dt_s : {1.0 / 240.0, 0.05, 0.3, 1.0}) {
      const test::ScratchFolder folder;
      std::string text = scene_text();
      const std::string shipped = vehicles_folder() + "/bluerov2_heavy_dynamics.toml";
      text.replace(text.find(shipped), shipped.size(), strong_vehicle(folder, mass_share));
      const TestDive dive = dive_of(text);
      PhysicsState state = dive.world->start();
      PhysicsInputs inputs = dive.world->start_inputs();
      inputs.vehicles()[0] = held({.piloted = 1});
      inputs.vehicles()[0].wrench.wrench[0] = 1e4;  // north: into the block
      double fastest_m_s = 0.0;
      std::uint64_t step = 0;
      for (double t_s = 0.0; t_s < 20.0; t_s += dt_s) {
        state = dive.world->step(state, inputs, {step++, dt_s});
        ASSERT_TRUE(sim::all_finite(state)) << mass_share << " " << dt_s << " " << t_s;
        const rov::State& body = state.vehicles()[0].body;
        const Pose pose = rov::world_pose(body.position_ned_m, body.attitude);
        ASSERT_LT(depth_inside(pose), 0.0) << mass_share << " " << dt_s << " " << t_s;
        fastest_m_s = std::max(fastest_m_s, glm::length(body.velocity.linear()));
      }
      // Terminal: 141 v^2 = 1e4 N. A thousandth of the mass is there within the first long step.
      if (dt_s < 0.1) {
        EXPECT_GT(fastest_m_s, 1.0) << mass_share << " " << dt_s;
      }
      EXPECT_LT(fastest_m_s, 12.0) << mass_share << " " << dt_s;
      EXPECT_GT(state.vehicles()[0].contact.touched_steps, 0u) << mass_share << " " << dt_s;
    }
}

// Put upside down, into the block, at the surface or far from everything, it comes back
// to its place.
TEST(PhysicsExtremes, TeleportedAnywhereItFliesOn) {
  const TestDive dive = dive_of(
      scene_text("bluerov2_heavy_dynamics.toml",
                 "mission = { speed_m_s = 0.6, waypoints = [ { position_m = [1, -10, 2] } ] }"));
  const struct {
    Vec3 world_m;
    double roll_rad;
  } places[] = {
      {{3, -11, 3}, kPi}, {{1, -10, -3.5}, 0.4}, {{15, -11, 12}, 2.0}, {{-4, -0.1, 2}, -1.0}};
  for (const auto& place : places) {
    PhysicsState state = dive.world->start();
    const Quat attitude = glm::angleAxis(place.roll_rad, Vec3(1, 0, 0));
    ASSERT_TRUE(
        rov::teleport(state.vehicles()[0].body, rov::ned_from_world(place.world_m), attitude));
    for (std::uint64_t i = 0; i < 60 * 240; ++i) {
      state = dive.world->step(state, dive.world->start_inputs(), {i, dive.world->step_s()});
      ASSERT_TRUE(sim::all_finite(state)) << place.world_m.x << " " << i;
      ASSERT_LT(glm::length(state.vehicles()[0].body.velocity.linear()), 3.0);
    }
    const Vec3 end_m = rov::world_from_ned(state.vehicles()[0].body.position_ned_m);
    EXPECT_LT(glm::distance(end_m, Vec3(1, -10, 2)), 0.05) << place.world_m.x;
  }
}

}  // namespace
}  // namespace neritic::testbed
