// A tree over boxes that finds those which a box or a ray meets: Bullet's quantized tree, whose
// nodes are widened to a 65536th of the whole. Immutable once built: any number of threads may ask.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <type_traits>

#include "engine/sim/box.hpp"

namespace neritic::sim {

class BoxTree {
 public:
  // Boxes are known by their index; none may be empty. No boxes: finds nothing.
  explicit BoxTree(std::span<const Box> boxes = {});
  ~BoxTree();
  BoxTree(BoxTree&&) noexcept;
  BoxTree& operator=(BoxTree&&) noexcept;

  // Calls found(index) for each box that may overlap, in the tree's order. A few that do not may be
  // among them.
  template <class Found>
  void overlapping(const Box& box, Found&& found) const {
    using Plain = std::remove_reference_t<Found>;
    report_overlapping(box, &found,
                       [](void* to, std::uint32_t i) { (*static_cast<Plain*>(to))(i); });
  }
  // The same for those that the segment may meet.
  template <class Found>
  void along(const Vec3& from, const Vec3& to, Found&& found) const {
    using Plain = std::remove_reference_t<Found>;
    report_along(from, to, &found,
                 [](void* target, std::uint32_t i) { (*static_cast<Plain*>(target))(i); });
  }
  const Box& bounds() const { return bounds_; }

 private:
  using Report = void (*)(void* to, std::uint32_t index);
  struct Tree;
  void report_overlapping(const Box& box, void* to, Report report) const;
  void report_along(const Vec3& from, const Vec3& to, void* target, Report report) const;

  Box bounds_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace neritic::sim
