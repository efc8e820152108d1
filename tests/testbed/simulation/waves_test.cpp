// Waves that a scene lets move bodies: vehicles, divers and things ride them as linear theory says,
// a hull floats on them, and without the key nothing of it happens.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/scene/motion.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

std::string sea(const std::string& keys) {
  return kStillWater +
         ("[water]\nsurface = true\n[water.waves]\nwind_m_s = 8\nfetch_km = 30\n" + keys) + "\n";
}
constexpr const char* kMoves = "moves = true";

// How far a place of a dive goes up and down: over the moving surface, and in the world.
struct Ridden {
  double over_m = 0.0, moved_m = 0.0;
};
Ridden ridden(TestDive& dive, double seconds, const std::function<Vec3()>& at) {
  const SeaWaves waves(*dive.scene.water->waves);
  double low_m = 1e9, high_m = -1e9, deepest_m = 1e9, highest_m = -1e9;
  dive.run(seconds, [&] {
    const Vec3 at_m = at();
    const double over_m = at_m.y - waves.height_m(at_m.x, at_m.z, dive.time_s());
    low_m = std::min(low_m, over_m), high_m = std::max(high_m, over_m);
    deepest_m = std::min(deepest_m, at_m.y), highest_m = std::max(highest_m, at_m.y);
  });
  return {high_m - low_m, highest_m - deepest_m};
}

// A vehicle without thrust that floats high: its origin keeps its height over the moving surface.
TEST(Waves, AVehicleThatFloatsRidesThem) {
  const std::string rov = rov_text("position_m = [0, -0.1, 0]\nnavigation = \"truth\"\n");
  TestDive moved = dive_of(sea(kMoves) + rov), still = dive_of(sea("") + rov);
  moved.run(10.0), still.run(10.0);
  const Ridden rides = ridden(moved, 25.0, [&] { return moved.pose().position_m; });
  EXPECT_GT(rides.moved_m, 0.6) << "waves of 0.3 m rms";
  EXPECT_LT(rides.over_m, 0.3 * rides.moved_m);
  EXPECT_LT(ridden(still, 5.0, [&] { return still.pose().position_m; }).moved_m, 0.05);
}

// Its head, so that it breathes air.
TEST(Waves, ADiverWithAFullJacketRidesThem) {
  const test::ScratchFolder scratch;
  const std::string buttons = (scratch / "buttons.csv").string();
  ASSERT_TRUE(write_text(buttons, "t_s,inflate\n0,1\n").ok());
  TestDive dive =
      dive_of(sea(kMoves) +
              diver_text("position_m = [0, -1.2, 0]\njacket_buttons = \"" + buttons + "\"\n"));
  const auto head_m = [&] {
    return rov::world_from_ned(dive.state().humans()[0].human.root.position_ned_m);
  };
  dive.run(30.0);
  const Ridden rides = ridden(dive, 20.0, head_m);
  EXPECT_GT(rides.moved_m, 0.6);
  EXPECT_LT(rides.over_m, 0.4 * rides.moved_m);
}

// A diver who hovers goes to and fro with the water, and neither turns into each wave nor kicks or
// trims against it, also in a rough sea.
TEST(Waves, ADiverWhoHoversRidesThemOut) {
  struct Case {
    const char* rough;
    double depth_m, off_depth_m;
  };
  for (const Case& c : {Case{"", 4.0, 0.8}, Case{"wind_m_s = 10\nfetch_km = 200\n", 6.0, 1.6}}) {
    SCOPED_TRACE(c.depth_m);
    const std::string diver =
        diver_text(fmt::format("position_m = [0, {}, 0]\n{}", -c.depth_m, kProne));
    TestDive dive = dive_of(*c.rough ? kStillWater + ("[water]\nsurface = true\n[water.waves]\n" +
                                                      std::string(c.rough) + kMoves + "\n" + diver)
                                     : sea(kMoves) + diver);
    const auto heading_rad = [&] {
      return diver::attitude_of(dive.state().humans()[0].human.root.attitude).heading_rad;
    };
    dive.run(60.0);
    double last_rad = heading_rad(), turned_rad = 0.0, most_rad = 0.0, away_m = 0.0, off_m = 0.0,
           effort = 0.0;
    dive.run(60.0, [&] {
      const HumanPhysics& state = dive.state().humans()[0];
      const Vec3& at = state.human.root.position_ned_m;
      turned_rad += std::remainder(heading_rad() - last_rad, 2.0 * kPi);
      last_rad = heading_rad();
      most_rad = std::max(most_rad, std::abs(turned_rad));
      away_m = std::max(away_m, std::hypot(at.x, at.y));
      off_m = std::max(off_m, std::abs(at.z - c.depth_m));
      effort = std::max(effort, state.swimmer.effort);
    });
    EXPECT_LT(most_rad, radians(120.0));
    EXPECT_LT(away_m, 3.0);
    EXPECT_LT(off_m, c.off_depth_m);
    EXPECT_LT(effort, 0.1);
  }
}

// A diver's dive computer reads the pressure at its place under the waves.
TEST(Waves, ADiveComputerReadsTheirPressure) {
  TestDive dive = dive_of(sea(kMoves) + diver_text("position_m = [0, -3, 0]\n"));
  const SeaWaves waves(*dive.scene.water->waves);
  double worst_m = 0.0, most_head_m = 0.0, read_m = 3.0;
  dive.run(15.0, [&] {
    const HumanPhysics& human = dive.state().humans()[0];
    // The step of a sample alone: later it is old.
    if (std::exchange(read_m, human.human.life.computer.last.depth_m) ==
        human.human.life.computer.last.depth_m)
      return;
    const Vec3 at_m = rov::world_from_ned(human.human.root.position_ned_m);
    const double head_m = waves.flow(at_m, dive.time_s()).head_m;
    most_head_m = std::max(most_head_m, std::abs(head_m));
    worst_m = std::max(worst_m, std::abs(read_m + at_m.y - head_m));
  });
  EXPECT_GT(most_head_m, 0.08);
  EXPECT_LT(worst_m, 0.01);
}

// A thing as heavy as its water goes with it, though its drag alone would leave it behind.
TEST(Waves, AThingAsHeavyAsItsWaterMovesWithTheWater) {
  TestDive dive = dive_of(
      sea(kMoves) +
      "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\nradius_m = 0.2\nposition_m = [0, -2, 0]\n"
      "thing = { mass_kg = 34.45, volume_l = 33.5 }\n");
  const SeaWaves waves(*dive.scene.water->waves);
  const auto ball = [&]() -> const Motion& { return dive.state().objects()[0].motion; };
  // From rest it keeps the difference that it began with, but for its drag.
  double worst_m_s = 0.0, fastest_m_s = 0.0;
  std::optional<Vec3> began_m_s;
  dive.run(5.0, [&] {
    const Vec3 level(1.0, 0.0, 1.0);
    const Vec3 water_m_s = level * waves.velocity_m_s(ball().pose.position_m, dive.time_s());
    const Vec3 through_m_s = level * ball().velocity_m_s - water_m_s;
    if (!began_m_s) began_m_s = through_m_s;
    fastest_m_s = std::max(fastest_m_s, glm::length(water_m_s));
    worst_m_s = std::max(worst_m_s, glm::distance(through_m_s, *began_m_s));
  });
  EXPECT_GT(fastest_m_s, 0.25);
  EXPECT_LT(worst_m_s, 0.5 * fastest_m_s);
}

// Deep in a swell a vehicle as heavy as the water goes round with it.
TEST(Waves, OneAsHeavyAsItsWaterMovesWithTheWater) {
  TestDive dive =
      dive_of(sea(kMoves) + rov_text("position_m = [0, -4, 0]\nnavigation = \"truth\"\n"));
  const SeaWaves waves(*dive.scene.water->waves);
  double worst_m_s = 0.0, fastest_m_s = 0.0;
  dive.run(20.0);
  dive.run(15.0, [&] {
    const Vec3 at_m = dive.pose().position_m;
    const Vec3 water_m_s = waves.velocity_m_s(at_m, dive.time_s());
    const Vec3 level(1.0, 0.0, 1.0);
    const auto& body = dive.vehicle().body;
    const Vec3 own_m_s = rov::world_from_ned(body.attitude * body.velocity.linear());
    fastest_m_s = std::max(fastest_m_s, glm::length(level * water_m_s));
    worst_m_s = std::max(worst_m_s, glm::length(level * (own_m_s - water_m_s)));
  });
  EXPECT_GT(fastest_m_s, 0.1);
  EXPECT_LT(worst_m_s, 0.5 * fastest_m_s);
}

TEST(Waves, WithoutTheKeyNothingMoves) {
  const std::string rov = rov_text("position_m = [0, -1, 0]\nnavigation = \"truth\"\n");
  TestDive named = dive_of(sea("") + rov), none = dive_of(std::string(kStillWater) + rov),
           moved = dive_of(sea(kMoves) + rov);
  for (TestDive* dive : {&named, &none, &moved}) dive->run(2.0);
  EXPECT_EQ(named.simulation->newest().hash, none.simulation->newest().hash);
  EXPECT_NE(named.simulation->newest().hash, moved.simulation->newest().hash);
}

TEST(Waves, DeepDownThereAreNone) {
  const std::string rov = rov_text("position_m = [0, -200, 0]\nnavigation = \"truth\"\n");
  TestDive still = dive_of(sea("") + rov), moved = dive_of(sea(kMoves) + rov);
  still.run(3.0), moved.run(3.0);
  EXPECT_LT(glm::distance(still.pose().position_m, moved.pose().position_m), 1e-6);
}

TEST(Waves, AHullFloatsOnThem) {
  TestDive dive = dive_of(sea("") + rov_text("position_m = [0, -10, 0]\nnavigation = \"truth\"\n") +
                          "[[objects]]\nname = \"hull\"\nshape = \"box\"\nsize_m = [1, 0.5, "
                          "3]\nposition_m = [4, 0, 7]\n"
                          "yaw_deg = 30\nafloat = { length_m = 3, breadth_m = 1 }\n"
                          "[[objects]]\nname = \"lamp\"\non = \"hull\"\nshape = \"box\"\nsize_m = "
                          "[0.1, 0.1, 0.1]\nposition_m = [0, 2, 0]\n");
  const scene::MotionSource motion(dive.scene);
  const SeaWaves waves(*dive.scene.water->waves);
  const auto find = [&](const char* name) {
    return static_cast<std::size_t>(
        std::ranges::find(dive.scene.objects, std::string(name), &scene::Object::name) -
        dive.scene.objects.begin());
  };
  const std::size_t hull = find("hull"), lamp = find("lamp");
  for (const double t : {0.0, 1.3, 7.9, 1e5}) {
    const scene::MotionAt at = motion.at(dive.scene.objects[hull].mount, t);
    const Vec3 fit = waves.height_and_slopes({4, 7}, {3, 1}, radians(-30.0), t);
    EXPECT_NEAR(at.motion.pose.position_m.y, fit.x, 1e-12);
    const Vec3 up = at.motion.pose.rotation * Vec3(0, 1, 0);
    EXPECT_NEAR(-up.x / up.y, fit.y, 1e-9);
    EXPECT_NEAR(-up.z / up.y, fit.z, 1e-9);
    EXPECT_NEAR(
        glm::distance(motion.world_from_object(lamp, t).position_m, at.motion.pose.position_m), 2.0,
        1e-9);
    // Velocities are those of the poses.
    const Pose soon = motion.world_from_object(hull, t + 1e-4);
    EXPECT_LT(
        glm::distance((soon.position_m - at.motion.pose.position_m) / 1e-4, at.motion.velocity_m_s),
        1e-3);
    const Vec3 up_soon = soon.rotation * Vec3(0, 1, 0);
    EXPECT_LT(
        glm::distance((up_soon - up) / 1e-4, glm::cross(at.motion.angular_velocity_rad_s, up)),
        1e-3);
  }
}

TEST(Waves, AHullWithoutWavesOrOnAnotherIsRefused) {
  const auto told = [](const std::string& text) {
    const auto scene = load_text(text);
    return scene.ok() ? std::string() : scene.error().message;
  };
  const std::string hull = "[[objects]]\nname = \"hull\"\nshape = \"box\"\nsize_m = [1, 1, 1]\n";
  EXPECT_THAT(told(hull + "afloat = { length_m = 3, breadth_m = 1 }\n"),
              testing::HasSubstr("accepted: a scene with [water.waves]"));
  EXPECT_THAT(told(sea("") + hull + "afloat = { length_m = 3 }\n"),
              testing::HasSubstr("breadth_m"));
  EXPECT_THAT(told(sea("") + hull + "afloat = { length_m = 0, breadth_m = 1 }\n"),
              testing::HasSubstr("length_m: found 0"));
  EXPECT_THAT(told(sea("") + hull + "on = \"x\"\nafloat = { length_m = 3, breadth_m = 1 }\n"),
              testing::HasSubstr("no such key beside afloat"));
}

}  // namespace
}  // namespace neritic::testbed
