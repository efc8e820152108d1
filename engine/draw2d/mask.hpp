// The coverage of a box of pixels by a shape, before the shape gets its colour. A plain value.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace neritic::draw2d {

// Pixels left <= x < right, top <= y < bottom; y down.
struct PixelBox {
  int left = 0, top = 0, right = 0, bottom = 0;
  int width() const { return std::max(0, right - left); }
  int height() const { return std::max(0, bottom - top); }
  bool empty() const { return right <= left || bottom <= top; }
  PixelBox intersect(const PixelBox& other) const {
    return {std::max(left, other.left), std::max(top, other.top), std::min(right, other.right),
            std::min(bottom, other.bottom)};
  }
};

struct Mask {
  PixelBox box;
  std::vector<std::uint8_t> coverage;  // [height][width], 255: the shape covers the whole pixel

  Mask() = default;
  explicit Mask(const PixelBox& where)
      : box(where), coverage(std::size_t(where.width()) * std::size_t(where.height())) {}
  std::uint8_t& at(int x, int y) { return coverage[index(x, y)]; }
  std::uint8_t at(int x, int y) const { return coverage[index(x, y)]; }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y - box.top) * std::size_t(box.width()) + std::size_t(x - box.left);
  }
};

}  // namespace neritic::draw2d
