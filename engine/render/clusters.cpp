#include "engine/render/clusters.hpp"

#include <algorithm>
#include <array>

#include "engine/scene/mesh_levels.hpp"

namespace neritic::render {
namespace {

// Rounding of the bounds themselves, relative: they are made in double from float positions.
constexpr double kRounding = 1e-9;

struct Key {
  std::array<float, 3> centroid_m{};
  std::uint32_t triangle = 0;
};

class ClusterBuilder {
 public:
  ClusterBuilder(std::span<const Vec3f> positions, const std::vector<std::uint32_t>& indices)
      : positions_(positions), indices_(indices) {}

  std::vector<ClusterNode> build(std::vector<std::uint32_t>& ordered) {
    make_keys();
    nodes_.reserve(keys_.size() / kClusterTriangles * 4);
    ordered_.reserve(indices_.size());
    add_node(0, keys_.size());
    ordered = std::move(ordered_);
    return std::move(nodes_);
  }

 private:
  Vec3 corner(std::uint32_t triangle, std::uint32_t i) const {
    return Vec3(positions_[indices_[3 * triangle + i]]);
  }

  void make_keys() {
    const auto triangles = static_cast<std::uint32_t>(indices_.size() / 3);
    keys_.resize(triangles);
    for (std::uint32_t t = 0; t < triangles; ++t) {
      const Vec3 centroid_m = (corner(t, 0) + corner(t, 1) + corner(t, 2)) / 3.0;
      keys_[t] = {{float(centroid_m.x), float(centroid_m.y), float(centroid_m.z)}, t};
    }
  }

  std::size_t widest_axis(std::size_t begin, std::size_t end) const {
    std::array<float, 3> least = keys_[begin].centroid_m, most = least;
    for (std::size_t k = begin; k < end; ++k)
      for (std::size_t i = 0; i < 3; ++i) {
        least[i] = std::min(least[i], keys_[k].centroid_m[i]);
        most[i] = std::max(most[i], keys_[k].centroid_m[i]);
      }
    std::size_t widest = 0;
    for (std::size_t i = 1; i < 3; ++i)
      if (most[i] - least[i] > most[widest] - least[widest]) widest = i;
    return widest;
  }

  // Adds the node of keys [begin, end) with its descendants; returns its index and box.
  std::pair<std::size_t, scene::Bounds> add_node(std::size_t begin, std::size_t end) {
    const std::size_t index = nodes_.size();
    nodes_.emplace_back();
    const auto first_index = static_cast<std::uint32_t>(ordered_.size());
    scene::Bounds box;
    const std::size_t clusters = (end - begin + kClusterTriangles - 1) / kClusterTriangles;
    if (clusters == 1) {
      box = fill_leaf(index, begin, end);
    } else {
      const std::size_t axis = widest_axis(begin, end);
      const std::size_t middle = begin + (end - begin) * (clusters / 2) / clusters;
      const auto at = [&](std::size_t k) { return keys_.begin() + static_cast<std::ptrdiff_t>(k); };
      std::nth_element(at(begin), at(middle), at(end), [axis](const Key& a, const Key& b) {
        return a.centroid_m[axis] != b.centroid_m[axis] ? a.centroid_m[axis] < b.centroid_m[axis]
                                                        : a.triangle < b.triangle;
      });
      const auto [first, first_box] = add_node(begin, middle);
      const auto [second, second_box] = add_node(middle, end);
      box.add(glm::min(first_box.min, second_box.min));
      box.add(glm::max(first_box.max, second_box.max));
      join(nodes_[index], box, nodes_[first], nodes_[second]);
    }
    nodes_[index].first_index = first_index;
    nodes_[index].index_count = static_cast<std::uint32_t>(ordered_.size()) - first_index;
    nodes_[index].end = static_cast<std::uint32_t>(nodes_.size());
    return {index, box};
  }

  scene::Bounds fill_leaf(std::size_t index, std::size_t begin, std::size_t end) {
    std::vector<std::uint32_t> triangles;
    for (std::size_t k = begin; k < end; ++k) triangles.push_back(keys_[k].triangle);
    std::sort(triangles.begin(), triangles.end());
    scene::Bounds box;
    for (const std::uint32_t t : triangles)
      for (std::uint32_t i = 0; i < 3; ++i) {
        ordered_.push_back(indices_[3 * t + i]);
        box.add(corner(t, i));
      }
    ClusterNode& node = nodes_[index];
    node.center_m = (box.min + box.max) * 0.5;
    for (const std::uint32_t t : triangles)
      for (std::uint32_t i = 0; i < 3; ++i)
        node.radius_m = std::max(node.radius_m, glm::length(corner(t, i) - node.center_m));
    node.radius_m *= 1.0 + kRounding;
    return box;
  }

  static void join(ClusterNode& node, const scene::Bounds& box, const ClusterNode& a,
                   const ClusterNode& b) {
    node.center_m = (box.min + box.max) * 0.5;
    for (const ClusterNode* child : {&a, &b}) {
      const double moved = glm::length(child->center_m - node.center_m);
      node.radius_m = std::max(node.radius_m, (moved + child->radius_m) * (1.0 + kRounding));
    }
  }

  std::span<const Vec3f> positions_;
  const std::vector<std::uint32_t>& indices_;
  std::vector<Key> keys_;
  std::vector<std::uint32_t> ordered_;
  std::vector<ClusterNode> nodes_;
};

}  // namespace

std::vector<ClusterNode> build_clusters(std::span<const Vec3f> positions,
                                        std::vector<std::uint32_t>& indices) {
  if (indices.size() <= 3 * kClusterTriangles) return {};
  for (const std::uint32_t i : indices)
    if (!is_finite(Vec3(positions[i]))) return {};
  return ClusterBuilder(positions, indices).build(indices);
}

void add_coarse_clusters(const scene::Primitive& primitive, std::vector<ClusterNode>& nodes,
                         std::vector<std::uint32_t>& indices) {
  if (nodes.empty() || !scene::MeshSimplifier::accepts(primitive)) return;
  const scene::MeshSimplifier simplifier(primitive);
  struct Made {
    std::vector<std::uint32_t> places;
    double moved_m = 0.0;
    std::uint32_t height = 0;  // over the leaves
  };
  std::vector<Made> made(nodes.size());
  std::vector<std::uint32_t> order;
  // Children come after their parents.
  for (auto n = static_cast<std::uint32_t>(nodes.size()); n-- > 0;) {
    ClusterNode& node = nodes[n];
    if (node.end == n + 1) {
      made[n].places = simplifier.places_of(
          std::span<const std::uint32_t>(indices).subspan(node.first_index, node.index_count));
      continue;
    }
    const Made &a = made[n + 1], &b = made[nodes[n + 1].end];
    std::vector<std::uint32_t> both = a.places;
    both.insert(both.end(), b.places.begin(), b.places.end());
    scene::MeshSimplifier::Coarse coarse = simplifier.coarser(both, both.size() / 6, true);
    made[n].height = std::max(a.height, b.height) + 1;
    made[n].moved_m = std::max(a.moved_m, b.moved_m);
    if (coarse.places.empty() || 4 * coarse.places.size() > 3 * both.size()) {
      made[n].places = std::move(both);  // its border is nearly all of it
      continue;
    }
    made[n].moved_m += coarse.moved_m;
    made[n].places = std::move(coarse.places);
    node.coarse_count = static_cast<std::uint32_t>(made[n].places.size());
    node.coarse_error_m =
        std::max(made[n].moved_m, simplifier.edge_m(made[n].places) / scene::kEdgeShare);
    order.push_back(n);
  }
  // Neighbours of one height follow each other, so that they are one draw.
  std::ranges::sort(order, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(made[a].height, a) < std::pair(made[b].height, b);
  });
  for (const std::uint32_t n : order) {
    nodes[n].coarse_first = static_cast<std::uint32_t>(indices.size());
    const std::vector<std::uint32_t> vertices = simplifier.vertices_of(made[n].places);
    indices.insert(indices.end(), vertices.begin(), vertices.end());
  }
}

}  // namespace neritic::render
