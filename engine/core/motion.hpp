// How a frame moves in another: its pose and its velocities. Plain values, pure functions.
#pragma once

#include "engine/core/math.hpp"

namespace neritic {

struct Motion {
  Pose pose;                         // target_from_source
  Vec3 velocity_m_s{0.0};            // of the source's origin, in the target's axes
  Vec3 angular_velocity_rad_s{0.0};  // in the target's axes

  static void fields(auto&& field, auto& self) {
    field("pose", self.pose);
    field("velocity_m_s", self.velocity_m_s);
    field("angular_velocity_rad_s", self.angular_velocity_rad_s);
  }
};

// Composes motions: c moves in frame b, and b in frame a; the result is c's motion in a.
Motion operator*(const Motion& a_from_b, const Motion& b_from_c);
// Later by ahead_s, at velocities that stay as they are.
Motion predicted(const Motion& from, double ahead_s);
// Positions along the line, attitudes along the shortest turn, velocities in proportion; share: 0
// at a, 1 at b.
Motion between(const Motion& a, const Motion& b, double share);

}  // namespace neritic
