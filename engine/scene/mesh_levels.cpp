#include "engine/scene/mesh_levels.hpp"

#include <meshoptimizer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <span>
#include <unordered_map>

namespace neritic::scene {
namespace {

constexpr std::size_t kLeastTriangles = 32, kCoarsest = 6;
// A level is kept if it has at most this share of the triangles of the one before.
constexpr double kLeastGain = 0.75;
// A level that errs by more than this share of the mesh's size shows no mesh any more.
constexpr double kLargestError = 0.25;

// The places of a mesh's vertices, each once: a simplifier that sees the seams of texture and
// normals cannot pass them.
struct Places {
  std::vector<Vec3f> positions_m;
  std::vector<std::uint32_t> of_vertex;
  // The vertices of place p: vertices[first[p]] to vertices[first[p + 1] - 1].
  std::vector<std::uint32_t> first, vertices;
};

Places places_of(const Primitive& p) {
  struct Key {
    std::array<std::uint32_t, 3> bits;
    bool operator==(const Key&) const = default;
  };
  struct HashOf {
    std::size_t operator()(const Key& k) const {
      return (k.bits[0] * 73856093u) ^ (k.bits[1] * 19349663u) ^ (k.bits[2] * 83492791u);
    }
  };
  Places out;
  std::unordered_map<Key, std::uint32_t, HashOf> seen;
  seen.reserve(p.positions.size());
  out.of_vertex.reserve(p.positions.size());
  for (const Vec3f& at : p.positions) {
    const Vec3f same = at + 0.0f;  // one zero
    Key key;
    std::memcpy(key.bits.data(), &same, sizeof key.bits);
    const auto [found, is_new] =
        seen.try_emplace(key, static_cast<std::uint32_t>(out.positions_m.size()));
    if (is_new) out.positions_m.push_back(same);
    out.of_vertex.push_back(found->second);
  }
  out.first.assign(out.positions_m.size() + 1, 0);
  for (const std::uint32_t place : out.of_vertex) ++out.first[place + 1];
  for (std::size_t i = 1; i < out.first.size(); ++i) out.first[i] += out.first[i - 1];
  std::vector<std::uint32_t> next(out.first.begin(), out.first.end() - 1);
  out.vertices.resize(out.of_vertex.size());
  for (std::uint32_t v = 0; v < out.of_vertex.size(); ++v)
    out.vertices[next[out.of_vertex[v]]++] = v;
  return out;
}

double area_m2(std::span<const Vec3f> positions, std::span<const std::uint32_t> indices) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Vec3 a(positions[indices[i]]), b(positions[indices[i + 1]]), c(positions[indices[i + 2]]);
    sum += 0.5 * glm::length(glm::cross(b - a, c - a));
  }
  return sum;
}

// Chooses, for each corner of a triangle of places, the vertex whose normal faces as the triangle
// does and whose texture lies beside that of the other two.
class CornerChoice {
 public:
  CornerChoice(const Primitive& primitive, const Places& places)
      : primitive_(primitive), places_(places) {}

  std::array<std::uint32_t, 3> of(const std::uint32_t* corners) const {
    std::array<std::span<const std::uint32_t>, 3> from;
    std::array<Vec3, 3> at;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t first = places_.first[corners[k]];
      from[k] = std::span(places_.vertices).subspan(first, places_.first[corners[k] + 1] - first);
      from[k] = from[k].first(std::min<std::size_t>(from[k].size(), kMostChoices));
      at[k] = Vec3(places_.positions_m[corners[k]]);
    }
    std::array<std::uint32_t, 3> best{from[0][0], from[1][0], from[2][0]};
    if (from[0].size() == 1 && from[1].size() == 1 && from[2].size() == 1) return best;
    const Vec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
    const double size = glm::length(normal);
    double least = std::numeric_limits<double>::infinity();
    for (const std::uint32_t a : from[0])
      for (const std::uint32_t b : from[1])
        for (const std::uint32_t c : from[2]) {
          double cost = 0.0;
          if (size > 0.0)
            for (const std::uint32_t v : {a, b, c})
              cost -= glm::dot(Vec3(primitive_.normals[v]), normal) / size;
          cost += kTexture * (apart(a, b) + apart(b, c) + apart(c, a));
          if (cost < least) {
            least = cost;
            best = {a, b, c};
          }
        }
    return best;
  }

 private:
  static constexpr std::size_t kMostChoices = 6;
  static constexpr double kTexture = 4.0;  // weight of a whole picture's width

  double apart(std::uint32_t a, std::uint32_t b) const {
    return primitive_.uv0.empty()
               ? 0.0
               : static_cast<double>(glm::length(primitive_.uv0[a] - primitive_.uv0[b]));
  }

  const Primitive& primitive_;
  const Places& places_;
};

bool has_levels(const Primitive& p) {
  if (p.topology != Topology::kTriangles || !p.targets.empty()) return false;
  if (p.indices.size() < 3 * kLeastTriangles) return false;
  return std::ranges::all_of(p.positions, [](const Vec3f& at) { return is_finite(Vec3(at)); });
}

}  // namespace

std::vector<MeshLevel> mesh_levels(const Primitive& p) {
  std::vector<MeshLevel> out;
  if (!has_levels(p)) return out;
  const Places places = places_of(p);
  const CornerChoice choice(p, places);
  const float* positions = &places.positions_m.front().x;
  const std::size_t count = places.positions_m.size();
  const double scale_m =
      static_cast<double>(meshopt_simplifyScale(positions, count, sizeof(Vec3f)));
  std::vector<std::uint32_t> now;
  for (std::size_t i = 0; i < p.indices.size(); i += 3) {
    const std::uint32_t a = places.of_vertex[p.indices[i]], b = places.of_vertex[p.indices[i + 1]],
                        c = places.of_vertex[p.indices[i + 2]];
    if (a != b && b != c && c != a) now.insert(now.end(), {a, b, c});
  }
  double moved_m = 0.0;
  while (now.size() / 3 > kCoarsest) {
    std::vector<std::uint32_t> next(now.size());
    float error = 0.0f;
    next.resize(meshopt_simplify(next.data(), now.data(), now.size(), positions, count,
                                 sizeof(Vec3f), now.size() / 6 * 3, 1.0f, 0, &error));
    if (next.empty() || static_cast<double>(next.size()) > kLeastGain * double(now.size())) break;
    now = std::move(next);
    moved_m += static_cast<double>(error) * scale_m;
    // Of equal-sided triangles of the mean area.
    const double edge_m =
        std::sqrt(4.0 / std::sqrt(3.0) * area_m2(places.positions_m, now) / double(now.size() / 3));
    MeshLevel level;
    level.error_m = std::max(moved_m, edge_m / kEdgeShare);
    if (!(level.error_m <= kLargestError * scale_m)) break;
    level.indices.reserve(now.size());
    for (std::size_t i = 0; i < now.size(); i += 3)
      for (const std::uint32_t vertex : choice.of(&now[i])) level.indices.push_back(vertex);
    out.push_back(std::move(level));
  }
  return out;
}

}  // namespace neritic::scene
