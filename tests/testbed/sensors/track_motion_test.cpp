// Motion on tracks: cameras, lamps, sonars and their loads are where the track says at the
// frame's time, and motion images tell where each pixel's point is at the next frame's.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/core/intrinsics.hpp"
#include "engine/render/lighting.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint32_t kTrackImageSize =
    81;  // odd: the middle pixel's centre lies on the optical axis
constexpr double kTrackSpeed_m_s = 2.0;

scene::Object object_of(const char* name, int model, const Vec3& position_m) {
  scene::Object object;
  object.name = name;
  object.model = model;
  object.mount.pose.position_m = position_m;
  object.class_id = object.instance = static_cast<std::uint16_t>(model + 1);
  return object;
}

// A ship that heads north (-z) towards a wall whose face is at z = -20, with a ball ahead of its
// bow that it carries, a camera, a sonar and a lamp; a fish that crosses.
scene::Scene scene_with_tracks(const Vec3& offset_m = Vec3(0.0)) {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{};
  for (const auto& model : {scene::make_sphere(0.2), scene::make_box({60.0, 60.0, 1.0}),
                            scene::make_sphere(0.3), scene::make_sphere(0.1)})
    scene.models.push_back(std::make_shared<scene::Model>(model));
  scene.objects = {object_of("ball", 0, {0.8, 0.0, -3.0}),
                   object_of("wall", 1, offset_m + Vec3(0, -5, -20.5)), object_of("fish", 2, {}),
                   object_of("ship", 3, {})};
  const auto course = [](std::vector<Vec3> points, const scene::TrackHeading& heading) {
    return scene::track_of(scene::places_of({std::move(points), kTrackSpeed_m_s, 0.0}), heading);
  };
  scene.objects[2].mount.track =
      course({offset_m + Vec3(-3, -5.5, -9), offset_m + Vec3(9, -5.5, -9)}, {});
  scene.objects[3].mount.track =
      course({offset_m + Vec3(0, -5, 0), offset_m + Vec3(0, -5, -4), offset_m + Vec3(4, -5, -4)},
             {.turn_m = 2.0});
  scene.objects[0].mount.object = 3;
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = kTrackImageSize;
  camera.mount.object = 3;
  camera.mount.pose.position_m = {0.0, 0.0, -0.5};
  scene.cameras.push_back(camera);
  scene::Sonar sonar;
  sonar.name = "sonar";
  sonar.range_min_m = 12.0;
  sonar.range_max_m = 22.0;
  sonar.azimuth_rad = radians(20.0);
  sonar.elevation_rad = radians(10.0);
  sonar.bins_range = 200;
  sonar.bins_azimuth = sonar.bins_elevation = 21;
  sonar.mount = camera.mount;
  scene.sonars.push_back(sonar);
  scene::Lamp lamp;
  lamp.mount = camera.mount;
  scene.lamps.push_back(lamp);
  return scene;
}

FrameRequest request_at(double time_s, double next_time_s) {
  FrameRequest request;
  request.time_s = time_s;
  request.next_time_s = next_time_s;
  request.cameras = {0};
  request.sonars = {0};
  return request;
}

class TrackMotion : public test::GpuTest {
 protected:
  ViewImages view_at(Session& session, double time_s, double next_time_s) {
    auto result = session.render(request_at(time_s, next_time_s));
    EXPECT_TRUE(result.ok());
    return result.ok() ? std::move(result->cameras[0].eyes[0]) : ViewImages{};
  }
};

// The pixel that a point of the view frame falls on.
glm::dvec2 pixel_of(const Intrinsics& k, const Vec3& p) {
  return {k.cx + k.fx * p.x / -p.z, k.cy - k.fy * p.y / -p.z};
}

// Compares every pixel's motion with its point moved by its object's pose and seen from the next
// view. Returns how many pixels of each label were compared.
std::vector<std::size_t> compare_motion(const scene::Scene& scene, const ViewImages& eye,
                                        double time_s, double next_time_s) {
  const Pose world_from_view = scene.world_from(scene.cameras[0].mount, time_s);
  const Pose next_view_from_world = inverse(scene.world_from(scene.cameras[0].mount, next_time_s));
  std::vector<std::size_t> compared(scene.objects.size() + 1, 0);
  for (std::uint32_t y = 0; y < kTrackImageSize; ++y)
    for (std::uint32_t x = 0; x < kTrackImageSize; ++x) {
      const std::uint16_t label = eye.labels.at(x, y);
      if (label == 0) {
        // Infinitely far: only the view's turn moves it.
        const Vec3 ray((x + 0.5 - eye.intrinsics.cx) / eye.intrinsics.fx,
                       (eye.intrinsics.cy - y - 0.5) / eye.intrinsics.fy, -1.0);
        const glm::dvec2 next = pixel_of(
            eye.intrinsics, next_view_from_world.rotation * (world_from_view.rotation * ray));
        EXPECT_NEAR(eye.motion.at(x, y, 0), next.x - x - 0.5, 0.02) << x << ' ' << y;
        EXPECT_NEAR(eye.motion.at(x, y, 1), next.y - y - 0.5, 0.02) << x << ' ' << y;
        ++compared[0];
        continue;
      }
      const scene::Mount& mount = scene.objects[label - 1u].mount;
      const double depth = eye.depth.at(x, y);
      const glm::dvec2 pixel(x + 0.5, y + 0.5);
      const Vec3 in_view((pixel.x - eye.intrinsics.cx) / eye.intrinsics.fx * depth,
                         -(pixel.y - eye.intrinsics.cy) / eye.intrinsics.fy * depth, -depth);
      const Pose moved =
          scene.world_from(mount, next_time_s) * inverse(scene.world_from(mount, time_s));
      const glm::dvec2 next =
          pixel_of(eye.intrinsics, next_view_from_world * (moved * (world_from_view * in_view)));
      EXPECT_NEAR(eye.motion.at(x, y, 0), next.x - pixel.x, 0.02) << x << ' ' << y;
      EXPECT_NEAR(eye.motion.at(x, y, 1), next.y - pixel.y, 0.02) << x << ' ' << y;
      ++compared[label];
    }
  return compared;
}

TEST_F(TrackMotion, IsWhereEachPixelsPointIsAtTheNextFrame) {
  for (const Vec3& offset : {Vec3(0.0), Vec3(1e5, 0.0, -1e5)}) {
    scene::Scene scene = scene_with_tracks(offset);
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
    // Straight ahead, and in the middle of the turn.
    for (const auto& [time_s, step_s] : {std::pair(0.7, 0.1), std::pair(1.9, 0.05)}) {
      const ViewImages eye = view_at(*session, time_s, time_s + step_s);
      const auto compared = compare_motion(scene, eye, time_s, time_s + step_s);
      EXPECT_GT(compared[1], 10u);
      EXPECT_GT(compared[2], 1000u);
      if (time_s < 1.0) {
        EXPECT_GT(compared[3], 10u);
      } else {
        EXPECT_GT(compared[0], 400u);  // the background, in the turn
      }
    }
  }
}

TEST_F(TrackMotion, ACarriedThingStandsStillInItsCarriersCameraAndTheWallComesNearer) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene_with_tracks()));
  for (const double time_s : {0.2, 0.9, 1.3}) {  // before the turn
    const ViewImages eye = view_at(*session, time_s, time_s + 0.1);
    const std::uint32_t middle = kTrackImageSize / 2;
    ASSERT_EQ(eye.labels.at(middle, middle), 2);
    const double wall_m = 20.0 - 0.5 - kTrackSpeed_m_s * time_s;
    EXPECT_NEAR(eye.depth.at(middle, middle), wall_m, 1e-3);
    // A point off the axis runs outwards as the wall comes nearer.
    const double off_px = 0.5 - eye.intrinsics.cx + 3;
    EXPECT_NEAR(eye.motion.at(3, middle, 0),
                off_px * (wall_m / (wall_m - 0.1 * kTrackSpeed_m_s) - 1.0), 2e-3);
    std::size_t ball = 0;
    for (std::size_t i = 0; i < eye.labels.data.size(); ++i) {
      if (eye.labels.data[i] != 1) continue;
      ASSERT_NEAR(eye.motion.data[2 * i], 0.0, 2e-3);
      ASSERT_NEAR(eye.motion.data[2 * i + 1], 0.0, 2e-3);
      ++ball;
    }
    EXPECT_GT(ball, 10u);
  }
}

TEST_F(TrackMotion, ASonarHearsFromWhereItsCarrierIs) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene_with_tracks()));
  for (const double time_s : {0.0, 0.5, 1.3}) {
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request_at(time_s, time_s)));
    const sonar::SonarImage& image = result.sonars[0].image;
    const sonar::BeamGrid& grid = result.sonars[0].grid;
    const std::uint32_t beam = grid.bins.azimuth / 2;
    std::uint32_t loudest = 0;
    for (std::uint32_t row = 0; row < grid.bins.range; ++row)
      if (image.intensity[row * grid.bins.azimuth + beam] >
          image.intensity[loudest * grid.bins.azimuth + beam])
        loudest = row;
    EXPECT_NEAR(grid.range_m(loudest), 19.5 - kTrackSpeed_m_s * time_s, grid.range_step_m())
        << time_s;
  }
}

TEST(TrackLight, ALampShinesFromWhereItsCarrierIs) {
  const scene::Scene scene = scene_with_tracks();
  for (const auto& [time_s, wanted] :
       {std::pair(0.5, Vec3f(0, 0, -1.5)), std::pair(10.0, Vec3f(4.5, 0, -4))}) {
    render::FrameState state;
    state.world_from_lamp = {scene.world_from(scene.lamps[0].mount, time_s)};
    const auto light = render::make_lighting(scene, state, Vec3(0, -5, 0), {}, false);
    ASSERT_TRUE(light.ok());
    EXPECT_LT(glm::distance(Vec3f(light->lamps[0].position), wanted), 1e-5f);
  }
}

}  // namespace
}  // namespace neritic::testbed
