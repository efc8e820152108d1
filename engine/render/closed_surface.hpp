// Whether a mesh is the skin of a solid: then nobody outside it ever sees a back face, and a pass
// that draws both sides of sheets need not draw this mesh's. Mesh frame, metres. Pure function; any
// thread.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/math.hpp"

namespace neritic::render {

// indices: three a triangle. True where every edge is passed as often one way as the other
// (vertices at the same place are one, triangles without area are none) and each connected part is
// wound outwards, its signed volume above 0. False where a position is not finite, and for no
// triangles at all.
bool is_closed(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices);

}  // namespace neritic::render
