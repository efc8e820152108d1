// See gltf_draco.hpp.
#include "engine/scene/gltf_draco.hpp"

#include <draco/compression/decode.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/metadata_decoder.h>

namespace neritic::scene::gltf {
namespace {

constexpr std::uint8_t kTriangles = 1, kSequential = 0, kEdgebreaker = 1;
constexpr std::uint16_t kMetadataFlag = 0x8000;
// Bytes that a face takes while it is decoded and in the supplied accessors.
constexpr std::size_t kBytesPerFace = 128;

draco::DecoderBuffer buffer_of(std::span<const std::byte> bytes) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  return buffer;
}

struct Header {
  char magic[5] = {};
  std::uint8_t major = 0, minor = 0, geometry = 0, method = 0;
  std::uint16_t flags = 0;
};

// Faces as the stream's own header says (specification, sections 3 to 5): the decoder allocates for
// them before it looks for their data.
Result<std::uint32_t> count_faces(std::span<const std::byte> bytes) {
  const auto broken = [](std::string_view found) {
    return refusal("", found, "a whole Draco stream 2.2 of triangles");
  };
  draco::DecoderBuffer buffer = buffer_of(bytes);
  Header h;
  const bool whole = buffer.Decode(h.magic, sizeof h.magic) && buffer.Decode(&h.major) &&
                     buffer.Decode(&h.minor) && buffer.Decode(&h.geometry) &&
                     buffer.Decode(&h.method) && buffer.Decode(&h.flags);
  if (!whole || std::string_view(h.magic, sizeof h.magic) != "DRACO")
    return broken(fmt::format("{} bytes that do not begin as Draco does", bytes.size()));
  if (h.major != 2 || h.minor != 2) return broken(fmt::format("Draco {}.{}", h.major, h.minor));
  if (h.geometry != kTriangles || h.method > kEdgebreaker)
    return broken(fmt::format("Draco geometry {}, method {}", h.geometry, h.method));
  buffer.set_bitstream_version(DRACO_BITSTREAM_VERSION(2, 2));
  if (h.flags & kMetadataFlag) {
    draco::GeometryMetadata ignored;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(&buffer, &ignored))
      return broken("broken metadata");
  }
  std::uint8_t traversal = 0;
  std::uint32_t faces = 0, vertices = 0;
  const bool counted =
      h.method == kSequential
          ? draco::DecodeVarint(&faces, &buffer) && draco::DecodeVarint(&vertices, &buffer)
          : buffer.Decode(&traversal) && draco::DecodeVarint(&vertices, &buffer) &&
                draco::DecodeVarint(&faces, &buffer);
  if (!counted) return broken("a stream that ends before its counts");
  if (vertices > 3ull * faces)
    return broken(fmt::format("{} vertices of {} faces", vertices, faces));
  return faces;
}

template <class T>
std::vector<std::byte> values_of(const draco::Mesh& mesh, const draco::PointAttribute& attribute) {
  const int n = attribute.num_components();
  std::vector<std::byte> out(mesh.num_points() * n * sizeof(T));
  T value[256];  // a stream counts components in a byte
  for (std::uint32_t i = 0; i < mesh.num_points(); ++i) {
    const auto at = attribute.mapped_index(draco::PointIndex(i));
    if (at.value() >= attribute.size() ||
        !attribute.ConvertValue<T>(at, static_cast<std::int8_t>(n), value))
      return {};
    std::memcpy(out.data() + i * n * sizeof(T), value, n * sizeof(T));
  }
  return out;
}

}  // namespace

struct DracoMesh::Decoded {
  std::unique_ptr<draco::Mesh> mesh;
};

DracoMesh::DracoMesh(std::unique_ptr<Decoded> decoded) : decoded_(std::move(decoded)) {}
DracoMesh::DracoMesh(DracoMesh&&) noexcept = default;
DracoMesh::~DracoMesh() = default;

Result<DracoMesh> DracoMesh::decode(std::span<const std::byte> bytes, std::size_t max_faces) {
  NERITIC_TRY(const std::uint32_t faces, count_faces(bytes));
  if (faces > max_faces)
    return refusal("", fmt::format("a Draco stream of {} faces", faces),
                   fmt::format("at most {}, as many as the indices' accessor has", max_faces));
  draco::DecoderBuffer buffer = buffer_of(bytes);
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok())
    return refusal("", fmt::format("a broken Draco stream ({})", mesh.status().error_msg_string()),
                   "a whole one");
  auto decoded = std::make_unique<Decoded>();
  decoded->mesh = std::move(mesh).value();
  for (std::uint32_t i = 0; i < decoded->mesh->num_faces(); ++i)
    for (const auto& point : decoded->mesh->face(draco::FaceIndex(i)))
      if (point.value() >= decoded->mesh->num_points())
        return refusal("", fmt::format("point {} in a Draco stream", point.value()),
                       fmt::format("points below {}", decoded->mesh->num_points()));
  return DracoMesh(std::move(decoded));
}

std::size_t DracoMesh::points() const {
  return decoded_->mesh->num_points();
}

std::vector<std::uint32_t> DracoMesh::indices() const {
  std::vector<std::uint32_t> out;
  out.reserve(std::size_t{decoded_->mesh->num_faces()} * 3);
  for (std::uint32_t i = 0; i < decoded_->mesh->num_faces(); ++i)
    for (const auto& point : decoded_->mesh->face(draco::FaceIndex(i)))
      out.push_back(point.value());
  return out;
}

int DracoMesh::components(std::uint32_t id) const {
  const draco::PointAttribute* attribute = decoded_->mesh->GetAttributeByUniqueId(id);
  return attribute ? attribute->num_components() : 0;
}

std::vector<std::byte> DracoMesh::attribute(std::uint32_t id, std::uint32_t component_type) const {
  const draco::Mesh& mesh = *decoded_->mesh;
  const draco::PointAttribute& attribute = *mesh.GetAttributeByUniqueId(id);
  switch (component_type) {
    case 5120:
      return values_of<std::int8_t>(mesh, attribute);
    case 5121:
      return values_of<std::uint8_t>(mesh, attribute);
    case 5122:
      return values_of<std::int16_t>(mesh, attribute);
    case 5123:
      return values_of<std::uint16_t>(mesh, attribute);
    case 5125:
      return values_of<std::uint32_t>(mesh, attribute);
    default:
      return values_of<float>(mesh, attribute);
  }
}

namespace {

void supply_attribute(Loading& loading, const DracoMesh& mesh, Field id, Field reference) {
  const Resources::Shape shape = loading.resources.shape(reference);
  if (loading.report.failed()) return;
  const auto unique_id = static_cast<std::uint32_t>(id.whole(0, UINT32_MAX));
  const int components = mesh.components(unique_id);
  if (components != shape.components) {
    id.refuse(components == 0
                  ? fmt::format("id {}, which the Draco stream does not have", unique_id)
                  : fmt::format("a Draco attribute of {} numbers a point", components),
              components == 0 ? std::string("the id of an attribute in it")
                              : fmt::format("{}, as in the accessor", shape.components));
    return;
  }
  if (mesh.points() > shape.count) {
    id.refuse(fmt::format("a Draco stream of {} points", mesh.points()),
              fmt::format("at most {}, the accessor's count", shape.count));
    return;
  }
  auto bytes = mesh.attribute(unique_id, shape.component_type);
  if (bytes.empty() && mesh.points() > 0)
    id.refuse("a Draco attribute without a value for each point", "one with");
  else
    loading.resources.supply(reference, mesh.points(), std::move(bytes));
}

void supply_indices(Loading& loading, const DracoMesh& mesh, Field reference) {
  const Resources::Shape shape = loading.resources.shape(reference);
  const std::vector<std::uint32_t> indices = mesh.indices();
  const std::size_t width = Resources::bytes_of(shape.component_type);
  if (width < 4 && mesh.points() > std::size_t{1} << (8 * width)) {
    reference.refuse(fmt::format("indices of {} bytes for {} points", width, mesh.points()),
                     "a component type that holds them");
    return;
  }
  std::vector<std::byte> bytes(indices.size() * width);
  for (std::size_t i = 0; i < indices.size(); ++i)  // little-endian: the low bytes come first
    std::memcpy(bytes.data() + i * width, &indices[i], width);
  loading.resources.supply(reference, indices.size(), std::move(bytes));
}

}  // namespace

void unpack_draco(Loading& loading, Field primitive) {
  const Field packed = primitive.extension("KHR_draco_mesh_compression");
  if (!packed.present()) return;
  const Field indices = primitive["indices"], attributes = packed["attributes"];
  if (primitive["mode"].whole(4) != 4)
    primitive["mode"].refuse(fmt::format("mode {}", primitive["mode"].whole(4)),
                             "4 (triangles) beside KHR_draco_mesh_compression");
  if (!indices.present())
    primitive.refuse("no indices", "indices beside KHR_draco_mesh_compression");
  if (!packed["bufferView"].present()) packed.refuse("no bufferView", "the index of a buffer view");
  const auto bytes = loading.resources.view(packed["bufferView"]);
  const Resources::Shape shape = loading.resources.shape(indices);
  if (loading.report.failed() || !loading.resources.charge(shape.count / 3 * kBytesPerFace, packed))
    return;
  auto mesh = DracoMesh::decode(bytes, shape.count / 3);
  if (!mesh.ok()) {
    packed.fail(mesh.error().message);
    return;
  }
  supply_indices(loading, *mesh, indices);
  for (const std::string& name : attributes.keys()) {
    const Field reference = primitive["attributes"][name];
    if (reference.present())
      supply_attribute(loading, *mesh, attributes[name], reference);
    else
      attributes[name].note_with("ignored, the primitive has no {}", one_line(name, 60));
    if (loading.report.failed()) return;
  }
}

}  // namespace neritic::scene::gltf
