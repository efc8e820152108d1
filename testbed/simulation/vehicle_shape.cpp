#include "testbed/simulation/vehicle_shape.hpp"

#include <algorithm>
#include <cmath>

#include "engine/scene/animation.hpp"
#include "rov/frames.hpp"
#include "testbed/simulation/static_scene.hpp"

namespace neritic::testbed {
namespace {

// A hull is of the outermost points in so many directions: the most with which its corners, moved
// inwards to be rounded, are few enough.
constexpr int kHullDirections[] = {48, 40, 32, 24, 16};

// Points evenly over a sphere (Fibonacci's spiral; e.g. Gonzalez 2010, Math. Geosci. 42, 49).
Vec3 direction_of(int i, int count) {
  const double up = 1.0 - (2.0 * i + 1.0) / count, flat = std::sqrt(1.0 - up * up);
  const double turn = kPi * (3.0 - std::sqrt(5.0)) * i;
  return {flat * std::cos(turn), up, flat * std::sin(turn)};
}

std::vector<Vec3> outermost(const std::vector<Vec3>& points_m, int count) {
  std::vector<Vec3> out;
  for (int i = 0; i < count; ++i) {
    const Vec3 direction = direction_of(i, count);
    const auto farther = [&](const Vec3& a, const Vec3& b) {
      return glm::dot(a, direction) < glm::dot(b, direction);
    };
    const Vec3 point = *std::ranges::max_element(points_m, farther);
    if (std::ranges::find(out, point) == out.end()) out.push_back(point);
  }
  return out;
}

Status add_hull_of(const std::vector<Vec3>& points_m, sim::BodyShape& body) {
  Status added = bad_input("nothing is drawn of it");
  for (const int count : kHullDirections) {
    if (points_m.empty()) break;
    added = body.add_hull(outermost(points_m, count), "collision");
    if (added.ok()) break;
  }
  return added;
}

Status add_part(const rov::OutlinePart& part, sim::BodyShape& body) {
  const auto point = [](const Vec3& marine) { return rov::world_from_ned(marine); };
  if (const auto* box = std::get_if<rov::OutlineBox>(&part)) {
    body.add_box({point(box->position_m), rov::world_from_ned(box->rotation)},
                 glm::abs(point(0.5 * box->size_m)));
  } else if (const auto* sphere = std::get_if<rov::OutlineSphere>(&part)) {
    body.add_sphere(point(sphere->position_m), sphere->radius_m);
  } else if (const auto* capsule = std::get_if<rov::OutlineCapsule>(&part)) {
    body.add_capsule(point(capsule->from_m), point(capsule->to_m), capsule->radius_m);
  } else {
    std::vector<Vec3> points_m;
    for (const Vec3& p : std::get<rov::OutlineHull>(part).points_m) points_m.push_back(point(p));
    return body.add_hull(points_m, "outline");
  }
  return {};
}

}  // namespace

Result<VehicleShape> vehicle_shape(const scene::Scene& scene, const scene::Object& object,
                                   const std::vector<rov::OutlinePart>& outline) {
  const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  const scene::Bounds bounds = scene::model_bounds(model, scene::evaluate_pose(model, -1, 0.0));
  const Vec3 low = object.scale * bounds.min, high = object.scale * bounds.max;
  const Vec3 half = 0.5 * (high - low);
  if (bounds.empty() || !(half.x > 0.0 && half.y > 0.0 && half.z > 0.0) || !is_finite(half))
    return bad_input("what is drawn of it has no volume; accepted: a solid vehicle");
  VehicleShape shape{.top_m = high.y, .bottom_m = low.y};
  if (object.collision == scene::Collision::kHull) {
    NERITIC_TRY_STATUS(add_hull_of(rest_points(model, object.scale), shape.body));
  } else if (outline.empty()) {
    shape.body.add_box({0.5 * (low + high), Quat(1.0, 0.0, 0.0, 0.0)}, half);
  }
  if (object.collision != scene::Collision::kHull)
    for (const rov::OutlinePart& part : outline) NERITIC_TRY_STATUS(add_part(part, shape.body));
  return shape;
}

}  // namespace neritic::testbed
