// The steps by which a mesh for collisions is built.
#include "engine/sim/mesh_topology.hpp"

#include <algorithm>
#include <bit>
#include <functional>
#include <map>
#include <numeric>

#include "engine/core/refusal.hpp"

namespace neritic::sim {
namespace {

// Positions by value: -0 is 0.
std::array<float, 3> place_key(const Vec3f& p) {
  return {p.x + 0.0f, p.y + 0.0f, p.z + 0.0f};
}

// Sorts by `less`, whose first key is vertex(item), below vertex_count: deals the items out by it
// and sorts the few of each vertex, which takes a quarter of the time of sorting them all.
template <class Item, class Vertex, class Less>
void sort_by_vertex(std::vector<Item>& items, std::size_t vertex_count, Vertex vertex, Less less) {
  std::vector<std::uint32_t> next(vertex_count + 1, 0);
  for (const Item& item : items) ++next[vertex(item) + 1];
  std::partial_sum(next.begin(), next.end(), next.begin());
  std::vector<Item> dealt(items.size());
  for (const Item& item : items) dealt[next[vertex(item)]++] = item;
  auto begin = dealt.begin();
  for (std::size_t v = 0; v < vertex_count; ++v) {
    const auto end = dealt.begin() + next[v];
    std::sort(begin, end, less);
    begin = end;
  }
  items = std::move(dealt);
}

}  // namespace

void MeshTopology::weld(std::span<const Vec3f> vertices_m, std::span<const std::uint32_t> indices) {
  std::vector<std::pair<std::array<float, 3>, std::uint32_t>> places;
  places.reserve(vertices_m.size());
  for (std::uint32_t i = 0; i < vertices_m.size(); ++i)
    places.emplace_back(place_key(vertices_m[i]), i);
  std::sort(places.begin(), places.end());
  std::vector<std::uint32_t> welded(vertices_m.size());
  mesh_.vertices_.reserve(vertices_m.size());
  mesh_.corners_.reserve(indices.size() / 3);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i == 0 || places[i].first != places[i - 1].first)
      mesh_.vertices_.push_back(vertices_m[places[i].second]);
    welded[places[i].second] = static_cast<std::uint32_t>(mesh_.vertices_.size() - 1);
  }
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    TriangleMesh::Corners corners{};
    for (std::size_t j = 0; j < 3; ++j) corners.vertex[j] = welded[indices[i + j]];
    const auto& [a, b, c] = corners.vertex;
    if (a == b || b == c || c == a)
      ++mesh_.dropped_;
    else
      mesh_.corners_.push_back(corners);
  }
}

void MeshTopology::drop_repeated() {
  using Key = std::pair<std::array<std::uint32_t, 3>, std::uint32_t>;
  std::vector<Key> keys;
  keys.reserve(mesh_.corners_.size());
  for (std::uint32_t t = 0; t < mesh_.corners_.size(); ++t) {
    auto vertex = mesh_.corners_[t].vertex;
    std::sort(vertex.begin(), vertex.end());
    keys.emplace_back(vertex, t);
  }
  sort_by_vertex(
      keys, mesh_.vertices_.size(), [](const Key& key) { return key.first[0]; }, std::less<>());
  std::vector<bool> keep(keys.size(), true);
  for (std::size_t i = 1; i < keys.size(); ++i)
    if (keys[i].first == keys[i - 1].first) keep[keys[i].second] = false;
  std::vector<TriangleMesh::Corners> kept;
  kept.reserve(keep.size());
  for (std::size_t i = 0; i < keep.size(); ++i)
    if (keep[i]) kept.push_back(mesh_.corners_[i]);
  mesh_.dropped_ += mesh_.corners_.size() - kept.size();
  mesh_.corners_ = std::move(kept);
}

std::uint32_t MeshTopology::surface_of(std::uint32_t triangle) {
  while (parent_[triangle] != triangle) {
    parent_[triangle] = parent_[parent_[triangle]];
    triangle = parent_[triangle];
  }
  return triangle;
}

void MeshTopology::connect() {
  const auto count = static_cast<std::uint32_t>(mesh_.corners_.size());
  parent_.resize(count);
  std::iota(parent_.begin(), parent_.end(), 0u);
  sides_.reserve(std::size_t{count} * 3);
  for (std::uint32_t t = 0; t < count; ++t)
    for (std::uint32_t i = 0; i < 3; ++i) {
      const auto& vertex = mesh_.corners_[t].vertex;
      const std::uint32_t from = vertex[i], to = vertex[(i + 1) % 3];
      sides_.push_back({std::minmax(from, to), t, i, from < to});
    }
  sort_by_vertex(
      sides_, mesh_.vertices_.size(), [](const Side& side) { return side.edge.first; },
      [](const Side& a, const Side& b) {
        return std::pair(a.edge, a.triangle) < std::pair(b.edge, b.triangle);
      });
  for (std::size_t first = 0; first < sides_.size();) {
    std::size_t end = first + 1;
    while (end < sides_.size() && sides_[end].edge == sides_[first].edge) ++end;
    for (std::size_t i = first; i < end; ++i) {
      const Side& side = sides_[i];
      TriangleMesh::Corners& corners = mesh_.corners_[side.triangle];
      parent_[surface_of(side.triangle)] = surface_of(sides_[first].triangle);
      corners.owned[side.place] = true;
      corners.across[side.place] = TriangleMesh::kNone;
      if (end - first != 2) continue;
      const Side& other = sides_[first + (i == first ? 1 : 0)];
      if (thin_[other.triangle]) continue;
      corners.owned[side.place] = i == first;
      corners.across[side.place] = mesh_.corners_[other.triangle].vertex[(other.place + 2) % 3];
    }
    first = end;
  }
}

double MeshTopology::signed_volume(std::span<const std::uint32_t> surface) const {
  double six_volumes = 0.0;
  for (const std::uint32_t t : surface) {
    const Triangle triangle = mesh_.triangle(t, 1.0, -Vec3(mesh_.vertices_[0]));
    six_volumes += glm::dot(triangle.corner[0], glm::cross(triangle.corner[1], triangle.corner[2]));
  }
  return six_volumes / 6.0;
}

// Closed: every edge is walked as often one way as the other, so that a winding number exists.
void MeshTopology::find_closed() {
  std::vector<bool> has_rim(mesh_.corners_.size(), false);
  for (std::size_t first = 0; first < sides_.size();) {
    std::size_t end = first;
    int balance = 0;
    for (; end < sides_.size() && sides_[end].edge == sides_[first].edge; ++end)
      balance += sides_[end].forward ? 1 : -1;
    if (balance != 0) has_rim[surface_of(sides_[first].triangle)] = true;
    first = end;
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> closed;
  for (std::uint32_t t = 0; t < mesh_.corners_.size(); ++t)
    if (!has_rim[surface_of(t)]) closed[surface_of(t)].push_back(t);
  std::vector<std::vector<std::uint32_t>> surfaces;
  std::vector<Box> boxes;
  for (auto& [root, surface] : closed) {
    Box box;
    for (const std::uint32_t t : surface) box.add(mesh_.triangle(t, 1.0, Vec3(0.0)).box());
    surfaces.push_back(std::move(surface));
    boxes.push_back(box);
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    // One that is turned inwards is a cavity where another goes about it, else a mistake.
    bool enclosed = false;
    for (std::size_t other = 0; other < boxes.size(); ++other)
      enclosed = enclosed || (other != s && boxes[other].contains(boxes[s].low) &&
                              boxes[other].contains(boxes[s].high));
    const bool turn = !enclosed && signed_volume(surfaces[s]) < 0.0;
    for (const std::uint32_t t : surfaces[s]) {
      TriangleMesh::Corners& corners = mesh_.corners_[t];
      corners.solid = true;
      if (!turn) continue;
      // Edges 0-1, 1-2, 2-0 become 1-0, 0-2, 2-1.
      std::swap(corners.vertex[0], corners.vertex[1]);
      std::swap(corners.across[1], corners.across[2]);
      std::swap(corners.owned[1], corners.owned[2]);
    }
    mesh_.solid_bounds_.add(boxes[s]);
  }
}

// Those that are all but a line have no normal. Their edges count for what is closed, so they go
// last.
void MeshTopology::find_thin() {
  for (std::uint32_t t = 0; t < mesh_.corners_.size(); ++t) {
    const Triangle triangle = mesh_.triangle(t, 1.0, Vec3(0.0));
    double longest = 0.0;
    for (std::size_t i = 0; i < 3; ++i)
      longest = std::max(longest, glm::length(triangle.corner[(i + 1) % 3] - triangle.corner[i]));
    thin_.push_back(!(glm::length(triangle.area_normal()) > 1e-9 * longest * longest));
  }
}

void MeshTopology::build_tree() {
  std::vector<TriangleMesh::Corners> kept;
  std::vector<Box> boxes;
  kept.reserve(mesh_.corners_.size());
  boxes.reserve(mesh_.corners_.size());
  for (std::uint32_t t = 0; t < mesh_.corners_.size(); ++t) {
    if (thin_[t]) {
      ++mesh_.dropped_;
      continue;
    }
    kept.push_back(mesh_.corners_[t]);
    boxes.push_back(mesh_.triangle(t, 1.0, Vec3(0.0)).box());
  }
  mesh_.corners_ = std::move(kept);
  mesh_.tree_ = BoxTree(boxes);
}

Result<TriangleMesh> TriangleMesh::build(std::span<const Vec3f> vertices_m,
                                         std::span<const std::uint32_t> indices,
                                         const std::string& name) {
  if (indices.size() % 3 != 0)
    return refusal(name, fmt::format("{} indices", indices.size()), "three a triangle");
  for (std::size_t i = 0; i < indices.size(); ++i)
    if (indices[i] >= vertices_m.size())
      return refusal(fmt::format("{}: index {}", name, i), fmt::format("{}", indices[i]),
                     fmt::format("below {}, the number of vertices", vertices_m.size()));
  for (std::size_t i = 0; i < vertices_m.size(); ++i)
    if (!is_finite(Vec3(vertices_m[i])))
      return refusal(name, fmt::format("vertex {}, which is not finite", i), "finite numbers");
  TriangleMesh mesh;
  MeshTopology topology(mesh);
  topology.weld(vertices_m, indices);
  topology.drop_repeated();
  topology.find_thin();
  topology.connect();
  topology.find_closed();
  topology.build_tree();
  return mesh;
}

}  // namespace neritic::sim
