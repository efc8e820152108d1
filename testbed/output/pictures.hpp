// Data as pictures for a person: depth, normals, labels and motion in colours, and a contact sheet
// of captioned pictures. Pure functions.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "testbed/sensors/session.hpp"

namespace neritic::testbed {

// The nearest and the farthest that a depth image shows, m; nothing where it shows nothing.
std::optional<std::pair<double, double>> depth_span(const ImageF32& depth_m);
// Near bright, far dark, logarithmic over the span; black: nothing.
ImageU8 depth_picture(const ImageF32& depth_m);
ImageU8 normals_picture(const ImageF32& normals);  // 0.5 + 0.5 n
using Rgb = std::array<std::uint8_t, 3>;
Rgb label_color(std::uint16_t label);  // 0, nothing, is black
// A colour a label; a sonar's shadow dark grey, its ghosts light.
ImageU8 labels_picture(const ImageU16& labels);
ImageU8 motion_picture(const ImageF32& motion_px);  // hue: direction, brightness: length

// Shrinks by averaging whole source pixels to the size given (never enlarges detail).
ImageU8 resized(const ImageU8& image, std::uint32_t width, std::uint32_t height);

struct Tile {
  ImageU8 image;
  std::string caption;
  // The meaning of its colours, beside the caption as far as there is room.
  std::vector<std::pair<Rgb, std::string>> key = {};
};
// The first tile large on the left, the others in rows beside and under it.
ImageU8 contact_sheet(const std::vector<Tile>& tiles);
// Equal tiles in rows: many pictures at one glance.
ImageU8 grid_sheet(const std::vector<Tile>& tiles, std::uint32_t columns, std::uint32_t tile_width,
                   std::uint32_t tile_height);

}  // namespace neritic::testbed
