// Vehicles that fly on what they measure: control and missions by the estimate, which errs as the
// seed has it; and the choice of the truth.
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kSensing = "bluerov2_heavy_survey_dynamics.toml";

// Sand at 14 m, and a vehicle that flies a square of 5 m in a current.
std::string square_text(int seed, const std::string& keys = {}) {
  return "title = \"square\"\nseed = " + std::to_string(seed) + R"(
[physics]
[current]
kind = "uniform"
velocity_m_s = [0.1, 0, 0.05]
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [80, 80]
position_m = [0, -14, 0]
)" +
         rov_text("position_m = [0, -10, 0]\n" + keys + R"(
[vehicles.mission]
speed_m_s = 0.5
acceptance_m = 0.3
waypoints = [
  { position_m = [5, -10, 0] },
  { position_m = [5, -11, -5] },
  { position_m = [0, -11, -5] },
  { position_m = [0, -10, 0] },
]
)",
                  "rov", kSensing);
}

const Vec3 kCorners[] = {{5, -10, 0}, {5, -11, -5}, {0, -11, -5}, {0, -10, 0}};

struct Square {
  std::uint64_t arrived = 0;
  double largest_error_m = 0.0;    // of the navigation
  double farthest_corner_m = 0.0;  // the least distance to each corner, the largest of them
  Vec3 end_m{0.0};
};

Square fly_square(const std::string& text) {
  TestDive dive = dive_of(text);
  Square out;
  double nearest_m[] = {1e9, 1e9, 1e9, 1e9};
  dive.run(70.0, [&] {
    const Vec3 at = dive.pose().position_m;
    for (std::size_t i = 0; i < 4; ++i)
      nearest_m[i] = std::min(nearest_m[i], glm::distance(at, kCorners[i]));
    if (const auto estimate = dive.world->estimate(dive.state(), 0))
      out.largest_error_m =
          std::max(out.largest_error_m,
                   glm::distance(estimate->position_ned_m, dive.vehicle().body.position_ned_m));
  });
  out.arrived = dive.vehicle().mission.arrived;
  out.farthest_corner_m = *std::ranges::max_element(nearest_m);
  out.end_m = dive.pose().position_m;
  return out;
}

TEST(Navigation, AMissionSucceedsByWhatIsMeasuredAlone) {
  for (int seed = 1; seed <= (test::is_thorough() ? 8 : 3); ++seed) {
    const Square square = fly_square(square_text(seed));
    EXPECT_EQ(square.arrived, 4u) << seed;
    EXPECT_LT(square.largest_error_m, 0.6) << seed;
    EXPECT_GT(square.largest_error_m, 0.02) << seed;
    // Accepted within 0.3 m by an estimate that errs.
    EXPECT_LT(square.farthest_corner_m, 0.3 + square.largest_error_m) << seed;
  }
}

TEST(Navigation, SeedsChangeTheTrueWayIfAndOnlyIfItIsMeasured) {
  const Square a = fly_square(square_text(1)), b = fly_square(square_text(2));
  EXPECT_GT(glm::distance(a.end_m, b.end_m), 0.01);
  const std::string truth = "navigation = \"truth\"\n";
  const Square c = fly_square(square_text(1, truth)), d = fly_square(square_text(2, truth));
  EXPECT_EQ(c.end_m, d.end_m);
  EXPECT_EQ(c.arrived, 4u);
  EXPECT_EQ(c.largest_error_m, 0.0);
}

TEST(Navigation, AVehicleThatFliesOnTheTruthHasNoEstimate) {
  const TestDive measured = dive_of(square_text(1)),
                 truth = dive_of(square_text(1, "navigation = \"truth\"\n"));
  EXPECT_TRUE(measured.world->estimate(measured.state(), 0).has_value());
  EXPECT_FALSE(truth.world->estimate(truth.state(), 0).has_value());
  EXPECT_EQ(truth.state().bytes().size() + sizeof(rov::NavigationState),
            measured.state().bytes().size());
  EXPECT_NE(measured.world->state_format().scene_hash, truth.world->state_format().scene_hash);
}

TEST(Navigation, MissingSensorsAreNamed) {
  const auto scene = load_text(std::string(kStillWater) +
                               rov_text("position_m = [0, -10, 0]\nnavigation = \"measured\"\n"));
  ASSERT_TRUE(scene.ok());
  const auto world = PhysicsWorld::create(*scene);
  ASSERT_FALSE(world.ok());
  EXPECT_EQ(world.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(world.error().message,
              ::testing::HasSubstr("rov: navigation: found \"measured\"; accepted: \"truth\", or "
                                   "[imu], [pressure], [compass], [dvl] or [usbl] added to "));
  EXPECT_THAT(world.error().message, ::testing::HasSubstr("bluerov2_heavy_dynamics.toml"));
}

// The controller acts on the estimate: of a state whose navigation is 2 m off, it pushes towards
// where it takes the waypoint to be.
TEST(Navigation, ControlGoesByTheEstimate) {
  TestDive dive = dive_of(
      std::string(kStillWater) +
      rov_text("position_m = [0, -10, 0]\nmission = { hold = \"station\" }\n", "rov", kSensing));
  dive.run(5.0);
  PhysicsState off = dive.state();
  off.navigation()[0].position_ned_m += Vec3(2.0, 0.0, 0.0);
  const auto& inputs = dive.world->start_inputs();
  const sim::StepTime time{240 * 5, dive.world->step_s()};
  const PhysicsState plain = dive.world->step(dive.state(), inputs, time),
                     pushed = dive.world->step(off, inputs, time);
  const auto surge = [&](const PhysicsState& state) {
    return rov::thruster_wrench(dive.world->vehicles()[0].vehicle,
                                state.vehicles()[0].command_n)[0];
  };
  EXPECT_LT(surge(pushed), surge(plain) - 20.0);
}

}  // namespace
}  // namespace neritic::testbed
