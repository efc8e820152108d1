// See netpbm_file.hpp.
#include "engine/scene/netpbm_file.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstring>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"

namespace neritic::scene {
namespace {

constexpr std::uint32_t kLargestSide = 32768;

bool is_space(char c) {
  return c == ' ' || c == '\t' || c == '\n' || c == '\r' || c == '\v' || c == '\f';
}

class Reader {
 public:
  Reader(std::span<const std::byte> bytes, const std::string& name)
      : text_(reinterpret_cast<const char*>(bytes.data()), bytes.size()), name_(name) {}

  Result<NetpbmMap> run() {
    const std::string_view magic = text_.substr(0, 2);
    at_ = magic.size();
    const bool floats = magic == "Pf" || magic == "PF";
    if (!floats && magic != "P5" && magic != "P2")
      return refusal(name_, fmt::format("{} bytes of another kind", text_.size()),
                     "a grey .pgm (P5, P2) or a .pfm (Pf, PF)");
    NetpbmMap map;
    map.channels = magic == "PF" ? 3 : 1;
    NERITIC_TRY(map.width, side("width"));
    NERITIC_TRY(map.height, side("height"));
    const std::string_view last = word();
    double scale = 0.0;
    const auto read = std::from_chars(last.data(), last.data() + last.size(), scale);
    if (read.ec != std::errc() || read.ptr != last.data() + last.size() || !std::isfinite(scale) ||
        scale == 0.0)
      return refusal(name_, fmt::format("'{}' after the size", shown(last)), "a number");
    if (!floats && (scale < 1.0 || scale > 65535.0 || scale != std::floor(scale)))
      return refusal(name_, fmt::format("largest value {}", scale), "1 to 65535");
    at_ = std::min(at_ + 1, text_.size());  // the one space that ends the header
    map.bits = floats ? 0 : scale > 255.0 ? 16 : 8;
    if (magic == "P2") {
      NERITIC_TRY_STATUS(read_words(map));
    } else {
      NERITIC_TRY_STATUS(read_bytes(map, floats && scale < 0.0));
    }
    return map;
  }

 private:
  static std::string shown(std::string_view word) { return printable(word, 20); }

  // The next word of the header, behind spaces and comments.
  std::string_view word() {
    while (at_ < text_.size() && (is_space(text_[at_]) || text_[at_] == '#')) {
      if (text_[at_] != '#')
        ++at_;
      else
        while (at_ < text_.size() && text_[at_] != '\n') ++at_;
    }
    const std::size_t from = at_;
    while (at_ < text_.size() && !is_space(text_[at_])) ++at_;
    return text_.substr(from, at_ - from);
  }

  Result<std::uint32_t> side(const char* what) {
    const std::string_view text = word();
    std::uint32_t n = 0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), n);
    if (read.ec != std::errc() || read.ptr != text.data() + text.size() || n == 0 ||
        n > kLargestSide)
      return refusal(name_, fmt::format("{} '{}'", what, shown(text)),
                     fmt::format("1 to {} pixels", kLargestSide));
    return n;
  }

  // A width of bytes each, rows from the top (of floats from the bottom).
  Status read_bytes(NetpbmMap& map, bool little_endian) {
    const std::size_t row = std::size_t{map.width} * map.channels,
                      width = map.bits == 0 ? 4 : static_cast<std::size_t>(map.bits / 8),
                      need = row * map.height * width;
    const std::size_t left = text_.size() - std::min(at_, text_.size());
    if (left < need)
      return refusal(name_, fmt::format("{} bytes of numbers", left),
                     fmt::format("{} for {} x {}", need, map.width, map.height));
    map.values.resize(row * map.height);
    const auto* from = reinterpret_cast<const unsigned char*>(text_.data()) + at_;
    for (std::size_t i = 0; i < map.values.size(); ++i, from += width) {
      std::uint32_t code = 0;
      for (std::size_t k = 0; k < width; ++k)
        code |= std::uint32_t{from[k]} << 8 * (little_endian ? k : width - 1 - k);
      float number = 0.0f;
      std::memcpy(&number, &code, 4);
      const std::size_t y = i / row;
      const std::size_t to = map.bits == 0 ? (map.height - 1 - y) * row + i % row : i;
      map.values[to] = map.bits == 0 ? double{number} : double(code);
    }
    return {};
  }

  Status read_words(NetpbmMap& map) {
    const std::size_t n = std::size_t{map.width} * map.height;
    if (n > text_.size())
      return refusal(name_, fmt::format("{} bytes", text_.size()), fmt::format("{} numbers", n));
    map.values.reserve(n);
    while (map.values.size() < n) {
      const std::string_view text = word();
      std::uint32_t code = 0;
      const auto read = std::from_chars(text.data(), text.data() + text.size(), code);
      if (read.ec != std::errc() || read.ptr != text.data() + text.size() || code > 65535)
        return refusal(name_, fmt::format("'{}' as number {}", shown(text), map.values.size()),
                       fmt::format("{} whole numbers up to 65535", n));
      map.values.push_back(code);
    }
    return {};
  }

  std::string_view text_;
  const std::string& name_;
  std::size_t at_ = 0;
};

}  // namespace

Result<NetpbmMap> parse_netpbm(std::span<const std::byte> bytes, const std::string& name) {
  return Reader(bytes, name).run();
}

}  // namespace neritic::scene
