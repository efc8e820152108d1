// Bullet's quantized bounding volume tree behind box_tree.hpp.
#include "engine/sim/box_tree.hpp"

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

struct BoxTree::Tree : btQuantizedBvh {};

BoxTree::BoxTree(std::span<const Box> boxes) {
  if (boxes.empty()) return;
  NERITIC_CHECK(boxes.size() < std::size_t{1} << 30, "{} boxes", boxes.size());
  for (const Box& box : boxes) bounds_.add(box);
  tree_ = std::make_unique<Tree>();
  // A margin, since a flat whole has no thickness to divide.
  const double margin = 1e-3 * (1.0 + glm::length(bounds_.half()));
  tree_->setQuantizationValues(to_bullet(bounds_.low), to_bullet(bounds_.high), margin);
  QuantizedNodeArray& leaves = tree_->getLeafNodeArray();
  leaves.resize(static_cast<int>(boxes.size()));
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    btQuantizedBvhNode& leaf = leaves[static_cast<int>(i)];
    tree_->quantize(leaf.m_quantizedAabbMin, to_bullet(boxes[i].low), 0);
    tree_->quantize(leaf.m_quantizedAabbMax, to_bullet(boxes[i].high), 1);
    leaf.m_escapeIndexOrTriangleIndex = static_cast<int>(i);
  }
  tree_->buildInternal();
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
