// A broken glTF rule that the model does not depend on becomes a note, and the model is shown.
#include <fmt/ranges.h>
#include <gtest/gtest.h>

#include <ctime>
#include <functional>

#include "gltf_builder.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

struct BrokenRule {
  const char* words;  // of its note
  std::function<void(Json&)> make;
};

TEST(GltfAudit, AWholeFileHasNoNotes) {
  Builder b;
  b.quad();
  const auto model = b.load();
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_TRUE(model->notes.empty()) << model->notes[0];
}

TEST(GltfAudit, EachBrokenRuleIsANoteWithItsPath) {
  const Json far_view = {{"buffer", 0}, {"byteOffset", 4}, {"byteLength", 1u << 30}};
  const std::vector<BrokenRule> rules = {
      {"cameras: found an empty list", [](Json& j) { j["cameras"] = Json::array(); }},
      {"nodes[0].children: found an empty list",
       [](Json& j) { j["nodes"][0]["children"] = Json::array(); }},
      {"images[0].bufferView: found 9; accepted: an index below 2, the number of bufferViews",
       [](Json& j) {
         j["images"] = {{{"bufferView", 9}, {"mimeType", "image/png"}}};
       }},
      {"bufferViews[2]: found no buffer",
       [](Json& j) {
         j["bufferViews"].push_back({{"byteLength", 4}});
       }},
      {"bytes from byte 4 on; accepted: a range inside its buffer",
       [&](Json& j) { j["bufferViews"].push_back(far_view); }},
      {"byteLength: found 0",
       [](Json& j) {
         j["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}});
       }},
      {"byteStride: found 6; accepted: a multiple of 4",
       [](Json& j) {
         j["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 8}, {"byteStride", 6}});
       }},
      {"images[0].uri: found ftp://a/b.png",
       [](Json& j) {
         j["images"] = {{{"uri", "ftp://a/b.png"}}};
       }},
      {"is a multiple of 4 bytes",
       [](Json& j) {
         j["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", 2},
                                   {"componentType", 5126},
                                   {"count", 1},
                                   {"type", "SCALAR"}});
       }},
      {"found a matrix beside translation",
       [](Json& j) {
         j["nodes"].push_back({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                               {"translation", {0, 0, 0}}});
       }},
      {"weights: found a value without a mesh",
       [](Json& j) {
         j["nodes"].push_back({{"weights", {1}}});
       }},
      {"found perspective and orthographic",
       [](Json& j) {
         j["cameras"] = {{{"type", "perspective"},
                          {"perspective", {{"yfov", 1}, {"znear", 1}}},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}};
       }},
      {"POSITION: found an accessor without min and max",
       [](Json& j) { j["accessors"][0].erase("min"); }},
      {"WIDTH; accepted: glTF's names",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["WIDTH"] = 0; }},
      {"found KHR_materials_unlit; accepted: extensions that belong",
       [](Json& j) {
         j["extensionsUsed"] = {"KHR_materials_unlit"};
         j["nodes"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
       }},
      {"byteOffset: found a value without a bufferView",
       [](Json& j) {
         j["accessors"].push_back(
             {{"byteOffset", 0}, {"componentType", 5126}, {"count", 1}, {"type", "SCALAR"}});
       }},
      {"bufferViews[1].byteStride: found a stride for indices; accepted: none",
       [](Json& j) {
         j["bufferViews"][1]["byteStride"] = 4;
         j["accessors"][1]["count"] = 3;
       }},
      {"nodes[0].extensions.KHR_lights_punctual: found no light",
       [](Json& j) {
         j["extensionsUsed"] = {"KHR_lights_punctual"};
         j["nodes"][0]["extensions"]["KHR_lights_punctual"] = Json::object();
       }},
      {"found EXT_secret; accepted: extensions that extensionsUsed names",
       [](Json& j) { j["nodes"][0]["extensions"]["EXT_secret"]["a"] = 1; }},
      {"extensionsRequired does not name it",
       [](Json& j) { j["extensionsUsed"] = {"KHR_mesh_quantization"}; }},
  };
  for (const BrokenRule& rule : rules) {
    SCOPED_TRACE(rule.words);
    Builder b;
    b.quad();
    rule.make(b.json);
    const auto model = b.load();
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ(model->meshes.size(), 1u);
    std::string all;
    for (const std::string& note : model->notes) all += note + "\n";
    EXPECT_NE(all.find(rule.words), std::string::npos) << all;
  }
}

struct BrokenValue {
  std::string words;  // of its only note; empty: there is none
  std::function<void(Builder&)> make;
};

TEST(GltfAudit, EachBrokenValueIsTheOneNote) {
  const auto skin = [](Builder& b, const std::vector<float>& last_rows) {
    std::vector<float> matrices(32, 0.0f);
    for (int k = 0; k < 8; ++k) matrices[4 * k + k % 4] = 1.0f;
    for (int k = 0; k < 8; ++k) matrices[4 * k + 3] = last_rows[k];
    auto& attributes = b.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] =
        b.accessor<std::uint8_t>("VEC4", 4, {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0, 1, 0, 0, 0});
    attributes["WEIGHTS_0"] =
        b.accessor<float>("VEC4", 4, {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0});
    b.json["skins"] = {
        {{"joints", {1, 2}}, {"inverseBindMatrices", b.accessor("MAT4", 16, matrices)}}};
    b.json["nodes"][0]["skin"] = 0;
    b.json["nodes"].push_back({{"children", {2}}});
    b.json["nodes"].push_back(Json::object());
    b.json["scenes"][0]["nodes"] = {0, 1};
  };
  const auto normals = [](Builder& b, float length) {
    b.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] =
        b.vec3({0, 0, length, 0, 0, 1, 0, 0, 1, 0, 0, 1});
  };
  const std::vector<BrokenValue> values = {
      {"accessors[0].min[1]: found -0.5; accepted: the least value of the data, 0",
       [](Builder& b) { b.json["accessors"][0]["min"][1] = -0.5; }},
      {"accessors[0].max[0]: found 0.99; accepted: the largest value of the data, 1",
       [](Builder& b) { b.json["accessors"][0]["max"][0] = 0.99; }},
      {"accessors[1].max: found 2 numbers; accepted: 1",
       [](Builder& b) {
         b.json["accessors"][1]["max"] = {3, 3};
       }},
      {"accessors[0].min[2]: found \"low\"; accepted: a number",
       [](Builder& b) { b.json["accessors"][0]["min"][2] = "low"; }},
      // Seven digits, as some exporters write them.
      {"",
       [](Builder& b) {
         b.json["accessors"][b.vec3({0, 0, 0, 1.0f / 3, 0, 0})]["max"][0] = 0.3333333;
       }},
      {"accessors[2].min[0]: found 1; accepted: the least value of the data, -7",
       [](Builder& b) {
         b.json["accessors"][b.accessor<std::int8_t>("VEC3", 3, {-7, 2, 3, 4, 5, 6})]["min"][0] = 1;
       }},
      {"accessors[2]: found 9 elements, 108 bytes from byte 0 on; accepted: a range inside "
       "bufferViews[2], which has 12 bytes",
       [](Builder& b) {
         Json& accessor = b.json["accessors"][b.vec3({0, 0, 0})];
         accessor["count"] = 9;
         accessor.erase("min");
         accessor.erase("max");
       }},
      // A sparse value takes the place of the one that was the least.
      {"",
       [](Builder& b) {
         const int at = b.view(std::vector<std::uint16_t>{0});
         const int by = b.view(std::vector<float>{4});
         Json& accessor = b.json["accessors"][b.accessor<float>("SCALAR", 1, {-9, 5, 6})];
         accessor["min"] = {4};
         accessor["sparse"] = {{"count", 1},
                               {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                               {"values", {{"bufferView", by}}}};
       }},
      // Zeros where there is no view, but for one.
      {"accessors[2].min[0]: found 4; accepted: the least value of the data, 0",
       [](Builder& b) {
         const int at = b.view(std::vector<std::uint16_t>{0});
         const int by = b.view(std::vector<float>{4});
         Json& accessor = b.json["accessors"][b.accessor<float>("SCALAR", 1, {4, 4})];
         accessor.erase("bufferView");
         accessor["sparse"] = {{"count", 1},
                               {"indices", {{"bufferView", at}, {"componentType", 5123}}},
                               {"values", {{"bufferView", by}}}};
       }},
      {"meshes[0].primitives[0].indices: found 255; accepted: smaller values, since glTF reserves "
       "the largest of each type",
       [](Builder& b) {
         auto& primitive = b.json["meshes"][0]["primitives"][0];
         primitive["attributes"]["POSITION"] = b.vec3(std::vector<float>(3 * 256, 0.0f));
         primitive["indices"] = b.accessor<std::uint8_t>("SCALAR", 1, {0, 1, 255});
         b.json["accessors"].back().erase("min");
         b.json["accessors"].back().erase("max");
       }},
      {"images[0].uri: ./none.png: found no such file; accepted: a file that can be read",
       [](Builder& b) {
         b.json["images"] = {{{"uri", "none.png"}}};
       }},
      {"images[0].uri: found a data URI with other characters than base64's; accepted: base64",
       [](Builder& b) {
         b.json["images"] = {{{"uri", "data:image/png;base64,`"}}};
       }},
      {"images[0]: found 3 bytes of another kind; accepted: a PNG, JPEG or WebP picture",
       [](Builder& b) {
         b.json["images"] = {{{"uri", "data:image/png;base64,AAAA"}}};
       }},
      {"the extension KHR_texture_basisu is not supported and ignored",
       [](Builder& b) {
         b.json["images"] = {{{"uri", "data:image/ktx2;base64,AAAA"}}};
         b.json["extensionsUsed"] = {"KHR_texture_basisu"};
       }},
      {"",
       [&](Builder& b) {
         skin(b, {0, 0, 0, 1, 0, 0, 0, 1});
       }},
      {"skins[0].inverseBindMatrices: found the last row 0, 0, 0, 4 in matrix 1; accepted: "
       "0, 0, 0, 1",
       [&](Builder& b) {
         skin(b, {0, 0, 0, 1, 0, 0, 0, 4});
       }},
      {"nodes[0].skin: found joint node 1 outside the shown scene; accepted: nodes of that scene",
       [&](Builder& b) {
         skin(b, {0, 0, 0, 1, 0, 0, 0, 1});
         b.json["scenes"][0]["nodes"] = {0};
       }},
      {"", [&](Builder& b) { normals(b, 0.995f); }},
      {"meshes[0].primitives[0].attributes.NORMAL: 1 of 4 normals are not of length 1, they are "
       "made so",
       [&](Builder& b) { normals(b, 3.0f); }},
      {"materials[0].pbrMetallicRoughness.baseColorFactor: 1.5 is outside [0, 1], 1 is used",
       [&](Builder& b) {
         b.json["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] = {1.5, 0.5, 0.5, 1.0};
       }},
      {"materials[0].pbrMetallicRoughness.roughnessFactor: -2 is outside [0, 1], 0 is used",
       [&](Builder& b) {
         b.json["materials"][0]["pbrMetallicRoughness"]["roughnessFactor"] = -2.0;
       }},
  };
  for (std::size_t i = 0; i < values.size(); ++i) {
    SCOPED_TRACE(fmt::format("{}: {}", i, values[i].words));
    Builder b;
    b.quad();
    values[i].make(b);
    const auto model = b.load(".");
    ASSERT_TRUE(model.ok()) << model.error().message;
    EXPECT_EQ(fmt::format("{}", fmt::join(model->notes, "\n")), values[i].words);
  }
}

// Accessors without end over the same bytes: the look at them has one.
TEST(GltfAudit, BytesAreNotLookedAtAgainAndAgain) {
  Builder b;
  b.quad();
  Json big = b.json["accessors"]
                   [b.accessor<std::uint8_t>("SCALAR", 1, std::vector<std::uint8_t>(1 << 20, 7))];
  for (int i = 0; i < 100; ++i) b.json["accessors"].push_back(big);
  const auto model = b.load();
  ASSERT_TRUE(model.ok()) << model.error().message;
  ASSERT_EQ(model->notes.size(), 1u);
  EXPECT_NE(model->notes[0].find("lie over one another"), std::string::npos) << model->notes[0];
}

// Seconds of processor time that a load takes with accessors over the same sparse places.
double load_of_sparse_s(int accessors) {
  Builder b;
  b.quad();
  constexpr std::uint32_t kCount = 1 << 20;
  std::vector<std::uint32_t> places(kCount);
  for (std::uint32_t i = 0; i < kCount; ++i) places[i] = i;
  const Json sparse = {
      {"count", kCount},
      {"indices", {{"bufferView", b.view<std::uint32_t>(places)}, {"componentType", 5125}}},
      {"values", {{"bufferView", b.view<std::uint8_t>(std::vector<std::uint8_t>(kCount, 7))}}}};
  const Json accessor = {
      {"componentType", 5121}, {"type", "SCALAR"}, {"count", kCount}, {"sparse", sparse}};
  for (int i = 0; i < accessors; ++i) b.json["accessors"].push_back(accessor);
  const std::clock_t start = std::clock();
  const auto model = b.load();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  EXPECT_TRUE(model.ok()) << model.error().message;
  EXPECT_EQ(model->notes.size(), 1u);
  EXPECT_NE(model->notes.at(0).find("lie over one another"), std::string::npos);
  return seconds;
}

// Nor are sparse places, which are copied where they are located.
TEST(GltfAudit, SparsePlacesAreNotCopiedAgainAndAgain) {
  const double few_s = load_of_sparse_s(20);
  EXPECT_LT(load_of_sparse_s(2000), 20.0 * few_s) << few_s;
}

// A value of the wrong JSON type does not stop the audit.
TEST(GltfAudit, AnyShapeIsTaken) {
  const Json odd[] = {nullptr, 1, -1, 1.5, "x", Json::array(), Json::object(), {{"a", {1, 2}}}};
  for (const char* key : {"cameras", "images", "textures", "samplers"})
    for (const Json& value : odd) {
      Builder b;
      b.quad();
      b.json[key] = value;
      (void)b.load();  // loads or is refused
      b.json[key] = {value};
      (void)b.load();
    }
}

}  // namespace
}  // namespace neritic::scene
