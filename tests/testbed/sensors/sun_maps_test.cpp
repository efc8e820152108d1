// The sun's kept depth maps: drawn once, drawn anew where something has changed, and never another
// picture than maps that are fresh. And a camera's levels of detail: sizes, knobs, what is absent.
#include <gtest/gtest.h>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/frame_memory.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/picture_difference.hpp"

namespace neritic::testbed {
namespace {

using SunMapsTest = test::GpuTest;

void add_box(scene::Scene& scene, const std::string& name, const Vec3& size_m,
             const Vec3& place_m) {
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box(size_m)));
  scene::Object object;
  object.name = name;
  object.model = static_cast<int>(scene.models.size()) - 1;
  object.class_id = 1;
  object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
  object.mount.pose.position_m = place_m;
  scene.objects.push_back(object);
}

// A floor at 8 m with a box that stands and one that slides by, in water, camera above.
scene::Scene beach(bool slides) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = radians(60.0), .azimuth_rad = radians(70.0)};
  scene.sun->shadows = scene::SunShadows{.size = 256, .cascades = 2};
  scene.ambient = scene::Ambient{.occlusion_m = 0.5};
  scene.water = scene::Water{.type = "IB", .scattering = true};
  add_box(scene, "floor", {80.0, 1.0, 80.0}, {0.0, -8.5, 0.0});
  add_box(scene, "still", {1.0, 1.0, 1.0}, {-1.0, -7.0, 0.0});
  add_box(scene, "slider", {0.6, 0.6, 0.6}, {1.0, -7.0, 0.0});
  if (slides) {
    scene::Track track;
    track.places = {{0.0, {1.0, -7.0, 0.0}}, {4.0, {1.0, -7.0, 4.0}}};
    track.attitudes = {{0.0, Quat(1.0, 0.0, 0.0, 0.0)}};
    scene.objects.back().mount.track = track;
  }
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 160;
  camera.height = 90;
  camera.mount.pose = {Vec3(0.0, -4.0, 6.0), glm::angleAxis(-0.5, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  return scene;
}

ImageU8 maps_shown(Session& session, double time_s, std::string* plan = nullptr) {
  session.keep_plan_dump(true);
  FrameRequest request;
  request.cameras = {0};
  request.time_s = time_s;
  request.next_time_s = time_s + 0.1;
  auto result = session.render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  if (plan) *plan = session.plan_text();
  return result->cameras[0].eyes[0].color;
}

TEST_F(SunMapsTest, AreDrawnOnceAndGiveTheSamePicture) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), beach(false)));
  std::string first, second;
  const ImageU8 before = maps_shown(*session, 0.0, &first),
                after = maps_shown(*session, 0.5, &second);
  EXPECT_NE(first.find("eye sun shadows"), std::string::npos);
  EXPECT_EQ(second.find("pass \"eye sun shadows\""), std::string::npos) << second;
  EXPECT_EQ(second.find("moving shadows"), std::string::npos);
  EXPECT_NE(second.find("eye visibility"), std::string::npos);
  EXPECT_EQ(before.data, after.data);
}

TEST_F(SunMapsTest, WhatMovesIsDrawnOverThemAsInFreshOnes) {
  NERITIC_ASSERT_OK(const auto kept, Session::create(device(), beach(true)));
  std::string plan;
  maps_shown(*kept, 0.0);
  const ImageU8 later = maps_shown(*kept, 1.5, &plan);
  EXPECT_NE(plan.find("moving shadows"), std::string::npos);
  NERITIC_ASSERT_OK(const auto fresh, Session::create(device(), beach(true)));
  EXPECT_EQ(later.data, maps_shown(*fresh, 1.5).data);
  NERITIC_ASSERT_OK(const auto still, Session::create(device(), beach(false)));
  EXPECT_NE(later.data, maps_shown(*still, 1.5).data);
}

// A view set at a place, so that one session can look from many.
ImageU8 seen_from(Session& session, const Vec3& offset_m, const scene::PictureDetail& detail = {}) {
  const scene::Camera& camera = session.scene().cameras.front();
  FrameRequest request;
  request.views.push_back({.name = "eye",
                           .views = camera_views(session.scene(), camera),
                           .exposure = camera.exposure,
                           .detail = detail,
                           .capture = Capture{.motion = false}.without_geometry()});
  for (render::ViewDesc& view : request.views[0].views.views) {
    view.world_from_view.position_m += offset_m;
    view.next_world_from_view = view.world_from_view;
  }
  auto result = session.render(request);
  EXPECT_TRUE(result.ok()) << result.error().message;
  return result->views[0].eyes[0].color;
}

// A window's view has the name of the camera that it looks through.
TEST_F(SunMapsTest, AViewOfACamerasNameHasMapsOfItsOwn) {
  const auto both = [](Session& session, bool camera, bool view) {
    const scene::MotionSource motion(session.scene(), nullptr);
    FrameRequest request;
    if (camera) request.cameras = {0};
    if (view) {
      request.views.push_back({.name = "eye",
                               .views = camera_views(motion, session.scene().cameras[0]),
                               .capture = {.motion = false}});
      request.views[0].detail.shadow_size = 0.5;
      for (render::ViewDesc& one : request.views[0].views.views)
        one.world_from_view.position_m.x += 1.5;
    }
    auto result = session.render(request);
    EXPECT_TRUE(result.ok()) << (result.ok() ? "" : result.error().message);
    return std::move(result).value();
  };
  NERITIC_ASSERT_OK(const auto alone, Session::create(device(), beach(false)));
  NERITIC_ASSERT_OK(const auto together, Session::create(device(), beach(false)));
  const FrameResult camera = both(*alone, true, false), view = both(*alone, false, true);
  for (int frame = 0; frame < 2; ++frame) {
    const FrameResult result = both(*together, true, true);
    EXPECT_EQ(result.cameras[0].eyes[0].color.data, camera.cameras[0].eyes[0].color.data);
    EXPECT_EQ(result.views[0].eyes[0].color.data, view.views[0].eyes[0].color.data);
  }
}

TEST_F(SunMapsTest, FollowTheCameraWithoutAPop) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), beach(false)));
  NERITIC_ASSERT_OK(const auto fresh, Session::create(device(), beach(false)));
  ImageU8 last = seen_from(*session, Vec3(0.0));
  double worst = 0.0;
  // Over more than a step of the nearer map (0.83 m), by centimetres at a time round the step.
  for (double x = 0.02; x < 1.0; x += 0.02) {
    const ImageU8 now = seen_from(*session, Vec3(x, 0.0, 0.0));
    worst = std::max(worst, test::mean_difference(last, now));
    last = now;
  }
  EXPECT_LT(worst, 1.0);
  EXPECT_EQ(last.data, seen_from(*fresh, Vec3(0.98, 0.0, 0.0)).data);
}

TEST_F(SunMapsTest, ACoarserPictureHasTheSizeThatIsNamedAndTheArraysTheirOwn) {
  scene::Scene coarse = beach(false), fine = beach(false);
  coarse.cameras[0].detail = scene::picture_level("draft").detail;
  std::vector<ImageU8> colors;
  std::vector<std::vector<float>> depths;
  for (scene::Scene* scene : {&coarse, &fine}) {
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), *scene));
    FrameRequest request;
    request.cameras = {0};
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    colors.push_back(result.cameras[0].eyes[0].color);
    depths.push_back(result.cameras[0].eyes[0].depth.data);
  }
  ASSERT_EQ(colors[0].width, 160u);
  ASSERT_EQ(colors[0].height, 90u);
  EXPECT_EQ(depths[0], depths[1]);
  EXPECT_NE(colors[0].data, colors[1].data);
  EXPECT_LT(test::mean_difference(colors[0], colors[1]), 6.0);
}

Result<scene::Scene> camera_with(const std::string& keys) {
  return scene::load_scene("test.toml", {.text = "[[cameras]]\nname = \"eye\"\n" + keys});
}

TEST(PictureDetailKeys, NameALevelAnErrorOrSingleKnobs) {
  NERITIC_ASSERT_OK(const auto plain, camera_with(""));
  EXPECT_EQ(plain.cameras[0].detail, scene::PictureDetail{});
  NERITIC_ASSERT_OK(const auto draft, camera_with("quality = \"draft\"\ndetail = {waves = 7}\n"));
  scene::PictureDetail expected = scene::picture_level("draft").detail;
  expected.waves = 7;
  EXPECT_EQ(draft.cameras[0].detail, expected);
  NERITIC_ASSERT_OK(const auto any, camera_with("max_error = 1\n"));
  EXPECT_EQ(any.cameras[0].detail, scene::picture_level("draft").detail);
  const double best = scene::picture_level("reference").error;
  NERITIC_ASSERT_OK(const auto good, camera_with(fmt::format("max_error = {}\n", best)));
  EXPECT_EQ(good.cameras[0].detail, scene::picture_level("reference").detail);
}

TEST(PictureDetailKeys, AreRefusedWithWhatIsAccepted) {
  for (const auto& [keys, said] : std::vector<std::pair<std::string, std::string>>{
           {"quality = \"best\"\n", "standard"},
           {"quality = \"draft\"\nmax_error = 0.1\n", "no such key beside quality"},
           {"max_error = 1e-9\n", "at least"},
           {"detail = {resolution = 1.5}\n", "[0.1, 1], 2, 3 or 4"},
           {"detail = {resolution = 5}\n", "4"},
           {"detail = {resolutoin = 1}\n", "resolution"}}) {
    const auto scene = camera_with(keys);
    ASSERT_FALSE(scene.ok()) << keys;
    EXPECT_NE(scene.error().message.find(said), std::string::npos) << scene.error().message;
  }
}

TEST_F(SunMapsTest, FrameMemoryCountsThem) {
  scene::Scene with = beach(false), without = beach(false);
  with.sun->shadows->size = 2048;
  without.sun->shadows.reset();
  FrameRequest request;
  request.cameras = {0};
  EXPECT_GE(host_bytes(device(), with, request),
            host_bytes(device(), without, request) + 2u * 4u * 2048u * 2048u);
}

}  // namespace
}  // namespace neritic::testbed
