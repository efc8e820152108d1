#include "engine/draw2d/resample.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/core/check.hpp"

namespace neritic::draw2d {
namespace {

// Source cells that [at, at + 1) * step covers, and how much of the first and last.
struct Cover {
  std::size_t first, last;
  double from, to;
  double weight(std::size_t i) const {
    return std::min(to, static_cast<double>(i + 1)) - std::max(from, static_cast<double>(i));
  }
};
Cover cover(std::uint32_t at, std::uint32_t pixels, std::size_t cells) {
  const double step = static_cast<double>(cells) / pixels;
  const double from = at * step, to = at + 1 == pixels ? static_cast<double>(cells) : from + step;
  const auto first = std::min(static_cast<std::size_t>(from), cells - 1);
  const auto end = static_cast<std::size_t>(std::ceil(to));
  return {first, std::clamp(end, first + 1, cells) - 1, from, to};
}

}  // namespace

ImageF32 resample_area(std::span<const float> values, std::size_t rows, std::size_t columns,
                       std::uint32_t width, std::uint32_t height) {
  NERITIC_CHECK(
      values.size() == rows * columns && rows > 0 && columns > 0 && width > 0 && height > 0,
      "{} values for {} x {}, to {} x {} pixels", values.size(), rows, columns, height, width);
  ImageF32 out(width, height, 1);
  std::vector<Cover> across;
  for (std::uint32_t x = 0; x < width; ++x) across.push_back(cover(x, width, columns));
  for (std::uint32_t y = 0; y < height; ++y) {
    const Cover down = cover(y, height, rows);
    for (std::uint32_t x = 0; x < width; ++x) {
      double sum = 0.0, weight = 0.0;
      for (std::size_t r = down.first; r <= down.last; ++r)
        for (std::size_t c = across[x].first; c <= across[x].last; ++c) {
          const float v = values[r * columns + c];
          if (std::isnan(v)) continue;
          const double w = down.weight(r) * across[x].weight(c);
          sum += w * v;
          weight += w;
        }
      out.at(x, y) =
          weight > 0.0 ? static_cast<float>(sum / weight) : std::numeric_limits<float>::quiet_NaN();
    }
  }
  return out;
}

void draw_shades(Canvas& canvas, int left, int top, const ImageF32& shades, ColorMap map) {
  for (std::uint32_t y = 0; y < shades.height; ++y)
    for (std::uint32_t x = 0; x < shades.width; ++x)
      if (const float v = shades.at(x, y); !std::isnan(v))
        canvas.blend(left + static_cast<int>(x), top + static_cast<int>(y), map_color(map, v),
                     1.0f);
}

}  // namespace neritic::draw2d
