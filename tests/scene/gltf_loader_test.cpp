// Small glTF files written here, one feature or fault each.
#include "engine/scene/gltf_loader.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/scene/gltf_invariants.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {
using Json = nlohmann::json;

std::string base64(const std::vector<std::uint8_t>& bytes) {
  const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = word << 8 | (i + k < bytes.size() ? bytes[i + k] : 0);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k <= bytes.size() ? digits[word >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

// Builds a file with one buffer; accessors are added as lists of numbers.
struct Builder {
  Json json = {{"asset", {{"version", "2.0"}}}};
  std::vector<std::uint8_t> bytes;

  template <class T>
  int view(const std::vector<T>& values, int stride = 0) {
    while (bytes.size() % 4 != 0) bytes.push_back(0);
    Json view = {
        {"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", values.size() * sizeof(T)}};
    if (stride > 0) view["byteStride"] = stride;
    const auto* from = reinterpret_cast<const std::uint8_t*>(values.data());
    bytes.insert(bytes.end(), from, from + values.size() * sizeof(T));
    json["bufferViews"].push_back(view);
    return static_cast<int>(json["bufferViews"].size()) - 1;
  }
  template <class T>
  int accessor(const char* type, std::size_t components, const std::vector<T>& values,
               bool normalized = false) {
    const int component = std::is_same_v<T, float>           ? 5126
                          : std::is_same_v<T, std::uint8_t>  ? 5121
                          : std::is_same_v<T, std::int8_t>   ? 5120
                          : std::is_same_v<T, std::uint16_t> ? 5123
                          : std::is_same_v<T, std::int16_t>  ? 5122
                                                             : 5125;
    Json accessor = {{"bufferView", view(values)},
                     {"componentType", component},
                     {"type", type},
                     {"count", values.size() / components}};
    if (normalized) accessor["normalized"] = true;
    json["accessors"].push_back(accessor);
    return static_cast<int>(json["accessors"].size()) - 1;
  }
  int vec3(const std::vector<float>& values) { return accessor("VEC3", 3, values); }

  // The quad (0,0) (1,0) (1,1) (0,1) in the xy plane, facing +z, as two triangles.
  Json& quad() {
    const int p = vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
    const int i = accessor<std::uint16_t>("SCALAR", 1, {0, 1, 2, 0, 2, 3});
    json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
    json["nodes"] = {{{"mesh", 0}}};
    json["scenes"] = {{{"nodes", {0}}}};
    json["scene"] = 0;
    return json["meshes"][0]["primitives"][0];
  }

  Result<Model> load(const std::filesystem::path& folder = {}) {
    if (!bytes.empty())
      json["buffers"] = {{{"byteLength", bytes.size()},
                          {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
    const std::string text = json.dump();
    return parse_gltf_bytes(std::as_bytes(std::span(text.data(), text.size())), "made.gltf",
                            folder);
  }
};

#define ASSERT_LOADS(model)                         \
  ASSERT_TRUE(model.ok()) << model.error().message; \
  ASSERT_EQ(test::broken_promise(*model), "")

void expect_refused(Builder& builder, const std::string& words) {
  const auto model = builder.load();
  ASSERT_FALSE(model.ok()) << words;
  EXPECT_EQ(model.error().code, ErrorCode::kBadInput);
  EXPECT_NE(model.error().message.find(words), std::string::npos) << model.error().message;
  EXPECT_EQ(model.error().message.rfind("made.gltf: ", 0), 0u) << model.error().message;
}

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

TEST(GltfLoader, TextureTransformIsTheExtensionsOwnExample) {
  Builder b;
  b.quad();
  const Json transform = {
      {"offset", {0, 1}}, {"rotation", kPi / 2}, {"scale", {0.5, 0.5}}, {"texCoord", 1}};
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
  expect_refused(b, "the mesh uses joint");
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
  EXPECT_EQ(model->notes.size(), 2u);
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

TEST(GltfLoader, RequiredExtensionsAreRefusedByNameOptionalOnesNotedOnce) {
  Builder b;
  b.quad();
  b.json["extensionsUsed"] = {"KHR_draco_mesh_compression", "KHR_draco_mesh_compression",
                              "KHR_materials_unlit"};
  const auto model = b.load();
  ASSERT_LOADS(model);
  ASSERT_EQ(model->notes.size(), 1u);
  EXPECT_NE(model->notes[0].find("KHR_draco_mesh_compression"), std::string::npos);
  b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  expect_refused(b, "KHR_draco_mesh_compression is required but not supported");
}

TEST(GltfLoader, FaultsAreNamedWithTheirPlaceInTheFile) {
  const auto broken = [](const std::string& words, auto change) {
    Builder b;
    b.quad();
    change(b);
    expect_refused(b, words);
  };
  broken("nodes[0].mesh: 7 found, but the file has 1 meshes",
         [](Builder& b) { b.json["nodes"][0]["mesh"] = 7; });
  broken("nodes[0].mesh: -1 found", [](Builder& b) { b.json["nodes"][0]["mesh"] = -1; });
  broken("nodes[0].mesh: \"a\" found", [](Builder& b) { b.json["nodes"][0]["mesh"] = "a"; });
  broken("accessors[0]: 4000000000 elements need",
         [](Builder& b) { b.json["accessors"][0]["count"] = 4000000000u; });
  broken("too much for a file of this size", [](Builder& b) {
    b.json["accessors"][0]["count"] = 4000000000u;
    b.json["accessors"][0].erase("bufferView");
  });
  broken("accessors[0]: 4 elements need 48 bytes from 8",
         [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 8; });
  broken("bufferViews[0]: bytes",
         [](Builder& b) { b.json["bufferViews"][0]["byteOffset"] = 18446744073709551615u; });
  broken("bufferViews[0].byteStride: 4 found",
         [](Builder& b) { b.json["bufferViews"][0]["byteStride"] = 4; });
  broken("index 3 found, but there are 3 vertices",
         [](Builder& b) { b.json["accessors"][0]["count"] = 3; });
  broken("component type 5124", [](Builder& b) { b.json["accessors"][0]["componentType"] = 5124; });
  broken("type \"VEC2\" found, VEC3 is accepted",
         [](Builder& b) { b.json["accessors"][0]["type"] = "VEC2"; });
  broken("meshes[0].primitives[0].mode: 9 found",
         [](Builder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 9; });
  broken("its own ancestor", [](Builder& b) {
    b.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  });
  broken("its own ancestor", [](Builder& b) { b.json["nodes"] = {{{"children", {0}}}}; });
  broken("has two parents", [](Builder& b) {
    b.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, Json::object()};
  });
  broken("two parents", [](Builder& b) {
    b.json["nodes"] = {{{"children", {1, 1}}}, Json::object()};
  });
  broken("asset.version: \"1.0\"", [](Builder& b) { b.json["asset"]["version"] = "1.0"; });
}

TEST(GltfLoader, UrisLeadBelowTheModelsFolderOnly) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "secret.bin", std::string(100, 'x')).ok());
  ASSERT_TRUE(make_folder(folder / "model").ok());
  ASSERT_TRUE(write_text(folder / "model/inside.bin", std::string(100, '\0')).ok());
  for (const auto& [uri, accepted] :
       std::vector<std::pair<std::string, bool>>{{"inside.bin", true},
                                                 {"./x/../inside.bin", true},
                                                 {"in%73ide.bin", true},
                                                 {"../secret.bin", false},
                                                 {"%2e%2e/secret.bin", false},
                                                 {"x/../../secret.bin", false},
                                                 {(folder / "secret.bin").string(), false},
                                                 {"file:///etc/passwd", false},
                                                 {"http://example.com/a.bin", false},
                                                 {"", false},
                                                 {"missing.bin", false}}) {
    Json json = {{"asset", {{"version", "2.0"}}},
                 {"buffers", {{{"byteLength", 36}, {"uri", uri}}}},
                 {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                 {"accessors",
                  {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 3}}}},
                 {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}}}}}}}};
    ASSERT_TRUE(write_text(folder / "model/m.gltf", json.dump()).ok());
    const auto model = load_gltf(folder / "model/m.gltf");
    EXPECT_EQ(model.ok(), accepted) << uri << (model.ok() ? "" : " " + model.error().message);
    if (model.ok()) continue;
    EXPECT_NE(model.error().message.find("buffers[0].uri"), std::string::npos);
  }
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

// A file with many faults or oddities must not take time that grows with their square.
TEST(GltfLoader, ManyOdditiesAreSummedUpQuickly) {
  Builder b;
  for (int i = 0; i < 20000; ++i)
    b.json["meshes"].push_back({{"primitives", {{{"attributes", Json::object()}}}}});
  const auto model = b.load();
  ASSERT_LOADS(model);
  ASSERT_EQ(model->notes.size(), 32u);
  EXPECT_EQ(model->notes.back(), "further notes are left out");
}

TEST(GltfLoader, JsonNestedAThousandDeepIsRefused) {
  for (const std::string open : {"[", "{\"a\":"}) {
    std::string text = "{\"extras\":";
    for (int i = 0; i < 100000; ++i) text += open;
    const auto model =
        parse_gltf_bytes(std::as_bytes(std::span(text.data(), text.size())), "deep.gltf");
    ASSERT_FALSE(model.ok());
    EXPECT_NE(model.error().message.find("nested"), std::string::npos) << model.error().message;
  }
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
