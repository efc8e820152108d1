// Files that the glTF loader refuses, and the place that its error names.
#include "engine/core/files.hpp"
#include "tests/scene/gltf_builder.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

TEST(GltfLoader, RequiredExtensionsAreRefusedByNameOptionalOnesNotedOnce) {
  Builder b;
  b.quad();
  b.json["extensionsUsed"] = {"KHR_materials_variants", "KHR_materials_variants",
                              "KHR_materials_unlit"};
  const auto model = b.load();
  ASSERT_LOADS(model);
  ASSERT_EQ(model->notes.size(), 1u);
  EXPECT_NE(model->notes[0].find("KHR_materials_variants"), std::string::npos);
  b.json["extensionsRequired"] = {"KHR_materials_variants"};
  expect_refused(b, "extensionsRequired: found KHR_materials_variants; accepted: EXT_mesh_gpu");
}

TEST(GltfLoader, FaultsAreNamedWithTheirPlaceInTheFile) {
  const auto broken = [](const std::string& words, auto change) {
    Builder b;
    b.quad();
    change(b);
    expect_refused(b, words);
  };
  broken("nodes[0].mesh: found 7; accepted: an index below 1, the number of meshes",
         [](Builder& b) { b.json["nodes"][0]["mesh"] = 7; });
  broken("nodes[0].mesh: found -1", [](Builder& b) { b.json["nodes"][0]["mesh"] = -1; });
  broken("nodes[0].mesh: found \"a\"", [](Builder& b) { b.json["nodes"][0]["mesh"] = "a"; });
  broken("nodes[0].rotation: found \"a\" as entry 2; accepted: a list of 4 numbers",
         [](Builder& b) {
           b.json["nodes"][0]["rotation"] = {0, 0, "a", 1};
         });
  broken("nodes[0].scale: found [1,2]; accepted: a list of 3 numbers", [](Builder& b) {
    b.json["nodes"][0]["scale"] = {1, 2};
  });
  broken("accessors[0]: found 4000000000 elements",
         [](Builder& b) { b.json["accessors"][0]["count"] = 4000000000u; });
  broken("accepted: less, for a file of this size", [](Builder& b) {
    b.json["accessors"][0]["count"] = 4000000000u;
    b.json["accessors"][0].erase("bufferView");
  });
  broken("accessors[0]: found 4 elements, 48 bytes from byte 8 on",
         [](Builder& b) { b.json["accessors"][0]["byteOffset"] = 8; });
  broken("bufferViews[0]: found 18446744073709551615 + ",
         [](Builder& b) { b.json["bufferViews"][0]["byteOffset"] = 18446744073709551615u; });
  broken("bufferViews[0].byteStride: found 4",
         [](Builder& b) { b.json["bufferViews"][0]["byteStride"] = 4; });
  broken("found index 3; accepted: an index below 3",
         [](Builder& b) { b.json["accessors"][0]["count"] = 3; });
  broken("found component type 5124; accepted: 5120 (int8)",
         [](Builder& b) { b.json["accessors"][0]["componentType"] = 5124; });
  broken("type \"VEC2\"; accepted: VEC3",
         [](Builder& b) { b.json["accessors"][0]["type"] = "VEC2"; });
  broken("meshes[0].primitives[0].mode: found 9",
         [](Builder& b) { b.json["meshes"][0]["primitives"][0]["mode"] = 9; });
  broken("its own ancestor", [](Builder& b) {
    b.json["nodes"] = {{{"children", {1}}}, {{"children", {0}}}};
  });
  broken("its own ancestor", [](Builder& b) { b.json["nodes"] = {{{"children", {0}}}}; });
  broken("accepted: one parent", [](Builder& b) {
    b.json["nodes"] = {{{"children", {2}}}, {{"children", {2}}}, Json::object()};
  });
  broken("accepted: one parent", [](Builder& b) {
    b.json["nodes"] = {{{"children", {1, 1}}}, Json::object()};
  });
  broken("asset.version: found \"1.0\"", [](Builder& b) { b.json["asset"]["version"] = "1.0"; });
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
    ASSERT_TRUE(write_text(folder / "model/m.gltf", json_text(json, -1)).ok());
    const auto model = load_gltf(folder / "model/m.gltf");
    EXPECT_EQ(model.ok(), accepted) << uri << (model.ok() ? "" : " " + model.error().message);
    if (model.ok()) continue;
    EXPECT_NE(model.error().message.find("buffers[0].uri"), std::string::npos);
  }
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

}  // namespace
}  // namespace neritic::scene
