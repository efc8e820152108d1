// The numbers of a glTF file: buffers (read when first used), buffer views and accessors, decoded
// to what the model holds. Every offset, stride, count and sparse index is checked against the
// bytes that are there. One thread. Source: Khronos glTF 2.0, section 3.6; KHR_mesh_quantization.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/scene/gltf_json.hpp"

namespace neritic::scene::gltf {

// How integers without the "normalized" flag become floats.
enum class Integers { kAsStored, kAlwaysNormalized };

class Resources {
 public:
  // bin: a .glb's binary chunk. folder: where relative URIs lead; empty: no files.
  Resources(Field root, std::span<const std::byte> bin, std::filesystem::path folder);

  // The bytes of the buffer view that `reference` names, decompressed; empty after a failure.
  std::span<const std::byte> view(Field reference);

  // The accessor's element count; 0 where absent or wrong.
  std::size_t count(Field reference) const;

  // An accessor as the file describes it; all 0 after a failure and where it is absent.
  struct Shape {
    std::uint32_t component_type = 0;  // glTF's code
    int components = 0;
    std::size_t count = 0;
  };
  Shape shape(Field reference);
  // Bytes of a component of glTF's code, 0 for an unknown one.
  static std::size_t bytes_of(std::uint32_t component_type);
  // Elements made by a decoder, packed, in the accessor's shape, instead of those that its buffer
  // view holds.
  void supply(Field reference, std::size_t count, std::vector<std::byte> bytes);
  bool is_supplied(Field accessor) const { return supplied_.contains(accessor.place()); }

  // The elements of the accessor that `reference` names; empty where it is absent or after a
  // failure. Numbers that are not finite become 0, with a note.
  std::vector<float> floats(Field reference);
  std::vector<Vec2f> vec2s(Field reference, Integers integers = Integers::kAsStored);
  std::vector<Vec3f> vec3s(Field reference, Integers integers = Integers::kAsStored);
  std::vector<Vec4f> vec4s(Field reference, Integers integers = Integers::kAsStored);
  // RGB or RGBA, alpha 1 where there is none.
  std::vector<Vec4f> colors(Field reference);
  std::vector<Mat4> matrices(Field reference);
  std::vector<std::uint32_t> indices(Field reference);
  std::vector<std::array<std::uint16_t, 4>> joints(Field reference);
  // Components of every element in a row, whatever the type is, and how many there are an element.
  std::vector<float> any(Field reference, int& components);

  // The smallest and largest stored value of each component of an accessor, numbers that
  // are not finite left out (min > max where none is). Empty where it has no bytes, after a failure
  // and where the file's accessors together ask for several times its bytes to be looked at:
  // examined_all() is false from then on.
  struct Extremes {
    std::vector<double> min, max;
    double type_max = 0.0;  // the largest of the component's type
  };
  Extremes extremes(Field accessor);
  // Fails where the accessor is wrong or its elements are not in their bytes; within the same
  // limit.
  void check(Field accessor);
  bool examined_all() const { return examined_all_; }

  // Counts bytes that the model will hold against a limit in proportion to the file, so that a
  // small file cannot ask for all memory by naming one accessor often. Fails at `where` when
  // exceeded.
  bool charge(std::size_t bytes, Field where);
  // Likewise the bytes of a decoded picture, with a limit of their own. False where it is exceeded:
  // the picture is to be left out. file_bytes: of the picture's own file, 0 where a buffer holds
  // it.
  bool charge_picture(std::size_t bytes, std::size_t file_bytes);

  const std::filesystem::path& folder() const { return folder_; }

 private:
  enum class Component { kInt8, kUint8, kInt16, kUint16, kUint32, kFloat };
  struct Elements {  // where an accessor's elements lie; null data means zeros
    const std::byte* data = nullptr;
    std::size_t count = 0, stride = 0;
    Component component = Component::kFloat;
    int components = 0;
    bool normalized = false;
    std::size_t sparse_count = 0;
    std::vector<std::uint32_t> sparse_indices;
    const std::byte* sparse_values = nullptr;
  };
  struct Buffer {
    bool read = false;
    std::vector<std::byte> owned;
    std::span<const std::byte> bytes;
  };

  std::span<const std::byte> buffer(int i);
  std::span<const std::byte> view_at(int i);
  // The bytes from byteOffset on, byteLength of them, of the buffer that `field` names.
  std::span<const std::byte> stored_bytes(Field field);
  std::span<const std::byte> unpacked_view(int i, Field view, Field packed);
  Field accessor(Field reference) const;
  // False where absent or wrong. shapes: accepted types, as "VEC3" or "VEC3 VEC4". resolve() also
  // charges what the elements take; locate() has the accessor itself, said at `reference`.
  bool resolve(Field reference, std::string_view shapes, Elements& out);
  bool locate(Field accessor, Field reference, std::string_view shapes, Elements& out);
  bool resolve_sparse(Field sparse, Elements& out);
  void decode(const Elements& elements, Integers integers, int out_components, float* out,
              Field reference);
  template <class T>
  std::vector<T> vectors(Field reference, std::string_view shape, Integers integers);

  bool may_examine(std::size_t bytes);  // false, and examined_all() too, beyond the limit
  bool may_locate(Field accessor);
  static bool parse_component(Field field, Component& out);
  static std::size_t size_of(Component component);
  static std::vector<std::uint32_t> wholes(const Elements& elements);

  Field root_;
  std::span<const std::byte> bin_;
  std::filesystem::path folder_;
  std::vector<Buffer> buffers_;
  struct Supplied {
    std::size_t count = 0;
    std::vector<std::byte> bytes;
  };
  std::map<const Json*, Supplied> supplied_;              // by accessor
  std::map<int, std::vector<std::byte>> unpacked_views_;  // by buffer view
  std::size_t source_bytes_ = 0, charged_bytes_ = 0, picture_bytes_ = 0, examined_bytes_ = 0;
  bool examined_all_ = true;
};

}  // namespace neritic::scene::gltf
