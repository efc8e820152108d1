// A 64-bit hash in the manner of FNV-1a: image and state hashes that tests and benchmarks compare.
// Basis and prime of Fowler, Noll and Vo (draft-eastlake-fnv). Any thread.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstring>
#include <span>
#include <string>

namespace neritic {

class Hash64 {
 public:
  void add_bytes(const void* data, std::size_t size) {
    // Eight bytes a step (FNV's mixing on words, then a fold): the value is ours, not
    // interchangeable with other FNV programs; it only has to differ when the bytes do.
    const auto* p = static_cast<const unsigned char*>(data);
    for (; size >= 8; p += 8, size -= 8) {
      std::uint64_t word = 0;
      std::memcpy(&word, p, 8);
      mix(word);
    }
    for (; size > 0; ++p, --size) mix(*p);
  }
  template <class T>
  void add(const T& value) {
    static_assert(std::is_trivially_copyable_v<T>);
    add_bytes(&value, sizeof value);
  }
  template <class T>
  void add_span(std::span<const T> values) {
    add(static_cast<std::uint64_t>(values.size()));
    add_bytes(values.data(), values.size_bytes());
  }
  std::uint64_t value() const { return state_; }
  std::string hex() const { return fmt::format("{:016x}", state_); }

 private:
  void mix(std::uint64_t word) {
    state_ = (state_ ^ word) * 0x100000001b3ull;
    state_ ^= state_ >> 29;
  }
  std::uint64_t state_ = 0xcbf29ce484222325ull;
};

}  // namespace neritic
