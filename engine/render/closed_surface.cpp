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

// Edges by their lower vertex: the higher one and which way the edge is passed.
struct EdgeWay {
  std::uint32_t high = 0;
  int way = 0;
  bool operator<(const EdgeWay& other) const { return high < other.high; }
};

bool edges_cancel(const std::vector<Corners>& triangles, std::size_t vertices) {
  std::vector<std::size_t> first(vertices + 1, 0);
  for (const Corners& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) ++first[std::min(t[k], t[(k + 1) % 3]) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<EdgeWay> edges(first.back());
  std::vector<std::size_t> next(first.begin(), first.end() - 1);
  for (const Corners& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t a = t[k], b = t[(k + 1) % 3];
      edges[next[std::min(a, b)]++] = {std::max(a, b), a < b ? 1 : -1};
    }
  for (std::size_t v = 0; v < vertices; ++v) {
    const auto begin = edges.begin() + static_cast<std::ptrdiff_t>(first[v]);
    const auto end = edges.begin() + static_cast<std::ptrdiff_t>(first[v + 1]);
    std::sort(begin, end);
    int sum = 0;
    for (auto e = begin; e != end; ++e) {
      sum += e->way;
      if ((e + 1 == end || (e + 1)->high != e->high) && sum != 0) return false;
    }
  }
  return true;
}

std::uint32_t root_of(std::vector<std::uint32_t>& parent, std::uint32_t v) {
  while (parent[v] != v) v = parent[v] = parent[parent[v]];
  return v;
}

bool parts_face_outwards(std::span<const Vec3f> positions, const std::vector<Corners>& triangles) {
  std::vector<std::uint32_t> parent(positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
  for (const Corners& t : triangles)
    for (const std::uint32_t v : {t[1], t[2]}) parent[root_of(parent, v)] = root_of(parent, t[0]);
  std::vector<double> volume(positions.size(), 0.0);
  std::vector<bool> is_part(positions.size(), false);
  for (const Corners& t : triangles) {
    const std::uint32_t part = root_of(parent, t[0]);
    const Vec3 from(positions[part]);  // near the part, so that its volume keeps its digits
    is_part[part] = true;
    volume[part] +=
        glm::dot(Vec3(positions[t[0]]) - from,
                 glm::cross(Vec3(positions[t[1]]) - from, Vec3(positions[t[2]]) - from));
  }
  for (std::size_t v = 0; v < volume.size(); ++v)
    if (is_part[v] && !(volume[v] > 0.0)) return false;
  return true;
}

}  // namespace

bool is_closed(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices) {
  for (const Vec3f& p : positions)
    if (!is_finite(Vec3(p))) return false;
  const std::vector<Corners> triangles = triangles_of(welded(positions), indices);
  return !triangles.empty() && edges_cancel(triangles, positions.size()) &&
         parts_face_outwards(positions, triangles);
}

}  // namespace neritic::render
