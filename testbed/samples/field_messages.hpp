// A struct that lists its fields (engine/sim/fields.hpp) as a ROS 2 message: the lines of its
// definition, its bytes, and back with every bit. Vectors, rotations and poses are those of
// geometry_msgs, in the struct's own axes; a struct within a struct gives fields with its name
// before theirs. Pure functions; any thread.
#pragma once

#include <string>

#include "engine/recording/cdr.hpp"
#include "engine/sim/fields.hpp"

namespace neritic::testbed {

namespace detail {

template <class T>
concept MessageNumber = sim::Scalar<T> || std::is_enum_v<T>;
template <class T>
concept MessageLeaf =
    MessageNumber<T> || std::same_as<T, Vec3> || std::same_as<T, Quat> || std::same_as<T, Pose>;

template <MessageLeaf T>
constexpr const char* type_word() {
  if constexpr (std::is_enum_v<T>) return type_word<std::underlying_type_t<T>>();
  if constexpr (std::same_as<T, double>) return "float64";
  if constexpr (std::same_as<T, float>) return "float32";
  if constexpr (std::same_as<T, std::int32_t>) return "int32";
  if constexpr (std::same_as<T, std::uint32_t>) return "uint32";
  if constexpr (std::same_as<T, std::int64_t>) return "int64";
  if constexpr (std::same_as<T, std::uint64_t>) return "uint64";
  if constexpr (std::same_as<T, Vec3>) return "geometry_msgs/Vector3";
  if constexpr (std::same_as<T, Quat>) return "geometry_msgs/Quaternion";
  return "geometry_msgs/Pose";
}

// Calls visit(name, leaf) for each leaf, and visit_list(name, list) for each list of leaves.
template <class T, class Leaf, class List>
void for_each_leaf(T& value, const std::string& name, Leaf&& visit, List&& visit_list) {
  using Plain = std::remove_const_t<T>;
  if constexpr (MessageLeaf<Plain>) {
    visit(name, value);
  } else if constexpr (std::is_bounded_array_v<Plain> || sim::detail::IsStdArray<Plain>::value) {
    if constexpr (MessageLeaf<std::remove_cvref_t<decltype(value[0])>>)
      visit_list(name, value);
    else
      for (std::size_t i = 0; i < std::size(value); ++i)
        for_each_leaf(value[i], fmt::format("{}_{}", name, i), visit, visit_list);
  } else {
    sim::for_each_part(value, [&](const auto& part, auto& piece) {
      const std::string own = fmt::format("{}", part);
      for_each_leaf(piece, name.empty() ? own : name + "_" + own, visit, visit_list);
    });
  }
}

template <MessageLeaf T>
void put_leaf(recording::CdrWriter& out, const T& value) {
  if constexpr (std::is_enum_v<T>)
    out.number(static_cast<std::underlying_type_t<T>>(value));
  else if constexpr (std::same_as<T, Vec3>)
    out.vector(value);
  else if constexpr (std::same_as<T, Quat>)
    out.quaternion(value);
  else if constexpr (std::same_as<T, Pose>)
    out.vector(value.position_m), out.quaternion(value.rotation);
  else
    out.number(value);
}

template <MessageLeaf T>
void take_leaf(recording::CdrReader& in, T& value) {
  if constexpr (std::is_enum_v<T>) {
    value = static_cast<T>(in.number<std::underlying_type_t<T>>());
  } else if constexpr (std::same_as<T, Vec3>) {
    value.x = in.number<double>(), value.y = in.number<double>(), value.z = in.number<double>();
  } else if constexpr (std::same_as<T, Quat>) {
    value.x = in.number<double>(), value.y = in.number<double>();
    value.z = in.number<double>(), value.w = in.number<double>();
  } else if constexpr (std::same_as<T, Pose>) {
    take_leaf(in, value.position_m), take_leaf(in, value.rotation);
  } else {
    value = in.number<T>();
  }
}

}  // namespace detail

// "float64 heading_rad\n" and so on.
template <class T>
std::string message_lines(const T& value) {
  std::string lines;
  detail::for_each_leaf(
      value, {},
      [&](const std::string& name, const auto& leaf) {
        lines +=
            fmt::format("{} {}\n", detail::type_word<std::remove_cvref_t<decltype(leaf)>>(), name);
      },
      [&](const std::string& name, const auto& list) {
        using Item = std::remove_cvref_t<decltype(list[0])>;
        lines += fmt::format("{}[{}] {}\n", detail::type_word<Item>(), std::size(list), name);
      });
  return lines;
}

template <class T>
void put_message(recording::CdrWriter& out, const T& value) {
  detail::for_each_leaf(
      value, {}, [&](const std::string&, const auto& leaf) { detail::put_leaf(out, leaf); },
      [&](const std::string&, const auto& list) {
        for (const auto& item : list) detail::put_leaf(out, item);
      });
}

template <class T>
void take_message(recording::CdrReader& in, T& value) {
  detail::for_each_leaf(
      value, {}, [&](const std::string&, auto& leaf) { detail::take_leaf(in, leaf); },
      [&](const std::string&, auto& list) {
        for (auto& item : list) detail::take_leaf(in, item);
      });
}

}  // namespace neritic::testbed
