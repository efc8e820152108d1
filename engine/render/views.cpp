#include "engine/render/views.hpp"

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

}  // namespace neritic::render
