// Coarser versions of a mesh, for pictures in which it is small: fewer triangles on the same
// vertices. Made by meshoptimizer's simplifier (quadric errors, Garland and Heckbert 1997). Pure;
// any thread. The same mesh gives the same levels on every machine.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/model.hpp"

namespace neritic::scene {

struct MeshLevel {
  std::vector<std::uint32_t> indices;  // three a triangle, of the primitive's vertices
  // What the level leaves wrong, metres in the mesh's frame: the surface lies no farther off than
  // this (as the simplifier estimates it), and an edge, between whose ends normals, colours and
  // texture are interpolated, is kEdgeShare times as long.
  double error_m = 0.0;
};

// Edges of this many times the error's length are allowed: at half a pixel of error, four pixels.
inline constexpr double kEdgeShare = 8.0;

// From the finest to the coarsest, each with some half of the triangles of the one before it. None
// for points and lines, for meshes of fewer than 32 triangles, with morph targets, or not finite.
std::vector<MeshLevel> mesh_levels(const Primitive& primitive);

}  // namespace neritic::scene
