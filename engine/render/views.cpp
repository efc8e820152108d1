#include "engine/render/views.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

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

bool SphereCulling::may_see_box(const Vec3& center_m, double radius_m,
                                const std::array<Vec3, 3>& halves_m, double margin_m) const {
  const auto outside = [&](const Plane& plane) {
    const double inside_m = glm::dot(plane.normal, center_m) + plane.offset_m;
    if (inside_m < -radius_m) return true;
    if (inside_m >= 0.0) return false;  // of most things: their boxes need not be looked at
    double reach_m = margin_m;
    for (const Vec3& half : halves_m) reach_m += std::abs(glm::dot(plane.normal, half));
    return inside_m < -reach_m;
  };
  if (within_ && outside(*within_)) return false;
  return std::ranges::any_of(
      views_, [&](const auto& planes) { return std::ranges::none_of(planes, outside); });
}

bool SphereCulling::may_see_between(const Vec3& from_m, const Vec3& to_m, double radius_m) const {
  const auto outside = [&](const Plane& plane) {
    return std::max(glm::dot(plane.normal, from_m), glm::dot(plane.normal, to_m)) + plane.offset_m <
           -radius_m;
  };
  if (within_ && outside(*within_)) return false;
  return std::ranges::any_of(
      views_, [&](const auto& planes) { return std::ranges::none_of(planes, outside); });
}

bool SphereCulling::may_see(const Vec3& center_m, double radius_m, Part& part) const {
  part.planes_.clear();
  part.ends_.clear();
  // False where the ball is outside; else adds the plane where it cuts the ball.
  const auto add = [&](const Plane& plane) {
    const double inside_m = glm::dot(plane.normal, center_m) + plane.offset_m;
    if (inside_m < -radius_m) return false;
    if (inside_m < radius_m) part.planes_.push_back(plane);
    return true;
  };
  if (within_ && !add(*within_)) return false;
  part.ends_.push_back(part.planes_.size());
  for (const auto& planes : views_) {
    const std::size_t first = part.planes_.size();
    if (!std::ranges::all_of(planes, add))
      part.planes_.resize(first);
    else
      part.ends_.push_back(part.planes_.size());
  }
  return part.ends_.size() > 1;
}

bool SphereCulling::Part::may_see(const Vec3& center_m, double radius_m) const {
  const auto inside = [&](const Plane& plane) {
    return glm::dot(plane.normal, center_m) + plane.offset_m >= -radius_m;
  };
  std::size_t plane = 0;
  for (; plane < ends_.front(); ++plane)
    if (!inside(planes_[plane])) return false;
  for (std::size_t view = 1; view < ends_.size(); ++view) {
    while (plane < ends_[view] && inside(planes_[plane])) ++plane;
    if (plane == ends_[view]) return true;
    plane = ends_[view];
  }
  return false;
}

bool SphereCulling::narrow(const Vec3& at_m, double radius_m, double& low_m, double& high_m) const {
  constexpr double kRounding_m = 1e-6;
  const auto cut = [&](const Plane& plane, double& low, double& high) {
    const Vec3& n = plane.normal;
    const double here_m = n.y * at_m.y + n.z * at_m.z + plane.offset_m + radius_m + kRounding_m;
    // n.x x + here_m >= 0
    if (std::abs(n.x) < 1e-9)
      high = here_m < 0.0 ? -std::numeric_limits<double>::infinity() : high;
    else if (n.x > 0.0)
      low = std::max(low, -here_m / n.x);
    else
      high = std::min(high, -here_m / n.x);
  };
  if (within_) cut(*within_, low_m, high_m);
  double first_m = high_m, last_m = low_m;
  for (const auto& planes : views_) {
    double low = low_m, high = high_m;
    for (const Plane& plane : planes) cut(plane, low, high);
    if (!(low <= high)) continue;
    first_m = std::min(first_m, low);
    last_m = std::max(last_m, high);
  }
  low_m = first_m, high_m = last_m;
  return low_m <= high_m;
}

}  // namespace neritic::render
