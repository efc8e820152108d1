// Physics beside a picture: in lock-step it is where a simulation of that time is, on its thread
// where the clock says, between two steps and no farther than one from either.
#include "testbed/motion/live_physics.hpp"

#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

scene::Scene drifting_scene() {
  return load_text("[physics]\n[current]\nkind = \"uniform\"\nvelocity_m_s = [0.5, 0, 0]\n" +
                   rov_text("position_m = [0, -10, 0]\n"))
      .value();
}

TEST(LivePhysics, InLockStepItIsThePathFlown) {
  scene::Scene scene = drifting_scene();
  TestDive dive = dive_of(scene);
  const auto live = LivePhysics::create(scene, LivePhysics::Pace::kPicture);
  ASSERT_TRUE(live.ok());
  (*live)->start();
  for (int frame = 0; frame < 30; ++frame) {
    EXPECT_EQ((*live)->follow(0, frame / 30.0), frame / 30.0);
    EXPECT_LT(glm::distance((*live)->pose(0).position_m, dive.pose().position_m), 1e-9);
    dive.run(1.0 / 30.0);
  }
  EXPECT_EQ((*live)->newest().hash, dive.simulation->log().hashes[(*live)->newest().step]);
}

TEST(LivePhysics, OnItsThreadItKeepsTheClocksPace) {
  scene::Scene scene = drifting_scene();
  TestDive dive = dive_of(scene);
  dive.run(3.0);
  std::vector<Vec3> path{Vec3(0, -10, 0)};
  TestDive again = dive_of(scene);
  again.run(3.0, [&] { path.push_back(again.pose().position_m); });
  const auto live = LivePhysics::create(scene, LivePhysics::Pace::kClock);
  ASSERT_TRUE(live.ok());
  (*live)->start();
  const TimeNs begun_ns = now_ns();
  double farthest_m = 0.0;
  for (TimeNs now = begun_ns; now < begun_ns + 1'000'000'000; now = now_ns()) {
    (*live)->follow(now, 0.0);
    const Vec3 at = (*live)->pose(0).position_m;
    double nearest_m = 1e9;
    for (const Vec3& p : path) nearest_m = std::min(nearest_m, glm::distance(p, at));
    farthest_m = std::max(farthest_m, nearest_m);
  }
  EXPECT_LT(farthest_m, 5e-3);
  const auto counts = (*live)->counts();
  EXPECT_GT(counts.steps + counts.dropped, 235u);
  EXPECT_LT(counts.steps + counts.dropped, 260u);
}

}  // namespace
}  // namespace neritic::testbed
