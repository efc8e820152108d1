#include "engine/render/closed_surface.hpp"

#include <algorithm>
#include <array>
#include <numeric>
#include <tuple>
#include <vector>

namespace neritic::render {
namespace {

using Corners = std::array<std::uint32_t, 3>;

// For each vertex the first of those at its place.
std::vector<std::uint32_t> welded(std::span<const Vec3f> positions) {
  std::vector<std::uint32_t> order(positions.size()), place(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    return std::tuple(positions[v].x, positions[v].y, positions[v].z, v);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool same = i > 0 && positions[order[i]] == positions[order[i - 1]];
    place[order[i]] = same ? place[order[i - 1]] : order[i];
  }
  return place;
}

std::vector<Corners> triangles_of(std::span<const std::uint32_t> place,
                                  std::span<const std::uint32_t> indices) {
  std::vector<Corners> triangles;
  triangles.reserve(indices.size() / 3);
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Corners t{place[indices[i]], place[indices[i + 1]], place[indices[i + 2]]};
    if (t[0] != t[1] && t[1] != t[2] && t[2] != t[0]) triangles.push_back(t);
  }
  return triangles;
}

// Leaves out both of each two triangles that are one another's backs: a sheet drawn as two sides.
void drop_sheets(std::vector<Corners>& triangles) {
  struct Side {
    Corners sorted;
    bool turned;  // against the corners' order
    std::uint32_t triangle;
    auto tie() const { return std::tie(sorted, turned, triangle); }
  };
  std::vector<Side> sides;
  sides.reserve(triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Corners& t = triangles[i];
    Side side{t, ((t[0] > t[1]) != (t[1] > t[2])) != (t[2] > t[0]), i};
    std::ranges::sort(side.sorted);
    sides.push_back(side);
  }
  std::ranges::sort(sides, [](const Side& a, const Side& b) { return a.tie() < b.tie(); });
  std::vector<bool> sheet(triangles.size(), false);
  for (std::size_t i = 0; i < sides.size();) {
    std::size_t turned = i;
    while (turned < sides.size() && sides[turned].sorted == sides[i].sorted &&
           !sides[turned].turned)
      ++turned;
    std::size_t end = turned;
    while (end < sides.size() && sides[end].sorted == sides[i].sorted) ++end;
    for (std::size_t k = 0; k < std::min(turned - i, end - turned); ++k)
      sheet[sides[i + k].triangle] = sheet[sides[turned + k].triangle] = true;
    i = end;
  }
  std::size_t kept = 0;
  for (std::size_t i = 0; i < triangles.size(); ++i)
    if (!sheet[i]) triangles[kept++] = triangles[i];
  triangles.resize(kept);
}

// An edge of a triangle, kept with its lower vertex.
struct Edge {
  std::uint32_t high = 0, triangle = 0;
  bool rising = false;  // passed from the lower vertex to the higher
  bool operator<(const Edge& other) const {
    return std::tuple(high, rising) < std::tuple(other.high, other.rising);
  }
};

// The edges of all triangles, by their lower vertex: those of vertex v from first[v] on.
struct Edges {
  std::vector<std::size_t> first;
  std::vector<Edge> all;
};

Edges edges_of(const std::vector<Corners>& triangles, std::size_t vertices) {
  Edges edges{std::vector<std::size_t>(vertices + 1, 0), std::vector<Edge>(3 * triangles.size())};
  for (const Corners& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++edges.first[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(edges.first.begin(), edges.first.end(), edges.first.begin());
  std::vector<std::size_t> next(edges.first.begin(), edges.first.end() - 1);
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = triangles[i][k], b = triangles[i][(k + 1) % 3];
      edges.all[next[std::min(a, b)]++] = {std::max(a, b), i, a < b};
    }
  return edges;
}

// Triangles that hang together by edges have one root.
class Parts {
 public:
  explicit Parts(std::size_t triangles) : parent_(triangles) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }
  std::uint32_t root(std::uint32_t t) {
    while (parent_[t] != t) t = parent_[t] = parent_[parent_[t]];
    return t;
  }
  void join(std::uint32_t a, std::uint32_t b) { parent_[root(a)] = root(b); }

 private:
  std::vector<std::uint32_t> parent_;
};

// kOpen: an edge is passed more often one way than the other. kCrowded: one is passed more than
// once either way.
enum class Skin { kOpen, kCrowded, kWhole };

// Joins the two triangles of each edge.
Skin join_over_edges(Edges& edges, Parts& parts) {
  bool crowded = false;
  for (std::size_t v = 0; v + 1 < edges.first.size(); ++v) {
    const std::size_t end = edges.first[v + 1];
    std::sort(edges.all.begin() + static_cast<std::ptrdiff_t>(edges.first[v]),
              edges.all.begin() + static_cast<std::ptrdiff_t>(end));
    for (std::size_t e = edges.first[v]; e < end;) {
      const std::uint32_t high = edges.all[e].high;
      std::size_t rising = e;
      while (rising < end && edges.all[rising].high == high && !edges.all[rising].rising) ++rising;
      std::size_t next = rising;
      while (next < end && edges.all[next].high == high) ++next;
      if (rising - e != next - rising) return Skin::kOpen;
      crowded |= rising - e > 1;
      parts.join(edges.all[e].triangle, edges.all[rising].triangle);
      e = next;
    }
  }
  return crowded ? Skin::kCrowded : Skin::kWhole;
}

bool face_outwards(std::span<const Vec3f> positions, const std::vector<Corners>& triangles,
                   Parts& parts) {
  std::vector<double> volume(triangles.size(), 0.0);
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const std::uint32_t root = parts.root(i);
    const Vec3 from(positions[triangles[root][0]]);  // on the part: its volume keeps its digits
    const Corners& t = triangles[i];
    volume[root] +=
        glm::dot(Vec3(positions[t[0]]) - from,
                 glm::cross(Vec3(positions[t[1]]) - from, Vec3(positions[t[2]]) - from));
  }
  for (std::uint32_t i = 0; i < triangles.size(); ++i)
    if (parts.root(i) == i && !(volume[i] > 0.0)) return false;
  return true;
}

}  // namespace

bool is_closed(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices) {
  for (const Vec3f& p : positions)
    if (!is_finite(Vec3(p))) return false;
  std::vector<Corners> triangles = triangles_of(welded(positions), indices);
  if (triangles.empty()) return false;
  bool open = false;
  const auto encloses = [&] {
    Edges edges = edges_of(triangles, positions.size());
    Parts parts(triangles.size());
    const Skin skin = join_over_edges(edges, parts);
    open = skin == Skin::kOpen;
    return skin == Skin::kWhole && face_outwards(positions, triangles, parts);
  };
  if (encloses()) return true;
  // Without its sheets an open mesh is no less open.
  if (open) return false;
  drop_sheets(triangles);
  return encloses();
}

}  // namespace neritic::render
