// Materials of extensions become metallic-roughness ones that send the same light.
#include "engine/scene/gltf_mix.hpp"

#include "engine/scene/image_file.hpp"
#include "tests/scene/gltf_builder.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

Builder with_material(const Json& extensions) {
  Builder b;
  b.quad()["material"] = 0;
  b.json["materials"] = {{{"extensions", extensions}}};
  for (const auto& [name, ignored] : extensions.items()) b.json["extensionsUsed"].push_back(name);
  return b;
}

// A surface of each metalness, told as specular and diffuse colour, is found again.
TEST(GltfMix, SpecularAndDiffuseColoursGiveBackBaseColourAndMetalness) {
  const Vec3f base(0.8f, 0.5f, 0.3f);
  for (const float m : {0.0f, 0.25f, 0.5f, 1.0f}) {
    const Vec3f specular = glm::mix(Vec3f(0.04f), base, m);
    const float strongest = std::max({specular.x, specular.y, specular.z});
    const Vec3f diffuse = base * (1.0f - m) * 0.96f / (1.0f - strongest);
    const gltf::SolvedColor found = gltf::solve_specular(diffuse, specular);
    EXPECT_NEAR(found.metallic, m, 1e-3f);
    EXPECT_LT(glm::distance(found.base, base), 0.01f) << m;
  }
  EXPECT_EQ(gltf::solve_specular(base, Vec3f(0.0f)).metallic, 0.0f);  // duller than a dielectric
}

TEST(GltfMix, SpecularGlossinessFactorsAreSolved) {
  const auto gold = with_material({{"KHR_materials_pbrSpecularGlossiness",
                                    {{"diffuseFactor", {0, 0, 0, 0.5}},
                                     {"specularFactor", {1, 0.77, 0.34}},
                                     {"glossinessFactor", 0.7}}}})
                        .load();
  ASSERT_LOADS(gold);
  EXPECT_TRUE(gold->notes.empty()) << gold->notes[0];
  const Material& m = gold->materials[0];
  EXPECT_NEAR(m.metallic, 1.0f, 1e-3f);
  EXPECT_NEAR(m.roughness, 0.3f, 1e-6f);
  EXPECT_LT(glm::distance(Vec3f(m.base_color), Vec3f(1, 0.77f, 0.34f)), 0.01f);
  EXPECT_FLOAT_EQ(m.base_color.w, 0.5f);
}

// Left half gold, right half blue plastic, in two pictures of different sizes.
TEST(GltfMix, SpecularGlossinessPicturesAreMixedByPixel) {
  const test::ScratchFolder folder;
  ImageU8 diffuse(2, 1, 4), specular(4, 2, 4);
  const std::uint8_t gold[] = {255, 226, 157, 230}, dull[] = {56, 56, 56, 51},
                     blue[] = {30, 60, 200, 255};
  std::copy_n(blue, 4, &diffuse.at(1, 0));
  diffuse.at(0, 0, 3) = 255;
  for (std::uint32_t i = 0; i < 8; ++i)
    std::copy_n(i % 4 < 2 ? gold : dull, 4, &specular.data[4 * i]);
  ASSERT_TRUE(write_png8(folder / "d.png", diffuse).ok() &&
              write_png8(folder / "s.png", specular).ok());
  Builder b = with_material(
      {{"KHR_materials_pbrSpecularGlossiness",
        {{"diffuseTexture", {{"index", 0}}}, {"specularGlossinessTexture", {{"index", 1}}}}}});
  b.json["images"] = {{{"uri", "d.png"}}, {{"uri", "s.png"}}};
  b.json["textures"] = {{{"source", 0}}, {{"source", 1}}};
  const auto model = b.load(folder.path());
  ASSERT_LOADS(model);
  const auto picture = [&](const TextureRef& ref) -> const ImageU8& {
    return model->images[model->textures[ref.texture].image];
  };
  const Material& m = model->materials[0];
  const ImageU8 &base = picture(m.base_color_texture),
                &rough = picture(m.metallic_roughness_texture);
  ASSERT_EQ(base.width, 4u);
  ASSERT_EQ(base.height, 2u);
  EXPECT_GT(rough.at(0, 0, 2), 250);             // metal
  EXPECT_LT(rough.at(3, 1, 2), 20);              // none
  EXPECT_NEAR(rough.at(0, 0, 1), 255 - 230, 1);  // roughness = 1 - glossiness
  EXPECT_NEAR(rough.at(3, 0, 1), 255 - 51, 1);
  EXPECT_NEAR(base.at(1, 1, 1), 226, 2);
  EXPECT_NEAR(base.at(2, 1, 2), 200, 4);
}

TEST(GltfMix, TransmissionBecomesTheShareThatPasses) {
  auto model =
      with_material({{"KHR_materials_transmission", {{"transmissionFactor", 0.75}}}}).load();
  ASSERT_LOADS(model);
  EXPECT_TRUE(model->materials[0].transmissive);
  EXPECT_FLOAT_EQ(model->materials[0].base_color.w, 0.25f);

  const test::ScratchFolder folder;
  ImageU8 mask(2, 1, 3);
  mask.at(1, 0, 0) = 255;
  ASSERT_TRUE(write_png8(folder / "t.png", mask).ok());
  Builder b =
      with_material({{"KHR_materials_transmission",
                      {{"transmissionFactor", 1}, {"transmissionTexture", {{"index", 0}}}}}});
  b.json["images"] = {{{"uri", "t.png"}}};
  b.json["textures"] = {{{"source", 0}}};
  model = b.load(folder.path());
  ASSERT_LOADS(model);
  const TextureRef& ref = model->materials[0].base_color_texture;
  ASSERT_TRUE(ref.present());
  const ImageU8& made = model->images[model->textures[ref.texture].image];
  EXPECT_EQ(made.at(0, 0, 3), 255);
  EXPECT_EQ(made.at(1, 0, 3), 0);
}

TEST(GltfMix, SheetsLetAShareOfDiffuseLightThrough) {
  auto model =
      with_material({{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 0.4}}}})
          .load();
  ASSERT_LOADS(model);
  EXPECT_FLOAT_EQ(model->materials[0].diffuse_transmission, 0.4f);
  EXPECT_FALSE(model->materials[0].transmissive);
  model =
      with_material({{"KHR_materials_diffuse_transmission", {{"diffuseTransmissionFactor", 1e30}}}})
          .load();
  ASSERT_LOADS(model);
  EXPECT_FLOAT_EQ(model->materials[0].diffuse_transmission, 1.0f);
}

TEST(GltfMix, IndexAndSpecularGiveTheReflectance) {
  const auto reflectance = [](const Json& extensions) {
    return with_material(extensions).load().value().materials[0].reflectance;
  };
  EXPECT_FLOAT_EQ(reflectance({{"KHR_materials_ior", {{"ior", 2.42}}}}), 1.42f / 3.42f);
  EXPECT_FLOAT_EQ(reflectance({{"KHR_materials_specular", {{"specularFactor", 0.25}}}}), 0.1f);
  EXPECT_FLOAT_EQ(reflectance({{"KHR_materials_ior", {{"ior", 0}}}}), 0.8f);
  EXPECT_FLOAT_EQ(reflectance({{"KHR_materials_ior", Json::object()}}), 0.2f);
}

}  // namespace
}  // namespace neritic::scene
