// Whether a mesh is the skin of solids, or of sheets with two sides: a pass that draws both sides
// of sheets need not draw its back faces for an eye outside it. Mesh frame, metres. Pure function;
// any thread.
#pragma once

#include <cstdint>
#include <span>

#include "engine/core/math.hpp"

namespace neritic::render {

// indices: three a triangle. True where every edge has two triangles that pass it opposite ways
// (vertices at the same place are one, triangles without area are none; nor are two that are each
// other's backs, one of which always shows its front) and each part that hangs together by edges is
// wound outwards, its signed volume above 0. False where a position is not
// finite, and for no triangles at all. A part that crosses itself may still show backs to the
// outside: ask only where the material has one side.
bool is_closed(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices);

}  // namespace neritic::render
