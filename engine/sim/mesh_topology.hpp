// How a mesh for collisions is built: vertices at the same place become one, triangles without area
// and repeated ones go, edges learn what lies across, and connected surfaces without a rim are
// known as closed, their normals turned outwards. Used once a mesh.
#pragma once

#include "engine/sim/triangle_mesh.hpp"

namespace neritic::sim {

class MeshTopology {
 public:
  explicit MeshTopology(TriangleMesh& mesh) : mesh_(mesh) {}

  void weld(std::span<const Vec3f> vertices_m, std::span<const std::uint32_t> indices);
  void drop_repeated();
  void find_thin();
  void connect();
  void find_closed();
  void build_tree();

 private:
  using Edge = std::pair<std::uint32_t, std::uint32_t>;  // lower vertex first

  std::uint32_t surface_of(std::uint32_t triangle);
  double signed_volume(std::span<const std::uint32_t> surface) const;

  TriangleMesh& mesh_;
  // Every edge side: edge, triangle, which of its edges; sorted.
  struct Side {
    Edge edge;
    std::uint32_t triangle = 0;
    std::uint32_t place = 0;
    bool forward = false;  // from the lower vertex to the higher
  };
  std::vector<Side> sides_;
  std::vector<bool> thin_;             // triangles without area
  std::vector<std::uint32_t> parent_;  // union-find over triangles
};

}  // namespace neritic::sim
