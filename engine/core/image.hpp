// A picture or map in memory: rows from the top, interleaved channels. A plain value; any thread.
#pragma once

#include <cstdint>
#include <vector>

namespace neritic {

// Longest side of a picture or G-buffer that may be asked for: maxImageDimension2D of most devices.
inline constexpr std::uint32_t kMaxPictureSide = 16384;

template <class T>
struct Raster {
  std::uint32_t width = 0, height = 0, channels = 1;
  std::vector<T> data;  // [height][width][channels]

  Raster() = default;
  Raster(std::uint32_t w, std::uint32_t h, std::uint32_t c, T fill = T{})
      : width(w), height(h), channels(c), data(std::size_t{w} * h * c, fill) {}
  T& at(std::uint32_t x, std::uint32_t y, std::uint32_t c = 0) {
    return data[(std::size_t{y} * width + x) * channels + c];
  }
  const T& at(std::uint32_t x, std::uint32_t y, std::uint32_t c = 0) const {
    return data[(std::size_t{y} * width + x) * channels + c];
  }
  bool empty() const { return data.empty(); }
};

using ImageU8 = Raster<std::uint8_t>;
using ImageU16 = Raster<std::uint16_t>;
using ImageF32 = Raster<float>;

}  // namespace neritic
