#include "rov/outline.hpp"

#include "engine/core/refusal.hpp"

namespace neritic::rov {
namespace {

constexpr double kFarthest_m = 100.0;

Vec3 point_of(const CaseField& field) {
  const Vec3 p = field.vec3(Vec3(0.0));
  if (!(glm::length(p) <= kFarthest_m)) field.refuse("a point within 100 m of the origin");
  return p;
}

double radius_of(const CaseField& field) {
  return field.required("radius_m").number(1.0, 1e-3, kFarthest_m);
}

OutlineBox read_box(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"kind",    "position_m", "size_m",
                                        "yaw_deg", "pitch_deg",  "roll_deg"};
  field.allow(kKeys);
  OutlineBox box{.position_m = point_of(field["position_m"])};
  box.size_m = field.required("size_m").vec3(Vec3(1.0));
  for (int i = 0; i < 3; ++i)
    if (!(box.size_m[i] >= 1e-3 && box.size_m[i] <= kFarthest_m))
      field["size_m"].refuse("three lengths from 0.001 to 100");
  const auto turn = [&](const char* key, const Vec3& axis) {
    return glm::angleAxis(radians(field[key].number(0.0, -360.0, 360.0)), axis);
  };
  box.rotation =
      turn("yaw_deg", {0, 0, 1}) * turn("pitch_deg", {0, 1, 0}) * turn("roll_deg", {1, 0, 0});
  return box;
}

OutlineSphere read_sphere(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"kind", "position_m", "radius_m"};
  field.allow(kKeys);
  return {point_of(field["position_m"]), radius_of(field)};
}

OutlineCapsule read_capsule(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"kind", "from_m", "to_m", "radius_m"};
  field.allow(kKeys);
  return {point_of(field.required("from_m")), point_of(field.required("to_m")), radius_of(field)};
}

OutlineHull read_hull(const CaseField& field) {
  constexpr std::string_view kKeys[] = {"kind", "points_m"};
  field.allow(kKeys);
  const CaseField points = field.required("points_m");
  OutlineHull hull;
  for (const auto& row : points.rows(0, 3)) hull.points_m.emplace_back(row[0], row[1], row[2]);
  if (hull.points_m.size() < 4) points.refuse("four points or more");
  return hull;
}

}  // namespace

std::vector<OutlinePart> read_outline(const CaseField& list) {
  std::vector<OutlinePart> parts;
  if (list.size() > kMaxOutlineParts) {
    list.fail(found_accepted(fmt::format("{} parts", list.size()),
                             fmt::format("up to {}", kMaxOutlineParts)));
    return parts;
  }
  for (std::size_t i = 0; i < list.size(); ++i) {
    const CaseField part = list.at(i);
    const std::string kind = part.required("kind").text();
    if (kind == "box")
      parts.emplace_back(read_box(part));
    else if (kind == "sphere")
      parts.emplace_back(read_sphere(part));
    else if (kind == "capsule")
      parts.emplace_back(read_capsule(part));
    else if (kind == "hull")
      parts.emplace_back(read_hull(part));
    else
      part["kind"].refuse("box, sphere, capsule or hull");
  }
  return parts;
}

}  // namespace neritic::rov
