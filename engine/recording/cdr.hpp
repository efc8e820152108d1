// Values as CDR lays them out in ROS 2 messages (XCDR1, little-endian): four bytes that say so,
// then each number at a multiple of its size from there; a string with its length and a zero behind
// it. Source: OMG Data Distribution Service Interoperability Wire Protocol 2.5, section 10. Any
// thread.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <string_view>

#include "engine/core/math.hpp"

namespace neritic::recording {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

class CdrWriter {
 public:
  // Appends to out.
  explicit CdrWriter(std::string& out) : out_(out) {
    out_.append("\0\1\0\0", 4);
    begin_ = out_.size();
  }

  template <class T>
  void number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    align(sizeof value);
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view text) {
    number(static_cast<std::uint32_t>(text.size() + 1));
    out_ += text;
    out_ += '\0';
  }
  // The count of a sequence, before its items. A fixed array has none.
  void count(std::size_t items) { number(static_cast<std::uint32_t>(items)); }
  void bytes(std::span<const std::byte> bytes) {
    out_.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  }
  void vector(const Vec3& v) { number(v.x), number(v.y), number(v.z); }
  void quaternion(const Quat& q) { number(q.x), number(q.y), number(q.z), number(q.w); }
  // builtin_interfaces/Time, from a time that is not before 0.
  void time(std::int64_t ns) {
    ns = ns < 0 ? 0 : ns;
    number(static_cast<std::int32_t>(ns / 1'000'000'000));
    number(static_cast<std::uint32_t>(ns % 1'000'000'000));
  }
  // std_msgs/Header.
  void header(std::int64_t ns, std::string_view frame_id) {
    time(ns);
    text(frame_id);
  }

 private:
  void align(std::size_t size) { out_.append((size - (out_.size() - begin_) % size) % size, '\0'); }

  std::string& out_;
  std::size_t begin_;
};

// After the end, or where the first bytes name another layout, every number is 0 and whole() is
// false.
class CdrReader {
 public:
  explicit CdrReader(std::span<const std::byte> bytes) : bytes_(bytes) {
    whole_ = bytes.size() >= 4 && bytes[0] == std::byte{0} && bytes[1] == std::byte{1};
    if (whole_) bytes_ = bytes_.subspan(4);
  }

  template <class T>
  T number() {
    static_assert(std::is_arithmetic_v<T>);
    T value{};
    at_ += (sizeof(T) - at_ % sizeof(T)) % sizeof(T);
    const auto from = take(sizeof(T));
    if (!from.empty()) std::memcpy(&value, from.data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto size = number<std::uint32_t>();
    const auto from = take(size);
    if (size == 0 || from.empty()) return {};
    return {reinterpret_cast<const char*>(from.data()), size - 1u};
  }
  std::span<const std::byte> bytes(std::size_t size) { return take(size); }
  bool whole() const { return whole_; }
  std::size_t left() const { return whole_ ? bytes_.size() - at_ : 0; }

 private:
  std::span<const std::byte> take(std::size_t size) {
    if (!whole_ || at_ > bytes_.size() || size > bytes_.size() - at_) {
      whole_ = false;
      return {};
    }
    const auto taken = bytes_.subspan(at_, size);
    at_ += size;
    return taken;
  }

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  bool whole_ = true;
};

}  // namespace neritic::recording
