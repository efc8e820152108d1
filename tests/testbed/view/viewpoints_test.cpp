// From where a person of `dive` looks: every mounted camera rides, a chase keeps its participant in
// the picture, and the keys visit every view.
#include "testbed/view/viewpoints.hpp"

#include <gtest/gtest.h>

#include <set>

#include "engine/xr/offscreen.hpp"
#include "testbed/loop/loop.hpp"
#include "testbed/view/dive_view.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

scene::Scene shipped(const char* name) {
  return scene::load_scene(test::source_dir() / "assets/scenes" / name).value();
}

// The view's request for each frame, beside where the motion source has the things of the scene.
class WatchedView final : public FrameView {
 public:
  explicit WatchedView(DiveView& view) : view_(view) {}
  Result<xr::FrameVerdict> begin_frame() override { return view_.begin_frame(); }
  std::optional<TimeNs> display_at_ns() const override { return view_.display_at_ns(); }
  bool shown() const override { return view_.shown(); }
  bool in_frame() const override { return view_.in_frame(); }
  bool take_input() override { return view_.take_input(); }
  void add_views(FrameRequest& request) override {
    view_.add_views(request);
    time_s = request.time_s;
    drawn = request.views.front().views.views.front();
    mounted = scene::MotionSource(*scene, request.simulated).world_from(mount, time_s);
  }
  Status declare(graph::FrameGraph& graph, const SensorFrame& frame, double time,
                 bool last) override {
    return view_.declare(graph, frame, time, last);
  }
  gpu::Frames::SubmitSync sync() const override { return view_.sync(); }
  Status end_frame(std::optional<std::uint64_t> value) override { return view_.end_frame(value); }
  Status finish() override { return view_.finish(); }

  const scene::Scene* scene = nullptr;
  scene::Mount mount;
  double time_s = 0.0;
  render::ViewDesc drawn;
  Pose mounted;

 private:
  DiveView& view_;
};

class Views : public test::GpuTest {};

TEST_F(Views, TheMountedCamerasPictureIsDrawnFromItsPoseAtTheDisplayTime) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), shipped("mission.toml")));
  const scene::Scene& scene = session->scene();
  const auto physics = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  NERITIC_ASSERT_OK(const std::size_t viewpoint, viewpoint_named("rov_camera", scene));
  NERITIC_ASSERT_OK(const auto display, xr::OffscreenDisplay::create(
                                            device(), {{xr::one_view(64, 36, radians(60.0))}}));
  NERITIC_ASSERT_OK(const auto view, DiveView::create(*session, *display, nullptr, physics.get(),
                                                      {.viewpoint = viewpoint}));
  WatchedView watched(*view);
  watched.scene = &scene;
  watched.mount = scene.cameras[viewpoint].mount;
  const Pose start = scene.world_from(watched.mount);
  Loop loop({.clock = Clock::simulated(0.0, 3.0),
             .physics = physics.get(),
             .sensors = LoopSensors{.session = session.get(), .capture = kColorOnGpu},
             .view = &watched,
             .stop = {.seconds = 3.0}});
  NERITIC_ASSERT_STATUS(loop.run());
  EXPECT_EQ(watched.time_s, 3.0);
  const Pose& drawn = watched.drawn.world_from_view;
  EXPECT_EQ(drawn.position_m, watched.mounted.position_m);
  EXPECT_EQ(drawn.rotation, watched.mounted.rotation);
  EXPECT_GT(glm::distance(drawn.position_m, start.position_m), 0.5);
  // Its lens, in a picture of another shape.
  EXPECT_NEAR(watched.drawn.tangents.top, std::tan(0.5 * scene.cameras[viewpoint].vertical_fov_rad),
              1e-12);
}

// All that is drawn, with a tenth of room, through the lens of the scene's first camera.
void expect_in_picture(const scene::Scene& scene, const Viewpoint& chase,
                       const Pose& world_from_chased, const Pose& eye) {
  const Pose view_from_chased = inverse(eye) * world_from_chased;
  const Vec3 middle = view_from_chased * chase.middle_m;
  EXPECT_NEAR(middle.x, 0.0, 1e-6) << chase.name;
  EXPECT_NEAR(middle.y, 0.0, 1e-6) << chase.name;
  ASSERT_LT(middle.z, 0.0) << chase.name;
  // The ball touches the picture's edge where its tangent leaves by half the angle of view.
  EXPECT_LT(chase.radius_m / -middle.z, 0.9 * std::sin(0.5 * scene.cameras[0].vertical_fov_rad))
      << chase.name;
}

TEST(Viewpoints, AChaseKeepsItsParticipantInThePicture) {
  const scene::Scene scene = shipped("dive.toml");
  const auto physics = LivePhysics::create(scene, LivePhysics::Pace::kPicture).value();
  physics->start();
  std::vector<ViewChoice> chases;
  for (std::size_t i = 0; i < viewpoints_of(scene).size(); ++i)
    if (viewpoints_of(scene)[i].kind == Viewpoint::Kind::kChase) chases.emplace_back(scene, i);
  std::set<std::string> names;
  for (const ViewChoice& chase : chases) names.insert(chase.viewpoint().name);
  EXPECT_EQ(names, (std::set<std::string>{"chase:diver", "chase:rov", "chase:shark"}));
  for (double time_s = 0.0; time_s <= 8.0; time_s += 0.25) {
    physics->follow(0, time_s);
    const scene::MotionSource motion(scene, &physics->motion());
    for (ViewChoice& chase : chases) {
      chase.follow(motion, time_s);
      expect_in_picture(scene, chase.viewpoint(),
                        motion.world_from(chase.viewpoint().mount, time_s),
                        chase.world_from_view());
    }
  }
}

TEST(Viewpoints, KeysVisitEveryViewBothWaysAndHomeLeadsBack) {
  const scene::Scene scene = shipped("dive.toml");
  const std::size_t begin = first_viewpoint(scene);
  ViewChoice choice(scene, begin);
  EXPECT_EQ(choice.viewpoint().name, "chase:diver");
  const std::size_t count = choice.all().size();
  for (const int step : {1, -1}) {
    std::set<std::string> seen;
    for (std::size_t i = 0; i < count; ++i) {
      seen.insert(choice.viewpoint().name);
      choice.take({.view_step = step}, 0.01, false);
    }
    EXPECT_EQ(seen.size(), count);
    EXPECT_EQ(choice.viewpoint().name, "chase:diver");
  }
  choice.take({.view_step = 2}, 0.01, false);
  EXPECT_NE(choice.viewpoint().name, "chase:diver");
  choice.take({.reset = true}, 0.01, false);
  EXPECT_EQ(choice.viewpoint().name, "chase:diver");
}

// Keys of moving: to the free view, from where the eye was; while a vehicle is flown they are its.
TEST(Viewpoints, MovingLeavesAViewUnlessAVehicleIsFlown) {
  const scene::Scene scene = shipped("mission.toml");
  ViewChoice choice(scene, viewpoint_named("rov_camera", scene).value());
  const scene::MotionSource still(scene);
  const Vec3 was_m = choice.world_from_view().position_m;
  const DiveInput ahead{.move = {0, 0, -1}};
  choice.take(ahead, 0.1, true);
  EXPECT_EQ(choice.viewpoint().name, "rov_camera");
  choice.take(ahead, 0.1, false);
  choice.follow(still, 0.0);
  EXPECT_EQ(choice.viewpoint().name, "free");
  EXPECT_NEAR(glm::distance(choice.world_from_view().position_m, was_m), 0.15, 1e-6);
}

TEST(Viewpoints, TheMouseLooksRoundOnAMountedCameraWhichGoesOnRiding) {
  const scene::Scene scene = shipped("mission.toml");
  ViewChoice choice(scene, viewpoint_named("rov_camera", scene).value());
  const Pose straight = choice.world_from_view();
  choice.take({.look_px = {200, 0}}, 0.01, false);
  choice.follow(scene::MotionSource(scene), 0.0);
  EXPECT_EQ(choice.world_from_view().position_m, straight.position_m);
  const Vec3 ahead =
      inverse(straight).rotation * (choice.world_from_view().rotation * Vec3(0.0, 0.0, -1.0));
  EXPECT_NEAR(std::atan2(ahead.x, -ahead.z), 0.5, 1e-9);  // 200 px to starboard
}

// As a head: in the world and level, while the body rides on below it.
TEST(Viewpoints, TheOwnViewOfASwumDiverTurnsByKeysAndMouse) {
  const scene::Scene scene =
      load_text(kStillWater + diver_text(std::string("position_m = [0, -12, 0]\n") + kProne) +
                "[[objects.cameras]]\nname = \"eyes\"\nposition_m = [0, 0.66, -0.16]\npitch_deg = "
                "80\nroll_deg = 5\n")
          .value();
  ViewChoice choice(scene, own_viewpoint(scene));
  ASSERT_EQ(choice.viewpoint().name, "diver_eyes");
  const int diver = choice.carrier();
  const scene::MotionSource still(scene);
  const auto show = [&](const DiveInput& input, int swum) {
    choice.take(input, 0.2, true, swum);
    choice.follow(still, 0.0);
  };
  show({}, -1);
  EXPECT_FALSE(choice.world_from_eyes());
  show({}, diver);
  show({}, diver);
  ASSERT_TRUE(choice.world_from_eyes());
  const auto angles = [&] {
    const Vec3 ahead = *choice.world_from_eyes() * Vec3(0, 0, -1);
    return Vec2(degrees(std::atan2(ahead.x, -ahead.z)), degrees(std::asin(ahead.y)));
  };
  EXPECT_NEAR((*choice.world_from_eyes() * Vec3(1, 0, 0)).y, 0.0, 1e-9);
  const Vec2 begin = angles();
  show({.move = {1, 0, 0}}, diver);  // D
  show({.turn = 1.0}, diver);        // Right
  EXPECT_NEAR(std::remainder(angles().x - begin.x, 360.0), 18.0, 1e-6);
  EXPECT_NEAR(angles().y, begin.y, 1e-6);
  show({.look_px = {-40, -40}}, diver);
  EXPECT_NEAR(std::remainder(angles().x - begin.x, 360.0), 18.0 - degrees(0.1), 1e-6);
  EXPECT_NEAR(angles().y, begin.y + degrees(0.1), 1e-6);
  show({.view_step = 1}, diver);
  EXPECT_FALSE(choice.world_from_eyes());
}

TEST(Viewpoints, AnUnknownViewIsRefusedWithTheKnownOnes) {
  const auto found = viewpoint_named("nose", shipped("pool.toml"));
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(found.error().message, "--view: found 'nose'; accepted: camera, free");
}

}  // namespace
}  // namespace neritic::testbed
