// The lights of models (KHR_lights_punctual) on pictures: each kind against a closed form or
// against a light of the scene that must give the same. Candela and lux are held against a surface
// that glows with the same radiance.
#include "engine/scene/model_lights.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

using ModelLights = test::GpuTest;

constexpr std::uint32_t kLitSide = 65, kMiddle = 32;
constexpr double kWall_m = 2.0;  // in front of the eye

// A rough white wall. At normal incidence and sight it sends 0.97 / pi of what it receives: 0.96
// by Lambert, and 0.04 / 4 by a highlight of roughness 1.
scene::Model white_wall() {
  scene::Model model = scene::make_box({40.0, 40.0, 1.0});
  scene::Material white;
  white.metallic = 0.0f;
  model.materials = {white};
  for (scene::Primitive& primitive : model.meshes[0].primitives) primitive.material = 0;
  return model;
}
constexpr double kReflected = 0.97 / kPi;

// The eye at the origin, the wall before it at -z. Radiance 1 is stored as 1.
scene::Scene scene_of_wall(scene::Model model, double depth_m = 0.0) {
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
  scene::Object object;
  object.name = "wall";
  object.model = 0;
  object.class_id = object.instance = 1;
  object.mount.pose.position_m = {0.0, -depth_m, -0.5 - kWall_m};
  scene.objects.push_back(object);
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = kLitSide;
  camera.mount.pose.position_m = {0.0, -depth_m, 0.0};
  camera.exposure.fixed_ev = 0.0;
  scene.cameras.push_back(camera);
  return scene;
}

// A node with a light, at a place relative to the eye.
void add_light(scene::Model& model, const scene::Light& light, const Vec3& at_m,
               const Quat& turn = Quat(1.0, 0.0, 0.0, 0.0)) {
  scene::Node node;
  node.light = static_cast<int>(model.lights.size());
  node.translation_m = at_m + Vec3(0.0, 0.0, 0.5 + kWall_m);
  node.rotation = turn;
  model.roots.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(node);
  model.lights.push_back(light);
}

scene::Light make_light(scene::Light::Kind kind, float intensity) {
  scene::Light light;
  light.kind = kind;
  light.intensity = intensity;
  light.color = {1.0f, 0.5f, 0.25f};
  return light;
}

Result<ImageU8> lit_picture(gpu::Device& device, scene::Scene scene, double time_s = 0.0) {
  NERITIC_TRY(const auto session, Session::create(device, std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  request.time_s = time_s;
  NERITIC_TRY(FrameResult result, session->render(request));
  return std::move(result.cameras[0].eyes[0].color);
}

std::array<int, 3> color_at(const ImageU8& image, std::uint32_t x, std::uint32_t y) {
  return {image.at(x, y, 0), image.at(x, y, 1), image.at(x, y, 2)};
}

void expect_near(const std::array<int, 3>& a, const std::array<int, 3>& b, int levels) {
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(a[i], b[i], levels) << "channel " << i;
}

// The picture of an unlit wall that glows with that radiance.
Result<std::array<int, 3>> look_of(gpu::Device& device, const Vec3f& radiance) {
  scene::Model model = white_wall();
  model.materials[0].base_color = {0.0f, 0.0f, 0.0f, 1.0f};
  model.materials[0].emissive = radiance;
  NERITIC_TRY(const ImageU8 image, lit_picture(device, scene_of_wall(std::move(model))));
  return color_at(image, kMiddle, kMiddle);
}

TEST_F(ModelLights, PointLightsGiveCandelaOverSquaredDistance) {
  for (const double distance_m : {0.5, 1.0}) {
    scene::Model model = white_wall();
    add_light(model, make_light(scene::Light::Kind::kPoint, 1.0f),
              {0.0, 0.0, distance_m - kWall_m});
    scene::Scene scene = scene_of_wall(std::move(model));
    scene::choose_model_lights(scene);
    EXPECT_TRUE(scene.notes.empty());
    NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), std::move(scene)));
    const Vec3f wanted(Vec3(1.0, 0.5, 0.25) * kReflected / (distance_m * distance_m));
    NERITIC_ASSERT_OK(const auto look, look_of(device(), wanted));
    expect_near(color_at(image, kMiddle, kMiddle), look, 2);
    // All around: as bright left as right, above as below.
    expect_near(color_at(image, 5, kMiddle), color_at(image, kLitSide - 6, kMiddle), 1);
    expect_near(color_at(image, kMiddle, 5), color_at(image, kMiddle, kLitSide - 6), 1);
    EXPECT_GT(image.at(5, kMiddle, 0), 20);
  }
}

TEST_F(ModelLights, PointLightsShineBehindAndBesideThemselvesToo) {
  // Turned any way, and the wall behind the light's -z: the same picture.
  std::vector<ImageU8> images;
  for (const double turn_rad : {0.0, 1.1, kPi}) {
    scene::Model model = white_wall();
    add_light(model, make_light(scene::Light::Kind::kPoint, 1.0f), {0.0, 0.0, -1.0},
              glm::angleAxis(turn_rad, Vec3(0, 1, 0)));
    scene::Scene scene = scene_of_wall(std::move(model));
    scene::choose_model_lights(scene);
    NERITIC_ASSERT_OK(ImageU8 image, lit_picture(device(), std::move(scene)));
    images.push_back(std::move(image));
  }
  EXPECT_EQ(images[0].data, images[1].data);
  EXPECT_EQ(images[0].data, images[2].data);
}

TEST_F(ModelLights, SpotLightsAreLamps) {
  const Quat turn = glm::angleAxis(0.2, Vec3(0, 1, 0));
  scene::Light spot = make_light(scene::Light::Kind::kSpot, 3.0f);
  spot.inner_cone_rad = 0.2f;
  spot.outer_cone_rad = 0.4f;
  scene::Model model = white_wall();
  add_light(model, spot, {0.1, 0.0, 0.0}, turn);
  scene::Scene lit = scene_of_wall(std::move(model));
  scene::choose_model_lights(lit);
  scene::Scene lamp = scene_of_wall(white_wall());
  scene::Lamp same{"lamp", {-1, {{0.1, 0.0, 0.0}, turn}}, spot.color, 3.0, 0.2, 0.4};
  lamp.lamps.push_back(same);
  NERITIC_ASSERT_OK(const ImageU8 a, lit_picture(device(), std::move(lit)));
  NERITIC_ASSERT_OK(const ImageU8 b, lit_picture(device(), std::move(lamp)));
  int worst = 0, brightest = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) {
    worst = std::max(worst, std::abs(int(a.data[i]) - int(b.data[i])));
    brightest = std::max(brightest, int(a.data[i]));
  }
  EXPECT_LE(worst, 1);
  EXPECT_GT(brightest, 100);
  EXPECT_EQ(color_at(a, 0, 0), (std::array<int, 3>{0, 0, 0}));  // outside the cone
}

TEST_F(ModelLights, DirectionalLightsAreTheSunWhereTheSceneNamesNone) {
  // Level, as a node without a turn shines, and from below: lux times the cosine, and no sky.
  for (const double below_rad : {0.0, 0.9}) {
    scene::Model model = white_wall();
    add_light(model, make_light(scene::Light::Kind::kDirectional, 1.0f), {7.0, 7.0, 7.0},
              glm::angleAxis(below_rad, Vec3(1, 0, 0)));
    scene::Scene scene = scene_of_wall(model);
    scene::choose_model_lights(scene);
    EXPECT_TRUE(scene.notes.empty());
    NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), std::move(scene)));
    const Vec3f wanted(Vec3(1.0, 0.5, 0.25) * (kReflected * std::cos(below_rad)));
    NERITIC_ASSERT_OK(const auto look, look_of(device(), wanted));
    expect_near(color_at(image, kMiddle, kMiddle), look, 3);

    scene::Scene with_sun = scene_of_wall(std::move(model));
    with_sun.sun = scene::Sun{};
    scene::choose_model_lights(with_sun);
    EXPECT_TRUE(with_sun.model_lights.empty());
    ASSERT_EQ(with_sun.notes.size(), 1u);
    EXPECT_NE(with_sun.notes[0].find("sun"), std::string::npos);
  }
}

TEST_F(ModelLights, DirectionalLightUnderWaterComesFromAbove) {
  int brightness[2];
  for (int i = 0; i < 2; ++i) {
    scene::Model model = white_wall();
    const double down_rad = i == 0 ? -0.8 : 0.8;  // about x: -z turns down, or up
    add_light(model, make_light(scene::Light::Kind::kDirectional, 20.0f), {},
              glm::angleAxis(down_rad, Vec3(1, 0, 0)));
    scene::Scene scene = scene_of_wall(std::move(model), 1.0);
    scene.water = scene::Water{.type = "I"};
    scene::choose_model_lights(scene);
    NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), std::move(scene)));
    brightness[i] = image.at(kMiddle, kMiddle, 0);
  }
  EXPECT_GT(brightness[0], 60);
  EXPECT_EQ(brightness[1], 0);
}

// The beam of a point light in scattering water is a ball of light, round and brighter than what a
// light of no candela leaves.
TEST_F(ModelLights, PointLightsGlowAllAround) {
  scene::Model model = white_wall();
  add_light(model, make_light(scene::Light::Kind::kPoint, 30.0f), {0.0, 0.0, -1.0});
  scene::Scene scene = scene_of_wall(model, 20.0);
  scene.objects[0].mount.pose.position_m.z -= 30.0;  // only water behind the light
  scene.objects[0].copies.clear();
  scene.models[0] = std::make_shared<scene::Model>([&] {
    scene::Model moved = model;
    moved.nodes.back().translation_m.z += 30.0;
    return moved;
  }());
  scene.water = scene::Water{.type = "III", .scattering = true};
  scene::choose_model_lights(scene);
  NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), std::move(scene)));
  for (const std::uint32_t d : {4u, 12u}) {
    const auto right = color_at(image, kMiddle + d, kMiddle);
    EXPECT_GT(right[1], 3) << d;
    expect_near(color_at(image, kMiddle - d, kMiddle), right, 1);
    expect_near(color_at(image, kMiddle, kMiddle - d), right, 1);
    expect_near(color_at(image, kMiddle, kMiddle + d), right, 1);
  }
  EXPECT_GT(image.at(kMiddle + 4, kMiddle, 1), image.at(kMiddle + 12, kMiddle, 1));
}

TEST_F(ModelLights, LightsFollowTheirAnimatedNode) {
  scene::Model model = white_wall();
  scene::Light spot = make_light(scene::Light::Kind::kSpot, 3.0f);
  spot.inner_cone_rad = 0.05f;
  spot.outer_cone_rad = 0.15f;
  add_light(model, spot, {});
  scene::Channel channel;
  channel.node = static_cast<int>(model.nodes.size()) - 1;
  channel.path = scene::Channel::Path::kTranslation;
  channel.times_s = {0.0f, 1.0f};
  const auto z = static_cast<float>(model.nodes.back().translation_m.z);
  channel.values = {-0.5f, 0.0f, z, 0.5f, 0.0f, z};
  model.clips.push_back({"slide", 1.0, {channel}});
  scene::Scene scene = scene_of_wall(std::move(model));
  scene.objects[0].clip = 0;
  scene::choose_model_lights(scene);
  for (const double time_s : {0.0, 0.5, 0.999}) {
    NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), scene, time_s));
    double sum = 0.0, moment = 0.0;
    for (std::uint32_t x = 0; x < kLitSide; ++x) {
      sum += image.at(x, kMiddle, 0);
      moment += (x - double(kMiddle)) * image.at(x, kMiddle, 0);
    }
    ASSERT_GT(sum, 0.0);
    const double pixels_per_m = kLitSide / (2.0 * kWall_m * std::tan(radians(30.0)));
    EXPECT_NEAR(moment / sum / pixels_per_m, time_s - 0.5, 0.03) << time_s;
  }
}

// `neritic render model.glb`: lit by the model's own light and well exposed, whatever its size and
// its lamp's candela; a model without lights has a sun.
TEST_F(ModelLights, BareModelsAreLitByTheirOwnLights) {
  for (const double size_m : {0.02, 50.0})
    for (const float intensity : {0.5f, 800.0f}) {
      scene::Model model = scene::make_sphere(size_m / 2);
      scene::Material white;
      white.metallic = 0.0f;
      model.materials = {white};
      model.meshes[0].primitives[0].material = 0;
      scene::Light light = make_light(scene::Light::Kind::kPoint, intensity);
      light.color = Vec3f(1.0f);
      scene::Node node;
      node.light = 0;
      node.translation_m = Vec3(0.6, 0.4, 1.0) * size_m;
      model.nodes.push_back(node);
      model.roots.push_back(1);
      model.lights.push_back(light);
      scene::Scene scene = scene::scene_of_model(std::move(model), kLitSide, kLitSide);
      EXPECT_FALSE(scene.sun.has_value());
      NERITIC_ASSERT_OK(const ImageU8 image, lit_picture(device(), std::move(scene)));
      EXPECT_GT(image.at(kMiddle, kMiddle, 1), 110) << size_m << " m, " << intensity << " cd";
    }
  EXPECT_TRUE(scene::scene_of_model(scene::make_sphere(1.0), 64, 64).sun.has_value());
}

}  // namespace
}  // namespace neritic::testbed
