// Textures, samplers, lights, instances and emission from small glTF files.
#include "engine/scene/image_file.hpp"
#include "tests/scene/gltf_builder.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

TEST(GltfLoader, TextureTransformIsTheExtensionsOwnExample) {
  Builder b;
  b.quad();
  const Json transform = {
      {"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
  b.json["extensionsUsed"] = {"KHR_texture_transform"};
  b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"] = {
      {{"emissiveTexture", {{"index", 0}, {"extensions", {{"KHR_texture_transform", transform}}}}},
       {"name", "m"}}};
  // The picture is broken on purpose: the reference is dropped with a note, the model stays.
  auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_FALSE(model->materials[0].emissive_texture.present());
  ASSERT_EQ(model->notes.size(), 1u);
  EXPECT_NE(model->notes[0].find("images[0]"), std::string::npos) << model->notes[0];

  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a b.png", ImageU8(2, 2, 3, 9)).ok());
  b.json["images"][0]["uri"] = "a%20b.png";
  model = b.load(folder.path());
  ASSERT_LOADS(model);
  const TextureRef& ref = model->materials[0].emissive_texture;
  ASSERT_TRUE(ref.present());
  EXPECT_EQ(ref.uv_set, 1);
  // "This example utilizes only the lower left quadrant of the source image": v points down.
  for (const Vec2 uv : {Vec2(0, 0), Vec2(1, 0), Vec2(0, 1), Vec2(1, 1)}) {
    const double u = glm::dot(Vec3(ref.transform_u), Vec3(uv.x, uv.y, 1));
    const double v = glm::dot(Vec3(ref.transform_v), Vec3(uv.x, uv.y, 1));
    EXPECT_NEAR(u, 0.5 * uv.y, 1e-6);
    EXPECT_NEAR(v, 1.0 - 0.5 * uv.x, 1e-6);
  }
}

TEST(GltfLoader, ADetailTextureRepeatsAsItsExtrasSay) {
  Builder b;
  b.quad();
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_png8(folder / "a.png", ImageU8(2, 2, 3, 9)).ok());
  b.json["images"] = {{{"uri", "a.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"] = {
      {{"extras", {{"detailTexture", {{"index", 0}, {"texCoord", 1}, {"repeats", 6.5}}}}}},
      {{"extras", {{"detailTexture", {{"index", 0}}}}}},
      {{"extras", {{"note", "none"}}}}};
  const auto model = b.load(folder.path());
  ASSERT_LOADS(model);
  const TextureRef& ref = model->materials[0].detail_texture;
  ASSERT_TRUE(ref.present());
  EXPECT_EQ(ref.uv_set, 1);
  EXPECT_EQ(ref.transform_u, Vec3f(6.5, 0, 0));
  EXPECT_EQ(ref.transform_v, Vec3f(0, 6.5, 0));
  EXPECT_EQ(model->materials[1].detail_texture.transform_u, Vec3f(1, 0, 0));
  EXPECT_FALSE(model->materials[2].detail_texture.present());
}

TEST(GltfLoader, ExtrasNameThePictureThatAProgramMayShow) {
  Builder b;
  b.quad();
  b.json["materials"] = {{{"extras", {{"picture", "gauge"}}}}, {{"extras", {{"note", "none"}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->materials[0].picture, "gauge");
  EXPECT_EQ(model->materials[1].picture, "");
}

// Extras belong to any program: what has another shape there is none of ours.
TEST(GltfLoader, ExtrasOfOtherProgramsAreNoError) {
  Builder b;
  b.quad();
  b.json["materials"] = {{{"extras", 5}},
                         {{"extras", "a note"}},
                         {{"extras", {{"picture", 5}}}},
                         {{"extras", {{"picture", nullptr}}}},
                         {{"extras", {{"picture", {{"file", "a.png"}}}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  for (const Material& material : model->materials) EXPECT_EQ(material.picture, "");
}

TEST(GltfLoader, SamplersKeepFiltersAndWraps) {
  Builder b;
  b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  b.json["samplers"] = {
      {{"magFilter", 9728}, {"minFilter", 9728}, {"wrapS", 33071}, {"wrapT", 33648}},
      {{"minFilter", 9985}, {"wrapS", 1}}};
  b.json["textures"] = {
      {{"source", 0}, {"sampler", 0}}, {{"source", 0}, {"sampler", 1}}, {{"source", 0}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  const Sampler& nearest = model->textures[0].sampler;
  EXPECT_FALSE(nearest.mag_linear || nearest.min_linear || nearest.mipmapped);
  EXPECT_EQ(nearest.wrap_u, Wrap::kClampToEdge);
  EXPECT_EQ(nearest.wrap_v, Wrap::kMirroredRepeat);
  const Sampler& nearest_mip = model->textures[1].sampler;
  EXPECT_TRUE(nearest_mip.mag_linear && nearest_mip.min_linear && nearest_mip.mipmapped);
  EXPECT_FALSE(nearest_mip.mip_linear);
  EXPECT_EQ(nearest_mip.wrap_u, Wrap::kRepeat);
  const Sampler& standard = model->textures[2].sampler;
  EXPECT_TRUE(standard.mag_linear && standard.min_linear && standard.mip_linear &&
              standard.mipmapped);
}

TEST(GltfLoader, InstancesLightsAndEmissionComeFromTheirExtensions) {
  Builder b;
  b.quad();
  const int t = b.vec3({1, 2, 3, 4, 5, 6});
  const int r = b.accessor<std::int16_t>("VEC4", 4, {0, 0, 0, 32767, 0, 0, 32767, 0}, true);
  const int s = b.vec3({1, 1, 1, 2, 2, 2});
  b.json["nodes"][0]["extensions"] = {
      {"EXT_mesh_gpu_instancing",
       {{"attributes", {{"TRANSLATION", t}, {"ROTATION", r}, {"SCALE", s}}}}},
      {"KHR_lights_punctual", {{"light", 0}}}};
  b.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "spot"},
       {"intensity", 40},
       {"color", {1, 0.5, 0}},
       {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.5}}}}};
  b.json["materials"] = {{{"emissiveFactor", {1, 0.5, 0}},
                          {"extensions",
                           {{"KHR_materials_emissive_strength", {{"emissiveStrength", 8}}},
                            {"KHR_materials_unlit", Json::object()}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  ASSERT_EQ(model->nodes[0].instances.size(), 2u);
  const Vec3 moved(model->nodes[0].instances[1] *
                   Vec4(1, 0, 0, 1));  // half a turn about z, doubled
  EXPECT_NEAR(glm::distance(moved, Vec3(2, 5, 6)), 0.0, 1e-9);
  ASSERT_EQ(model->nodes[0].light, 0);
  EXPECT_EQ(model->lights[0].kind, Light::Kind::kSpot);
  EXPECT_FLOAT_EQ(model->lights[0].outer_cone_rad, 0.5f);
  EXPECT_EQ(model->materials[0].emissive, Vec3f(8, 4, 0));
  EXPECT_TRUE(model->materials[0].unlit);
}

}  // namespace
}  // namespace neritic::scene
