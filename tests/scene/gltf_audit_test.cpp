// What breaks glTF's rules beside what a model needs is said, and the model is shown.
#include <gtest/gtest.h>

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
      {"cameras: an empty list found", [](Json& j) { j["cameras"] = Json::array(); }},
      {"nodes[0].children: an empty list",
       [](Json& j) { j["nodes"][0]["children"] = Json::array(); }},
      {"images[0].bufferView: 9 found, there are 2 bufferViews",
       [](Json& j) {
         j["images"] = {{{"bufferView", 9}, {"mimeType", "image/png"}}};
       }},
      {"bufferViews[2]: no buffer found",
       [](Json& j) {
         j["bufferViews"].push_back({{"byteLength", 4}});
       }},
      {"bytes from byte 4 found", [&](Json& j) { j["bufferViews"].push_back(far_view); }},
      {"byteLength: 0 found",
       [](Json& j) {
         j["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 0}});
       }},
      {"byteStride: 6 found, multiples of 4",
       [](Json& j) {
         j["bufferViews"].push_back({{"buffer", 0}, {"byteLength", 8}, {"byteStride", 6}});
       }},
      {"images[0].uri: ftp://a/b.png found",
       [](Json& j) {
         j["images"] = {{{"uri", "ftp://a/b.png"}}};
       }},
      {"no multiple of 4 bytes",
       [](Json& j) {
         j["accessors"].push_back({{"bufferView", 0},
                                   {"byteOffset", 2},
                                   {"componentType", 5126},
                                   {"count", 1},
                                   {"type", "SCALAR"}});
       }},
      {"a matrix beside translation",
       [](Json& j) {
         j["nodes"].push_back({{"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}},
                               {"translation", {0, 0, 0}}});
       }},
      {"weights: found without a mesh",
       [](Json& j) {
         j["nodes"].push_back({{"weights", {1}}});
       }},
      {"perspective and orthographic found",
       [](Json& j) {
         j["cameras"] = {{{"type", "perspective"},
                          {"perspective", {{"yfov", 1}, {"znear", 1}}},
                          {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 2}, {"znear", 1}}}}};
       }},
      {"POSITION: an accessor without min and max",
       [](Json& j) { j["accessors"][0].erase("min"); }},
      {"WIDTH found, glTF's names",
       [](Json& j) { j["meshes"][0]["primitives"][0]["attributes"]["WIDTH"] = 0; }},
      {"KHR_materials_unlit found, it does not belong there",
       [](Json& j) {
         j["extensionsUsed"] = {"KHR_materials_unlit"};
         j["nodes"][0]["extensions"]["KHR_materials_unlit"] = Json::object();
       }},
      {"EXT_secret found, extensionsUsed does not name it",
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

// What is no object, no list or no number where one belongs is no fault of the audit's reading.
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
