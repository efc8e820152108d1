// Clusters of a rigid mesh: its triangles in an order where neighbours in space are neighbours in
// the index list, with a tree of bounds over runs of that list, so that a view pays only for the
// triangles it can see. Mesh frame, metres. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/scene/model.hpp"

namespace neritic::render {

// Triangles of one cluster, at most.
inline constexpr std::size_t kClusterTriangles = 128;

// A node of the tree, in depth-first order: its first child is the next node, its second child that
// one's end. A leaf is a cluster; its end is the next node.
struct ClusterNode {
  Vec3 center_m{0.0};
  double radius_m = 0.0;                           // of a sphere that holds every vertex
  std::uint32_t first_index = 0, index_count = 0;  // from the primitive's first index
  std::uint32_t end = 0;                           // node after this one's descendants
  // A coarser version of all that (add_coarse_clusters), with the same border; count 0: none.
  std::uint32_t coarse_first = 0, coarse_count = 0;  // from the primitive's first index
  double coarse_error_m = 0.0;                       // as scene::MeshLevel has it
};

// Puts the triangles into clusters (indices: three a triangle; within a cluster they keep their
// order) and returns the tree. Empty, and nothing moved, where all fit into one cluster or a
// position is not finite. The same input gives the same order on every machine.
std::vector<ClusterNode> build_clusters(std::span<const Vec3f> positions,
                                        std::vector<std::uint32_t>& indices);

// Gives inner nodes coarser versions, from the leaves up: of what its two children have, some half
// of the triangles. A node's border is that of the mesh itself, so that neighbours fit whichever
// version each is drawn with. indices: the mesh's, to which theirs are appended.
void add_coarse_clusters(const scene::Primitive& primitive, std::vector<ClusterNode>& nodes,
                         std::vector<std::uint32_t>& indices);

}  // namespace neritic::render
