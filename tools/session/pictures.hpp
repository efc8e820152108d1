// Data as pictures for a person: depth, normals, labels and motion in colours, and a contact sheet
// of captioned pictures. Pure functions.
#pragma once

#include <string>
#include <vector>

#include "tools/session/session.hpp"

namespace neritic::tools {

ImageU8 depth_picture(
    const ImageF32& depth_m);  // near bright, far dark, logarithmic; black: nothing
ImageU8 normals_picture(const ImageF32& normals);  // 0.5 + 0.5 n
// A colour a label; a sonar's shadow dark grey, its ghosts light.
ImageU8 labels_picture(const ImageU16& labels);
ImageU8 motion_picture(const ImageF32& motion_px);  // hue: direction, brightness: length

// Shrinks by averaging whole source pixels to the size given (never enlarges detail).
ImageU8 resized(const ImageU8& image, std::uint32_t width, std::uint32_t height);

struct Tile {
  ImageU8 image;
  std::string caption;
};
// The first tile large on the left, the others in rows beside and under it.
ImageU8 contact_sheet(const std::vector<Tile>& tiles);
// Equal tiles in rows: many pictures at one glance.
ImageU8 grid_sheet(const std::vector<Tile>& tiles, std::uint32_t columns, std::uint32_t tile_width,
                   std::uint32_t tile_height);

}  // namespace neritic::tools
