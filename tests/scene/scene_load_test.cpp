// Good scene files load with the values they name: units, defaults, includes, mounts.
#include <gtest/gtest.h>

#include "engine/scene/scene_keys.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

TEST(SceneLoad, AnEmptyFileIsAnEmptyScene) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, "");
  EXPECT_TRUE(scene.objects.empty() && scene.models.empty() && scene.cameras.empty());
  EXPECT_TRUE(scene.sonars.empty() && scene.lamps.empty());
  EXPECT_FALSE(scene.sun.has_value());
  EXPECT_FALSE(scene.water.has_value());
  EXPECT_EQ(scene.seed, 1u);
  EXPECT_EQ(scene.class_names.at(4), "diver");
}

TEST(SceneLoad, TablesCarryTheirValuesInSiUnits) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
title = "Test"
seed = 77
[classes]
net = 40
[sun]
elevation_deg = 30
azimuth_deg = -90
intensity = 0.5
[water]
type = "5C"
scattering = true
surface = true
[[objects]]
shape = "box"
size_m = [1, 2, 3]
color = [0.1, 0.2, 0.3]
roughness = 0.25
metallic = 0.75
double_sided = true
class = "net"
reflectivity = 0.5
position_m = [1, -2, 3.5]
yaw_deg = 90
scale = [1, 2, 1]
[[cameras]]
width = 640
height = 480
fov_deg = 45
near_m = 0.2
rate_hz = 5
stereo_baseline_m = 0.12
exposure = 3
exposure_compensation_ev = 0.5
[[sonars]]
range_m = [0, 20]
azimuth_deg = 130
elevation_deg = 20
bins = [100, 200, 300]
gbuffer_scale = 0.5
gather = "nearest"
rate_hz = 4
near_m = 0.1
[[lamps]]
color = [1, 0.9, 0.8]
intensity_cd = 2500
cone_deg = [10, 30]
)");
  EXPECT_EQ(scene.title, "Test");
  EXPECT_EQ(scene.seed, 77u);
  EXPECT_EQ(scene.class_names.at(40), "net");
  ASSERT_TRUE(scene.sun && scene.water);
  EXPECT_DOUBLE_EQ(scene.sun->elevation_rad, kPi / 6.0);
  EXPECT_DOUBLE_EQ(scene.sun->azimuth_rad, -kPi / 2.0);
  EXPECT_EQ(scene.sun->intensity, 0.5);
  EXPECT_EQ(scene.water->type, "5C");
  EXPECT_TRUE(scene.water->scattering && scene.water->surface);
  ASSERT_EQ(scene.objects.size(), 1u);
  const Object& object = scene.objects[0];
  EXPECT_EQ(object.name, "object_0");
  EXPECT_EQ(object.class_id, 40);
  EXPECT_EQ(object.instance, 1);
  EXPECT_EQ(object.reflectivity, 0.5f);
  EXPECT_EQ(object.scale, Vec3(1, 2, 1));
  expect_near(object.mount.pose.position_m, {1, -2, 3.5});
  expect_near(forward_of(object.mount.pose), {-1, 0, 0});  // yaw turns to port
  const Model& model = *scene.models.at(0);
  EXPECT_EQ(model.meshes[0].primitives[0].bounds.max, Vec3(0.5, 1.0, 1.5));
  EXPECT_EQ(model.materials.at(0).base_color, Vec4f(0.1f, 0.2f, 0.3f, 1.0f));
  EXPECT_EQ(model.materials[0].roughness, 0.25f);
  EXPECT_EQ(model.materials[0].metallic, 0.75f);
  EXPECT_TRUE(model.materials[0].double_sided);
  const Camera& camera = scene.cameras.at(0);
  EXPECT_EQ(camera.name, "camera");
  EXPECT_EQ(camera.width, 640u);
  EXPECT_EQ(camera.height, 480u);
  EXPECT_DOUBLE_EQ(camera.vertical_fov_rad, kPi / 4.0);
  EXPECT_EQ(camera.near_m, 0.2);
  EXPECT_EQ(camera.rate_hz, 5.0);
  EXPECT_EQ(camera.stereo_baseline_m, 0.12);
  EXPECT_EQ(camera.exposure.fixed_ev, 3.0);
  EXPECT_EQ(camera.exposure.compensation_ev, 0.5);
  const Sonar& sonar = scene.sonars.at(0);
  EXPECT_EQ(sonar.range_min_m, 0.0);
  EXPECT_EQ(sonar.range_max_m, 20.0);
  EXPECT_DOUBLE_EQ(sonar.azimuth_rad, radians(130.0));
  EXPECT_DOUBLE_EQ(sonar.elevation_rad, radians(20.0));
  EXPECT_EQ(sonar.bins_range, 100u);
  EXPECT_EQ(sonar.bins_azimuth, 200u);
  EXPECT_EQ(sonar.bins_elevation, 300u);
  EXPECT_EQ(sonar.gbuffer_scale, 0.5);
  EXPECT_EQ(sonar.gather, "nearest");
  EXPECT_EQ(sonar.rate_hz, 4.0);
  EXPECT_EQ(sonar.near_m, 0.1);
  const Lamp& lamp = scene.lamps.at(0);
  EXPECT_EQ(lamp.color, Vec3f(1.0f, 0.9f, 0.8f));
  EXPECT_EQ(lamp.intensity_cd, 2500.0);
  EXPECT_DOUBLE_EQ(lamp.inner_cone_rad, radians(10.0));
  EXPECT_DOUBLE_EQ(lamp.outer_cone_rad, radians(30.0));
}

TEST(SceneLoad, DefaultsAreThePublishedOnes) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, "[[sonars]]\n[[cameras]]\n[[lamps]]\n[water]\n[sun]\n");
  const Sonar sonar;  // the contract's defaults
  EXPECT_EQ(scene.sonars[0].range_min_m, sonar.range_min_m);
  EXPECT_EQ(scene.sonars[0].range_max_m, sonar.range_max_m);
  EXPECT_EQ(scene.sonars[0].azimuth_rad, sonar.azimuth_rad);
  EXPECT_EQ(scene.sonars[0].elevation_rad, sonar.elevation_rad);
  EXPECT_EQ(scene.sonars[0].bins_range, 500u);
  EXPECT_EQ(scene.sonars[0].gather, "");
  EXPECT_EQ(scene.cameras[0].width, 1280u);
  EXPECT_EQ(scene.cameras[0].vertical_fov_rad, Camera{}.vertical_fov_rad);
  EXPECT_FALSE(scene.cameras[0].exposure.fixed_ev.has_value());
  EXPECT_EQ(scene.water->type, "II");
  EXPECT_FALSE(scene.water->scattering || scene.water->surface);
}

TEST(SceneLoad, VehiclesTakeTheirSensorsFromAFileAndOverrideThem) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "sensor.toml", "range_m = [2, 8]\nazimuth_deg = 60\n").ok());
  ASSERT_TRUE(write_text(scratch / "rov.toml", R"(
shape = "box"
size_m = [0.5, 0.3, 0.6]
[[sonars]]
name = "imaging"
include = "sensor.toml"
azimuth_deg = 70
position_m = [0, -0.1, -0.2]
[[lamps]]
name = "left"
)")
                  .ok());
  const Scene scene = scene_of(scratch, R"(
[[vehicles]]
include = "rov.toml"
name = "alpha"
position_m = [10, -5, 0]
yaw_deg = 90
[[vehicles.sonars]]
name = "imaging"
elevation_deg = 12
[[vehicles.cameras]]
name = "front"
[[vehicles]]
include = "rov.toml"
name = "beta"
)");
  ASSERT_EQ(scene.objects.size(), 2u);
  EXPECT_EQ(scene.objects[0].name, "alpha");
  EXPECT_EQ(scene.objects[0].class_id, 5);  // rov
  EXPECT_EQ(scene.models.size(), 1u);       // the same box twice is one model
  ASSERT_EQ(scene.sonars.size(), 2u);
  const Sonar& sonar = scene.sonars[0];
  EXPECT_EQ(sonar.name, "alpha_imaging");
  EXPECT_EQ(sonar.range_max_m, 8.0);                     // the sensor file's
  EXPECT_DOUBLE_EQ(sonar.azimuth_rad, radians(70.0));    // the vehicle file's
  EXPECT_DOUBLE_EQ(sonar.elevation_rad, radians(12.0));  // the scene's
  EXPECT_DOUBLE_EQ(scene.sonars[1].elevation_rad, radians(28.0));
  EXPECT_EQ(sonar.mount.object, 0);
  EXPECT_EQ(scene.sonars[1].mount.object, 1);
  EXPECT_EQ(scene.cameras.at(0).name, "alpha_front");
  EXPECT_EQ(scene.lamps.at(1).name, "beta_left");
  // Yaw 90 turns -Z to -X: 0.2 m ahead is at x = 9.8.
  const Pose world = scene.world_from(sonar.mount);
  expect_near(world.position_m, {9.8, -5.1, 0.0});
  expect_near(forward_of(world), {-1, 0, 0});
}

TEST(SceneLoad, MountsChain) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[objects]]
name = "tip"
shape = "sphere"
on = "arm"
position_m = [0, 0, -2]
[[objects]]
name = "arm"
shape = "sphere"
on = "base"
position_m = [0, 1, 0]
pitch_deg = 90
[[objects]]
name = "base"
shape = "sphere"
position_m = [5, 0, 0]
yaw_deg = -90
[[cameras]]
on = "tip"
position_m = [0, 0, -1]
)");
  // Yaw -90: -Z becomes +X. Pitch 90: ahead becomes up. So the camera is 3 m above the arm.
  const Pose world = scene.world_from(scene.cameras[0].mount);
  expect_near(world.position_m, {5, 4, 0});
  expect_near(forward_of(world), {0, 1, 0});
}

TEST(SceneLoad, ThingsLookAtEachOther) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, R"(
[[objects]]
name = "rov"
shape = "box"
position_m = [3, -8, 1]
look_at = "diver"
[[objects]]
name = "diver"
shape = "box"
position_m = [0, -7, 5]
look_at = "rov"
[[cameras]]
on = "rov"
position_m = [0.5, 0, 0]
look_at = "diver"
[[lamps]]
position_m = [0, -2, 5]
look_at_m = [0, -7, 5]
)");
  const Vec3 rov(3, -8, 1), diver(0, -7, 5);
  expect_near(forward_of(scene.objects[0].mount.pose), glm::normalize(diver - rov));
  expect_near(forward_of(scene.objects[1].mount.pose), glm::normalize(rov - diver));
  const Pose camera = scene.world_from(scene.cameras[0].mount);
  expect_near(forward_of(camera), glm::normalize(diver - camera.position_m));
  expect_near(forward_of(scene.lamps[0].mount.pose), {0, -1, 0});
}

}  // namespace
}  // namespace neritic::scene
