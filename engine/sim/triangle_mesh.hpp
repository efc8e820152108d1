// A mesh that things collide with, in its own frame: its triangles, who lies across each edge,
// which of them enclose something, and the tree that finds them. Immutable once built; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/sim/box_tree.hpp"
#include "engine/sim/triangle.hpp"

namespace neritic::sim {

class TriangleMesh {
 public:
  // Three indices a triangle, either winding. Triangles without area collide with nothing, and of
  // several on the same three points one stays. An error for an index past the vertices or a vertex
  // that is not finite; name stands in messages.
  static Result<TriangleMesh> build(std::span<const Vec3f> vertices_m,
                                    std::span<const std::uint32_t> indices,
                                    const std::string& name);

  std::size_t triangle_count() const { return corners_.size(); }
  std::size_t dropped_count() const { return dropped_; }  // no area, or there already
  const Box& bounds() const { return tree_.bounds(); }
  // Some of its surfaces are closed.
  bool has_inside() const { return !solid_bounds_.empty(); }

  // As the mesh has it, times scale and then moved by offset. link() adds what lies across its
  // edges.
  Triangle triangle(std::uint32_t index, double scale, const Vec3& offset) const;
  void link(Triangle& triangle, double scale, const Vec3& offset) const;

  template <class Found>
  void overlapping(const Box& box, Found&& found) const {
    tree_.overlapping(box, found);
  }

  // Nearest triangle along the ray, or kNone.
  struct Hit {
    std::uint32_t triangle = 0;
    double distance = 0.0;
  };
  std::optional<Hit> cast(const Vec3& origin, const Vec3& direction, double max_distance) const;

  // Enclosed by closed surfaces: their winding number about the point is not 0.
  bool inside(const Vec3& point) const;
  // The nearest point of the closed surfaces. Precondition: has_inside().
  Vec3 nearest_surface(const Vec3& point) const;

 private:
  // Indices into vertices_; across: the corner beyond each edge's other side, kNone where there is
  // not exactly one triangle.
  struct Corners {
    std::array<std::uint32_t, 3> vertex;
    std::array<std::uint32_t, 3> across;
    std::array<bool, 3> owned;
    bool solid = false;
  };
  static constexpr std::uint32_t kNone = ~0u;

  int winding_along(const Vec3& point, const Vec3& direction) const;

  std::vector<Vec3f> vertices_;  // one for each place
  std::vector<Corners> corners_;
  std::size_t dropped_ = 0;
  Box solid_bounds_;
  BoxTree tree_;

  friend class MeshTopology;
};

}  // namespace neritic::sim
