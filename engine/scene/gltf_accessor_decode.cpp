// Decoding of accessor elements into floats, matrices and whole numbers. See gltf_accessor.hpp.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <type_traits>

#include "engine/scene/gltf_accessor.hpp"

namespace neritic::scene::gltf {
namespace {
static_assert(std::endian::native == std::endian::little, "glTF's numbers are little-endian");

// Integer c to float, glTF 2.0 section 3.6.2.2: max(c / 127, -1) and so on when normalized.
template <class T>
float to_float(T value, bool normalize) {
  if constexpr (std::is_same_v<T, float>) {
    return value;
  } else {
    if (!normalize) return static_cast<float>(value);
    constexpr double kMax = static_cast<double>(std::numeric_limits<T>::max());
    return std::max(static_cast<float>(static_cast<double>(value) / kMax), -1.0f);
  }
}

template <class T>
void convert(const std::byte* from, int components, bool normalize, float* out) {
  for (int c = 0; c < components; ++c) {
    T value;
    std::memcpy(&value, from + c * sizeof(T), sizeof(T));
    out[c] = to_float(value, normalize);
  }
}

using Convert = void (*)(const std::byte*, int, bool, float*);

template <class T>
void convert_whole(const std::byte* from, int components, std::uint32_t* out) {
  for (int c = 0; c < components; ++c) {
    T value;
    std::memcpy(&value, from + c * sizeof(T), sizeof(T));
    out[c] = value;
  }
}

}  // namespace

void Resources::decode(const Elements& e, Integers integers, int out_components, float* out,
                       Field reference) {
  const bool normalize = e.normalized || integers == Integers::kAlwaysNormalized;
  Convert convert_element = nullptr;
  switch (e.component) {
    case Component::kInt8:
      convert_element = convert<std::int8_t>;
      break;
    case Component::kUint8:
      convert_element = convert<std::uint8_t>;
      break;
    case Component::kInt16:
      convert_element = convert<std::int16_t>;
      break;
    case Component::kUint16:
      convert_element = convert<std::uint16_t>;
      break;
    case Component::kUint32:
      convert_element = convert<std::uint32_t>;
      break;
    case Component::kFloat:
      convert_element = convert<float>;
      break;
  }
  const std::size_t element_bytes = size_of(e.component) * e.components;
  if (e.data && e.component == Component::kFloat && e.stride == element_bytes &&
      e.components == out_components) {
    std::memcpy(out, e.data, e.count * element_bytes);
  } else if (e.data) {
    for (std::size_t i = 0; i < e.count; ++i)
      convert_element(e.data + i * e.stride, e.components, normalize, out + i * out_components);
  }
  for (std::size_t k = 0; k < e.sparse_indices.size(); ++k)
    convert_element(e.sparse_values + k * element_bytes, e.components, normalize,
                    out + std::size_t{e.sparse_indices[k]} * out_components);
  if (e.component != Component::kFloat) return;
  std::size_t n_repaired = 0;
  for (std::size_t i = 0; i < e.count * out_components; ++i) {
    if (std::isfinite(out[i])) continue;
    out[i] = 0.0f;
    ++n_repaired;
  }
  if (n_repaired > 0)
    reference.note_with("{} numbers that are not finite were set to 0", n_repaired);
}

std::vector<std::uint32_t> Resources::wholes(const Elements& e) {
  // Signed types hold no valid index; read as unsigned, a negative one falls out of every range.
  void (*convert_element)(const std::byte*, int, std::uint32_t*) = convert_whole<std::uint32_t>;
  if (size_of(e.component) == 1) convert_element = convert_whole<std::uint8_t>;
  if (size_of(e.component) == 2) convert_element = convert_whole<std::uint16_t>;
  const std::size_t element_bytes = size_of(e.component) * e.components;
  std::vector<std::uint32_t> out(e.count * e.components, 0);
  for (std::size_t i = 0; e.data && i < e.count; ++i)
    convert_element(e.data + i * e.stride, e.components, out.data() + i * e.components);
  for (std::size_t k = 0; k < e.sparse_indices.size(); ++k)
    convert_element(e.sparse_values + k * element_bytes, e.components,
                    out.data() + std::size_t{e.sparse_indices[k]} * e.components);
  return out;
}

template <class T>
std::vector<T> Resources::vectors(Field reference, std::string_view shape, Integers integers) {
  Elements elements;
  if (!resolve(reference, shape, elements)) return {};
  constexpr int kComponents = sizeof(T) / sizeof(float);
  std::vector<T> out(elements.count, T(0.0f));
  if (!out.empty())
    decode(elements, integers, kComponents, reinterpret_cast<float*>(out.data()), reference);
  return out;
}

std::vector<float> Resources::floats(Field reference) {
  return vectors<float>(reference, "SCALAR", Integers::kAsStored);
}
std::vector<Vec2f> Resources::vec2s(Field reference, Integers integers) {
  return vectors<Vec2f>(reference, "VEC2", integers);
}
std::vector<Vec3f> Resources::vec3s(Field reference, Integers integers) {
  return vectors<Vec3f>(reference, "VEC3", integers);
}
std::vector<Vec4f> Resources::vec4s(Field reference, Integers integers) {
  return vectors<Vec4f>(reference, "VEC4", integers);
}

std::vector<Vec4f> Resources::colors(Field reference) {
  Elements elements;
  if (!resolve(reference, "VEC3 VEC4", elements)) return {};
  std::vector<Vec4f> out(elements.count, Vec4f(0.0f, 0.0f, 0.0f, 1.0f));
  if (!out.empty()) decode(elements, Integers::kAlwaysNormalized, 4, &out[0].x, reference);
  for (Vec4f& color : out) color = glm::clamp(color, 0.0f, 1.0f);
  return out;
}

std::vector<Mat4> Resources::matrices(Field reference) {
  Elements elements;
  if (!resolve(reference, "MAT4", elements)) return {};
  std::vector<float> values(elements.count * 16, 0.0f);
  if (!values.empty()) decode(elements, Integers::kAsStored, 16, values.data(), reference);
  std::vector<Mat4> out(elements.count);
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i / 16][static_cast<int>(i % 16 / 4)][static_cast<int>(i % 4)] = values[i];
  return out;
}

std::vector<std::uint32_t> Resources::indices(Field reference) {
  Elements elements;
  if (!resolve(reference, "SCALAR", elements)) return {};
  if (elements.component == Component::kFloat) {
    reference.refuse("indices stored as floats", "unsigned whole numbers");
    return {};
  }
  return wholes(elements);
}

std::vector<std::array<std::uint16_t, 4>> Resources::joints(Field reference) {
  Elements elements;
  if (!resolve(reference, "VEC4", elements)) return {};
  if (size_of(elements.component) > 2) {
    reference.refuse("joints of 4 bytes each", "1 or 2 bytes");
    return {};
  }
  const auto values = wholes(elements);
  std::vector<std::array<std::uint16_t, 4>> out(elements.count);
  for (std::size_t i = 0; i < values.size(); ++i)
    out[i / 4][i % 4] = static_cast<std::uint16_t>(values[i]);
  return out;
}

std::vector<float> Resources::any(Field reference, int& components) {
  Elements elements;
  components = 0;
  if (!resolve(reference, "SCALAR VEC2 VEC3 VEC4", elements)) return {};
  components = elements.components;
  std::vector<float> out(elements.count * elements.components, 0.0f);
  if (!out.empty())
    decode(elements, Integers::kAsStored, elements.components, out.data(), reference);
  return out;
}

}  // namespace neritic::scene::gltf
