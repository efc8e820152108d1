// The wrist's instrument in a headset lies on the arm of the same picture, however far ahead of the
// newest state that picture is.
#include <gtest/gtest.h>

#include "diver/segments.hpp"
#include "hud/layout.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/view/dive_camera.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/view/kept_display.hpp"

namespace neritic::testbed {
namespace {

class DrawnWrist : public test::GpuTest {
 protected:
  void SetUp() override {
    test::GpuTest::SetUp();
    if (IsSkipped()) return;
    scene::Scene scene =
        dive_of(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne +
                                         "swim = { waypoints_m = [[0, -12, -50]], "
                                         "speed_m_s = 0.5 }\n"))
            .scene;
    scene.cameras.push_back(camera_for(scene));
    physics_ = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
    physics_->start();
    session_ = Session::create(device(), std::move(scene)).value();
  }
  void TearDown() override {
    session_.reset();
    test::GpuTest::TearDown();
  }
  // The motion by which pictures are drawn.
  scene::MotionSource motion() const { return {session_->scene(), &physics_->motion()}; }
  const PhysicsHuman& human() const { return physics_->world().humans()[0]; }
  // Declares a frame of that time.
  Status frame(DiveView& view, double time_s) {
    graph::FrameGraph graph;
    NERITIC_TRY_STATUS(view.begin_frame());
    view.take_input();
    FrameRequest request{.time_s = time_s, .next_time_s = time_s, .capture = kColorOnGpu};
    request.simulated = &physics_->motion();
    view.add_views(request);
    NERITIC_TRY(const auto declared, session_->declare(graph, request));
    NERITIC_TRY_STATUS(view.declare(graph, *declared, time_s, false));
    return view.end_frame(std::nullopt);
  }

  std::unique_ptr<LivePhysics> physics_;
  std::unique_ptr<Session> session_;
  KeptDisplay display_{true};
};

// At rest the joint of the model and the body's wrist are one.
TEST_F(DrawnWrist, HasTheAxesOfTheBodysWrist) {
  physics_->follow(0, 4.0);
  const double newest_s = physics_->newest().time_s;
  const Pose drawn = world_from_drawn_wrist(human(), motion(), newest_s);
  const Pose wanted = world_from_wrist(human(), physics_->shown().humans()[0]);
  EXPECT_LT(glm::distance(drawn.position_m, wanted.position_m), 0.02);
  EXPECT_GT(std::abs(glm::dot(drawn.rotation, wanted.rotation)), std::cos(radians(1.0)));
}

TEST_F(DrawnWrist, CarriesItsInstrumentInAPictureAheadOfTheNewestState) {
  NERITIC_ASSERT_OK(
      const auto view,
      DiveView::create(*session_, display_, nullptr, physics_.get(),
                       {.hud = DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}}}));
  physics_->follow(0, 20.0);
  const HumanPhysics& swims = physics_->shown().humans()[0];
  ASSERT_NEAR(glm::length(swims.human.root.velocity.linear()), 0.5, 0.12);
  for (const double ahead_s : {0.0, 0.03, 0.08}) {
    const double time_s = physics_->newest().time_s + ahead_s;
    NERITIC_ASSERT_STATUS(frame(*view, time_s));
    const hud::Layout& layout = hud::layout_of(hud::LayoutKind::kWrist);
    const xr::PanelLayer* const panel = display_.panel(layout.name);
    ASSERT_NE(panel, nullptr);
    ASSERT_EQ(panel->lock, xr::PanelLayer::Lock::kWorld);
    const Pose wrist = panel->pose * inverse(layout.lock_from_panel);
    const Pose drawn =
        motion().world_from_joint(human().object, human().nodes[diver::kLeftHand], time_s);
    EXPECT_LT(glm::distance(wrist.position_m, drawn.position_m), 1e-3) << ahead_s;
    // The newest state is elsewhere, so that a panel there would be seen beside the arm.
    const Pose newest = world_from_wrist(human(), swims);
    if (ahead_s > 0.0) {
      EXPECT_GT(glm::distance(newest.position_m, drawn.position_m), 0.3 * ahead_s) << ahead_s;
    }
  }
}

}  // namespace
}  // namespace neritic::testbed
