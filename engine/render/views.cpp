#include "engine/render/views.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::render {
namespace {

Mat4 clip_from_origin(const Pose& world_from_view, const ViewDesc& view, const Vec3& origin_m) {
  Pose origin_from_view = world_from_view;
  origin_from_view.position_m -= origin_m;
  Mat4 upright_from_view(1.0);
  upright_from_view[1][0] = -view.lean;
  return reversed_z_projection(view.tangents, view.near_m) * upright_from_view *
         to_matrix(inverse(origin_from_view));
}

}  // namespace

std::array<shared::View, shared::kMaxViews> gpu_views(const ViewSet& set) {
  NERITIC_CHECK(set.views.size() <= shared::kMaxViews, "{} views in a set", set.views.size());
  std::array<shared::View, shared::kMaxViews> out{};
  std::size_t filled = 0;
  const Vec3 origin = set.origin_m();
  for (const ViewDesc& view : set.views) {
    shared::View v{};
    v.clip_from_origin = Mat4f(clip_from_origin(view.world_from_view, view, origin));
    v.next_clip_from_origin = Mat4f(clip_from_origin(view.next_world_from_view, view, origin));
    v.eye = Vec3f(view.world_from_view.position_m - origin);
    v.near_m = static_cast<float>(view.near_m);
    const FrustumTangents& t = view.tangents;
    const Quat& q = view.world_from_view.rotation;
    v.ray_corner = Vec3f(q * Vec3(t.left + view.lean * t.top, t.top, -1.0));
    v.ray_dx = Vec3f(q * Vec3((t.right - t.left) / set.width, 0.0, 0.0));
    const double dy = -(t.top - t.bottom) / set.height;
    v.ray_dy = Vec3f(q * Vec3(view.lean * dy, dy, 0.0));
    if (set.within) {
      const Vec3& n = set.within->normal;
      v.within = Vec4f(Vec3f(n), static_cast<float>(glm::dot(n, origin) + set.within->offset_m));
    }
    out[filled++] = v;
  }
  return out;
}

double largest_stretch(const Mat4& m) {
  const Vec3 a(m[0]), b(m[1]), c(m[2]);
  const double ab = std::abs(glm::dot(a, b)), bc = std::abs(glm::dot(b, c)),
               ca = std::abs(glm::dot(c, a));
  // Rounding of a turn's columns leaves their products near nought.
  return std::sqrt(
      std::max({glm::dot(a, a) + ab + ca, glm::dot(b, b) + ab + bc, glm::dot(c, c) + bc + ca}));
}

bool any_view_sees(const ViewSet& set, const Vec3& center_from_origin_m, double radius_m) {
  if (!(radius_m < 1e9)) return true;
  const Vec3 origin = set.origin_m();
  if (set.within &&
      glm::dot(set.within->normal, center_from_origin_m + origin) + set.within->offset_m <
          -radius_m)
    return false;
  for (const ViewDesc& view : set.views) {
    Pose origin_from_view = view.world_from_view;
    origin_from_view.position_m -= origin;
    const Vec3 p = inverse(origin_from_view) * center_from_origin_m;
    const FrustumTangents& t = view.tangents;
    // Signed distances to the side planes through the eye and to the near plane.
    const auto outside = [&](double a, double b, double tangent, double lean) {
      return (a + b * tangent) / std::sqrt(1.0 + tangent * tangent + lean * lean) > radius_m;
    };
    if (p.z - radius_m > -view.near_m) continue;
    const double x = p.x - view.lean * p.y;
    if (outside(x, p.z, t.right, view.lean) || outside(-x, p.z, -t.left, view.lean)) continue;
    if (outside(p.y, p.z, t.top, 0.0) || outside(-p.y, p.z, -t.bottom, 0.0)) continue;
    return true;
  }
  return false;
}

SphereCulling::SphereCulling(const ViewSet& set) : origin_m_(set.origin_m()) {
  for (const ViewDesc& view : set.views) {
    const FrustumTangents& t = view.tangents;
    const Vec3 inward[5] = {{-1.0, view.lean, -t.right},
                            {1.0, -view.lean, t.left},
                            {0.0, -1.0, -t.top},
                            {0.0, 1.0, t.bottom},
                            {0.0, 0.0, -1.0}};
    const Vec3 eye_m = view.world_from_view.position_m - origin_m_;
    auto& planes = views_.emplace_back();
    for (std::size_t i = 0; i < 5; ++i) {
      planes[i].normal = view.world_from_view.rotation * glm::normalize(inward[i]);
      planes[i].offset_m = -glm::dot(planes[i].normal, eye_m);
    }
    planes[4].offset_m -= view.near_m;
  }
  if (set.within)
    within_ =
        Plane{set.within->normal, glm::dot(set.within->normal, origin_m_) + set.within->offset_m};
}

bool SphereCulling::may_see(const Vec3& center_m, double radius_m) const {
  const auto outside = [&](const Plane& plane) {
    return glm::dot(plane.normal, center_m) + plane.offset_m < -radius_m;
  };
  if (within_ && outside(*within_)) return false;
  for (const auto& planes : views_)
    if (std::ranges::none_of(planes, outside)) return true;
  return false;
}

bool SphereCulling::sees_all_of(const Vec3& center_m, double radius_m) const {
  const auto inside = [&](const Plane& plane) {
    return glm::dot(plane.normal, center_m) + plane.offset_m >= radius_m;
  };
  if (within_ && !inside(*within_)) return false;
  return std::ranges::any_of(
      views_, [&](const auto& planes) { return std::ranges::all_of(planes, inside); });
}

}  // namespace neritic::render
