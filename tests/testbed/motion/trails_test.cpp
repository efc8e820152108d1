// Sources of bubbles and silt: it is known where they were for as long as what they left is seen.
#include <gtest/gtest.h>

#include "testbed/motion/live_physics.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// A current carries the vehicle off at up to 0.5 m/s; a clip's joint leaks, too.
scene::Scene leaking_scene() {
  return load_text(
             "[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [0.5, 0, 0]\n"
             "[water]\ntype = \"IB\"\n"
             "[[water.bubbles]]\non = \"rov\"\nposition_m = [0, 0.1, 0]\n"
             "[[water.silt]]\non = \"ship\"\nbed_depth_m = 30\n"
             "[[objects]]\nname = \"ship\"\nshape = \"box\"\nposition_m = [0, 0, 50]\n" +
             rov_text("position_m = [0, -10, 0]\n"))
      .value();
}

TEST(Trails, BubblesStayWhereAVehicleThatWentOnLeftThem) {
  const scene::Scene scene = leaking_scene();
  TestDive dive = dive_of(scene);
  const auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  ASSERT_EQ(live->world().followed().size(), 1u);  // the ship stands
  live->start();
  const scene::MotionSource motion(scene, &live->motion());
  const std::size_t rov = live->world().vehicles()[0].object;
  std::vector<std::pair<double, Vec3>> was;
  for (int i = 0; i < 100; ++i) {
    was.emplace_back(0.1 * i, dive.pose() * Vec3(0.0, 0.1, 0.0));
    dive.run(0.1);
  }
  // A picture each three seconds: the states between them count, too.
  for (const double time_s : {3.0, 6.0, 9.9}) live->follow(0, time_s);
  double gone_m = 0.0;
  for (const auto& [time_s, place_m] : was) {
    EXPECT_LT(
        glm::distance(motion.place_of(rov, -1, Vec3(0.0, 0.1, 0.0), time_s).position_m, place_m),
        2e-3)
        << time_s;
    gone_m = glm::distance(place_m, was[0].second);
  }
  EXPECT_GT(gone_m, 2.0);
  // Before the start it was there; a point that nothing leaves is asked of the poses.
  EXPECT_EQ(motion.place_of(rov, -1, Vec3(0.0, 0.1, 0.0), -5.0).position_m, was[0].second);
  EXPECT_FALSE(live->motion().followed(rov, -1, Vec3(0.0, 0.2, 0.0), 1.0).has_value());
}

TEST(Trails, AreTheSameHoweverOftenAPictureIsAskedFor) {
  const scene::Scene scene = leaking_scene();
  const auto often = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  const auto seldom = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  for (int i = 1; i <= 120; ++i) often->follow(0, i / 30.0);
  seldom->follow(0, 4.0);
  const std::size_t rov = often->world().vehicles()[0].object;
  for (double time_s = 0.0; time_s < 3.9; time_s += 0.037)
    EXPECT_EQ(often->motion().followed(rov, -1, Vec3(0.0, 0.1, 0.0), time_s)->position_m,
              seldom->motion().followed(rov, -1, Vec3(0.0, 0.1, 0.0), time_s)->position_m);
}

// A vehicle held up by its thrusters 1.5 m over the bed, and one whose wash nobody asks for.
TEST(Trails, TheWashOfThrustersIsKnownWhereItMeetsTheBed) {
  for (const bool wash : {false, true}) {
    const scene::Scene scene =
        load_text(
            "[physics]\n[water]\ntype = \"IB\"\n"
            "[[water.silt]]\non = \"rov\"\nposition_m = [0, -0.2, 0]\nbed_depth_m = 11.5\n" +
            rov_text(std::string("position_m = [0, -10, 0]\n") +
                     "inputs = { wrench = \"python\" }\n" + (wash ? "wash = {}\n" : "")))
            .value();
    const auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
    live->start();
    // Up: the jets go down.
    const auto sources = live->inbox().source_names();
    const auto python =
        static_cast<SourceId>(std::ranges::find(sources, "python") - sources.begin());
    const StreamId stream = *live->world().streams().find("rov/wrench");
    VehicleWrench up;
    up.wrench[2] = -80.0;
    for (std::uint64_t i = 0; i < 20; ++i) {
      (void)live->inbox().push({{stream, python, i, 0, 0}, up});
      live->follow(0, 0.1 * static_cast<double>(i + 1));
    }
    const scene::MotionSource motion(scene, &live->motion());
    const std::size_t rov = live->world().vehicles()[0].object;
    const double wash_m_s = motion.place_of(rov, -1, Vec3(0.0, -0.2, 0.0), 0.5).wash_m_s;
    if (wash)
      EXPECT_GT(wash_m_s, 0.05);
    else
      EXPECT_EQ(wash_m_s, 0.0);
  }
}

TEST(Trails, AreNotKeptLongerThanWhatWasLeftIsSeen) {
  class Line final : public scene::SimulatedMotion {
   public:
    std::optional<scene::MotionAt> at(std::size_t, double time_s) const override {
      return scene::MotionAt{{{Vec3(time_s, 0.0, 0.0), Quat(1, 0, 0, 0)}}};
    }
  };
  const scene::Scene scene = leaking_scene();
  auto points = PhysicsWorld::create(scene).value()->followed();
  ASSERT_EQ(points.size(), 1u);
  points[0].kept_s = 10.0;
  Trails trails(points);
  const auto at = [&](double time_s) {
    return trails.at(points[0].object, -1, Vec3(0.0, 0.1, 0.0), time_s);
  };
  EXPECT_FALSE(at(0.0).has_value());
  for (int step = 0; step <= 240 * 60; ++step)
    if (trails.due(step / 240.0)) trails.add(Line(), step / 240.0, {});
  EXPECT_NEAR(at(55.51)->position_m.x, 55.51, 1e-9);
  EXPECT_NEAR(at(12.0)->position_m.x, 50.0, 0.03);
  EXPECT_FALSE(at(60.0).has_value());
  EXPECT_FALSE(trails.due(60.01));
  EXPECT_TRUE(trails.due(60.03));
  trails.clear();
  EXPECT_TRUE(trails.due(1.0));
}

}  // namespace
}  // namespace neritic::testbed
