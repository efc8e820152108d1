// The lights of models that shine: the brightest that there is room for, each copy's own.
#include "engine/scene/model_lights.hpp"

#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/scene_copies.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

// A model of n point lights of 1, 2, ... n candela, a node each, in an order that is not that of
// their brightness; the last node is in no scene of the file.
std::shared_ptr<const Model> candles(int n) {
  Model model = make_sphere(1.0);
  for (int i = 0; i <= n; ++i) {
    Light light;
    light.intensity = static_cast<float>(i == n ? 1000 : (i * 7) % n + 1);
    Node node;
    node.light = i;
    node.translation_m = Vec3(light.intensity, 0.0, 0.0);
    if (i < n) model.roots.push_back(static_cast<int>(model.nodes.size()));
    model.nodes.push_back(node);
    model.lights.push_back(light);
  }
  return std::make_shared<const Model>(std::move(model));
}

Scene lit_by(std::shared_ptr<const Model> model) {
  Scene scene;
  scene.path = "test";
  scene.models.push_back(std::move(model));
  Object object;
  object.model = 0;
  scene.objects.push_back(object);
  return scene;
}

TEST(ModelLights, AllShineWhereThereIsRoom) {
  Scene scene = lit_by(candles(15));
  scene.lamps.resize(1);
  choose_model_lights(scene);
  EXPECT_EQ(scene.model_lights.size(), 15u);
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ModelLights, TheBrightestAreKeptAndOneNoteSaysSo) {
  Scene scene = lit_by(candles(40));
  scene.lamps.resize(3);
  choose_model_lights(scene);
  ASSERT_EQ(scene.model_lights.size(), kMaxLamps - 3);
  for (std::size_t i = 0; i < scene.model_lights.size(); ++i)
    EXPECT_EQ(light_of(scene, scene.model_lights[i]).intensity, 40.0f - float(i));
  ASSERT_EQ(scene.notes.size(), 1u);
  EXPECT_NE(scene.notes[0].find("40 lights of models"), std::string::npos) << scene.notes[0];
  EXPECT_NE(scene.notes[0].find("13 brightest"), std::string::npos) << scene.notes[0];
}

// A type of some later version: the other lights shine, and a note names the file.
TEST(ModelLights, ATypeThatIsNotKnownIsIgnoredWithANote) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "lamps.gltf", R"({"asset": {"version": "2.0"},
      "extensionsUsed": ["KHR_lights_punctual"],
      "extensions": {"KHR_lights_punctual": {"lights": [
        {"type": "spherical", "intensity": 50}, {"type": "point", "intensity": 30}]}},
      "nodes": [{"extensions": {"KHR_lights_punctual": {"light": 0}}},
                {"extensions": {"KHR_lights_punctual": {"light": 1}}}],
      "scenes": [{"nodes": [0, 1]}]})")
                  .ok());
  ASSERT_TRUE(
      write_text(folder / "s.toml", "[[objects]]\nname = 'lamps'\nmodel = 'lamps.gltf'\n").ok());
  const auto scene = load_scene(folder / "s.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  ASSERT_EQ(scene->model_lights.size(), 1u);
  EXPECT_EQ(light_of(*scene, scene->model_lights[0]).intensity, 30.0f);
  ASSERT_EQ(scene->notes.size(), 1u);
  EXPECT_EQ(scene->notes[0], (folder / "lamps.gltf").string() +
                                 ": extensions.KHR_lights_punctual.lights[0]: light type "
                                 "\"spherical\" is not known and ignored; known are directional, "
                                 "point and spot");
}

TEST(ModelLights, EveryCopyBringsItsOwn) {
  Scene scene = lit_by(candles(2));
  scene.objects[0].copies.assign(5, Mat4(1.0));
  choose_model_lights(scene);
  EXPECT_EQ(scene.model_lights.size(), 10u);
  // Five of two candela first, then five of one.
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(scene.model_lights[i].copy, i % 5);
    EXPECT_EQ(light_of(scene, scene.model_lights[i]).intensity, i < 5 ? 2.0f : 1.0f);
  }
  scene.objects[0].copies.assign(kMaxInstances, Mat4(1.0));
  choose_model_lights(scene);
  EXPECT_EQ(scene.model_lights.size(), kMaxLamps);
}

TEST(ModelLights, LightsOfNoCandelaTakeNoRoom) {
  Model dark = *candles(20);
  for (Light& light : dark.lights) light.intensity = 0.0f;
  Scene scene = lit_by(std::make_shared<const Model>(std::move(dark)));
  choose_model_lights(scene);
  EXPECT_TRUE(scene.model_lights.empty());
  EXPECT_TRUE(scene.notes.empty());
}

TEST(ModelLights, IlluminanceAddsCandelaOverSquaredDistance) {
  Scene scene = lit_by(candles(2));  // 1 cd at 1 m, 2 cd at 2 m along x
  choose_model_lights(scene);
  EXPECT_DOUBLE_EQ(model_light_lx(scene, Vec3(0.0), 0.1), 1.0 + 2.0 / 4.0);
  EXPECT_DOUBLE_EQ(model_light_lx(scene, Vec3(1.0, 0.0, 0.0), 0.5), 4.0 + 2.0);
}

}  // namespace
}  // namespace neritic::scene
