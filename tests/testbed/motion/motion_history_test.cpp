// The history of what a simulation moves: closed forms between, before and after its states, and
// the same bits whether it keeps every state or the two newest.
#include "testbed/motion/motion_history.hpp"

#include <random>

#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

using scene::Knowledge;

const Vec3 kVelocity{1.0, -0.5, 2.0};
constexpr double kRate = 0.7;  // rad/s about y

// An object on a straight line that turns about y.
MotionSnapshot snapshot_at(double time_s) {
  return {time_s,
          {Motion{{Vec3(3.0, -4.0, 5.0) + kVelocity * time_s,
                   glm::angleAxis(kRate * time_s, Vec3(0, 1, 0))},
                  kVelocity,
                  Vec3(0, kRate, 0)}},
          {}};
}

MotionHistory history_of(std::initializer_list<double> times_s) {
  MotionHistory history(std::vector<MotionHistory::Moved>{{1, {}}});
  for (const double time_s : times_s) history.add(snapshot_at(time_s));
  return history;
}

void expect_on_the_line(const scene::MotionAt& at, double time_s) {
  const Motion expected = *snapshot_at(time_s).motions[0];
  EXPECT_LT(glm::distance(at.motion.pose.position_m, expected.pose.position_m), 1e-12) << time_s;
  EXPECT_GT(std::abs(glm::dot(at.motion.pose.rotation, expected.pose.rotation)), 1.0 - 1e-12);
  EXPECT_LT(glm::distance(at.motion.velocity_m_s, kVelocity), 1e-12);
  EXPECT_LT(glm::distance(at.motion.angular_velocity_rad_s, Vec3(0, kRate, 0)), 1e-12);
}

TEST(MotionHistory, SteadyMotionIsFoundBetweenAndAheadOfItsStates) {
  const MotionHistory history = history_of({0.0, 0.25, 0.5});
  for (const auto& [time_s, known] :
       {std::pair(0.25, Knowledge::kExact), std::pair(0.1, Knowledge::kBetween),
        std::pair(0.49, Knowledge::kBetween), std::pair(0.56, Knowledge::kPredicted)}) {
    const auto at = history.at(1, time_s);
    ASSERT_TRUE(at.has_value());
    expect_on_the_line(*at, time_s);
    EXPECT_EQ(at->known, known) << time_s;
  }
  EXPECT_NEAR(history.at(1, 0.56)->predicted_s, 0.06, 1e-12);
  EXPECT_FALSE(history.at(0, 0.25).has_value());
  EXPECT_FALSE(history.at(2, 0.25).has_value());
}

TEST(MotionHistory, BeforeTheOldestAndBeyondThePredictionItStandsStill) {
  const MotionHistory history = history_of({0.25, 0.5});
  const auto early = history.at(1, -3.0), late = history.at(1, 9.0);
  EXPECT_EQ(early->known, Knowledge::kHeld);
  EXPECT_EQ(early->motion.pose.position_m, snapshot_at(0.25).motions[0]->pose.position_m);
  EXPECT_EQ(early->motion.velocity_m_s, Vec3(0.0));
  EXPECT_EQ(late->known, Knowledge::kHeld);
  const double end_s = 0.5 + MotionHistory::kMostPredicted_s;
  EXPECT_LT(
      glm::distance(late->motion.pose.position_m, snapshot_at(end_s).motions[0]->pose.position_m),
      1e-12);
  EXPECT_EQ(late->motion.velocity_m_s, Vec3(0.0));
}

TEST(MotionHistory, TheOldestMakesRoom) {
  MotionHistory history(std::vector<MotionHistory::Moved>{{1, {}}});
  for (int i = 0; i < 1000; ++i) history.add(snapshot_at(i * 0.01));
  history.add(snapshot_at(3.0));  // late: left out
  EXPECT_EQ(history.newest_s(), 999 * 0.01);
  EXPECT_EQ(history.at(1, 1.0)->known, Knowledge::kHeld);
  EXPECT_EQ(history.at(1, (1000.0 - MotionHistory::kKept) * 0.01)->known, Knowledge::kExact);
}

// A sensor on a turning object that is carried by a moving one: its velocity is the rate of its
// pose.
TEST(MotionSource, WhatIsCarriedMovesAsItsPoseChanges) {
  scene::Scene scene;
  scene.objects.resize(3);
  scene.objects[0].mount.track = scene::Track{
      {{0.0, Vec3(1, 2, 3)}, {4.0, Vec3(9, -2, 3)}},
      {{0.0, Quat(1, 0, 0, 0)}, {4.0, glm::angleAxis(2.0, glm::normalize(Vec3(1, 2, 0.5)))}}};
  scene.objects[2].mount.object = 1;  // which the history moves
  scene.objects[2].mount.track = scene.objects[0].mount.track;
  const MotionHistory history = history_of({0.0, 4.0});
  const scene::MotionSource source(scene, &history);
  for (const int carrier : {0, 1, 2}) {
    const scene::Mount mount{carrier, {{0.3, -0.2, -1.0}, glm::angleAxis(0.4, Vec3(1, 0, 0))}};
    for (const double time_s : {0.5, 1.7, 3.1}) {
      constexpr double kApart_s = 1e-5;
      const Pose before = source.world_from(mount, time_s - kApart_s),
                 after = source.world_from(mount, time_s + kApart_s);
      const Motion at = source.at(mount, time_s).motion;
      EXPECT_LT(
          glm::distance((after.position_m - before.position_m) / (2.0 * kApart_s), at.velocity_m_s),
          1e-6)
          << carrier << " " << time_s;
      Quat turn = after.rotation * glm::conjugate(before.rotation);
      if (turn.w < 0.0) turn = -turn;
      EXPECT_LT(glm::distance(Vec3(turn.x, turn.y, turn.z) / kApart_s, at.angular_velocity_rad_s),
                1e-6)
          << carrier << " " << time_s;
    }
  }
}

// Two newest of many steps, as a reader of a thread gets them, against every step.
TEST(MotionHistory, TheTwoNewestStatesGiveTheBitsThatAllGive) {
  TestDive dive = dive_of(std::string(kStillWater) +
                          rov_text("position_m = [0, -10, 0]\nmission = { waypoints = [ { "
                                   "position_m = [5, -12, 3] } ] }\n") +
                          diver_text(std::string("position_m = [8, -8, 0]\n") + kProne));
  MotionHistory all(moved_objects(*dive.world)), newest(moved_objects(*dive.world));
  std::mt19937 random(7);
  sim::Snapshot<PhysicsState> previous = dive.simulation->newest();
  const scene::Model& model = *dive.scene.models[static_cast<std::size_t>(
      dive.scene.objects[dive.world->humans()[0].object].model)];
  for (int frame = 0; frame < 60; ++frame) {
    for (unsigned steps = 1 + random() % 12; steps > 0; --steps) {
      previous = dive.simulation->newest();
      dive.simulation->advance(1);
      all.add(motion_of(*dive.world, dive.simulation->newest()));
    }
    newest.add(motion_of(*dive.world, previous));
    newest.add(motion_of(*dive.world, dive.simulation->newest()));
    const double share = std::uniform_real_distribution(0.0, 1.0)(random);
    const double time_s = previous.time_s + share * dive.world->step_s();
    for (const std::size_t object :
         {dive.world->vehicles()[0].object, dive.world->humans()[0].object}) {
      const Motion a = all.at(object, time_s)->motion, b = newest.at(object, time_s)->motion;
      ASSERT_EQ(a.pose.position_m, b.pose.position_m);
      ASSERT_EQ(a.pose.rotation, b.pose.rotation);
      ASSERT_EQ(a.velocity_m_s, b.velocity_m_s);
      ASSERT_EQ(a.angular_velocity_rad_s, b.angular_velocity_rad_s);
    }
    const std::size_t diver = dive.world->humans()[0].object;
    const auto a = all.model_pose(diver, model, time_s),
               b = newest.model_pose(diver, model, time_s);
    ASSERT_TRUE(a && b);
    ASSERT_EQ(a->model_from_node, b->model_from_node);
  }
  EXPECT_GT(
      glm::length(all.at(dive.world->vehicles()[0].object, dive.time_s())->motion.velocity_m_s),
      0.05);
}

}  // namespace
}  // namespace neritic::testbed
