// The tree over boxes against Bullet's own build of it: what a box or a ray meets, in the same
// order. Contacts come in that order, so that states and recordings keep their hashes.
#include "engine/sim/box_tree.hpp"

#include <gtest/gtest.h>

#include "engine/core/random.hpp"
#include "engine/sim/bullet.hpp"

namespace neritic::sim {
namespace {

double draw_of_a_box(std::uint64_t of, std::size_t i) {
  return random_uniform({of}, i);
}

Vec3 point_in_a_box(std::uint64_t of, std::size_t i, double size_m) {
  Vec3 p;
  for (int axis = 0; axis < 3; ++axis)
    p[axis] = size_m * (draw_of_a_box(of + static_cast<std::uint64_t>(axis), i) - 0.5);
  return p;
}

// Boxes of all sizes in a flat room; each seventh is as one before it.
std::vector<Box> boxes_in_a_room(std::size_t count) {
  std::vector<Box> out;
  for (std::size_t i = 0; i < count; ++i) {
    if (i % 7 == 6) {
      out.push_back(out[i / 2]);
      continue;
    }
    Box box;
    const Vec3 at = point_in_a_box(10, i, 20.0) * Vec3(1.0, 1.0, 0.2);
    box.add(at);
    box.add(at + 0.5 * draw_of_a_box(20, i) * point_in_a_box(30, i, 2.0));
    out.push_back(box);
  }
  return out;
}

struct BulletTree : btNodeOverlapCallback {
  btQuantizedBvh tree;
  std::vector<std::uint32_t> seen;

  explicit BulletTree(const std::vector<Box>& boxes) {
    Box bounds;
    for (const Box& box : boxes) bounds.add(box);
    tree.setQuantizationValues(to_bullet(bounds.low), to_bullet(bounds.high),
                               1e-3 * (1.0 + glm::length(bounds.half())));
    tree.getLeafNodeArray().resize(static_cast<int>(boxes.size()));
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      btQuantizedBvhNode& leaf = tree.getLeafNodeArray()[static_cast<int>(i)];
      tree.quantize(leaf.m_quantizedAabbMin, to_bullet(boxes[i].low), 0);
      tree.quantize(leaf.m_quantizedAabbMax, to_bullet(boxes[i].high), 1);
      leaf.m_escapeIndexOrTriangleIndex = static_cast<int>(i);
    }
    tree.buildInternal();
  }
  void processNode(int, int index) override { seen.push_back(static_cast<std::uint32_t>(index)); }
};

TEST(BoxTree, FindsWhatBulletsOwnBuildFindsInItsOrder) {
  for (const std::size_t count : {1u, 2u, 3u, 4u, 7u, 50u, 3001u}) {
    const std::vector<Box> boxes = boxes_in_a_room(count);
    const BoxTree tree(boxes);
    BulletTree bullet(boxes);
    std::size_t met = 0;
    for (std::size_t i = 0; i < 200; ++i) {
      const Vec3 from = point_in_a_box(40, i, 24.0), to = point_in_a_box(50, i, 24.0);
      Box asked;
      asked.add(from);
      asked.add(i % 2 == 0 ? to : from + 0.1 * (to - from));
      std::vector<std::uint32_t> found;
      auto note = [&](std::uint32_t index) { found.push_back(index); };
      bullet.seen.clear();
      tree.overlapping(asked, note);
      if (tree.bounds().overlaps(asked))
        bullet.tree.reportAabbOverlappingNodex(&bullet, to_bullet(asked.low),
                                               to_bullet(asked.high));
      ASSERT_EQ(found, bullet.seen) << count << " boxes, box " << i;
      met += found.size();
      found.clear(), bullet.seen.clear();
      tree.along(from, to, note);
      bullet.tree.reportRayOverlappingNodex(&bullet, to_bullet(from), to_bullet(to));
      ASSERT_EQ(found, bullet.seen) << count << " boxes, ray " << i;
    }
    EXPECT_GT(met, 10u);
  }
}

}  // namespace
}  // namespace neritic::sim
