// The camera that the user of `dive` flies.
#include <gtest/gtest.h>

#include "testbed/view/dive_camera.hpp"

namespace neritic::testbed {
namespace {

void expect_near(const Vec3& a, const Vec3& b, double tolerance) {
  EXPECT_LT(glm::length(a - b), tolerance)
      << a.x << " " << a.y << " " << a.z << " against " << b.x << " " << b.y << " " << b.z;
}

TEST(FreeCamera, StartsWithTheEyesOfTheSceneCamera) {
  for (const Vec3& target : {Vec3(1, 2, 3), Vec3(-4, 0, 1), Vec3(0, -3, 5), Vec3(2, 0.1, -7)}) {
    const Pose pose = look_at(Vec3(0.5, -2.0, 0.25), target);
    const Pose started = FreeCamera(pose).world_from_view();
    expect_near(started.position_m, pose.position_m, 1e-12);
    for (const Vec3& axis : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, -1)})
      expect_near(started.rotation * axis, pose.rotation * axis, 1e-9);
  }
}

TEST(FreeCamera, AheadIsWhereItLooksAndUpIsTheWorlds) {
  const Vec3 eye(3, -2, 1), target(6, -6, 1);  // ahead (0.6, -0.8, 0)
  FreeCamera camera(look_at(eye, target));
  DiveInput input;
  input.move = {0, 0, -1};
  for (int i = 0; i < 20; ++i) camera.update(input, 0.05);
  expect_near(camera.position_m(), eye + Vec3(0.6, -0.8, 0.0) * camera.speed_m_s(), 1e-9);
  camera.start_at(look_at(eye, target));
  input.move = {0, 1, 0};
  camera.update(input, 0.1);
  expect_near(camera.position_m(), eye + Vec3(0, 0.1 * camera.speed_m_s(), 0), 1e-9);
}

TEST(FreeCamera, MouseToTheRightTurnsTheHeadingEastOfNorth) {
  FreeCamera camera(Pose{});  // faces -z, north
  EXPECT_NEAR(camera.heading_deg(), 0.0, 1e-9);
  DiveInput input;
  input.look_px = {100, 0};
  camera.update(input, 0.01);
  EXPECT_GT(camera.heading_deg(), 5.0);
  EXPECT_LT(camera.heading_deg(), 90.0);
  EXPECT_GT((camera.world_from_view().rotation * Vec3(0, 0, -1)).x, 0.0);
}

TEST(FreeCamera, NeverTurnsOverAndAHitchDoesNotThrowIt) {
  FreeCamera camera(Pose{});
  DiveInput input;
  input.look_px = {0, -1e5};
  camera.update(input, 0.01);
  EXPECT_LT(degrees(camera.pitch_rad()), 90.0);
  EXPECT_GT((camera.world_from_view().rotation * Vec3(0, 1, 0)).y, 0.0);
  input = {};
  input.move = {1, 0, 0};
  camera.update(input, 3600.0);
  EXPECT_LE(glm::length(camera.position_m()), camera.speed_m_s());
}

TEST(CameraForScene, WithoutOneLooksAtTheMiddleOfWhatIsThere) {
  auto model = std::make_shared<scene::Model>();
  scene::Primitive primitive;
  primitive.positions = {{-1, -1, -1}, {1, 1, 1}, {1, -1, 1}};
  for (const Vec3f& p : primitive.positions) primitive.bounds.add(Vec3(p));
  primitive.indices = {0, 1, 2};
  model->meshes = {scene::Mesh{"m", {primitive}, {}}};
  scene::Node node;
  node.mesh = 0;
  model->nodes = {node};
  model->roots = {0};
  scene::Scene scene;
  scene.models = {model};
  scene::Object object;
  object.model = 0;
  object.mount.pose.position_m = {20, -8, 4};
  scene.objects = {object};
  const Pose pose = scene.world_from(camera_for(scene).mount);
  const Vec3 ahead = pose.rotation * Vec3(0, 0, -1);
  expect_near(ahead, glm::normalize(Vec3(20, -8, 4) - pose.position_m), 1e-9);
  EXPECT_GT(glm::length(Vec3(20, -8, 4) - pose.position_m), 1.8);
}

// Level, behind and above, at what the sonar sees; on a track it rides along.
TEST(CameraForScene, OfSonarsAloneLooksWhereTheFirstOneDoes) {
  scene::Scene scene;
  scene.sonars.resize(1);
  scene::Mount& mount = scene.sonars[0].mount;
  mount.pose = {Vec3(3, -2, 1), from_yaw_pitch_roll(radians(90.0), radians(-90.0), 0.0)};
  const Vec3 along(-1, 0, 0);
  Pose pose = scene.world_from(camera_for(scene).mount);
  expect_near(pose.rotation * Vec3(1, 0, 0), Vec3(0, 0, -1), 1e-9);
  EXPECT_GT(glm::dot(pose.rotation * Vec3(0, 0, -1), along), 0.7);
  EXPECT_LT((pose.rotation * Vec3(0, 0, -1)).y, -0.3);
  mount.track = scene::track_of(scene::places_of({{{0, -2, 0}, {-20, -2, 0}}, 2.0}),
                                {.rotation = from_yaw_pitch_roll(0.0, radians(-90.0), 0.0)});
  pose = scene.world_from(camera_for(scene).mount, 5.0);
  EXPECT_NEAR(pose.position_m.x, -10.0, 1e-9);
  EXPECT_GT(pose.position_m.y, -2.0);
  EXPECT_GT(glm::dot(pose.rotation * Vec3(0, 0, -1), along), 0.7);
}

}  // namespace
}  // namespace neritic::testbed
