// Where a diver looks: angles, and the pixel of any camera that shows it. World frame or any other,
// so long as directions and cameras share it. Pure functions; any thread.
#pragma once

#include <optional>

#include "engine/core/math.hpp"

namespace neritic::diver {

// Radians, 0 to pi, of directions of any length; by atan2 of the cross and the dot product: acos
// would lose half the digits near 0, and be no number at all for a dot product a rounding above 1.
double angle_between(const Vec3& a, const Vec3& b);

// Screen angles as eye trackers write them (x to the right, y up), as a direction in a view's axes.
// No number where an angle is 90 degrees or more either way: no screen is there.
Vec3 direction_of_angles(double x_rad, double y_rad);

// A camera without distortion. Pixel centres at +0.5, row 0 on top.
struct GazeCamera {
  Pose world_from_view;
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;  // pixels
};
// The pixel under the gaze that leaves eye_m along the direction and rests on what is distance_m
// away (not finite: far away). Nothing where that lies behind the camera; it may lie beside the
// picture.
std::optional<Vec2> gaze_pixel(const Vec3& eye_m, const Vec3& direction, double distance_m,
                               const GazeCamera& camera);

}  // namespace neritic::diver
