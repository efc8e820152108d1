#include "engine/scene/mesh_levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <unordered_map>

namespace neritic::scene {
namespace {

// Eight triangles are made no coarser: fewer are no longer as long, wide and high as a solid.
constexpr std::size_t kLeastTriangles = 32, kCoarsest = 8;
// A level is kept if it has at most this share of the triangles of the one before.
constexpr double kLeastGain = 0.75;
// A level that errs by more than this share of the mesh's size shows no mesh any more.
constexpr double kLargestError = 0.25;
// The number of a corner's vertices that are tried; the weight of a whole picture's width of
// texture.
constexpr std::size_t kMostChoices = 6;
constexpr double kTexture = 4.0;

struct PlaceKey {
  std::array<std::uint32_t, 3> bits;
  bool operator==(const PlaceKey&) const = default;
};
struct HashOfPlace {
  std::size_t operator()(const PlaceKey& k) const {
    return (k.bits[0] * 73856093u) ^ (k.bits[1] * 19349663u) ^ (k.bits[2] * 83492791u);
  }
};

}  // namespace

bool MeshSimplifier::accepts(const Primitive& p) {
  if (p.topology != Topology::kTriangles || !p.targets.empty()) return false;
  return std::ranges::all_of(p.positions, [](const Vec3f& at) { return is_finite(Vec3(at)); });
}

MeshSimplifier::MeshSimplifier(const Primitive& primitive) : primitive_(primitive) {
  std::unordered_map<PlaceKey, std::uint32_t, HashOfPlace> seen;
  seen.reserve(primitive.positions.size());
  place_of_vertex_.reserve(primitive.positions.size());
  for (const Vec3f& at : primitive.positions) {
    const Vec3f same = at + 0.0f;  // one zero
    PlaceKey key;
    std::memcpy(key.bits.data(), &same, sizeof key.bits);
    const auto [found, is_new] =
        seen.try_emplace(key, static_cast<std::uint32_t>(positions_m_.size()));
    if (is_new) positions_m_.push_back(same);
    place_of_vertex_.push_back(found->second);
  }
  first_.assign(positions_m_.size() + 1, 0);
  for (const std::uint32_t place : place_of_vertex_) ++first_[place + 1];
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  vertices_.resize(place_of_vertex_.size());
  for (std::uint32_t v = 0; v < place_of_vertex_.size(); ++v)
    vertices_[next[place_of_vertex_[v]]++] = v;
  if (!positions_m_.empty())
    size_m_ = static_cast<double>(
        meshopt_simplifyScale(&positions_m_.front().x, positions_m_.size(), sizeof(Vec3f)));
}

std::vector<std::uint32_t> MeshSimplifier::places_of(
    std::span<const std::uint32_t> vertices) const {
  std::vector<std::uint32_t> out;
  out.reserve(vertices.size());
  for (std::size_t i = 0; i + 2 < vertices.size(); i += 3) {
    const std::uint32_t a = place_of_vertex_[vertices[i]], b = place_of_vertex_[vertices[i + 1]],
                        c = place_of_vertex_[vertices[i + 2]];
    if (a != b && b != c && c != a) out.insert(out.end(), {a, b, c});
  }
  return out;
}

MeshSimplifier::Coarse MeshSimplifier::coarser(std::span<const std::uint32_t> places,
                                               std::size_t target_triangles,
                                               bool keep_border) const {
  // The simplifier's time and memory grow with the vertices that it is told of: only those used.
  std::vector<std::uint32_t> used(places.begin(), places.end());
  std::sort(used.begin(), used.end());
  used.erase(std::unique(used.begin(), used.end()), used.end());
  std::vector<Vec3f> positions_m;
  positions_m.reserve(used.size());
  for (const std::uint32_t place : used) positions_m.push_back(positions_m_[place]);
  std::vector<std::uint32_t> own(places.size());
  for (std::size_t i = 0; i < places.size(); ++i)
    own[i] = static_cast<std::uint32_t>(std::lower_bound(used.begin(), used.end(), places[i]) -
                                        used.begin());
  Coarse out;
  if (own.empty()) return out;
  const float* xyz = &positions_m.front().x;
  float error = 0.0f;
  out.places.resize(own.size());
  out.places.resize(meshopt_simplify(
      out.places.data(), own.data(), own.size(), xyz, positions_m.size(), sizeof(Vec3f),
      3 * target_triangles, 1.0f, keep_border ? unsigned{meshopt_SimplifyLockBorder} : 0u, &error));
  for (std::uint32_t& place : out.places) place = used[place];
  out.moved_m = static_cast<double>(error) *
                static_cast<double>(meshopt_simplifyScale(xyz, positions_m.size(), sizeof(Vec3f)));
  return out;
}

double MeshSimplifier::edge_m(std::span<const std::uint32_t> places) const {
  double sum_m2 = 0.0;
  for (std::size_t i = 0; i + 2 < places.size(); i += 3) {
    const Vec3 a(positions_m_[places[i]]), b(positions_m_[places[i + 1]]),
        c(positions_m_[places[i + 2]]);
    sum_m2 += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  const double count = static_cast<double>(std::max<std::size_t>(places.size() / 3, 1));
  return std::sqrt(4.0 / std::sqrt(3.0) * sum_m2 / count);
}

double MeshSimplifier::apart(std::uint32_t a, std::uint32_t b) const {
  if (primitive_.uv0.empty()) return 0.0;
  return static_cast<double>(glm::length(primitive_.uv0[a] - primitive_.uv0[b]));
}

std::array<std::uint32_t, 3> MeshSimplifier::corners_of(const std::uint32_t* places) const {
  std::array<std::span<const std::uint32_t>, 3> from;
  std::array<Vec3, 3> at;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::uint32_t first = first_[places[k]];
    from[k] = std::span(vertices_).subspan(first, first_[places[k] + 1] - first);
    from[k] = from[k].first(std::min(from[k].size(), kMostChoices));
    at[k] = Vec3(positions_m_[places[k]]);
  }
  std::array<std::uint32_t, 3> best{from[0][0], from[1][0], from[2][0]};
  if (from[0].size() == 1 && from[1].size() == 1 && from[2].size() == 1) return best;
  const Vec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
  const double size = glm::length(normal);
  double least = std::numeric_limits<double>::infinity();
  for (const std::uint32_t a : from[0])
    for (const std::uint32_t b : from[1])
      for (const std::uint32_t c : from[2]) {
        double cost = kTexture * (apart(a, b) + apart(b, c) + apart(c, a));
        if (size > 0.0)
          for (const std::uint32_t v : {a, b, c})
            cost -= glm::dot(Vec3(primitive_.normals[v]), normal) / size;
        if (cost < least) {
          least = cost;
          best = {a, b, c};
        }
      }
  return best;
}

std::vector<std::uint32_t> MeshSimplifier::vertices_of(
    std::span<const std::uint32_t> places) const {
  std::vector<std::uint32_t> out;
  out.reserve(places.size());
  for (std::size_t i = 0; i + 2 < places.size(); i += 3)
    for (const std::uint32_t vertex : corners_of(&places[i])) out.push_back(vertex);
  return out;
}

std::vector<MeshLevel> mesh_levels(const Primitive& p) {
  std::vector<MeshLevel> out;
  if (p.indices.size() < 3 * kLeastTriangles || !MeshSimplifier::accepts(p)) return out;
  const MeshSimplifier simplifier(p);
  std::vector<std::uint32_t> now = simplifier.places_of(p.indices);
  double moved_m = 0.0;
  while (now.size() / 3 > kCoarsest) {
    MeshSimplifier::Coarse next = simplifier.coarser(now, now.size() / 6, false);
    if (next.places.empty() ||
        static_cast<double>(next.places.size()) > kLeastGain * static_cast<double>(now.size()))
      break;
    now = std::move(next.places);
    moved_m += next.moved_m;
    const double error_m = std::max(moved_m, simplifier.edge_m(now) / kEdgeShare);
    if (!(error_m <= kLargestError * simplifier.size_m())) break;
    out.push_back({simplifier.vertices_of(now), error_m});
  }
  return out;
}

}  // namespace neritic::scene
