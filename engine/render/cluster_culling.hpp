// Finds the clusters of an instance that the views of a set can see. Never drops a triangle that
// could reach a pixel: bounds are in double, with a margin for the GPU's rounding to float. Plain
// data on the CPU; any thread.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "engine/render/clusters.hpp"
#include "engine/render/views.hpp"

namespace neritic::render {

// A run of the index buffer, one draw command.
struct IndexRange {
  std::uint32_t first_index = 0, index_count = 0;
};

class ClusterCulling {
 public:
  explicit ClusterCulling(const ViewSet& views);

  // Appends the runs (in their order, from first_index on) of what some view can see of an
  // instance. mesh_error_px: coarser versions of nodes may stand for them where they differ by no
  // more pixels in any view; 0: none does.
  void append_visible(std::span<const ClusterNode> nodes, std::uint32_t first_index,
                      const Mat4& origin_from_primitive, std::vector<IndexRange>& out,
                      double mesh_error_px = 0.0) const;

 private:
  static constexpr std::size_t kPlanes = 5;  // four sides and the near plane; there is no far plane
  // A view's bounds: n . p + offset_m >= 0 inside, n unit, in the frame of the set's origin.
  struct View {
    std::array<Vec3, kPlanes> normal{};
    std::array<double, kPlanes> offset_m{};
    double near_m = 0.0, pixels = 0.0;  // a unit of tangent
  };
  class Walk;
  std::vector<View> views_;
  double farthest_eye_m_ = 0.0;  // from the origin
};

}  // namespace neritic::render
