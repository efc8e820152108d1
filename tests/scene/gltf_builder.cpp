#include "tests/scene/gltf_builder.hpp"

namespace neritic::scene {
namespace {

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

}  // namespace

Json& GltfBuilder::quad() {
  const int p = vec3({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0});
  const int i = accessor<std::uint16_t>("SCALAR", 1, {0, 1, 2, 0, 2, 3});
  json["meshes"] = {{{"primitives", {{{"attributes", {{"POSITION", p}}}, {"indices", i}}}}}};
  json["nodes"] = {{{"mesh", 0}}};
  json["scenes"] = {{{"nodes", {0}}}};
  json["scene"] = 0;
  return json["meshes"][0]["primitives"][0];
}

Result<Model> GltfBuilder::load(const std::filesystem::path& folder) {
  if (!bytes.empty())
    json["buffers"] = {{{"byteLength", bytes.size()},
                        {"uri", "data:application/octet-stream;base64," + base64(bytes)}}};
  if (fallback_bytes > 0)
    json["buffers"].push_back(
        {{"byteLength", fallback_bytes},
         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
  const std::string text = json_text(json, -1);
  return parse_gltf_bytes(std::as_bytes(std::span(text.data(), text.size())), "made.gltf", folder);
}

void expect_refused(GltfBuilder& builder, const std::string& words) {
  const auto model = builder.load();
  ASSERT_FALSE(model.ok()) << words;
  EXPECT_EQ(model.error().code, ErrorCode::kBadInput);
  EXPECT_NE(model.error().message.find(words), std::string::npos) << model.error().message;
  EXPECT_EQ(model.error().message.rfind("made.gltf: ", 0), 0u) << model.error().message;
}

}  // namespace neritic::scene
