#include "engine/render/least_drawn.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace neritic::render {
namespace {

// Beyond this nothing grows: a sheet seen edge-on has no width to begin with.
constexpr double kMostStretch = 1e3;

// Corners and spheres of an object or a copy from the eye, in the eye's axes.
struct Extent {
  bool draws = false, fits = true;           // only opaque triangles do
  std::vector<std::array<Vec3, 8>> corners;  // a primitive
  std::vector<std::pair<Vec3, double>> spheres;
};

struct Span {
  double low = 1e300, high = -1e300;
  void add(double from, double to) {
    low = std::min(low, from);
    high = std::max(high, to);
  }
};

// Along a unit direction: of each primitive the box or the sphere, whichever is narrower.
Span along(const Extent& extent, const Vec3& direction) {
  Span span;
  for (std::size_t i = 0; i < extent.corners.size(); ++i) {
    Span box;
    for (const Vec3& corner : extent.corners[i]) {
      const double at = glm::dot(corner, direction);
      box.add(at, at);
    }
    const auto& [center, radius] = extent.spheres[i];
    const double at = glm::dot(center, direction);
    span.add(std::max(box.low, at - radius), std::min(box.high, at + radius));
  }
  return span;
}

// By label.
std::vector<Extent> extents(const scene::Scene& scene, const GpuScene& gpu_scene,
                            const FrameState& state, const Vec3& eye_m,
                            const Quat& world_from_eye) {
  std::vector<Extent> out;
  const Quat eye_from_world = glm::conjugate(world_from_eye);
  for (std::size_t g = 0; g < gpu_scene.groups().size(); ++g) {
    const DrawGroup& group = gpu_scene.groups()[g];
    const GpuPrimitive& primitive = group.primitive;
    if (primitive.index_count == 0) continue;
    const GpuMaterial& material = gpu_scene.materials()[primitive.material];
    const bool fits =
        !material.mask && !material.blend && primitive.topology == scene::Topology::kTriangles;
    for (const Appearance& a : group.appearances) {
      if (scene.objects[a.object].copies.size() > kMostDrawnLarger) continue;
      if (out.size() <= a.label) out.resize(a.label + std::size_t{1});
      Extent& extent = out[a.label];
      const DeformJob* job =
          primitive.deforms() ? state.job_of(static_cast<std::uint32_t>(g), a.object, a.node, false)
                              : nullptr;
      if (!fits || (job && job->radius_m < 0.0)) extent.fits = false;
      if (!extent.fits) continue;
      extent.draws = true;
      Mat4 m =
          world_from_appearance(scene, state.world_from_object[a.object], state.poses[a.object], a,
                                primitive.first_skin != kNone && job, state.flock[a.object]);
      m[3] -= Vec4(eye_m, 0.0);
      const Vec3 own_center_m = job ? job->center_m : primitive.center_m;
      const double own_radius_m = job ? job->radius_m : primitive.radius_m;
      const Vec3 half_m = job ? Vec3(own_radius_m) : primitive.half_m;
      std::array<Vec3, 8> corners;
      double radius = 0.0;
      const Vec3 center = eye_from_world * Vec3(m * Vec4(own_center_m, 1.0));
      for (int i = 0; i < 8; ++i) {
        const Vec3 sign(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
        corners[i] = eye_from_world * Vec3(m * Vec4(own_center_m + sign * half_m, 1.0));
      }
      for (int k = 0; k < 3; ++k) radius = std::max(radius, glm::length(Vec3(m[k])));
      // A map that shears may lengthen by more than its columns do.
      const double sheared =
          glm::length(Vec3(m[0])) * glm::length(Vec3(m[1])) * glm::length(Vec3(m[2]));
      const bool turns = std::abs(glm::determinant(glm::dmat3(m))) > 0.999 * sheared;
      extent.corners.push_back(corners);
      extent.spheres.push_back({center, turns ? own_radius_m * radius : 1e300});
    }
  }
  return out;
}

struct Growing {
  DrawnLarger larger;
  DrawnPlace place;
  Vec3 ahead, aside, up;  // unit, in the eye's axes; ahead: to its middle
  double distance_m = 0.0;
};

// Nothing where the object is as large as the least, or not wholly among the samples.
std::optional<Growing> growing(const Extent& extent, const LeastDrawn& least, bool grows_up) {
  Span x = along(extent, {1, 0, 0}), y = along(extent, {0, 1, 0}), z = along(extent, {0, 0, 1});
  const Vec3 middle(0.5 * (x.low + x.high), 0.5 * (y.low + y.high), 0.5 * (z.low + z.high));
  Growing g;
  g.distance_m = glm::length(middle);
  const double level_m = std::hypot(middle.x, middle.z);
  if (!(g.distance_m > 0.0) || !std::isfinite(g.distance_m) || level_m < 1e-3 * g.distance_m)
    return {};
  g.ahead = middle / g.distance_m;
  g.aside = glm::normalize(glm::cross(g.ahead, Vec3(0, 1, 0)));
  g.up = glm::cross(g.aside, g.ahead);
  const Span wide = along(extent, g.aside), high = along(extent, g.up),
             deep = along(extent, g.ahead);
  if (!(deep.low > 0.5 * g.distance_m)) return {};
  DrawnPlace& p = g.place;
  p.own_half_wide_rad = std::max(0.5 * (wide.high - wide.low) / g.distance_m, 1e-9);
  const double own_high_rad = std::max((high.high - high.low) / g.distance_m, 1e-9);
  const double own_wide_rad = 2.0 * p.own_half_wide_rad;
  // Some rows or columns meet a long thing wherever it lies.
  if (own_wide_rad > 2.0 * least.wide_rad || own_high_rad > 2.0 * least.high_rad) return {};
  if (own_wide_rad >= least.wide_rad && own_high_rad >= least.high_rad) return {};
  p.azimuth_rad = std::atan2(middle.x, -middle.z);
  const double elevation_rad = std::asin(std::clamp(g.ahead.y, -1.0, 1.0));
  p.own_low_rad = elevation_rad - 0.5 * own_high_rad;
  p.own_high_rad = elevation_rad + 0.5 * own_high_rad;
  const double room_rad =
      std::min(p.azimuth_rad - least.azimuth_min_rad, least.azimuth_max_rad - p.azimuth_rad);
  if (room_rad < p.own_half_wide_rad || p.own_low_rad < least.elevation_min_rad ||
      p.own_high_rad > least.elevation_max_rad)
    return {};
  p.half_wide_rad = std::max(p.own_half_wide_rad, std::min(0.5 * least.wide_rad, room_rad));
  const double grown_rad = std::max(
      own_high_rad, std::min(least.high_rad, least.elevation_max_rad - least.elevation_min_rad));
  p.low_rad = grows_up ? p.own_low_rad : p.own_high_rad - grown_rad;
  // The upper limit first: rounding can leave it below the lower one.
  p.low_rad =
      std::max(std::min(p.low_rad, least.elevation_max_rad - grown_rad), least.elevation_min_rad);
  p.high_rad = p.low_rad + grown_rad;
  return g;
}

DrawnLarger finished(const Growing& g, const Quat& world_from_eye) {
  const DrawnPlace& p = g.place;
  DrawnLarger out = g.larger;
  const double own_high_rad = p.own_high_rad - p.own_low_rad;
  const double wide = std::min(p.half_wide_rad / p.own_half_wide_rad, kMostStretch);
  const double high = std::min((p.high_rad - p.low_rad) / own_high_rad, kMostStretch);
  const double rises_m =
      0.5 * (p.high_rad + p.low_rad - p.own_high_rad - p.own_low_rad) * g.distance_m;
  const Vec3 ahead = world_from_eye * g.ahead, aside = world_from_eye * g.aside,
             up = world_from_eye * g.up;
  const glm::dmat3 across =
      glm::outerProduct(aside, aside) * (wide - 1.0) + glm::outerProduct(up, up) * (high - 1.0);
  const Vec3 middle = ahead * g.distance_m;
  out.drawn_from_true = Mat4(glm::dmat3(1.0) + across);
  out.drawn_from_true[3] = Vec4(up * rises_m - across * middle, 1.0);
  out.area = wide * high;
  out.azimuth_rad = p.azimuth_rad;
  out.half_wide_rad = p.own_half_wide_rad;
  out.low_rad = p.own_low_rad;
  out.high_rad = p.own_high_rad;
  out.drawn_low_rad = p.low_rad;
  out.drawn_high_rad = p.high_rad;
  return out;
}

}  // namespace

void keep_apart(std::span<DrawnPlace> places) {
  for (std::size_t i = 0; i < places.size(); ++i)
    for (std::size_t k = i + 1; k < places.size(); ++k) {
      DrawnPlace &a = places[i], &b = places[k];
      const double aside_rad = std::abs(a.azimuth_rad - b.azimuth_rad);
      if (aside_rad >= a.half_wide_rad + b.half_wide_rad || a.low_rad >= b.high_rad ||
          b.low_rad >= a.high_rad)
        continue;
      if (a.own_high_rad <= b.own_low_rad || b.own_high_rad <= a.own_low_rad) {
        DrawnPlace &lower = a.own_high_rad <= b.own_low_rad ? a : b, &upper = &lower == &a ? b : a;
        const double between = 0.5 * (lower.own_high_rad + upper.own_low_rad);
        lower.high_rad = std::min(lower.high_rad, std::max(between, lower.own_high_rad));
        upper.low_rad = std::max(upper.low_rad, std::min(between, upper.own_low_rad));
        continue;
      }
      for (DrawnPlace* p : {&a, &b})
        p->half_wide_rad =
            std::max(p->own_half_wide_rad, std::min(p->half_wide_rad, 0.5 * aside_rad));
      if (aside_rad >= a.own_half_wide_rad + b.own_half_wide_rad) continue;
      for (DrawnPlace* p : {&a, &b}) {  // one hides part of the other
        p->half_wide_rad = p->own_half_wide_rad;
        p->low_rad = p->own_low_rad;
        p->high_rad = p->own_high_rad;
      }
    }
}

std::vector<DrawnLarger> drawn_larger(const scene::Scene& scene, const GpuScene& gpu_scene,
                                      const FrameState& state, const Vec3& eye_m,
                                      const LeastDrawn& least) {
  std::vector<Growing> all;
  const bool grows_up = (least.world_from_eye * Vec3(0, 1, 0)).y >= 0.0;
  const auto found = extents(scene, gpu_scene, state, eye_m, least.world_from_eye);
  for (std::size_t i = 0; i < found.size() && all.size() < kMostDrawnLarger; ++i) {
    if (!found[i].draws || !found[i].fits) continue;
    auto g = growing(found[i], least, grows_up);
    if (!g) continue;
    g->larger.label = static_cast<std::uint16_t>(i);
    all.push_back(*g);
  }
  std::vector<DrawnPlace> places;
  for (const Growing& g : all) places.push_back(g.place);
  keep_apart(places);
  std::vector<DrawnLarger> out;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].place = places[i];
    const DrawnLarger larger = finished(all[i], least.world_from_eye);
    if (larger.area > 1.0 + 1e-9) out.push_back(larger);
  }
  return out;
}

}  // namespace neritic::render
