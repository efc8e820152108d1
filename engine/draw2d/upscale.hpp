// A picture of four bytes a pixel brought to the size of a screen, and panels laid over it: what a
// compositor does, where host and device are one processor. Pure functions; any thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace neritic::draw2d {

// A rectangle of whole pixels.
struct PixelRect {
  std::uint32_t left = 0, top = 0, width = 0, height = 0;
};

// from: RGBA; to: BGRA. Bilinear between the middles of pixels, by steps of 1 / 256 of a pixel and
// of a level; a picture of the same size is copied as it is.
void upscale_to_bgra(std::span<const std::uint8_t> from, std::uint32_t from_width,
                     std::uint32_t from_height, std::span<std::uint8_t> to, std::uint32_t width,
                     std::uint32_t height);

// Lays a part of a panel (RGBA, colour multiplied by alpha) over a picture (BGRA), where the
// panel's corner is at (left, top) of the picture. What lies outside of the picture is left out.
void lay_over(std::span<const std::uint8_t> panel, std::uint32_t panel_width, const PixelRect& part,
              int left, int top, std::span<std::uint8_t> picture, std::uint32_t width,
              std::uint32_t height);

}  // namespace neritic::draw2d
