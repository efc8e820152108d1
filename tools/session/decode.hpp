// From G-buffer texels to the arrays of the file contract. Pure functions.
#pragma once

#include <cstddef>
#include <span>

#include "tools/session/session.hpp"

namespace neritic::tools {

// texels: one layer of the depth / normal / label image. Depth first: the others need its hits.
void decode_depth(std::span<const float> texels, ViewImages& out);
void decode_normals(std::span<const std::uint32_t> texels, ViewImages& out);
void decode_labels(std::span<const std::uint32_t> texels, ViewImages& out);
void decode_color(std::span<const std::uint32_t> texels, ViewImages& out);
void decode_motion(std::span<const float> texels, ViewImages& out);

}  // namespace neritic::tools
