// Models of scenes: shared and loaded once, single nodes, terrains, a camera for a lone model.
#include <gtest/gtest.h>

#include "engine/scene/image_file.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

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
               "color_texture = 'n.png'\ntexture_m = 3\ndetail_texture = 'n.png'\ndetail_m = 0.25");
  const Model& model = *scene.models.at(0);
  const Primitive& p = model.meshes[0].primitives[0];
  ASSERT_EQ(p.tangents.size(), p.positions.size());
  // The slope rises by a half: along x it climbs at that angle.
  const Vec3 along = glm::normalize(Vec3(1.0, 0.5, 0.0));
  for (const Vec4f& tangent : p.tangents) {
    expect_near(Vec3(tangent), along, 1e-6);
    EXPECT_EQ(tangent.w, 1.0f);
  }
  EXPECT_EQ(model.images.size(), 3u);
  EXPECT_EQ(model.textures.at(model.materials[0].normal_texture.texture).image, 1);
  EXPECT_EQ(model.textures.at(model.materials[0].base_color_texture.texture).image, 0);
  EXPECT_EQ(model.textures.at(model.materials[0].detail_texture.texture).image, 2);
  EXPECT_EQ(model.materials[0].detail_texture.transform_u, Vec3f(12, 0, 0));
}

TEST(SceneModels, APictureThatDoesNotLoadIsNamedWithItsOwnKeyAndLine) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "bad.png", "no picture").ok());
  ASSERT_TRUE(write_png8(scratch / "n.png", ImageU8(2, 2, 3, 128)).ok());
  write_hill(scratch);
  const std::string terrain = "[[objects]]\nterrain = 'hill.npy'\ncell_m = 2\n",
                    box = "[[objects]]\nshape = 'box'\nroughness = 0.5\n",
                    both = "color_texture = 'n.png'\nnormal_texture = 'bad.png'\n",
                    third = "color_texture = 'n.png'\ndetail_texture = 'bad.png'\n";
  EXPECT_TRUE(message_of(scratch, box + "color_texture = 'bad.png'\n")
                  .starts_with("s.toml:4: objects[0].color_texture: bad.png: "));
  EXPECT_TRUE(message_of(scratch, terrain + "color_texture = 'bad.png'\n")
                  .starts_with("s.toml:4: objects[0].color_texture: bad.png: "));
  EXPECT_TRUE(message_of(scratch, terrain + both)
                  .starts_with("s.toml:5: objects[0].normal_texture: bad.png: "));
  EXPECT_TRUE(message_of(scratch, terrain + third)
                  .starts_with("s.toml:5: objects[0].detail_texture: bad.png: "));
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

// The bounds in the picture of a scene_of_model: the largest |x|, |y| in the picture's
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

TEST(SceneOfModel, TheChosenClipIsShownWithAllOfItsCourse) {
  Model model = make_box(Vec3(1.0));
  for (const float end_m : {0.0f, 30.0f}) {
    const Channel slide{0,      Channel::Path::kTranslation, Channel::Interpolation::kLinear,
                        {0, 4}, {0, 0, 0, end_m, 0, 0},      3};
    model.clips.push_back({fmt::format("{} m", end_m), 4.0, {slide}});
  }
  const Scene first = scene_of_model(model, 640, 480), second = scene_of_model(model, 640, 480, 1);
  EXPECT_EQ(first.objects[0].clip, 0);
  EXPECT_EQ(second.objects[0].clip, 1);
  EXPECT_GT(framing_of(first, {Vec3(-0.5), Vec3(0.5)}).reach, 0.7);
  EXPECT_LT(framing_of(second, {Vec3(-0.5), Vec3(26.7, 0.5, 0.5)}).reach, 1.0);
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
