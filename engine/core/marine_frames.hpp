// The one place where marine axes meet the program's. Here: world north, east, down and body
// forward, starboard, down (Fossen 2011, section 2.1). Elsewhere: world x east, y up, z south, and
// bodies x starboard, y up, z backwards. Both pairs of axes differ by the same rotation. Pure
// functions; any thread.
#pragma once

#include "engine/core/math.hpp"
#include "engine/core/vector6.hpp"

namespace neritic {

// (north, east, down) as (east, up, south); and (forward, starboard, down) as (starboard, up,
// back).
inline Vec3 world_from_ned(const Vec3& v) {
  return {v.y, -v.z, -v.x};
}
inline Vec3 ned_from_world(const Vec3& v) {
  return {-v.z, v.x, -v.y};
}
// An attitude turns about the same axis, whose components are exchanged like any vector's.
inline Quat world_from_ned(const Quat& ned_from_body) {
  const Vec3 axis = world_from_ned(Vec3(ned_from_body.x, ned_from_body.y, ned_from_body.z));
  return {ned_from_body.w, axis.x, axis.y, axis.z};
}
inline Quat ned_from_world(const Quat& world_from_body) {
  const Vec3 axis = ned_from_world(Vec3(world_from_body.x, world_from_body.y, world_from_body.z));
  return {world_from_body.w, axis.x, axis.y, axis.z};
}
inline Pose world_pose(const Vec3& position_ned_m, const Quat& ned_from_body) {
  return {world_from_ned(position_ned_m), world_from_ned(ned_from_body)};
}

// A matrix over marine body axes, over the program's: contacts and the like are solved there.
inline Mat6 world_from_ned(const Mat6& marine) {
  Mat6 out;
  for (std::size_t block_row = 0; block_row < 6; block_row += 3)
    for (std::size_t block = 0; block < 6; block += 3) {
      Mat3 m;
      for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
          m[j][i] =
              marine(block_row + static_cast<std::size_t>(i), block + static_cast<std::size_t>(j));
      for (int j = 0; j < 3; ++j) {  // columns of C m C^T
        Vec3 unit(0.0);
        unit[j] = 1.0;
        const Vec3 column = world_from_ned(m * ned_from_world(unit));
        for (int i = 0; i < 3; ++i)
          out(block_row + static_cast<std::size_t>(i), block + static_cast<std::size_t>(j)) =
              column[i];
      }
    }
  return out;
}

}  // namespace neritic
