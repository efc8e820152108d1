// From G-buffer texels to the arrays of the file contract. Pure functions.
#pragma once

#include <cstddef>
#include <span>

#include "testbed/sensors/frame_result.hpp"

namespace neritic::testbed {

// texels: one layer of the image. depth_texels: its depth, which tells the hits.
void decode_depth(std::span<const float> texels, ViewImages& out);
void decode_normals(std::span<const std::uint32_t> texels, std::span<const float> depth_texels,
                    ViewImages& out);
// Those that are asked for, of class and instance.
void decode_labels(std::span<const std::uint32_t> texels, bool labels, bool instances,
                   ViewImages& out);
void decode_color(std::span<const std::uint32_t> texels, ViewImages& out);
// texels: half floats, so that counts above 2^11 are rounded. white: gains that were applied, which
// a raw picture has not.
void decode_linear(std::span<const std::uint64_t> texels, ViewImages& out);
void decode_raw(std::span<const std::uint64_t> texels, const scene::ImageSensor& sensor,
                const Vec3f& white, ViewImages& out);
// next_from_view: the view's turn from now to the next frame's time. Where depth_texels hit
// nothing, what is infinitely far moves by it alone; what would be behind the view then is NaN.
void decode_motion(std::span<const float> texels, std::span<const float> depth_texels,
                   const Quat& next_from_view, ViewImages& out);

}  // namespace neritic::testbed
