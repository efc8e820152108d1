// The fields of a struct, listed once: hash, finiteness check and log read them from here.
//   struct Pilot {
//     double surge_n = 0.0;
//     Vec3 goal_m{0.0};
//     static void fields(auto&& field, auto& self) {
//       field("surge_n", self.surge_n);
//       field("goal_m", self.goal_m);
//     }
//   };
// Fields are numbers of 32 or 64 bits, enums of such, vectors, quaternions, poses, arrays and spans
// of those, and structs that list theirs. No bool or smaller number: they would leave padding,
// whose bytes mean nothing.
#pragma once

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

#include "engine/core/check.hpp"
#include "engine/core/math.hpp"

namespace neritic::sim {

template <class T>
concept Scalar = std::same_as<T, double> || std::same_as<T, float> ||
    std::same_as<T, std::int32_t> || std::same_as<T, std::uint32_t> ||
    std::same_as<T, std::int64_t> || std::same_as<T, std::uint64_t>;

namespace detail {
template <class T>
struct IsStdArray : std::false_type {};
template <class T, std::size_t n>
struct IsStdArray<std::array<T, n>> : std::true_type {};
template <class T>
struct IsSpan : std::false_type {};
template <class T>
struct IsSpan<std::span<T>> : std::true_type {};
}  // namespace detail

// Calls part(name, piece) for each direct member or item of value, which is no number.
template <class T, class Part>
void for_each_part(T& value, Part&& part) {
  using Plain = std::remove_const_t<T>;
  if constexpr (std::same_as<Plain, Vec2>) {
    part("x", value.x), part("y", value.y);
  } else if constexpr (std::same_as<Plain, Vec3>) {
    part("x", value.x), part("y", value.y), part("z", value.z);
  } else if constexpr (std::same_as<Plain, Quat>) {
    part("w", value.w), part("x", value.x), part("y", value.y), part("z", value.z);
  } else if constexpr (std::same_as<Plain, Pose>) {
    part("position_m", value.position_m), part("rotation", value.rotation);
  } else if constexpr (std::is_bounded_array_v<Plain> || detail::IsStdArray<Plain>::value ||
                       detail::IsSpan<Plain>::value) {
    for (std::size_t i = 0; i < std::size(value); ++i) part(i, value[i]);
  } else {
    Plain::fields(part, value);
  }
}

// Calls visit(number) with an enum's number, and stores what visit makes of it.
template <class T, class Visit>
void visit_enum(T& value, Visit&& visit) {
  auto number = static_cast<std::underlying_type_t<std::remove_const_t<T>>>(value);
  static_assert(Scalar<decltype(number)>);
  visit(number);
  if constexpr (!std::is_const_v<T>) value = static_cast<T>(number);
}

// Calls visit(scalar) for every number in value, in the order of declaration.
template <class T, class Visit>
void for_each_scalar(T& value, Visit&& visit) {
  if constexpr (Scalar<std::remove_const_t<T>>)
    visit(value);
  else if constexpr (std::is_enum_v<T>)
    visit_enum(value, visit);
  else
    for_each_part(value, [&](const auto&, auto& piece) { for_each_scalar(piece, visit); });
}

// The same with names: visit("pose.position_m.x", scalar).
template <class T, class Visit>
void for_each_named_scalar(T& value, Visit&& visit, const std::string& name = {}) {
  if constexpr (Scalar<std::remove_const_t<T>>)
    visit(name, value);
  else if constexpr (std::is_enum_v<T>)
    visit_enum(value, [&](auto& number) { visit(name, number); });
  else
    for_each_part(value, [&](const auto& piece_name, auto& piece) {
      const std::string last = fmt::format("{}", piece_name);
      for_each_named_scalar(piece, visit, name.empty() ? last : name + "." + last);
    });
}

// Bytes of all numbers in value.
template <class T>
std::size_t scalar_bytes(const T& value) {
  std::size_t bytes = 0;
  for_each_scalar(value, [&](const auto& scalar) { bytes += sizeof scalar; });
  return bytes;
}

// The memory that a value occupies: of a struct its own, of a block (block.hpp) its items'.
template <class T>
std::span<const std::byte> bytes_of(const T& value) {
  if constexpr (requires { value.bytes(); }) {
    return value.bytes();
  } else {
    static_assert(std::is_trivially_copyable_v<T>);
    return std::as_bytes(std::span(&value, 1));
  }
}

// Aborts where the value has bytes that no field names: a forgotten field, or padding.
template <class T>
void check_fields_cover(const T& value) {
  NERITIC_CHECK(scalar_bytes(value) == bytes_of(value).size(), "fields name {} bytes of {}",
                scalar_bytes(value), bytes_of(value).size());
}

template <class T>
bool all_finite(const T& value) {
  bool finite = true;
  for_each_scalar(value, [&](const auto& scalar) {
    if constexpr (std::is_floating_point_v<std::remove_cvref_t<decltype(scalar)>>)
      finite = finite && std::isfinite(scalar);
  });
  return finite;
}

// The same bits in every number.
template <class T>
bool same_bits(const T& a, const T& b) {
  const auto left = bytes_of(a), right = bytes_of(b);
  return left.size() == right.size() && std::memcmp(left.data(), right.data(), left.size()) == 0;
}

}  // namespace neritic::sim
