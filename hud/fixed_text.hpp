// A short text in place: instruments compare and keep what they show without allocating. Text that
// does not fit is cut at its end. A plain value; any thread.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <string_view>

namespace neritic::hud {

class FixedText {
 public:
  FixedText() = default;
  FixedText(std::string_view text) {
    size_ = static_cast<std::uint8_t>(std::min(text.size(), bytes_.size()));
    std::copy_n(text.data(), size_, bytes_.data());
  }
  FixedText(const char* text) : FixedText(std::string_view(text)) {}
  template <class... Args>
  static FixedText of(fmt::format_string<Args...> form, Args&&... args) {
    FixedText out;
    const auto end =
        fmt::format_to_n(out.bytes_.data(), out.bytes_.size(), form, std::forward<Args>(args)...);
    out.size_ = static_cast<std::uint8_t>(std::min(end.size, out.bytes_.size()));
    return out;
  }
  std::string_view view() const { return {bytes_.data(), size_}; }
  bool empty() const { return size_ == 0; }
  bool operator==(const FixedText&) const = default;

 private:
  std::array<char, 31> bytes_{};
  std::uint8_t size_ = 0;
};

}  // namespace neritic::hud
