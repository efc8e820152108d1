// Numbers, strings and tables as MCAP lays them out: little-endian, lengths of 4 bytes before
// strings and tables; and CRC-32. Any thread.
#pragma once

#include <zlib.h>

#include <bit>
#include <cstring>

#include "engine/recording/mcap.hpp"

namespace neritic::recording {

static_assert(std::endian::native == std::endian::little, "numbers are copied as they lie");

inline std::uint32_t crc_of(std::span<const std::byte> bytes, std::uint32_t before = 0) {
  return static_cast<std::uint32_t>(
      ::crc32_z(before, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}
inline std::uint32_t crc_of(std::string_view bytes, std::uint32_t before = 0) {
  return crc_of(std::as_bytes(std::span(bytes)), before);
}

template <class T>
void put(std::string& out, const T& value) {
  static_assert(std::is_arithmetic_v<T>);
  out.append(reinterpret_cast<const char*>(&value), sizeof value);
}
inline void put_text(std::string& out, std::string_view text) {
  put(out, static_cast<std::uint32_t>(text.size()));
  out += text;
}
inline void put_words(std::string& out, const Words& words) {
  std::string body;
  for (const auto& [key, value] : words) put_text(body, key), put_text(body, value);
  put_text(out, body);
}
inline void put_bytes(std::string& out, std::span<const std::byte> bytes) {
  out.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

// Reads forward; after the end every number is 0, every text empty, and whole() is false.
class McapCursor {
 public:
  explicit McapCursor(std::span<const std::byte> bytes) : rest_(bytes) {}

  std::span<const std::byte> take(std::uint64_t size) {
    if (size > rest_.size()) {
      whole_ = false;
      rest_ = {};
      return {};
    }
    const auto taken = rest_.first(static_cast<std::size_t>(size));
    rest_ = rest_.subspan(static_cast<std::size_t>(size));
    return taken;
  }
  template <class T>
  T number() {
    T value{};
    const auto bytes = take(sizeof value);
    if (!bytes.empty()) std::memcpy(&value, bytes.data(), sizeof value);
    return value;
  }
  std::string text() {
    const auto bytes = take(number<std::uint32_t>());
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }
  Words words() {
    McapCursor body(take(number<std::uint32_t>()));
    Words out;
    while (body.whole() && body.left() > 0) {
      std::string key = body.text();
      std::string value = body.text();
      if (body.whole()) out[std::move(key)] = std::move(value);
    }
    whole_ = whole_ && body.whole();
    return out;
  }
  std::span<const std::byte> rest() { return take(rest_.size()); }
  bool whole() const { return whole_; }
  std::size_t left() const { return rest_.size(); }

 private:
  std::span<const std::byte> rest_;
  bool whole_ = true;
};

}  // namespace neritic::recording
