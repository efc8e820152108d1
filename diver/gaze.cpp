#include "diver/gaze.hpp"

#include <cmath>
#include <limits>

namespace neritic::diver {

double angle_between(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

Vec3 direction_of_angles(double x_rad, double y_rad) {
  constexpr double kMost_rad = radians(90.0);
  if (!(std::abs(x_rad) < kMost_rad && std::abs(y_rad) < kMost_rad))
    return Vec3(std::numeric_limits<double>::quiet_NaN());
  return glm::normalize(Vec3(std::tan(x_rad), std::tan(y_rad), -1.0));
}

std::optional<Vec2> gaze_pixel(const Vec3& eye_m, const Vec3& direction, double distance_m,
                               const GazeCamera& camera) {
  const Vec3 unit = glm::normalize(direction);
  const Pose view_from_world = inverse(camera.world_from_view);
  const Vec3 seen = std::isfinite(distance_m) ? view_from_world * (eye_m + distance_m * unit)
                                              : view_from_world.rotation * unit;
  if (!(seen.z < 0.0)) return std::nullopt;
  const Vec2 pixel(camera.cx - camera.fx * seen.x / seen.z,
                   camera.cy + camera.fy * seen.y / seen.z);
  if (!std::isfinite(pixel.x) || !std::isfinite(pixel.y)) return std::nullopt;
  return pixel;
}

}  // namespace neritic::diver
