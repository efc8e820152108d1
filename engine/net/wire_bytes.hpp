// Numbers in packets, in both byte orders. Preconditions: the bytes are there. Any thread.
#pragma once

#include <bit>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace neritic::net {

using Bytes = std::span<const std::byte>;

template <std::unsigned_integral T>
T big_endian(Bytes bytes, std::size_t at) {
  T value = 0;
  for (std::size_t i = 0; i < sizeof(T); ++i)
    value = static_cast<T>(static_cast<std::uint64_t>(value) << 8 |
                           std::to_integer<std::uint64_t>(bytes[at + i]));
  return value;
}
template <std::unsigned_integral T>
T little_endian(Bytes bytes, std::size_t at) {
  T value = 0;
  for (std::size_t i = sizeof(T); i-- > 0;)
    value = static_cast<T>(static_cast<std::uint64_t>(value) << 8 |
                           std::to_integer<std::uint64_t>(bytes[at + i]));
  return value;
}
inline float big_endian_float(Bytes bytes, std::size_t at) {
  return std::bit_cast<float>(big_endian<std::uint32_t>(bytes, at));
}

template <std::unsigned_integral T>
void put_big(std::vector<std::byte>& out, T value) {
  for (std::size_t i = sizeof(T); i-- > 0;)
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
}
template <std::unsigned_integral T>
void put_little(std::vector<std::byte>& out, T value) {
  for (std::size_t i = 0; i < sizeof(T); ++i)
    out.push_back(static_cast<std::byte>(static_cast<std::uint64_t>(value) >> (8 * i)));
}
inline void put_big_float(std::vector<std::byte>& out, float value) {
  put_big(out, std::bit_cast<std::uint32_t>(value));
}

}  // namespace neritic::net
