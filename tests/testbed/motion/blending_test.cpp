// The error of blending: what is between the states of 240 Hz against the exact state at that time,
// at the display times of views of 60, 90 and 200 Hz. The exact states are those of the same run
// at 960 Hz, of which the history gets every fourth.
#include "testbed/motion/motion_history.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

struct Worst {
  double mm = 0.0, deg = 0.0;
};

class Blending : public testing::Test {
 protected:
  static constexpr double kFine_hz = 960.0;
  static constexpr int kSteps = 1920, kCoarse = 4;

  // A vehicle that starts, turns and stops between waypoints, and a diver who kicks.
  void SetUp() override {
    TestDive dive = dive_of(
        "[physics]\nrate_hz = 960\n" +
        diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                   "swim = { waypoints_m = [[0, -12, -50]], speed_m_s = 0.5 }\n") +
        rov_text("position_m = [4, -10, 0]\nmission = { speed_m_s = 0.5, waypoints = [ "
                 "{ position_m = [4, -10, -0.6] }, { position_m = [5, -10.4, -0.6] } ] }\n"));
    ASSERT_EQ(dive.world->humans().size(), 1u);
    ASSERT_EQ(dive.world->vehicles().size(), 1u);
    objects_ = {dive.world->vehicles()[0].object, dive.world->humans()[0].object};
    history_.emplace(moved_objects(*dive.world));
    for (int step = 0; step <= kSteps; ++step) {
      exact_.push_back(motion_of(*dive.world, dive.simulation->newest()));
      dive.run(1.0 / kFine_hz);
    }
  }
  // At the nearest fine step of each frame's time, which lies anywhere between two coarse states.
  Worst worst_at(double view_hz) {
    Worst worst;
    int frames_between = 0, added = 0;
    for (int frame = 0;; ++frame) {
      const double display_s = 1.0 / 1000.0 + frame / view_hz;
      const int step = static_cast<int>(std::lround(display_s * kFine_hz));
      if (step + kCoarse >= kSteps) break;
      for (; added <= step + kCoarse; added += kCoarse)
        history_->add(exact_[static_cast<std::size_t>(added)]);
      frames_between += step % kCoarse != 0;
      const MotionSnapshot& exact = exact_[static_cast<std::size_t>(step)];
      for (std::size_t i = 0; i < objects_.size(); ++i) {
        const auto blended = history_->at(objects_[i], exact.time_s);
        const Motion& wanted = *exact.motions[i];
        const Pose& pose = blended->motion.pose;
        worst.mm = std::max(worst.mm, 1e3 * glm::distance(pose.position_m, wanted.pose.position_m));
        const double half = std::abs(glm::dot(pose.rotation, wanted.pose.rotation));
        worst.deg = std::max(worst.deg, degrees(2.0 * std::acos(std::min(1.0, half))));
      }
    }
    EXPECT_GT(frames_between, 10);
    history_->clear();
    return worst;
  }

  std::vector<std::size_t> objects_;
  std::optional<MotionHistory> history_;
  std::vector<MotionSnapshot> exact_;
};

TEST_F(Blending, IsRightToHundredthsOfAMillimetreAtEveryRateOfViews) {
  for (const double view_hz : {60.0, 90.0, 200.0}) {
    const Worst worst = worst_at(view_hz);
    RecordProperty(fmt::format("worst_mm_at_{:g}_hz", view_hz), fmt::format("{:.5f}", worst.mm));
    RecordProperty(fmt::format("worst_deg_at_{:g}_hz", view_hz), fmt::format("{:.5f}", worst.deg));
    EXPECT_LT(worst.mm, 0.03) << view_hz;
    EXPECT_LT(worst.deg, 0.005) << view_hz;
    EXPECT_GT(worst.mm, 0.0) << view_hz;
  }
}

}  // namespace
}  // namespace neritic::testbed
