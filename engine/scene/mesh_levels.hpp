// Coarser versions of a mesh, for pictures in which it is small: fewer triangles on the same
// vertices. Made by meshoptimizer's simplifier (quadric errors, Garland and Heckbert 1997). Pure;
// any thread. The same mesh gives the same levels on every machine.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/scene/model.hpp"

namespace neritic::scene {

struct MeshLevel {
  std::vector<std::uint32_t> indices;  // three a triangle, of the primitive's vertices
  // The level's error, metres in the mesh's frame: the surface lies no farther off than
  // this (as the simplifier estimates it), and an edge, between whose ends normals, colours and
  // texture are interpolated, is kEdgeShare times as long.
  double error_m = 0.0;
};

// Edges of this many times the error's length are allowed: at half a pixel of error, four pixels.
inline constexpr double kEdgeShare = 8.0;

// The places of a mesh's vertices, each once, and what makes coarser meshes of them: a simplifier
// that sees the seams of texture and normals cannot pass them. Keeps a reference to the primitive.
class MeshSimplifier {
 public:
  explicit MeshSimplifier(const Primitive& primitive);
  // Whether the mesh can be made coarser: triangles, finite, no morph targets.
  static bool accepts(const Primitive& primitive);

  // Triangles of places of these triangles of vertices; those without an area are left out.
  std::vector<std::uint32_t> places_of(std::span<const std::uint32_t> vertices) const;
  // Triangles of vertices of these triangles of places: at each corner the vertex whose normal
  // faces as the triangle does and whose texture lies beside that of the other two.
  std::vector<std::uint32_t> vertices_of(std::span<const std::uint32_t> places) const;

  struct Coarse {
    std::vector<std::uint32_t> places;
    double moved_m = 0.0;  // the surface
  };
  // Fewer of these triangles, target at best. keep_border: edges of one triangle stay as they are.
  Coarse coarser(std::span<const std::uint32_t> places, std::size_t target_triangles,
                 bool keep_border) const;
  // The side of equal-sided triangles of the mean area.
  double edge_m(std::span<const std::uint32_t> places) const;
  double size_m() const { return size_m_; }  // the longest side of its box

 private:
  std::array<std::uint32_t, 3> corners_of(const std::uint32_t* places) const;
  double apart(std::uint32_t a, std::uint32_t b) const;

  const Primitive& primitive_;
  std::vector<Vec3f> positions_m_;
  std::vector<std::uint32_t> place_of_vertex_;
  // The vertices of place p: vertices_[first_[p]] to vertices_[first_[p + 1] - 1].
  std::vector<std::uint32_t> first_, vertices_;
  double size_m_ = 0.0;
};

// From the finest to the coarsest, each with some half of the triangles of the one before it. None
// for points and lines, for meshes of fewer than 32 triangles, with morph targets, or not finite.
std::vector<MeshLevel> mesh_levels(const Primitive& primitive);

}  // namespace neritic::scene
