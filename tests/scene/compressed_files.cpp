#include "tests/scene/compressed_files.hpp"

#include <draco/compression/expert_encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>
#include <webp/encode.h>

namespace neritic::test {
namespace {
using scene::GltfBuilder;
using scene::Json;

constexpr int kSide = 10;

struct Bump {
  std::vector<float> positions, normals, uvs;
  std::vector<std::uint16_t> indices;
};

Bump bump() {
  Bump out;
  for (int y = 0; y < kSide; ++y)
    for (int x = 0; x < kSide; ++x) {
      const float u = float(x) / (kSide - 1), v = float(y) / (kSide - 1);
      const Vec3f p(u, v, 0.25f * u * u * v);
      const Vec3 n = bump_normal(p);
      out.positions.insert(out.positions.end(), {p.x, p.y, p.z});
      out.normals.insert(out.normals.end(), {float(n.x), float(n.y), float(n.z)});
      out.uvs.insert(out.uvs.end(), {u, 1.0f - v});
      if (x + 1 == kSide || y + 1 == kSide) continue;
      const std::uint16_t a = y * kSide + x, b = a + 1, c = b + kSide, d = a + kSide;
      out.indices.insert(out.indices.end(), {a, b, c, a, c, d});
    }
  return out;
}

GltfBuilder with_mesh(GltfBuilder b, int position, int normal, int uv, int indices) {
  b.json["meshes"] = {
      {{"primitives",
        {{{"attributes", {{"POSITION", position}, {"NORMAL", normal}, {"TEXCOORD_0", uv}}},
          {"indices", indices}}}}}};
  b.json["nodes"] = {{{"mesh", 0}}};
  b.json["scenes"] = {{{"nodes", {0}}}};
  b.json["scene"] = 0;
  return b;
}

Json accessor(const char* type, int component, int count) {
  return {{"componentType", component}, {"type", type}, {"count", count}};
}

std::vector<std::uint8_t> draco_stream(const Bump& bump, bool edgebreaker) {
  draco::TriangleSoupMeshBuilder builder;
  builder.Start(static_cast<int>(bump.indices.size() / 3));
  const auto add = [&](draco::GeometryAttribute::Type type, int n, const std::vector<float>& list) {
    const int id = builder.AddAttribute(type, static_cast<std::int8_t>(n), draco::DT_FLOAT32);
    for (std::size_t f = 0; f < bump.indices.size() / 3; ++f)
      builder.SetAttributeValuesForFace(
          id, draco::FaceIndex(static_cast<std::uint32_t>(f)), &list[bump.indices[3 * f] * n],
          &list[bump.indices[3 * f + 1] * n], &list[bump.indices[3 * f + 2] * n]);
  };
  add(draco::GeometryAttribute::POSITION, 3, bump.positions);
  add(draco::GeometryAttribute::NORMAL, 3, bump.normals);
  add(draco::GeometryAttribute::TEX_COORD, 2, bump.uvs);
  const auto mesh = builder.Finalize();
  draco::ExpertEncoder encoder(*mesh);
  encoder.SetEncodingMethod(edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                        : draco::MESH_SEQUENTIAL_ENCODING);
  for (int id = 0; id < 3; ++id) encoder.SetAttributeQuantization(id, id == 0 ? 14 : 12);
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(encoder.EncodeToBuffer(&buffer).ok());
  return {buffer.data(), buffer.data() + buffer.size()};
}

}  // namespace

Vec3 bump_normal(const Vec3f& p) {
  return glm::normalize(Vec3(-0.5 * p.x * p.y, -0.25 * p.x * p.x, 1.0));
}

GltfBuilder plain_bump() {
  const Bump list = bump();
  GltfBuilder b;
  const int p = b.vec3(list.positions), n = b.vec3(list.normals),
            uv = b.accessor("VEC2", 2, list.uvs), i = b.accessor("SCALAR", 1, list.indices);
  return with_mesh(std::move(b), p, n, uv, i);
}

GltfBuilder draco_bump(bool edgebreaker) {
  const Bump list = bump();
  GltfBuilder b;
  const int view = b.view(draco_stream(list, edgebreaker));
  b.json["accessors"] = {accessor("VEC3", 5126, kSide * kSide),
                         accessor("VEC3", 5126, kSide * kSide),
                         accessor("VEC2", 5126, kSide * kSide),
                         accessor("SCALAR", 5123, static_cast<int>(list.indices.size()))};
  b.json["accessors"][0]["min"] = {0, 0, 0};
  b.json["accessors"][0]["max"] = {1, 1, 0.25};
  b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
  b = with_mesh(std::move(b), 0, 1, 2, 3);
  b.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"] = {
      {"bufferView", view}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}};
  return b;
}

GltfBuilder meshopt_bump(const std::string& filter) {
  Bump list = bump();
  GltfBuilder b;
  const std::size_t n = kSide * kSide;
  // The view that the accessors see lies in a buffer without bytes, as gltfpack writes it.
  const auto add = [&](const std::vector<std::uint8_t>& stream, std::size_t count,
                       std::size_t stride, const char* mode, const char* how) {
    const Json stored = [&] {
      const int at = b.view(stream);
      const Json view = b.json["bufferViews"][at];
      b.json["bufferViews"].erase(at);
      return view;
    }();
    b.json["bufferViews"].push_back({{"buffer", 1},
                                     {"byteOffset", 0},
                                     {"byteLength", count * stride},
                                     {"extensions",
                                      {{"EXT_meshopt_compression",
                                        {{"buffer", 0},
                                         {"byteOffset", stored["byteOffset"]},
                                         {"byteLength", stored["byteLength"]},
                                         {"byteStride", stride},
                                         {"count", count},
                                         {"mode", mode},
                                         {"filter", how}}}}}});
    if (std::string(mode) == "ATTRIBUTES") b.json["bufferViews"].back()["byteStride"] = stride;
    return static_cast<int>(b.json["bufferViews"].size()) - 1;
  };
  const auto add_vertices = [&](const void* data, std::size_t stride, const char* how) {
    std::vector<std::uint8_t> stream(meshopt_encodeVertexBufferBound(n, stride));
    stream.resize(meshopt_encodeVertexBuffer(stream.data(), stream.size(), data, n, stride));
    return add(stream, n, stride, "ATTRIBUTES", how);
  };
  b.json["accessors"] = {accessor("VEC3", 5126, n), accessor("VEC3", 5126, n),
                         accessor("VEC2", 5126, n),
                         accessor("SCALAR", 5123, static_cast<int>(list.indices.size()))};
  if (filter == "EXPONENTIAL") {
    std::vector<std::uint32_t> packed(3 * n);
    meshopt_encodeFilterExp(packed.data(), n, 12, 15, list.positions.data());
    b.json["accessors"][0]["bufferView"] = add_vertices(packed.data(), 12, "EXPONENTIAL");
  } else {
    b.json["accessors"][0]["bufferView"] = add_vertices(list.positions.data(), 12, "NONE");
  }
  b.json["accessors"][0]["min"] = {0, 0, 0};
  b.json["accessors"][0]["max"] = {1, 1, 0.25};
  if (filter == "OCTAHEDRAL") {
    std::vector<float> wide;
    for (std::size_t i = 0; i < n; ++i)
      wide.insert(wide.end(),
                  {list.normals[3 * i], list.normals[3 * i + 1], list.normals[3 * i + 2], 0.0f});
    std::vector<std::int8_t> packed(4 * n);
    meshopt_encodeFilterOct(packed.data(), n, 4, 8, wide.data());
    b.json["accessors"][1] = accessor("VEC3", 5120, n);
    b.json["accessors"][1]["normalized"] = true;
    b.json["accessors"][1]["bufferView"] = add_vertices(packed.data(), 4, "OCTAHEDRAL");
  } else {
    b.json["accessors"][1]["bufferView"] = add_vertices(list.normals.data(), 12, "NONE");
  }
  b.json["accessors"][2]["bufferView"] = add_vertices(list.uvs.data(), 8, "NONE");
  const std::vector<std::uint32_t> indices(list.indices.begin(), list.indices.end());
  std::vector<std::uint8_t> stream(meshopt_encodeIndexBufferBound(indices.size(), n));
  stream.resize(
      meshopt_encodeIndexBuffer(stream.data(), stream.size(), indices.data(), indices.size()));
  b.json["accessors"][3]["bufferView"] = add(stream, indices.size(), 2, "TRIANGLES", "NONE");
  b.fallback_bytes = 1200;
  b.json["extensionsUsed"] = {"EXT_meshopt_compression", "KHR_mesh_quantization"};
  b.json["extensionsRequired"] = b.json["extensionsUsed"];
  return with_mesh(std::move(b), 0, 1, 2, 3);
}

std::vector<std::uint8_t> webp_file(bool lossless) {
  const int width = lossless ? 5 : 64, height = lossless ? 3 : 64;
  std::vector<std::uint8_t> pixels;
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const int rgba[] = {lossless ? 40 * x : 200, lossless ? 60 * y : 2 * y, 90, 255 - 10 * x};
      for (int c = 0; c < (lossless ? 4 : 3); ++c)
        pixels.push_back(static_cast<std::uint8_t>(rgba[c]));
    }
  std::uint8_t* out = nullptr;
  const std::size_t size =
      lossless ? WebPEncodeLosslessRGBA(pixels.data(), width, height, 4 * width, &out)
               : WebPEncodeRGB(pixels.data(), width, height, 3 * width, 80.0f, &out);
  const std::vector<std::uint8_t> file(out, out + size);
  WebPFree(out);
  return file;
}

GltfBuilder webp_quad(bool lossless) {
  GltfBuilder b;
  const int fall_back = b.view(webp_file(!lossless)), view = b.view(webp_file(lossless));
  b.json["images"] = {{{"bufferView", fall_back}, {"mimeType", "image/png"}},
                      {{"bufferView", view}, {"mimeType", "image/webp"}}};
  b.json["textures"] = {{{"source", 0}, {"extensions", {{"EXT_texture_webp", {{"source", 1}}}}}}};
  b.json["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
  b.json["extensionsUsed"] = {"EXT_texture_webp"};
  b.quad()["material"] = 0;
  return b;
}

}  // namespace neritic::test
