// See gltf_accessor.hpp: where elements lie, checked. Their decoding is in
// gltf_accessor_decode.cpp.
#include "engine/scene/gltf_accessor.hpp"

#include <algorithm>
#include <cstring>
#include <limits>

#include "engine/scene/gltf_container.hpp"
#include "engine/scene/gltf_meshopt.hpp"

namespace neritic::scene::gltf {
namespace {

// The memory that one file may make the model allocate: a base, plus a multiple of its own size.
constexpr std::size_t kBaseBudgetBytes = std::size_t{256} << 20, kBudgetFactor = 64;
constexpr std::size_t kMaxBudgetBytes = std::size_t{6} << 30;
// The base for pictures: plain ones shrink to next to nothing in a file. Sixteen of 4096 x 4096.
constexpr std::size_t kBasePictureBytes = std::size_t{1} << 30;

int components_of(std::string_view type) {
  if (type == "SCALAR") return 1;
  if (type == "VEC2") return 2;
  if (type == "VEC3") return 3;
  if (type == "VEC4") return 4;
  if (type == "MAT4") return 16;
  return 0;  // MAT2 and MAT3 are used by nothing that a model holds
}

}  // namespace

Resources::Resources(Field root, std::span<const std::byte> bin, std::filesystem::path folder)
    : root_(root), bin_(bin), folder_(std::move(folder)), buffers_(root["buffers"].size()) {
  source_bytes_ = bin.size();
}

std::size_t Resources::size_of(Component component) {
  switch (component) {
    case Component::kInt8:
    case Component::kUint8:
      return 1;
    case Component::kInt16:
    case Component::kUint16:
      return 2;
    case Component::kUint32:
    case Component::kFloat:
      return 4;
  }
  return 0;
}

bool Resources::parse_component(Field field, Component& out) {
  switch (const auto code = field.whole(0)) {
    case 5120:
      out = Component::kInt8;
      return true;
    case 5121:
      out = Component::kUint8;
      return true;
    case 5122:
      out = Component::kInt16;
      return true;
    case 5123:
      out = Component::kUint16;
      return true;
    case 5125:
      out = Component::kUint32;
      return true;
    case 5126:
      out = Component::kFloat;
      return true;
    default:
      if (!field.report().failed())
        field.refuse(fmt::format("component type {}", code),
                     "5120 (int8), 5121 (uint8), 5122 (int16), 5123 (uint16), 5125 (uint32) or "
                     "5126 (float)");
      return false;
  }
}

std::span<const std::byte> Resources::buffer(int i) {
  Buffer& buffer = buffers_[i];
  if (buffer.read) return buffer.bytes;
  buffer.read = true;
  const Field field = root_["buffers"].at(i);
  const Field uri = field["uri"];
  const std::uint64_t declared = field["byteLength"].whole(0);
  if (uri.present()) {
    auto bytes = read_uri(uri.text(), folder_);
    if (!bytes.ok()) {
      uri.fail(bytes.error().message);
      return {};
    }
    buffer.owned = std::move(bytes).value();
    buffer.bytes = buffer.owned;
    source_bytes_ += buffer.owned.size();
  } else if (i == 0 && !bin_.empty()) {
    buffer.bytes = bin_;
  } else {
    field.refuse("a buffer without data",
                 "a buffer with a uri, or the first one of a .glb with a BIN chunk");
    return {};
  }
  // Bytes beyond the declared length are padding; views may not reach into it.
  if (declared < buffer.bytes.size()) buffer.bytes = buffer.bytes.first(declared);
  return buffer.bytes;
}

std::size_t Resources::bytes_of(std::uint32_t component_type) {
  if (component_type == 5120 || component_type == 5121) return 1;
  if (component_type == 5122 || component_type == 5123) return 2;
  return component_type == 5125 || component_type == 5126 ? 4 : 0;
}

Resources::Shape Resources::shape(Field reference) {
  const Field field = accessor(reference);
  if (!field.present()) return {};
  Component component = Component::kFloat;
  if (!parse_component(field["componentType"], component)) return {};
  const std::string type = field["type"].text();
  const Shape out{static_cast<std::uint32_t>(field["componentType"].whole(0)), components_of(type),
                  field["count"].whole(0, std::numeric_limits<std::uint32_t>::max())};
  if (out.components == 0)
    field["type"].refuse(fmt::format("\"{}\"", one_line(type, 20)), "SCALAR, VEC2, VEC3 or VEC4");
  return field.report().failed() ? Shape{} : out;
}

void Resources::supply(Field reference, std::size_t count, std::vector<std::byte> bytes) {
  const Field field = accessor(reference);
  if (const std::uint64_t said = field["count"].whole(0); said != count)
    field.note_with("count {}, but the compressed mesh has {}, which are used", said, count);
  supplied_[field.place()] = {count, std::move(bytes)};
}

std::span<const std::byte> Resources::view_at(int i) {
  const Field field = root_["bufferViews"].at(i);
  const Field packed = field.extension("EXT_meshopt_compression");
  return packed.present() ? unpacked_view(i, field, packed) : stored_bytes(field);
}

std::span<const std::byte> Resources::unpacked_view(int i, Field view, Field packed) {
  if (const auto known = unpacked_views_.find(i); known != unpacked_views_.end())
    return known->second;
  std::vector<std::byte>& out = unpacked_views_[i];  // stays empty after a failure
  MeshoptStream stream;
  stream.count = packed["count"].whole(0, std::numeric_limits<std::uint32_t>::max());
  stream.stride = packed["byteStride"].whole(0, 1 << 20);
  stream.mode = packed["mode"].text();
  stream.filter = packed["filter"].text("NONE");
  const auto bytes = stored_bytes(packed);
  if (view.report().failed()) return {};
  if (const Status fits = check_meshopt(stream); !fits.ok()) {
    packed.fail(fits.error().message);
    return {};
  }
  const std::size_t size = stream.count * stream.stride;
  if (const std::uint64_t said = view["byteLength"].whole(size); said != size) {
    view.refuse(fmt::format("byteLength {}", said),
                fmt::format("{}, the extension's count * byteStride", size));
    return {};
  }
  if (!charge(size, packed)) return {};
  auto decoded = decode_meshopt(stream, bytes);
  if (decoded.ok())
    out = std::move(decoded).value();
  else
    packed.fail(decoded.error().message);
  return out;
}

std::span<const std::byte> Resources::stored_bytes(Field field) {
  const int buffer_index = field["buffer"].index(buffers_.size(), "buffers");
  if (buffer_index < 0) {
    field.refuse("no buffer", "the index of a buffer");
    return {};
  }
  const auto bytes = buffer(buffer_index);
  const std::uint64_t offset = field["byteOffset"].whole(0), length = field["byteLength"].whole(0);
  if (field.report().failed()) return {};
  if (offset > bytes.size() || length > bytes.size() - offset) {
    field.refuse(
        fmt::format("{} + {} bytes (byteOffset + byteLength)", offset, length),
        fmt::format("a range inside buffer {}, which has {} bytes", buffer_index, bytes.size()));
    return {};
  }
  return bytes.subspan(offset, length);
}

std::span<const std::byte> Resources::view(Field reference) {
  const int i = reference.index(root_["bufferViews"].size(), "bufferViews");
  return i < 0 ? std::span<const std::byte>{} : view_at(i);
}

Field Resources::accessor(Field reference) const {
  const Field accessors = root_["accessors"];
  const int i = reference.index(accessors.size(), "accessors");
  return i < 0 ? reference.absent() : accessors.at(i);
}

std::size_t Resources::count(Field reference) const {
  const Field field = accessor(reference);
  if (const auto given = supplied_.find(field.place()); given != supplied_.end())
    return given->second.count;
  return field["count"].whole(0, std::numeric_limits<std::uint32_t>::max());
}

bool Resources::charge(std::size_t bytes, Field where) {
  const std::size_t budget =
      std::min(kMaxBudgetBytes, kBaseBudgetBytes + kBudgetFactor * source_bytes_);
  if (bytes > budget - std::min(budget, charged_bytes_)) {
    where.refuse(fmt::format("data that need more than {} MiB", budget >> 20),
                 "less, for a file of this size");
    return false;
  }
  charged_bytes_ += bytes;
  return true;
}

bool Resources::charge_picture(std::size_t bytes, std::size_t file_bytes) {
  source_bytes_ += file_bytes;
  const std::size_t budget =
      std::min(kMaxBudgetBytes, kBasePictureBytes + kBudgetFactor * source_bytes_);
  if (bytes > budget - std::min(budget, picture_bytes_)) return false;
  picture_bytes_ += bytes;
  return true;
}

bool Resources::resolve(Field reference, std::string_view shapes, Elements& out) {
  const Field field = accessor(reference);
  return field.present() && locate(field, reference, shapes, out) &&
         charge(out.count * size_of(out.component) * out.components, field);
}

bool Resources::locate(Field field, Field reference, std::string_view shapes, Elements& out) {
  const std::string type = field["type"].text();
  out.components = components_of(type);
  if (out.components == 0 || shapes.find(type) == shapes.npos) {
    if (!field.report().failed())
      reference.refuse(fmt::format("an accessor of type \"{}\"", one_line(type, 20)), shapes);
    return false;
  }
  if (!parse_component(field["componentType"], out.component)) return false;
  out.normalized = field["normalized"].boolean(false);
  out.count = field["count"].whole(0, std::numeric_limits<std::uint32_t>::max());
  const std::size_t element_bytes = size_of(out.component) * out.components;
  out.stride = element_bytes;
  if (field.report().failed()) return false;

  if (const auto given = supplied_.find(field.place()); given != supplied_.end()) {
    out.count = given->second.count;
    out.data = given->second.bytes.data();
    return true;
  }
  if (const Field view_reference = field["bufferView"]; view_reference.present()) {
    const auto bytes = view(view_reference);
    const int view_index = view_reference.index(root_["bufferViews"].size(), "bufferViews");
    const std::uint64_t offset = field["byteOffset"].whole(0);
    if (field.report().failed()) return false;
    const Field stride = root_["bufferViews"].at(view_index)["byteStride"];
    out.stride = stride.whole(element_bytes, 1 << 20);
    if (out.stride == 0) out.stride = element_bytes;  // 0 is how glTF 1.0 said "packed"
    if (field.report().failed()) return false;
    if (out.stride < element_bytes) {
      stride.refuse(fmt::format("{}", out.stride),
                    fmt::format("at least {}, the bytes of an element", element_bytes));
      return false;
    }
    // Overflow-safe: count and stride are below 2^32 and 2^21.
    const std::size_t need = out.count == 0 ? 0 : (out.count - 1) * out.stride + element_bytes;
    if (offset > bytes.size() || need > bytes.size() - offset) {
      field.refuse(fmt::format("{} elements, {} bytes from byte {} on", out.count, need, offset),
                   fmt::format("a range inside bufferViews[{}], which has {} bytes", view_index,
                               bytes.size()));
      return false;
    }
    out.data = bytes.data() + offset;
  }
  const Field sparse = field["sparse"];
  return !sparse.present() || resolve_sparse(sparse, out);
}

bool Resources::resolve_sparse(Field sparse, Elements& out) {
  const Field indices = sparse["indices"], values = sparse["values"];
  out.sparse_count = sparse["count"].whole(0);
  Elements index_elements;
  index_elements.components = 1;
  index_elements.count = out.sparse_count;
  if (sparse.report().failed()) return false;
  if (out.sparse_count > out.count) {
    sparse.refuse(fmt::format("{} sparse elements", out.sparse_count),
                  fmt::format("at most {}, the accessor's count", out.count));
    return false;
  }
  if (!parse_component(indices["componentType"], index_elements.component)) return false;
  index_elements.stride = size_of(index_elements.component);
  const std::size_t element_bytes = size_of(out.component) * out.components;
  const auto place = [&](Field field, std::size_t stride) -> const std::byte* {
    if (!field["bufferView"].present()) field.refuse("no bufferView", "the index of a buffer view");
    const auto bytes = view(field["bufferView"]);
    const std::uint64_t offset = field["byteOffset"].whole(0);
    if (field.report().failed()) return nullptr;
    if (offset > bytes.size() || out.sparse_count > (bytes.size() - offset) / stride) {
      field.refuse(fmt::format("{} sparse elements", out.sparse_count),
                   fmt::format("as many as lie in the {} bytes of the buffer view", bytes.size()));
      return nullptr;
    }
    return bytes.data() + offset;
  };
  index_elements.data = place(indices, index_elements.stride);
  out.sparse_values = place(values, element_bytes);
  if (sparse.report().failed()) return false;
  if (out.sparse_count > 0) out.sparse_indices = wholes(index_elements);
  for (const std::uint32_t i : out.sparse_indices) {
    if (i < out.count) continue;
    indices.refuse(fmt::format("sparse index {}", i),
                   fmt::format("an index below {}, the accessor's count", out.count));
    return false;
  }
  return true;
}

}  // namespace neritic::scene::gltf
