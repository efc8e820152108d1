#include "engine/draw2d/upscale.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "engine/core/check.hpp"

namespace neritic::draw2d {
namespace {

// The two pixels of a row or column of `from` about the middle of a pixel of `to`.
struct Between {
  std::uint32_t first = 0, second = 0;
  std::uint32_t share = 0;  // of the second, of 256
};

Between between(std::uint32_t at, std::uint32_t size, std::uint32_t from_size) {
  const double place =
      std::clamp((at + 0.5) * from_size / size - 0.5, 0.0, static_cast<double>(from_size - 1));
  const auto first = static_cast<std::uint32_t>(place);
  return {first, std::min(first + 1, from_size - 1),
          static_cast<std::uint32_t>(std::lround((place - first) * 256.0))};
}

std::uint8_t mixed(std::uint32_t a, std::uint32_t b, std::uint32_t share) {
  return static_cast<std::uint8_t>((a * (256 - share) + b * share + 128) >> 8);
}

void swizzle(const std::uint8_t* rgba, std::uint8_t* bgra, std::size_t pixels) {
  for (std::size_t i = 0; i < pixels; ++i, rgba += 4, bgra += 4) {
    bgra[0] = rgba[2];
    bgra[1] = rgba[1];
    bgra[2] = rgba[0];
    bgra[3] = rgba[3];
  }
}

void widen(const std::uint8_t* row, std::span<const Between> columns, std::uint8_t* out) {
  for (const Between& column : columns) {
    const std::uint8_t *a = row + 4 * std::size_t{column.first},
                       *b = row + 4 * std::size_t{column.second};
    out[0] = mixed(a[2], b[2], column.share);
    out[1] = mixed(a[1], b[1], column.share);
    out[2] = mixed(a[0], b[0], column.share);
    out[3] = mixed(a[3], b[3], column.share);
    out += 4;
  }
}

// In blocks of a known size, which compilers turn into vector instructions at -O2.
void mix_rows(const std::uint8_t* a, const std::uint8_t* b, std::uint32_t share, std::uint8_t* out,
              std::size_t bytes) {
  constexpr std::size_t kBlock = 64;
  const auto second = static_cast<std::uint16_t>(share);
  const auto first = static_cast<std::uint16_t>(256 - share);
  std::size_t i = 0;
  for (; i + kBlock <= bytes; i += kBlock)
    for (std::size_t k = 0; k < kBlock; ++k)
      out[i + k] = static_cast<std::uint8_t>(
          static_cast<std::uint16_t>(a[i + k] * first + b[i + k] * second + 128) >> 8);
  for (; i < bytes; ++i) out[i] = mixed(a[i], b[i], share);
}

}  // namespace

void upscale_to_bgra(std::span<const std::uint8_t> from, std::uint32_t from_width,
                     std::uint32_t from_height, std::span<std::uint8_t> to, std::uint32_t width,
                     std::uint32_t height) {
  const std::size_t from_row = std::size_t{4} * from_width, row = std::size_t{4} * width;
  NERITIC_CHECK(from_width > 0 && from_height > 0 && from.size() >= from_row * from_height &&
                    to.size() >= row * height,
                "{} bytes of {} x {} to {} of {} x {}", from.size(), from_width, from_height,
                to.size(), width, height);
  if (from_width == width && from_height == height)
    return swizzle(from.data(), to.data(), std::size_t{width} * height);
  std::vector<Between> columns(width);
  for (std::uint32_t x = 0; x < width; ++x) columns[x] = between(x, width, from_width);
  // The two last rows of `from` that were widened.
  std::array<std::vector<std::uint8_t>, 2> wide{std::vector<std::uint8_t>(row),
                                                std::vector<std::uint8_t>(row)};
  std::array<std::uint32_t, 2> held{from_height, from_height};  // none
  const auto take = [&](std::uint32_t y, std::uint32_t keep) -> std::size_t {
    for (std::size_t i = 0; i < 2; ++i)
      if (held[i] == y) return i;
    const std::size_t into = held[0] == keep ? 1 : 0;
    widen(from.data() + from_row * y, columns, wide[into].data());
    held[into] = y;
    return into;
  };
  for (std::uint32_t y = 0; y < height; ++y) {
    const Between rows = between(y, height, from_height);
    const std::size_t a = take(rows.first, rows.second);
    const std::size_t b = take(rows.second, rows.first);
    mix_rows(wide[a].data(), wide[b].data(), rows.share, to.data() + row * y, row);
  }
}

void lay_over(std::span<const std::uint8_t> panel, std::uint32_t panel_width, const PixelRect& part,
              int left, int top, std::span<std::uint8_t> picture, std::uint32_t width,
              std::uint32_t height) {
  const auto first = [](int corner, std::uint32_t from) {
    return std::max(static_cast<std::int64_t>(from), -std::int64_t{corner});
  };
  const auto end = [](int corner, std::uint32_t to, std::uint32_t size) {
    return std::min(static_cast<std::int64_t>(to), std::int64_t{size} - corner);
  };
  const std::int64_t x0 = first(left, part.left), x1 = end(left, part.left + part.width, width);
  const std::int64_t y0 = first(top, part.top), y1 = end(top, part.top + part.height, height);
  for (std::int64_t y = y0; y < y1; ++y) {
    const std::uint8_t* from = panel.data() + 4 * (y * panel_width + x0);
    std::uint8_t* to = picture.data() + 4 * ((y + top) * std::int64_t{width} + x0 + left);
    for (std::int64_t x = x0; x < x1; ++x, from += 4, to += 4) {
      const std::uint32_t through = 255u - from[3];
      if (through == 255u && !(from[0] | from[1] | from[2])) continue;
      const auto over = [through](std::uint32_t under, std::uint32_t above) {
        return static_cast<std::uint8_t>(std::min(above + (under * through + 127) / 255, 255u));
      };
      to[0] = over(to[0], from[2]);
      to[1] = over(to[1], from[1]);
      to[2] = over(to[2], from[0]);
    }
  }
}

}  // namespace neritic::draw2d
