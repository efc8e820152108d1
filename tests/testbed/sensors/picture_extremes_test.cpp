// Pictures with every term of light and water at extremes: no pixel that is not a number (the tone
// curve makes those black), nothing that flickers where eye or time move by next to nothing.
#include <gtest/gtest.h>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/picture_difference.hpp"

namespace neritic::testbed {
namespace {

using PictureExtremes = test::GpuTest;

struct Place {
  Vec3 eye_m{0.0, -5.0, 0.0};
  double pitch_rad = -0.2, yaw_rad = 0.0, sun_rad = radians(50.0), bed_m = 8.0;
  Vec3 shift_m{0.0};
  bool particles = true;
};

scene::Scene everything(const Place& place) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{.elevation_rad = place.sun_rad, .azimuth_rad = 0.0};
  scene.sun->shadows = scene::SunShadows{.size = 256, .cascades = 2};
  scene.sun->caustics = scene::Caustics{.texels = 64};
  scene.ambient = scene::Ambient{.bottom_depth_m = place.bed_m, .occlusion_m = 0.5};
  const Vec3 middle_m = place.shift_m + Vec3(0.0, -place.bed_m, 0.0);
  scene.ambient->skylight = scene::Skylight{.low_m = middle_m - Vec3(6.0, 1.0, 6.0),
                                            .high_m = middle_m + Vec3(6.0, 5.0, 6.0)};
  scene::Water water{.type = "IB", .scattering = true, .surface = true};
  water.forward_scatter = scene::ForwardScatter{};
  water.waves = SeaState{};
  water.murk = scene::Murk{.bed_depth_m = place.bed_m};
  if (place.particles) {
    water.snow = scene::Snow{};
    scene::BubbleSource bubbles;
    bubbles.object = 1;
    water.bubbles = {bubbles};
    scene::SiltSource silt;
    silt.object = 1;
    silt.bed_depth_m = place.bed_m;
    silt.reach_m = 20.0;
    water.silt = {silt};
  }
  scene.water = water;
  const auto add = [&](const Vec3& size_m, const Vec3& at_m) {
    scene.models.push_back(std::make_shared<scene::Model>(scene::make_box(size_m)));
    scene::Object object;
    object.name = fmt::format("box_{}", scene.objects.size());
    object.model = static_cast<int>(scene.models.size()) - 1;
    object.class_id = 1;
    object.instance = static_cast<std::uint16_t>(scene.objects.size() + 1);
    object.mount.pose.position_m = at_m + place.shift_m;
    scene.objects.push_back(object);
  };
  add({40.0, 1.0, 40.0}, {0.0, -place.bed_m - 0.5, 0.0});
  add({1.0, 1.0, 1.0}, {0.5, -place.bed_m + 0.5, -3.0});
  scene::Lamp lamp;
  lamp.name = "lamp";
  lamp.shadows = true;
  lamp.shadow_size = 128;
  lamp.mount.pose.position_m = place.eye_m + Vec3(0.3, 0.1, 0.0) + place.shift_m;
  scene.lamps.push_back(lamp);
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 96;
  camera.height = 64;
  camera.mount.pose = {place.eye_m + place.shift_m,
                       glm::angleAxis(place.yaw_rad, Vec3(0.0, 1.0, 0.0)) *
                           glm::angleAxis(place.pitch_rad, Vec3(1.0, 0.0, 0.0))};
  scene.cameras.push_back(camera);
  return scene;
}

// Pictures of one session: as its camera sees it, a little aside, and at an exposure.
Result<ImageU8> shown(Session& session, double time_s = 2.0, double aside_m = 0.0,
                      std::optional<double> ev = {}) {
  const scene::Camera& camera = session.scene().cameras.front();
  FrameRequest request;
  request.time_s = time_s;
  request.next_time_s = time_s + 1.0 / 30.0;
  request.views.push_back({.name = "eye",
                           .views = camera_views(session.scene(), camera, time_s, time_s),
                           .exposure = camera.exposure,
                           .capture = Capture{.motion = false}.without_geometry()});
  request.views[0].exposure.fixed_ev = ev;
  request.views[0].views.views[0].world_from_view.position_m.x += aside_m;
  NERITIC_TRY(FrameResult result, session.render(request));
  return std::move(result.views[0].eyes[0].color);
}

int luma(const ImageU8& image, std::uint32_t x, std::uint32_t y) {
  return (2 * image.at(x, y, 0) + 5 * image.at(x, y, 1) + image.at(x, y, 2)) / 8;
}

// Black pixels among pixels that are not dark.
int holes(const ImageU8& image) {
  int count = 0;
  for (std::uint32_t y = 1; y + 1 < image.height; ++y)
    for (std::uint32_t x = 1; x + 1 < image.width; ++x)
      if (luma(image, x, y) == 0 && luma(image, x - 1, y) + luma(image, x + 1, y) +
                                            luma(image, x, y - 1) + luma(image, x, y + 1) >
                                        80)
        ++count;
  return count;
}

TEST_F(PictureExtremes, HaveNoHolesAndDoNotFlicker) {
  const double sun_in_water = std::acos(std::cos(radians(50.0)) / 1.333);
  const std::pair<const char*, Place> places[] = {
      {"at the surface", {.eye_m = {0.0, 0.0, 0.0}, .particles = false}},
      {"just over it", {.eye_m = {0.0, 1e-6, 0.0}, .pitch_rad = 0.1, .particles = false}},
      {"in silt", {.eye_m = {0.5, -7.5, -3.0}, .particles = true}},
      {"facing the sun", {.pitch_rad = sun_in_water, .particles = false}},
      {"straight up", {.pitch_rad = kPi / 2, .particles = false}},
      {"1000 m deep", {.eye_m = {0.0, -998.0, 0.0}, .bed_m = 1000.0}},
      {"sun on the horizon", {.sun_rad = 0.0}},
      {"sun below the horizon", {.sun_rad = radians(-20.0)}},
      {"1e7 m away", {.shift_m = {1e7, 0.0, -1e7}, .particles = false}},
  };
  for (const auto& [name, place] : places) {
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), everything(place)));
    NERITIC_ASSERT_OK(const ImageU8 first, shown(*session));
    EXPECT_EQ(holes(first), 0) << name;
    NERITIC_ASSERT_OK(const ImageU8 second, shown(*session, 2.0, 1e-4));
    EXPECT_LT(test::mean_difference(first, second), 1.0) << name;
  }
}

TEST_F(PictureExtremes, ExposureOverTwentyStopsGoesFromBlackToWhiteWithoutHoles) {
  NERITIC_ASSERT_OK(const auto session,
                    Session::create(device(), everything({.particles = false})));
  double last = 1e9;
  for (const double ev : {3.0, 7.0, 11.0, 15.0, 19.0, 23.0}) {
    NERITIC_ASSERT_OK(const ImageU8 picture, shown(*session, 2.0, 0.0, ev));
    EXPECT_EQ(holes(picture), 0) << ev;
    double mean = 0.0;
    for (const std::uint8_t value : picture.data) mean += value;
    mean /= static_cast<double>(picture.data.size());
    EXPECT_LE(mean, last) << ev;
    last = mean;
  }
  EXPECT_LT(last, 1.0);
}

// Light that scatters forwards beside the sun's glare is not taken from things in front of it.
TEST_F(PictureExtremes, AThingInFrontOfTheSunKeepsEachColour) {
  const Place place{.eye_m = {0.0, -13.0, 0.0},
                    .pitch_rad = std::acos(std::cos(radians(50.0)) / 1.333),
                    .bed_m = 40.0,
                    .particles = false};
  scene::Scene clear = everything(place);
  clear.lamps.clear();
  clear.objects[1].mount.pose.position_m =
      place.eye_m + 3.0 * Vec3(0.1, std::sin(place.pitch_rad), -std::cos(place.pitch_rad));
  clear.water->forward_scatter.reset();
  scene::Scene scattering = clear;
  scattering.water->forward_scatter = scene::ForwardScatter{};
  NERITIC_ASSERT_OK(const auto sharp_session, Session::create(device(), std::move(clear)));
  NERITIC_ASSERT_OK(const auto soft_session, Session::create(device(), std::move(scattering)));
  NERITIC_ASSERT_OK(const ImageU8 sharp, shown(*sharp_session));
  NERITIC_ASSERT_OK(const ImageU8 soft, shown(*soft_session));
  int bright = 0, lost = 0;
  for (std::uint32_t y = 0; y < sharp.height; ++y)
    for (std::uint32_t x = 0; x < sharp.width; ++x)
      for (std::uint32_t c = 0; c < 3; ++c) {
        bright += sharp.at(x, y, c) > 20;
        lost += sharp.at(x, y, c) > 20 && soft.at(x, y, c) < sharp.at(x, y, c) / 5;
      }
  EXPECT_GT(bright, 10'000);
  EXPECT_EQ(lost, 0);
}

TEST_F(PictureExtremes, AStillSceneChangesByLessThanALevelAFrame) {
  NERITIC_ASSERT_OK(const auto session,
                    Session::create(device(), everything({.particles = false})));
  NERITIC_ASSERT_OK(const ImageU8 now, shown(*session, 2.0));
  NERITIC_ASSERT_OK(const ImageU8 next, shown(*session, 2.0 + 1.0 / 30.0));
  EXPECT_LT(test::mean_difference(now, next), 1.0);
}

TEST_F(PictureExtremes, EachTermIsInTheGraphOnlyWhereItIsNamed) {
  const auto plan_of = [&](const std::function<void(scene::Scene&)>& without) {
    scene::Scene scene = everything({});
    without(scene);
    auto session = Session::create(device(), std::move(scene));
    EXPECT_TRUE(session.ok());
    (*session)->keep_plan_dump(true);
    FrameRequest request;
    request.cameras = {0};
    request.time_s = 2.0;
    EXPECT_TRUE((*session)->render(request).ok());
    return std::pair((*session)->plan_text(), (*session)->executor().transient_bytes());
  };
  const auto [all, all_bytes] = plan_of([](scene::Scene&) {});
  const std::tuple<const char*, const char*, std::function<void(scene::Scene&)>> terms[] = {
      {"shadows", "eye sun shadows", [](scene::Scene& s) { s.sun->shadows.reset(); }},
      {"caustics", "caustics", [](scene::Scene& s) { s.sun->caustics.reset(); }},
      {"occlusion", "ambient occlusion", [](scene::Scene& s) { s.ambient.reset(); }},
      {"skylight", "skylight", [](scene::Scene& s) { s.ambient->skylight.reset(); }},
      {"forward scatter", "forward scatter",
       [](scene::Scene& s) { s.water->forward_scatter.reset(); }},
      {"particles", "particles",
       [](scene::Scene& s) {
         s.water->snow.reset();
         s.water->bubbles.clear();
         s.water->silt.clear();
       }},
      {"lamp shadows", "lamp shadows", [](scene::Scene& s) { s.lamps[0].shadows = false; }},
  };
  for (const auto& [name, pass, without] : terms) {
    EXPECT_NE(all.find(pass), std::string::npos) << name;
    const auto [plan, bytes] = plan_of(without);
    EXPECT_EQ(plan.find(pass), std::string::npos) << name;
    EXPECT_LE(bytes, all_bytes) << name;
  }
}

}  // namespace
}  // namespace neritic::testbed
