// The loader's result for a primitive's raw lists: topology as lists, normals and tangents where
// the file has none, unit lengths. Pure functions on one primitive; indices must be in range.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/model.hpp"

namespace neritic::scene::gltf {

// glTF's primitive modes, in its numbering.
enum class Mode {
  kPoints,
  kLines,
  kLineLoop,
  kLineStrip,
  kTriangles,
  kTriangleStrip,
  kTriangleFan
};

Topology topology_of(Mode mode);
// The same shapes as a list; an incomplete last line or triangle is dropped.
std::vector<std::uint32_t> to_list(Mode mode, std::vector<std::uint32_t> indices);

// Every per-vertex list rearranged: new vertex i is old vertex old_of_new[i].
void gather_vertices(Primitive& primitive, std::span<const std::uint32_t> old_of_new);

// Face normals on vertices that faces no longer share (glTF 2.0 section 3.7.2.1), and morph
// targets' normal displacements to match. Triangles only.
void make_flat_normals(Primitive& primitive);

// Unit normals; where one has no direction, the faces around it give it. Returns how many were off
// by more than a hundredth, which is beyond the rounding of normals stored in bytes.
std::size_t repair_normals(Primitive& primitive);
// Unit tangents perpendicular to the normals, handedness +1 or -1.
void repair_tangents(Primitive& primitive);

// Tangents from the texture coordinates that ref samples with. Vertices on a seam between mirrored
// and unmirrored texture are split. Nothing where the coordinates are missing. Triangles only.
// Source: E. Lengyel, Foundations of Game Engine Development, vol. 2 (2019), section 7.5.
void make_tangents(Primitive& primitive, const TextureRef& ref);

}  // namespace neritic::scene::gltf
