// A short text in place: instruments compare and keep what they show without allocating. Text that
// does not fit is cut at its end. A plain value; any thread.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace neritic::hud {

template <std::size_t kBytes>
class FixedTextOf {
 public:
  FixedTextOf() = default;
  FixedTextOf(std::string_view text) {
    size_ = static_cast<std::uint8_t>(std::min(text.size(), bytes_.size()));
    std::copy_n(text.data(), size_, bytes_.data());
  }
  FixedTextOf(const char* text) : FixedTextOf(std::string_view(text)) {}
  template <class... Args>
  static FixedTextOf of(fmt::format_string<Args...> form, Args&&... args) {
    FixedTextOf out;
    const auto end =
        fmt::format_to_n(out.bytes_.data(), out.bytes_.size(), form, std::forward<Args>(args)...);
    out.size_ = static_cast<std::uint8_t>(std::min(end.size, out.bytes_.size()));
    return out;
  }
  std::string_view view() const { return {bytes_.data(), size_}; }
  bool empty() const { return size_ == 0; }
  bool operator==(const FixedTextOf&) const = default;

 private:
  std::array<char, kBytes> bytes_{};
  std::uint8_t size_ = 0;
};

using FixedText = FixedTextOf<31>;
using LongText = FixedTextOf<64>;  // a message of an acoustic modem

}  // namespace neritic::hud
