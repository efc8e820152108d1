// See gltf_geometry.hpp.
#include "engine/scene/gltf_geometry.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace neritic::scene::gltf {
namespace {

// Length 1, or zero where there is no direction. In double, so that no float length over- or
// underflows.
Vec3 unit_or_zero(const Vec3& v) {
  const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(largest > 0.0) || !std::isfinite(largest)) return Vec3(0.0);
  const Vec3 scaled = v / largest;
  return scaled / glm::length(scaled);
}

bool is_zero(const Vec3& v) {
  return v == Vec3(0.0);
}

// Any unit vector perpendicular to the unit vector n.
Vec3 perpendicular(const Vec3& n) {
  const Vec3 axis = std::abs(n.x) < 0.6 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  return unit_or_zero(glm::cross(n, axis));
}

Vec3 face_normal(const Vec3f& a, const Vec3f& b, const Vec3f& c) {
  return glm::cross(Vec3(b) - Vec3(a), Vec3(c) - Vec3(a));
}

template <class T>
void gather_list(std::vector<T>& list, std::span<const std::uint32_t> old_of_new) {
  if (list.empty()) return;
  std::vector<T> out(old_of_new.size());
  for (std::size_t i = 0; i < out.size(); ++i) out[i] = list[old_of_new[i]];
  list = std::move(out);
}

// Flat normals of the positions plus one target's displacements, one a vertex; a face without area
// gets `fallback`'s.
std::vector<Vec3f> flat_normals(const std::vector<Vec3f>& positions,
                                const std::vector<Vec3f>* offsets,
                                const std::vector<Vec3f>* fallback) {
  std::vector<Vec3f> out(positions.size());
  for (std::size_t i = 0; i + 2 < positions.size(); i += 3) {
    Vec3f p[3];
    for (int k = 0; k < 3; ++k) p[k] = positions[i + k] + (offsets ? (*offsets)[i + k] : Vec3f(0));
    Vec3f normal(unit_or_zero(face_normal(p[0], p[1], p[2])));
    if (normal == Vec3f(0)) normal = fallback ? (*fallback)[i] : Vec3f(0, 1, 0);
    out[i] = out[i + 1] = out[i + 2] = normal;
  }
  return out;
}

struct UvFrame {
  Vec3 tangent{0.0};  // unit, along u; zero where the coordinates span no area
  bool mirrored = false;
};

UvFrame uv_frame(const Primitive& p, const std::vector<Vec2f>& uv, const TextureRef& ref,
                 const std::uint32_t* triangle) {
  const auto transformed = [&](std::uint32_t v) {
    const Vec3 in(uv[v].x, uv[v].y, 1.0);
    return Vec2(glm::dot(Vec3(ref.transform_u), in), glm::dot(Vec3(ref.transform_v), in));
  };
  const Vec2 uv0 = transformed(triangle[0]);
  const Vec2 d1 = transformed(triangle[1]) - uv0, d2 = transformed(triangle[2]) - uv0;
  const Vec3 p0(p.positions[triangle[0]]);
  const Vec3 e1 = Vec3(p.positions[triangle[1]]) - p0, e2 = Vec3(p.positions[triangle[2]]) - p0;
  const double area = d1.x * d2.y - d2.x * d1.y;
  UvFrame frame;
  if (area == 0.0 || !std::isfinite(area)) return frame;
  const double sign = area < 0.0 ? -1.0 : 1.0;  // 1/area only scales; its sign matters
  frame.tangent = unit_or_zero((e1 * d2.y - e2 * d1.y) * sign);
  // v points down in a picture: seen from the front (counter-clockwise corners), a picture that
  // reads right has negative area.
  frame.mirrored = area > 0.0;
  return frame;
}

// The angle of the triangle at its corner k: the weight of a face at a vertex, which does not
// depend on how the surface is cut into triangles.
double corner_angle(const Primitive& p, const std::uint32_t* triangle, int k) {
  const Vec3 at(p.positions[triangle[k]]);
  const Vec3 a = unit_or_zero(Vec3(p.positions[triangle[(k + 1) % 3]]) - at);
  const Vec3 b = unit_or_zero(Vec3(p.positions[triangle[(k + 2) % 3]]) - at);
  return std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0));
}

// Gives vertices that mirrored and unmirrored faces share a copy for the mirrored ones.
void split_mirrored(Primitive& p, const std::vector<UvFrame>& frames) {
  enum : std::uint8_t { kPlain = 1, kMirrored = 2 };
  std::vector<std::uint8_t> seen(p.positions.size(), 0);
  for (std::size_t t = 0; t < frames.size(); ++t)
    for (int k = 0; k < 3; ++k)
      if (!is_zero(frames[t].tangent))
        seen[p.indices[3 * t + k]] |= frames[t].mirrored ? kMirrored : kPlain;
  if (std::find(seen.begin(), seen.end(), kPlain | kMirrored) == seen.end()) return;

  std::vector<std::uint32_t> old_of_new(p.positions.size());
  std::iota(old_of_new.begin(), old_of_new.end(), 0u);
  std::vector<std::uint32_t> copy_of(p.positions.size(), 0);
  for (std::uint32_t v = 0; v < seen.size(); ++v) {
    if (seen[v] != (kPlain | kMirrored)) continue;
    copy_of[v] = static_cast<std::uint32_t>(old_of_new.size());
    old_of_new.push_back(v);
  }
  for (std::size_t t = 0; t < frames.size(); ++t)
    for (int k = 0; k < 3; ++k) {
      std::uint32_t& v = p.indices[3 * t + k];
      if (frames[t].mirrored && copy_of[v] != 0) v = copy_of[v];
    }
  gather_vertices(p, old_of_new);
}

}  // namespace

Topology topology_of(Mode mode) {
  if (mode == Mode::kPoints) return Topology::kPoints;
  return mode < Mode::kTriangles ? Topology::kLines : Topology::kTriangles;
}

// The order of corners is the specification's (glTF 2.0 section 3.7.2.1), which keeps the winding.
std::vector<std::uint32_t> to_list(Mode mode, std::vector<std::uint32_t> in) {
  const std::size_t n = in.size();
  std::vector<std::uint32_t> out;
  switch (mode) {
    case Mode::kPoints:
      return in;
    case Mode::kLines:
      in.resize(n / 2 * 2);
      return in;
    case Mode::kTriangles:
      in.resize(n / 3 * 3);
      return in;
    case Mode::kLineStrip:
    case Mode::kLineLoop:
      for (std::size_t i = 0; i + 1 < n; ++i) out.insert(out.end(), {in[i], in[i + 1]});
      if (mode == Mode::kLineLoop && n > 1) out.insert(out.end(), {in[n - 1], in[0]});
      return out;
    case Mode::kTriangleStrip:
      for (std::size_t i = 0; i + 2 < n; ++i)
        out.insert(out.end(), {in[i], in[i + 1 + i % 2], in[i + 2 - i % 2]});
      return out;
    case Mode::kTriangleFan:
      for (std::size_t i = 0; i + 2 < n; ++i) out.insert(out.end(), {in[i + 1], in[i + 2], in[0]});
      return out;
  }
  return out;
}

void gather_vertices(Primitive& p, std::span<const std::uint32_t> old_of_new) {
  gather_list(p.positions, old_of_new);
  gather_list(p.normals, old_of_new);
  gather_list(p.tangents, old_of_new);
  gather_list(p.uv0, old_of_new);
  gather_list(p.uv1, old_of_new);
  gather_list(p.colors, old_of_new);
  gather_list(p.joints, old_of_new);
  gather_list(p.weights, old_of_new);
  for (MorphTarget& target : p.targets) {
    gather_list(target.positions, old_of_new);
    gather_list(target.normals, old_of_new);
  }
}

void make_flat_normals(Primitive& p) {
  const std::vector<std::uint32_t> corners = std::move(p.indices);
  gather_vertices(p, corners);
  p.indices.resize(corners.size());
  std::iota(p.indices.begin(), p.indices.end(), 0u);
  p.normals = flat_normals(p.positions, nullptr, nullptr);
  for (MorphTarget& target : p.targets) {
    if (target.positions.empty()) continue;
    target.normals = flat_normals(p.positions, &target.positions, &p.normals);
    for (std::size_t i = 0; i < target.normals.size(); ++i) target.normals[i] -= p.normals[i];
  }
}

std::size_t repair_normals(Primitive& p) {
  bool any_zero = false;
  std::size_t n_off = 0;
  for (Vec3f& normal : p.normals) {
    n_off += !(std::abs(glm::dot(Vec3(normal), Vec3(normal)) - 1.0) < 0.02);
    normal = Vec3f(unit_or_zero(Vec3(normal)));
    any_zero = any_zero || normal == Vec3f(0);
  }
  if (!any_zero) return n_off;
  std::vector<Vec3> from_faces(p.normals.size(), Vec3(0.0));
  for (std::size_t i = 0; p.topology == Topology::kTriangles && i < p.indices.size(); i += 3) {
    const std::uint32_t* v = &p.indices[i];
    const Vec3 n =
        unit_or_zero(face_normal(p.positions[v[0]], p.positions[v[1]], p.positions[v[2]]));
    for (int k = 0; k < 3; ++k) from_faces[v[k]] += n * corner_angle(p, v, k);
  }
  for (std::size_t i = 0; i < p.normals.size(); ++i) {
    if (p.normals[i] != Vec3f(0)) continue;
    const Vec3 n = unit_or_zero(from_faces[i]);
    p.normals[i] = is_zero(n) ? Vec3f(0, 1, 0) : Vec3f(n);
  }
  return n_off;
}

void repair_tangents(Primitive& p) {
  for (std::size_t i = 0; i < p.tangents.size(); ++i) {
    const Vec3 n(p.normals[i]);
    Vec3 t = unit_or_zero(Vec3(p.tangents[i]));
    if (is_zero(t)) t = perpendicular(is_zero(n) ? Vec3(0, 1, 0) : n);
    p.tangents[i] = Vec4f(Vec3f(t), p.tangents[i].w < 0.0f ? -1.0f : 1.0f);
  }
}

void make_tangents(Primitive& p, const TextureRef& ref) {
  if ((ref.uv_set == 0 ? p.uv0 : p.uv1).empty()) return;
  std::vector<UvFrame> frames(p.indices.size() / 3);
  for (std::size_t t = 0; t < frames.size(); ++t)
    frames[t] = uv_frame(p, ref.uv_set == 0 ? p.uv0 : p.uv1, ref, &p.indices[3 * t]);
  split_mirrored(p, frames);

  std::vector<Vec3> sums(p.positions.size(), Vec3(0.0));
  std::vector<std::uint8_t> mirrored(p.positions.size(), 0);
  for (std::size_t t = 0; t < frames.size(); ++t) {
    const std::uint32_t* v = &p.indices[3 * t];
    if (is_zero(frames[t].tangent)) continue;
    for (int k = 0; k < 3; ++k) {
      sums[v[k]] += frames[t].tangent * corner_angle(p, v, k);
      mirrored[v[k]] = frames[t].mirrored;
    }
  }
  p.tangents.resize(p.positions.size());
  for (std::size_t i = 0; i < p.tangents.size(); ++i) {
    const Vec3 n(p.normals[i]);
    Vec3 t = unit_or_zero(sums[i] - n * glm::dot(n, sums[i]));
    if (is_zero(t)) t = perpendicular(n);
    // glTF: bitangent = cross(normal, tangent) * w, and it points up in the picture.
    p.tangents[i] = Vec4f(Vec3f(t), mirrored[i] ? -1.0f : 1.0f);
  }
}

}  // namespace neritic::scene::gltf
