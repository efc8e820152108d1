// Closed-form scenes for the sonar tests: depth and normal images of spheres and planes by exact
// ray intersection, in a pinhole's view axes (x right, y up, z backwards). Nothing here uses
// sonar/'s own projection but its plain structs.
#pragma once

#include <cmath>
#include <functional>
#include <limits>
#include <optional>
#include <vector>

#include "engine/core/intrinsics.hpp"
#include "sonar/reference.hpp"

namespace neritic::test {

struct Hit {
  double t;  // multiple of the ray's direction
  Vec3 normal;
  std::uint16_t label = 1;
};
using Shape = std::function<std::optional<Hit>(const Vec3& direction)>;

inline Shape sphere(const Vec3& centre, double radius, std::uint16_t label = 1) {
  return [=](const Vec3& d) -> std::optional<Hit> {
    const double a = glm::dot(d, d), b = glm::dot(d, centre),
                 c = glm::dot(centre, centre) - radius * radius;
    const double discriminant = b * b - a * c;
    if (discriminant < 0.0) return std::nullopt;
    const double root = std::sqrt(discriminant);
    double t = (b - root) / a;
    double side = 1.0;
    if (t <= 0.0) {  // from inside: the wall faces the centre
      t = (b + root) / a;
      side = -1.0;
    }
    if (t <= 0.0) return std::nullopt;
    return Hit{t, side * (d * t - centre) / radius, label};
  };
}

// The plane n . p = distance, seen from the side the origin lies on.
inline Shape plane(const Vec3& normal, double distance, std::uint16_t label = 2) {
  return [=](const Vec3& d) -> std::optional<Hit> {
    const double along = glm::dot(normal, d);
    const double t = distance / along;
    if (!(t > 0.0) || !std::isfinite(t)) return std::nullopt;
    return Hit{t, along > 0.0 ? -normal : normal, label};
  };
}

inline Shape nearest_of(std::vector<Shape> shapes) {
  return [shapes](const Vec3& d) -> std::optional<Hit> {
    std::optional<Hit> best;
    for (const Shape& shape : shapes)
      if (const auto hit = shape(d); hit && (!best || hit->t < best->t)) best = hit;
    return best;
  };
}

inline Shape seabed_with_two_spheres() {
  return nearest_of({sphere(Vec3(.4, .1, -3), .35, 4), sphere(Vec3(-1, -.2, -3.5), .2, 5),
                     plane(Vec3(0, -1, 0), .6, 1)});
}

// The images that a perfect rasterizer gives for a pinhole whose axis has azimuth yaw_rad.
inline sonar::SonarInput images_of(const Shape& shape, std::uint32_t width, std::uint32_t height,
                                   const Intrinsics& k, double yaw_rad = 0.0) {
  sonar::SonarInput in;
  in.width = width;
  in.height = height;
  in.intrinsics = k;
  in.yaw_rad = yaw_rad;
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  const Vec3 ex(c, 0, s), ey(0, 1, 0), ez(-s, 0, c);
  for (std::uint32_t v = 0; v < height; ++v)
    for (std::uint32_t u = 0; u < width; ++u) {
      const Vec3 local((u + 0.5 - k.cx) / k.fx, -(v + 0.5 - k.cy) / k.fy, -1.0);
      const auto hit = shape(local.x * ex + local.y * ey + local.z * ez);
      in.depth.push_back(hit ? hit->t : std::numeric_limits<double>::infinity());
      const Vec3 n = hit ? hit->normal : Vec3(0.0);
      in.normals.insert(in.normals.end(), {glm::dot(n, ex), glm::dot(n, ey), glm::dot(n, ez)});
      in.labels.push_back(hit ? hit->label : std::uint16_t{0});
    }
  return in;
}

// One image a sector of the grid, at pixels_per_cell.
inline std::vector<sonar::SonarInput> sector_images(const sonar::BeamGrid& grid, const Shape& shape,
                                                    double pixels_per_cell) {
  std::vector<sonar::SonarInput> out;
  for (const sonar::Sector& sector : sonar::plan_sectors(grid)) {
    const auto size = sonar::gbuffer_size(grid, sector, pixels_per_cell);
    out.push_back(images_of(shape, size.width, size.height,
                            intrinsics_of(sector.tangents, size.width, size.height),
                            sector.yaw_rad));
  }
  return out;
}

}  // namespace neritic::test
