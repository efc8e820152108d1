// Compressed meshes and WebP pictures: what loads is what was compressed, within its rounding, and
// broken streams end in one line.
#include "tests/scene/compressed_files.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

using Builder = GltfBuilder;

// Centres of the faces, sorted: the compressors put vertices and faces in another order.
std::vector<std::array<float, 5>> faces_of(const Primitive& p) {
  std::vector<std::array<float, 5>> out;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    Vec3f centre(0.0f);
    Vec2f uv(0.0f);
    for (int k = 0; k < 3; ++k) {
      centre += p.positions[p.indices[i + k]] / 3.0f;
      uv += p.uv0[p.indices[i + k]] / 3.0f;
    }
    out.push_back(
        {std::round(centre.x * 300) / 300, std::round(centre.y * 300) / 300, centre.z, uv.x, uv.y});
  }
  std::sort(out.begin(), out.end());
  return out;
}

void expect_same_surface(const Model& found, const Model& wanted, float tolerance) {
  const Primitive &f = found.meshes[0].primitives[0], &w = wanted.meshes[0].primitives[0];
  ASSERT_EQ(f.indices.size(), w.indices.size());
  const auto faces = faces_of(f), expected = faces_of(w);
  for (std::size_t i = 0; i < faces.size(); ++i)
    for (int c = 0; c < 5; ++c) ASSERT_NEAR(faces[i][c], expected[i][c], tolerance) << i;
  double worst = 0.0;
  for (std::size_t i = 0; i < f.positions.size(); ++i)
    worst = std::max(worst, glm::distance(Vec3(f.normals[i]), test::bump_normal(f.positions[i])));
  EXPECT_LT(worst, 0.02);
}

TEST(GltfCompressed, DracoGivesTheSurfaceThatWasCompressed) {
  const Model plain = test::plain_bump().load().value();
  for (const bool edgebreaker : {true, false}) {
    const auto model = test::draco_bump(edgebreaker).load();
    ASSERT_LOADS(model);
    EXPECT_TRUE(model->notes.empty()) << model->notes[0];
    expect_same_surface(*model, plain, 1e-3f);
  }
}

TEST(GltfCompressed, MeshoptGivesTheSurfaceThatWasCompressed) {
  const Model plain = test::plain_bump().load().value();
  for (const char* filter : {"NONE", "OCTAHEDRAL", "EXPONENTIAL"}) {
    const auto model = test::meshopt_bump(filter).load();
    ASSERT_LOADS(model);
    EXPECT_TRUE(model->notes.empty()) << model->notes[0];
    expect_same_surface(*model, plain, 1e-3f);
  }
}

TEST(GltfCompressed, WebpPicturesAreDrawnInPlaceOfTheirFallBack) {
  const auto model = test::webp_quad(true).load();
  ASSERT_LOADS(model);
  EXPECT_TRUE(model->notes.empty()) << model->notes[0];
  const ImageU8& picture = model->images[model->textures[0].image];
  ASSERT_EQ(picture.width, 5u);
  ASSERT_EQ(picture.height, 3u);
  for (std::uint32_t y = 0; y < 3; ++y)
    for (std::uint32_t x = 0; x < 5; ++x) {
      EXPECT_EQ(picture.at(x, y, 0), 40 * x);
      EXPECT_EQ(picture.at(x, y, 1), 60 * y);
      EXPECT_EQ(picture.at(x, y, 3), 255 - 10 * x);
    }
}

TEST(GltfCompressed, LossyWebpIsNearAndGreyIsItsLuma) {
  const std::vector<std::uint8_t> file = test::webp_file(false);
  const auto bytes = std::as_bytes(std::span(file));
  EXPECT_EQ(peek_size(bytes).width, 64u);
  const auto color = decode_image8(bytes, "a.webp"), grey = decode_image8(bytes, "a.webp", 1);
  ASSERT_TRUE(color.ok() && grey.ok());
  ASSERT_EQ(color->channels, 3u);
  EXPECT_NEAR(color->at(50, 20, 0), 200, 12);
  EXPECT_NEAR(
      grey->at(50, 20),
      0.299 * color->at(50, 20, 0) + 0.587 * color->at(50, 20, 1) + 0.114 * color->at(50, 20, 2),
      1.0);
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    const auto cut = decode_image8(bytes.first(length), "cut.webp");
    ASSERT_FALSE(cut.ok()) << length;
    EXPECT_TRUE(cut.error().message.starts_with("cut.webp: found ")) << cut.error().message;
  }
}

TEST(GltfCompressed, BrokenDracoEndsInOneLine) {
  const Json extension = test::draco_bump(true).json["meshes"][0]["primitives"][0]["extensions"];
  const auto with = [](auto&& change) {
    Builder b = test::draco_bump(true);
    change(b, b.json["meshes"][0]["primitives"][0]);
    return b;
  };
  const std::string at = "meshes[0].primitives[0].extensions.KHR_draco_mesh_compression";
  Builder cut = with([](Builder& b, Json&) {
    auto& length = b.json["bufferViews"].back()["byteLength"];
    length = length.get<int>() / 2;
  });
  expect_refused(cut, at + ": found a broken Draco stream");
  Builder few =
      with([](Builder& b, Json& p) { b.json["accessors"][p["indices"].get<int>()]["count"] = 30; });
  expect_refused(few, at + ": found a Draco stream of 162 faces; accepted: at most 10");
  Builder id = with([](Builder&, Json& p) {
    p["extensions"]["KHR_draco_mesh_compression"]["attributes"]["NORMAL"] = 77;
  });
  expect_refused(id, at + ".attributes.NORMAL: found id 77");
  Builder type = with([](Builder& b, Json& p) {
    b.json["accessors"][p["attributes"]["NORMAL"].get<int>()]["type"] = "VEC4";
  });
  expect_refused(type, ".attributes.NORMAL: found a Draco attribute of 3 numbers");
  Builder no_stream = with([](Builder& b, Json&) { b.bytes.assign(b.bytes.size(), 7); });
  expect_refused(no_stream, "that do not begin as Draco does");
  Builder strip = with([](Builder&, Json& p) { p["mode"] = 5; });
  expect_refused(strip, "mode: found mode 5; accepted: 4 (triangles)");
}

TEST(GltfCompressed, BrokenMeshoptEndsInOneLine) {
  const auto change = [](const char* key, const Json& value) {
    Builder b = test::meshopt_bump("NONE");
    b.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = value;
    return b;
  };
  const std::string at = "bufferViews[0].extensions.EXT_meshopt_compression: found ";
  const std::pair<const char*, std::pair<Json, std::string>> cases[] = {
      {"mode", {"STRIPS", at + "mode \"STRIPS\"; accepted: ATTRIBUTES, TRIANGLES or INDICES"}},
      {"byteStride", {6, at + "byteStride 6; accepted: a multiple of 4"}},
      {"filter", {"QUATERNION", at + "byteStride 12 with filter QUATERNION; accepted: 8"}},
      {"count", {4, "bufferViews[0]: found byteLength 1200; accepted: 48"}},
      {"byteLength", {5, at + "a broken meshopt stream of 5 bytes"}},
      {"buffer", {9, "buffer: found 9"}}};
  for (const auto& [key, wrong] : cases) {
    Builder b = change(key, wrong.first);
    expect_refused(b, wrong.second);
  }
}

}  // namespace
}  // namespace neritic::scene
