// The range of an accessor's values as they are stored. See gltf_accessor.hpp.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

#include "engine/scene/gltf_accessor.hpp"

namespace neritic::scene::gltf {
namespace {

constexpr std::string_view kAccessorShapes = "SCALAR VEC2 VEC3 VEC4 MAT4";
// Limits the bytes that are examined, since accessors of a hostile file can overlap many times.
constexpr std::size_t kExamineFactor = 4, kExamineBaseBytes = std::size_t{1} << 20;

template <class T>
void widen(const std::byte* from, std::size_t stride, std::size_t count, Resources::Extremes& out) {
  for (std::size_t c = 0; c < out.min.size(); ++c) {
    T least = std::numeric_limits<T>::max(), largest = std::numeric_limits<T>::lowest();
    const std::byte* at = from + c * sizeof(T);
    for (std::size_t i = 0; i < count; ++i, at += stride) {
      T value;
      std::memcpy(&value, at, sizeof(T));
      if constexpr (std::is_floating_point_v<T>)
        if (!(std::abs(value) <= std::numeric_limits<T>::max())) continue;
      least = std::min(least, value);
      largest = std::max(largest, value);
    }
    if (least > largest) continue;
    out.min[c] = std::min<double>(out.min[c], least);
    out.max[c] = std::max<double>(out.max[c], largest);
  }
  out.type_max = static_cast<double>(std::numeric_limits<T>::max());
}

}  // namespace

bool Resources::may_examine(std::size_t bytes) {
  const std::size_t limit = kExamineBaseBytes + kExamineFactor * source_bytes_;
  if (bytes > limit - std::min(limit, examined_bytes_)) return examined_all_ = false;
  examined_bytes_ += bytes;
  return true;
}

// Asked before anything is done: sparse indices are copied as they are located. More of them than
// the file has bytes are refused uncopied.
bool Resources::may_locate(Field accessor) {
  const std::size_t count = accessor["sparse"]["count"].whole(0);
  return may_examine(std::min(count, source_bytes_) * sizeof(std::uint32_t));
}

void Resources::check(Field accessor) {
  Elements elements;
  if (may_locate(accessor)) locate(accessor, accessor, kAccessorShapes, elements);
}

Resources::Extremes Resources::extremes(Field accessor) {
  Extremes out;
  Elements e;
  if (!may_locate(accessor) || !locate(accessor, accessor, kAccessorShapes, e)) return out;
  const std::size_t element_bytes = size_of(e.component) * e.components;
  const std::size_t bytes = ((e.data ? e.count : 0) + e.sparse_count) * element_bytes;
  if (bytes == 0 || !may_examine(bytes)) return out;
  out.min.assign(e.components, std::numeric_limits<double>::infinity());
  out.max.assign(e.components, -std::numeric_limits<double>::infinity());
  const auto look = [&](const std::byte* from, std::size_t stride, std::size_t count) {
    switch (e.component) {
      case Component::kInt8:
        return widen<std::int8_t>(from, stride, count, out);
      case Component::kUint8:
        return widen<std::uint8_t>(from, stride, count, out);
      case Component::kInt16:
        return widen<std::int16_t>(from, stride, count, out);
      case Component::kUint16:
        return widen<std::uint16_t>(from, stride, count, out);
      case Component::kUint32:
        return widen<std::uint32_t>(from, stride, count, out);
      case Component::kFloat:
        return widen<float>(from, stride, count, out);
    }
  };
  // Values that sparse ones replace do not count: the runs between their places do.
  std::vector<std::uint32_t> replaced = e.sparse_indices;
  std::ranges::sort(replaced);
  replaced.erase(std::unique(replaced.begin(), replaced.end()), replaced.end());
  if (e.data) {
    std::size_t next = 0;
    for (const std::uint32_t i : replaced) {
      look(e.data + next * e.stride, e.stride, i - next);
      next = std::size_t{i} + 1;
    }
    look(e.data + next * e.stride, e.stride, e.count - next);
  } else if (replaced.size() < e.count) {
    std::ranges::fill(out.min, 0.0);
    std::ranges::fill(out.max, 0.0);
  }
  if (e.sparse_count > 0) look(e.sparse_values, element_bytes, e.sparse_count);
  return out;
}

}  // namespace neritic::scene::gltf
