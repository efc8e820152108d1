// Good scene files load with the values they name: units, defaults, includes, mounts, copies,
// scattering, models shared and loaded once.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/scene_keys.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

// The scene of text; the test fails with its message where it does not load.
Scene scene_of(const test::ScratchFolder& scratch, const std::string& text,
               const SceneOptions& options = {}) {
  EXPECT_TRUE(write_text(scratch / "s.toml", text).ok());
  auto scene = load_scene(scratch / "s.toml", options);
  if (scene.ok()) return std::move(scene).value();
  ADD_FAILURE() << scene.error().message;
  return {};
}

void expect_near(const Vec3& a, const Vec3& b, double tolerance = 1e-9) {
  EXPECT_NEAR(glm::length(a - b), 0.0, tolerance)
      << a.x << ' ' << a.y << ' ' << a.z << " against " << b.x << ' ' << b.y << ' ' << b.z;
}

Vec3 forward_of(const Pose& pose) {
  return pose.rotation * Vec3(0, 0, -1);
}

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

constexpr const char* kWorldOfThree = R"(
[[objects]]
name = "a"
shape = "sphere"
position_m = [1, 2, 3]
copies = [[0, 0, 0], [1, 0, 0, 90], [2, 0, 0, 0, 3]]
scale = 2
[[objects]]
name = "b"
shape = "box"
on = "a"
position_m = [1, 0, 0]
[[cameras]]
position_m = [0.1, 0.2, 0.3]
look_at = "b"
)";

TEST(SceneLoad, CopiesCarryPlaceTurnAndScaleAndEachItsLabel) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kWorldOfThree);
  const Object& a = scene.objects[0];
  ASSERT_EQ(a.instance_count(), 3u);
  EXPECT_EQ(a.instance, 1);
  EXPECT_EQ(scene.objects[1].instance, 4);
  EXPECT_EQ(a.scale, Vec3(1.0));  // held by the copies
  const auto point = [&](std::size_t copy, const Vec3& p) {
    return Vec3(scene.world_from_copy(a, copy) * Vec4(p, 1.0));
  };
  expect_near(point(0, {0, 0, -1}), {1, 2, 1});
  expect_near(point(1, {0, 0, -1}), {0, 2, 3});
  expect_near(point(2, {0, 0, -1}), {3, 2, -3});
  EXPECT_EQ(scene.world_from_copy(scene.objects[1], 0)[3], Vec4(2, 2, 3, 1));
}

TEST(SceneLoad, AnOffsetMovesWhatIsFixedToTheWorldAndNothingElse) {
  const test::ScratchFolder scratch;
  const Vec3 offset(100000.0, 0.0, -100000.0);
  const Scene here = scene_of(scratch, kWorldOfThree);
  const Scene there = scene_of(scratch, kWorldOfThree, {offset});
  expect_near(there.objects[0].mount.pose.position_m, Vec3(1, 2, 3) + offset);
  EXPECT_EQ(there.objects[1].mount.pose.position_m, here.objects[1].mount.pose.position_m);
  EXPECT_EQ(there.objects[0].copies, here.objects[0].copies);
  EXPECT_EQ(there.cameras[0].mount.pose.rotation, here.cameras[0].mount.pose.rotation);
  expect_near(there.world_from(there.objects[1].mount).position_m, Vec3(2, 2, 3) + offset);
}

TEST(SceneLoad, CopiesComeFromACsvFile) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(
      write_text(scratch / "c.csv", "x,y,z,yaw\r\n# first\n1, 2,3 , 90\r\n\n4,5,6 # last").ok());
  const Scene scene =
      scene_of(scratch, "[[objects]]\nshape = 'sphere'\ncopies_file = 'c.csv'\nscale = 2");
  ASSERT_EQ(scene.objects[0].copies.size(), 2u);
  expect_near(Vec3(scene.objects[0].copies[0] * Vec4(0, 0, -1, 1)), {-1, 2, 3});
  ASSERT_TRUE(write_text(scratch / "c.csv", "1,2,3\n1,2,x").ok());
  const auto bad = load_scene(scratch / "s.toml");
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().message.find("c.csv:2: found 'x'; accepted: a number"), std::string::npos)
      << bad.error().message;
}

constexpr const char* kHill = R"(
seed = 5
[[objects]]
name = "hill"
terrain = "hill.npy"
cell_m = 2.0
position_m = [10, -20, 0]
[[objects]]
name = "rock"
shape = "sphere"
scatter = {count = 200, area_m = [0, -9, 20, 9], on = "hill", scale = [0.5, 2], sink_m = 0.1, keep_out_m = [[10, 0, 4]]}
[[objects]]
name = "stone"
shape = "sphere"
scatter = {count = 50, area_m = [0, -9, 20, 9], on = "hill", align = "surface"}
)";

// A plane that rises by 0.5 m a metre eastwards: y = 0.5 x.
void write_hill(const test::ScratchFolder& scratch) {
  std::vector<float> heights;
  for (int row = 0; row < 11; ++row)
    for (int column = 0; column < 11; ++column)
      heights.push_back(static_cast<float>(0.5 * 2.0 * (column - 5)));
  ASSERT_TRUE(write_npy(scratch / "hill.npy", heights, {11, 11}).ok());
}

TEST(SceneScatter, StandsOnTheSurfaceInsideTheAreaAndOutsideTheKeepOut) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  const Scene scene = scene_of(scratch, kHill);
  ASSERT_EQ(scene.objects.at(1).copies.size(), 200u);
  double smallest = 9.0, largest = 0.0;
  for (const Mat4& copy : scene.objects[1].copies) {
    const Vec3 p(copy[3]);
    const double scale = glm::length(Vec3(copy[0]));
    EXPECT_TRUE(p.x >= 0 && p.x <= 20 && p.z >= -9 && p.z <= 9);
    EXPECT_GE(std::hypot(p.x - 10, p.z), 4.0);
    EXPECT_NEAR(p.y, -20.0 + 0.5 * (p.x - 10.0) - 0.1 * scale, 1e-6);
    smallest = std::min(smallest, scale);
    largest = std::max(largest, scale);
  }
  EXPECT_GE(smallest, 0.5);
  EXPECT_LE(largest, 2.0);
  EXPECT_LT(smallest, 0.6);  // of 200 draws
  EXPECT_GT(largest, 1.9);
  const Vec3 normal = glm::normalize(Vec3(-0.5, 1.0, 0.0));
  for (const Mat4& copy : scene.objects[2].copies) expect_near(Vec3(copy[1]), normal, 1e-6);
}

TEST(SceneScatter, TheSameSeedGivesTheSamePlacesAndAnotherSeedOthers) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  const Scene first = scene_of(scratch, kHill), second = scene_of(scratch, kHill);
  EXPECT_EQ(first.objects.at(1).copies, second.objects.at(1).copies);
  std::string other_seed = kHill;
  other_seed.replace(other_seed.find("seed = 5"), 8, "seed = 6");
  EXPECT_NE(scene_of(scratch, other_seed).objects.at(1).copies, first.objects[1].copies);
  // More copies leave the first ones where they are.
  std::string more = kHill;
  more.replace(more.find("count = 200"), 11, "count = 300");
  const Scene third = scene_of(scratch, more);
  EXPECT_TRUE(std::equal(first.objects[1].copies.begin(), first.objects[1].copies.end(),
                         third.objects.at(1).copies.begin()));
}

TEST(SceneScatter, ASurfaceThatDoesNotCoverTheAreaIsRefused) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  ASSERT_TRUE(write_text(scratch / "s.toml",
                         "[[objects]]\nname = 'hill'\nterrain = 'hill.npy'\ncell_m = 1\n"
                         "[[objects]]\nshape = 'box'\n"
                         "scatter = {area_m = [50, 50, 60, 60], on = 'hill'}")
                  .ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_NE(scene.error().message.find("copy 0 of 1 found no place"), std::string::npos);
}

TEST(SceneModels, AFileUsedTwiceIsLoadedOnceAndInTheOrderOfFirstUse) {
  const std::filesystem::path models = test::source_dir() / "assets/models";
  const test::ScratchFolder scratch;
  const std::string text = fmt::format(R"(
[[objects]]
model = "{0}/rocks.glb"
node = "rock_1"
[[objects]]
model = "{0}/diver.glb"
clip = "hover"
[[objects]]
model = "{0}/../models/diver.glb"
clip = "swim"
[[objects]]
model = "{0}/rocks.glb"
node = "rock_1"
[[objects]]
shape = "sphere"
)",
                                       models.string());
  const Scene scene = scene_of(scratch, text);
  ASSERT_EQ(scene.models.size(), 3u);
  EXPECT_EQ(scene.objects[0].model, 0);
  EXPECT_EQ(scene.objects[1].model, 1);
  EXPECT_EQ(scene.objects[2].model, 1);
  EXPECT_EQ(scene.objects[3].model, 0);
  EXPECT_EQ(scene.objects[4].model, 2);
  EXPECT_EQ(scene.models[1]->clips.at(scene.objects[1].clip).name, "hover");
  EXPECT_EQ(scene.models[1]->clips.at(scene.objects[2].clip).name, "swim");
}

TEST(SceneModels, ANamedNodeIsTakenAloneAndBroughtToTheOrigin) {
  const std::string rocks = (test::source_dir() / "assets/models/rocks.glb").string();
  const test::ScratchFolder scratch;
  const Scene scene =
      scene_of(scratch, fmt::format("[[objects]]\nmodel = '{}'\nnode = 'rock_2'", rocks));
  const Model& rock = *scene.models.at(0);
  ASSERT_EQ(rock.meshes.size(), 1u);
  ASSERT_EQ(rock.roots.size(), 1u);
  const Node& node = rock.nodes.at(rock.roots[0]);
  EXPECT_EQ(node.name, "rock_2");
  EXPECT_EQ(node.mesh, 0);
  EXPECT_EQ(node.translation_m, Vec3(0.0));
  for (const Primitive& primitive : rock.meshes[0].primitives)
    ASSERT_LT(primitive.material, static_cast<int>(rock.materials.size()));
  ASSERT_TRUE(write_text(scratch / "s.toml",
                         fmt::format("[[objects]]\nmodel = '{}'\nnode = 'rock_7'", rocks))
                  .ok());
  const auto bad = load_scene(scratch / "s.toml");
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().message.find("accepted: a node of the file (nearest: \"rock_0\")"),
            std::string::npos)
      << bad.error().message;
}

TEST(SceneModels, ATerrainWithANormalMapHasTangentsAlongX) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  ImageU8 flat(2, 2, 3, 128);
  ASSERT_TRUE(write_png8(scratch / "n.png", flat).ok());
  const Scene scene =
      scene_of(scratch,
               "[[objects]]\nterrain = 'hill.npy'\ncell_m = 2\nnormal_texture = 'n.png'\n"
               "color_texture = 'n.png'");
  const Model& model = *scene.models.at(0);
  const Primitive& p = model.meshes[0].primitives[0];
  ASSERT_EQ(p.tangents.size(), p.positions.size());
  // The slope rises by a half: along x it climbs at that angle.
  const Vec3 along = glm::normalize(Vec3(1.0, 0.5, 0.0));
  for (const Vec4f& tangent : p.tangents) {
    expect_near(Vec3(tangent), along, 1e-6);
    EXPECT_EQ(tangent.w, 1.0f);
  }
  EXPECT_EQ(model.images.size(), 2u);
  EXPECT_EQ(model.textures.at(model.materials[0].normal_texture.texture).image, 1);
  EXPECT_EQ(model.textures.at(model.materials[0].base_color_texture.texture).image, 0);
}

TEST(SceneModels, AFileThatDoesNotLoadIsNamedWithTheLineThatAsksForIt) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "bad.glb", "not a model").ok());
  ASSERT_TRUE(write_text(scratch / "s.toml", "[[objects]]\nmodel = 'bad.glb'").ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_EQ(scene.error().code, ErrorCode::kBadInput);
  EXPECT_NE(scene.error().message.find("s.toml:2: objects[0].model: "), std::string::npos)
      << scene.error().message;
}

// What the picture of a scene_of_model shows of the bounds: the largest |x|, |y| in the picture's
// halves, and whether all lies ahead of the near plane.
struct Framing {
  double reach = 0.0;
  bool ahead = true;
};

Framing framing_of(const Scene& scene, const Bounds& bounds) {
  const Camera& camera = scene.cameras.at(0);
  const Pose view_from_world = inverse(scene.world_from(camera.mount));
  const FrustumTangents t =
      tangents_from_fov(camera.vertical_fov_rad, static_cast<double>(camera.width) / camera.height);
  Framing framing;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 p = view_from_world * Vec3((corner & 1 ? bounds.max : bounds.min).x,
                                          (corner & 2 ? bounds.max : bounds.min).y,
                                          (corner & 4 ? bounds.max : bounds.min).z);
    framing.ahead = framing.ahead && -p.z > camera.near_m;
    framing.reach =
        std::max({framing.reach, std::abs(p.x / -p.z) / t.right, std::abs(p.y / -p.z) / t.top});
  }
  return framing;
}

TEST(SceneOfModel, TheCameraFramesAnySize) {
  for (const double size_m : {1e-3, 1.0, 1e5})
    for (const auto& [width, height] : {std::pair(640u, 480u), {100u, 900u}, {900u, 100u}}) {
      const Vec3 size = size_m * Vec3(1.0, 0.2, 3.0);
      const Scene scene = scene_of_model(make_box(size), width, height);
      EXPECT_EQ(scene.cameras.at(0).width, width);
      EXPECT_TRUE(scene.sun.has_value());
      EXPECT_FALSE(scene.water.has_value());
      const Framing framing = framing_of(scene, {-0.5 * size, 0.5 * size});
      EXPECT_TRUE(framing.ahead) << size_m;
      EXPECT_LT(framing.reach, 1.0) << size_m;
      EXPECT_GT(framing.reach, 0.7) << size_m;
    }
}

TEST(SceneOfModel, EmptyAndPointModelsGetACameraToo) {
  Model point = make_plane(1.0, 1.0);
  Primitive& primitive = point.meshes[0].primitives[0];
  primitive.topology = Topology::kPoints;
  primitive.positions.assign(1, Vec3f(5, 6, 7));
  primitive.normals.assign(1, Vec3f(0));
  primitive.uv0.clear();
  primitive.indices = {0};
  primitive.bounds = {Vec3(5, 6, 7), Vec3(5, 6, 7)};
  for (const Scene& scene :
       {scene_of_model(Model{}, 64, 64), scene_of_model(std::move(point), 64, 64)}) {
    const Pose pose = scene.world_from(scene.cameras.at(0).mount);
    EXPECT_TRUE(is_finite(pose.position_m));
    EXPECT_GT(scene.cameras[0].near_m, 0.0);
  }
}

}  // namespace
}  // namespace neritic::scene
