// Bullet's quantized bounding volume tree behind box_tree.hpp.
#include "engine/sim/box_tree.hpp"

#include <algorithm>
#include <vector>

#include "engine/core/check.hpp"
#include "engine/sim/bullet.hpp"

namespace neritic::sim {
namespace {

// Bullet splits an index into a part (high bits) and a triangle; here it is one number.
constexpr int kLowBits = 31 - MAX_NUM_PARTS_IN_BITS;

struct TreeReport final : btNodeOverlapCallback {
  void (*report)(void*, std::uint32_t);
  void* to;
  void processNode(int part, int low) override {
    report(to, static_cast<std::uint32_t>(part) << kLowBits | static_cast<std::uint32_t>(low));
  }
};

}  // namespace

// The tree that Bullet's buildInternal() makes, box by box and in the same order, in a quarter of
// its time: Bullet turns each leaf's box into metres and back at every level of the tree, this
// once.
struct BoxTree::Tree : btQuantizedBvh {
  using Node = btQuantizedBvhNode;
  struct Leaf {
    btVector3 centre;
    Node node;
    Node rounded;  // its box in metres and back, by which Bullet widens the nodes above
  };

  Leaf leaf_of(const Box& box, std::size_t index) const;
  void build(std::span<const Box> boxes);

 private:
  std::size_t split(std::span<Leaf> leaves) const;
  // Adds the nodes of one leaf or more; returns the box about all.
  Node add(std::span<Leaf> leaves);
};

BoxTree::Tree::Leaf BoxTree::Tree::leaf_of(const Box& box, std::size_t index) const {
  Leaf leaf;
  quantize(leaf.node.m_quantizedAabbMin, to_bullet(box.low), 0);
  quantize(leaf.node.m_quantizedAabbMax, to_bullet(box.high), 1);
  leaf.node.m_escapeIndexOrTriangleIndex = static_cast<int>(index);
  const btVector3 low = unQuantize(leaf.node.m_quantizedAabbMin),
                  high = unQuantize(leaf.node.m_quantizedAabbMax);
  leaf.centre = btScalar(0.5) * (high + low);
  quantize(leaf.rounded.m_quantizedAabbMin, low, 0);
  quantize(leaf.rounded.m_quantizedAabbMax, high, 1);
  return leaf;
}

// Sorts the leaves into those beyond the mean of the centres, along the axis of the widest spread,
// and the rest; returns how many are beyond, or half of all where a side would have under a third.
std::size_t BoxTree::Tree::split(std::span<Leaf> leaves) const {
  const std::size_t count = leaves.size();
  btVector3 mean(0, 0, 0), spread(0, 0, 0);
  for (const Leaf& leaf : leaves) mean += leaf.centre;
  mean *= btScalar(1) / static_cast<btScalar>(count);
  for (const Leaf& leaf : leaves) {
    const btVector3 off = leaf.centre - mean;
    spread += off * off;
  }
  spread *= btScalar(1) / (static_cast<btScalar>(count) - 1);
  const int axis = spread.maxAxis();
  std::size_t beyond = 0;
  for (Leaf& leaf : leaves)
    if (leaf.centre[axis] > mean[axis]) std::swap(leaf, leaves[beyond++]);
  const std::size_t third = count / 3;
  return beyond <= third || beyond + 1 + third >= count ? count / 2 : beyond;
}

BoxTree::Tree::Node BoxTree::Tree::add(std::span<Leaf> leaves) {
  if (leaves.size() == 1) {
    m_quantizedContiguousNodes.push_back(leaves[0].node);
    return leaves[0].rounded;
  }
  const int index = m_quantizedContiguousNodes.size();
  m_quantizedContiguousNodes.push_back({});
  const std::size_t first = split(leaves);
  Node box = add(leaves.first(first));
  const Node other = add(leaves.subspan(first));
  for (int i = 0; i < 3; ++i) {
    box.m_quantizedAabbMin[i] = std::min(box.m_quantizedAabbMin[i], other.m_quantizedAabbMin[i]);
    box.m_quantizedAabbMax[i] = std::max(box.m_quantizedAabbMax[i], other.m_quantizedAabbMax[i]);
  }
  // How many nodes a query passes over that does not meet the box.
  box.m_escapeIndexOrTriangleIndex = index - m_quantizedContiguousNodes.size();
  m_quantizedContiguousNodes[index] = box;
  return box;
}

void BoxTree::Tree::build(std::span<const Box> boxes) {
  std::vector<Leaf> leaves;
  leaves.reserve(boxes.size());
  for (std::size_t i = 0; i < boxes.size(); ++i) leaves.push_back(leaf_of(boxes[i], i));
  m_quantizedContiguousNodes.reserve(static_cast<int>(2 * boxes.size()));
  add(leaves);
  m_curNodeIndex = m_quantizedContiguousNodes.size();
  setTraversalMode(TRAVERSAL_STACKLESS);  // the other modes need lists that only Bullet makes
}

BoxTree::BoxTree(std::span<const Box> boxes) {
  if (boxes.empty()) return;
  NERITIC_CHECK(boxes.size() < std::size_t{1} << 30, "{} boxes", boxes.size());
  for (const Box& box : boxes) bounds_.add(box);
  tree_ = std::make_unique<Tree>();
  // A margin, since a flat whole has no thickness to divide.
  const double margin = 1e-3 * (1.0 + glm::length(bounds_.half()));
  tree_->setQuantizationValues(to_bullet(bounds_.low), to_bullet(bounds_.high), margin);
  tree_->build(boxes);
}

BoxTree::~BoxTree() = default;
BoxTree::BoxTree(BoxTree&&) noexcept = default;
BoxTree& BoxTree::operator=(BoxTree&&) noexcept = default;

void BoxTree::report_overlapping(const Box& box, void* to, Report report) const {
  if (!tree_ || !bounds_.overlaps(box)) return;
  TreeReport callback;
  callback.report = report;
  callback.to = to;
  tree_->reportAabbOverlappingNodex(&callback, to_bullet(box.low), to_bullet(box.high));
}

void BoxTree::report_along(const Vec3& from, const Vec3& to, void* target, Report report) const {
  if (!tree_) return;
  TreeReport callback;
  callback.report = report;
  callback.to = target;
  tree_->reportRayOverlappingNodex(&callback, to_bullet(from), to_bullet(to));
}

}  // namespace neritic::sim
