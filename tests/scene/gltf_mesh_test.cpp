// Vertices, indices, skins and morph targets from small glTF files.
#include <limits>

#include "tests/scene/gltf_builder.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

TEST(GltfLoader, MissingNormalsAreFlatAndUnshared) {
  Builder b;
  const int p = b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1});  // two faces share an edge
  const int i = b.accessor<std::uint8_t>("SCALAR", 1, {0, 1, 2, 0, 2, 3});
  b.json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  const Primitive& primitive = model->meshes[0].primitives[0];
  EXPECT_EQ(primitive.file_vertices, 4u);
  ASSERT_EQ(primitive.positions.size(), 6u);
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(primitive.normals[k], Vec3f(0, 0, 1));
    EXPECT_EQ(primitive.normals[3 + k], Vec3f(1, 0, 0));
  }
}

TEST(GltfLoader, StripsFansAndLoopsBecomeListsWithTheSpecifiedWinding) {
  const auto indices_of = [](int mode) {
    Builder b;
    b.json["meshes"] = {{{"primitives",
                          {{{"attributes",
                             {{"POSITION", b.vec3(std::vector<float>(15, 1.0f))},
                              {"NORMAL", b.vec3(std::vector<float>(15, 1.0f))}}},
                            {"mode", mode}}}}}};
    const auto model = b.load();
    EXPECT_TRUE(model.ok());
    return model.ok() ? model->meshes[0].primitives[0].indices : std::vector<std::uint32_t>{};
  };
  using List = std::vector<std::uint32_t>;
  EXPECT_EQ(indices_of(0), (List{0, 1, 2, 3, 4}));
  EXPECT_EQ(indices_of(1), (List{0, 1, 2, 3}));
  EXPECT_EQ(indices_of(2), (List{0, 1, 1, 2, 2, 3, 3, 4, 4, 0}));
  EXPECT_EQ(indices_of(3), (List{0, 1, 1, 2, 2, 3, 3, 4}));
  EXPECT_EQ(indices_of(4), (List{0, 1, 2}));
  EXPECT_EQ(indices_of(5), (List{0, 1, 2, 1, 3, 2, 2, 3, 4}));
  EXPECT_EQ(indices_of(6), (List{1, 2, 0, 2, 3, 0, 3, 4, 0}));
}

TEST(GltfLoader, NormalisedIntegersFollowTheSpecifiedFormulas) {
  Builder b;
  Json& primitive = b.quad();
  primitive["attributes"]["TEXCOORD_0"] =
      b.accessor<std::uint16_t>("VEC2", 2, {0, 65535, 32768, 0, 0, 0, 0, 0}, true);
  primitive["attributes"]["NORMAL"] =
      b.accessor<std::int8_t>("VEC3", 3, {0, 0, 127, 0, -128, 0, 0, 0, 127, 0, 0, 127}, true);
  primitive["attributes"]["COLOR_0"] =
      b.accessor<std::uint8_t>("VEC3", 3, {255, 0, 51, 255, 255, 255, 0, 0, 0, 0, 0, 0}, true);
  const auto model = b.load();
  ASSERT_LOADS(model);
  const Primitive& out = model->meshes[0].primitives[0];
  EXPECT_EQ(out.uv0[0], Vec2f(0.0f, 1.0f));
  EXPECT_FLOAT_EQ(out.uv0[1].x, 32768.0f / 65535.0f);
  EXPECT_EQ(out.normals[1], Vec3f(0, -1, 0));
  EXPECT_EQ(out.colors[0], Vec4f(1.0f, 0.0f, 0.2f, 1.0f));
}

TEST(GltfLoader, QuantisedPositionsKeepTheirWholeNumbers) {
  Builder b;
  b.quad();
  b.json["accessors"][0] = {
      {"bufferView", b.view<std::int16_t>({-5, 2, 0, 0, 300, 0, 0, 0, 1, 1, 1, 0, 7, 7, 7, 0}, 8)},
      {"componentType", 5122},
      {"type", "VEC3"},
      {"count", 4}};
  b.json["extensionsRequired"] = {"KHR_mesh_quantization"};
  const auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->meshes[0].primitives[0].bounds.min, Vec3(-5, 0, 0));
  EXPECT_EQ(model->meshes[0].primitives[0].bounds.max, Vec3(300, 7, 7));
}

TEST(GltfLoader, SparseAccessorsReplaceElementsOverBytesOrZeros) {
  Builder b;
  b.quad();
  const Json sparse = {
      {"count", 2},
      {"indices", {{"bufferView", b.view<std::uint8_t>({1, 3})}, {"componentType", 5121}}},
      {"values", {{"bufferView", b.view<float>({9, 0, 0, 0, 8, 0})}}}};
  b.json["accessors"][0]["sparse"] = sparse;
  auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->meshes[0].primitives[0].bounds.max, Vec3(9, 8, 0));
  b.json["accessors"][0].erase("bufferView");  // now over zeros
  model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->meshes[0].primitives[0].bounds.max, Vec3(9, 8, 0));
  b.json["accessors"][0]["sparse"]["indices"]["bufferView"] = b.view<std::uint8_t>({1, 4});
  expect_refused(b, "sparse index 4");
}

TEST(GltfLoader, InfluencesBeyondFourKeepTheLargestAndSumToOne) {
  Builder b;
  Json& primitive = b.quad();
  auto& attributes = primitive["attributes"];
  std::vector<std::uint8_t> joints0, joints1;
  std::vector<float> weights0, weights1;
  for (int v = 0; v < 4; ++v) {
    joints0.insert(joints0.end(), {0, 1, 2, 3});
    joints1.insert(joints1.end(), {4, 5, 200, 200});  // joints of no weight may be nonsense
    weights0.insert(weights0.end(), {0.1f, 0.2f, 0.05f, 0.3f});
    weights1.insert(weights1.end(), {0.25f, 0.1f, 0.0f, 0.0f});
  }
  attributes["JOINTS_0"] = b.accessor("VEC4", 4, joints0);
  attributes["JOINTS_1"] = b.accessor("VEC4", 4, joints1);
  attributes["WEIGHTS_0"] = b.accessor("VEC4", 4, weights0);
  attributes["WEIGHTS_1"] = b.accessor("VEC4", 4, weights1);
  for (int i = 0; i < 6; ++i) b.json["nodes"].push_back(Json::object());
  b.json["nodes"][0]["skin"] = 0;
  b.json["skins"] = {{{"joints", {1, 2, 3, 4, 5, 6}}}};
  auto model = b.load();
  ASSERT_LOADS(model);
  const Primitive& out = model->meshes[0].primitives[0];
  EXPECT_EQ(out.joints[0], (std::array<std::uint16_t, 4>{3, 4, 1, 0}));
  EXPECT_NEAR(out.weights[0].x, 0.3 / 0.85, 1e-6);
  EXPECT_EQ(model->skins[0].inverse_bind, std::vector<Mat4>(6, Mat4(1.0)));
  b.json["skins"][0]["joints"] = {1, 2, 3};
  expect_refused(b, "found joint 4 in the mesh; accepted: joints of skin 0");
}

TEST(GltfLoader, MirroredTextureSeamsSplitVerticesAndFlipHandedness) {
  Builder b;
  // Two quads side by side in the xy plane; u runs to the right on the first and back on the
  // second.
  const int p = b.vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 2, 0, 0, 2, 1, 0});
  std::vector<float> normals;
  for (int i = 0; i < 6; ++i) normals.insert(normals.end(), {0, 0, 1});
  const int n = b.vec3(normals);
  const int uv = b.accessor<float>("VEC2", 2, {0, 1, 1, 1, 1, 0, 0, 0, 0, 1, 0, 0});
  const int i = b.accessor<std::uint16_t>("SCALAR", 1, {0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2});
  b.json["meshes"] = {{{"primitives",
                        {{{"attributes", {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}}},
                          {"indices", i},
                          {"material", 0}}}}}};
  b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  const Primitive& out = model->meshes[0].primitives[0];
  EXPECT_EQ(out.file_vertices, 6u);
  ASSERT_EQ(out.positions.size(), 8u);  // the two on the seam twice
  for (std::size_t k = 0; k < 6; ++k)
    EXPECT_EQ(out.tangents[out.indices[k]], Vec4f(1, 0, 0, 1)) << k;
  for (std::size_t k = 6; k < 12; ++k)
    EXPECT_EQ(out.tangents[out.indices[k]], Vec4f(-1, 0, 0, -1)) << k;
}

TEST(GltfLoader, NumbersThatAreNotFiniteBecomeZeroWithANote) {
  Builder b;
  Json& primitive = b.quad();
  const float nan = std::numeric_limits<float>::quiet_NaN(),
              inf = std::numeric_limits<float>::infinity();
  primitive["attributes"]["POSITION"] = b.vec3({0, 0, nan, 1, 0, 0, inf, 1, 0, 0, 1, 0});
  primitive["attributes"]["NORMAL"] = b.vec3({nan, nan, nan, 0, 0, 0, 0, 0, 1e-30f, 0, 0, 1e30f});
  const auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->meshes[0].primitives[0].bounds.max, Vec3(1, 1, 0));
  EXPECT_EQ(model->notes.size(), 3u);  // the third: no normal had length 1
}

TEST(GltfLoader, DegenerateFacesGetUnitNormalsAndTangents) {
  Builder b;
  const int p = b.vec3({1, 1, 1, 1, 1, 1, 1, 1, 1});
  const int uv = b.accessor<float>("VEC2", 2, {0, 0, 0, 0, 0, 0});
  b.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", p}, {"TEXCOORD_0", uv}}}, {"material", 0}}}}}};
  b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
  b.json["textures"] = {{{"source", 0}}};
  b.json["materials"] = {{{"normalTexture", {{"index", 0}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  EXPECT_EQ(model->meshes[0].primitives[0].tangents.size(), 3u);
}

TEST(GltfLoader, MorphTargetsOfFlatShadedFacesTurnTheirNormals) {
  Builder b;
  const int p = b.vec3({0, 0, 0, 1, 0, 0, 0, 1, 0});
  const int lift = b.vec3({0, 0, 0, 0, 0, 1, 0, 0, 0});  // turns the face by 45 degrees about y
  b.json["meshes"] = {
      {{"primitives", {{{"attributes", {{"POSITION", p}}}, {"targets", {{{"POSITION", lift}}}}}}}}};
  const auto model = b.load();
  ASSERT_LOADS(model);
  const Primitive& out = model->meshes[0].primitives[0];
  const Vec3 turned(out.normals[0] + out.targets[0].normals[0]);
  EXPECT_NEAR(glm::distance(turned, glm::normalize(Vec3(-1, 0, 1))), 0.0, 1e-6);
}

}  // namespace
}  // namespace neritic::scene
