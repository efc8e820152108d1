#include "testbed/samples/pose_track.hpp"

#include <algorithm>
#include <cmath>

#include "testbed/samples/capture_times.hpp"

namespace neritic::testbed {

Vec3 turning_rad_s(const Quat& from, const Quat& to, double interval_s) {
  Quat turn = to * glm::conjugate(from);
  if (turn.w < 0.0) turn = -turn;
  const Vec3 axis(turn.x, turn.y, turn.z);
  const double sine = glm::length(axis);
  if (!(sine > 0.0)) return Vec3(0.0);
  return axis * (2.0 * std::atan2(sine, turn.w) / (sine * interval_s));
}

void PoseTrack::take(const ObjectPose& pose, const SampleHeader& header, double hold_s) {
  const Pose at{pose.world_from_object.position_m, glm::normalize(pose.world_from_object.rotation)};
  const double since_s = seconds_between(base_captured_ns, header.captured_ns);
  const bool follows = taken > 0 && since_s >= 0.0 && since_s <= hold_s;
  newest.pose = at;
  age_s = age_on_arrival_s(header);
  ++taken;
  if (follows && since_s < kLeastInterval_s && pose.measured == 0) return;
  newest.velocity_m_s = newest.angular_velocity_rad_s = Vec3(0.0);
  if (pose.measured != 0) {
    newest.velocity_m_s = pose.velocity_m_s;
    newest.angular_velocity_rad_s = pose.angular_velocity_rad_s;
  } else if (follows) {
    const Vec3 velocity_m_s = (at.position_m - base.position_m) / since_s;
    const Vec3 turn_rad_s = turning_rad_s(base.rotation, at.rotation, since_s);
    if (glm::length(velocity_m_s) <= kMostSpeed_m_s && glm::length(turn_rad_s) <= kMostRate_rad_s) {
      newest.velocity_m_s = velocity_m_s;
      newest.angular_velocity_rad_s = turn_rad_s;
    }
  }
  interval_s = follows ? since_s : 0.0;
  base = at;
  base_captured_ns = header.captured_ns;
}

Motion PoseTrack::at(double since_arrival_s) const {
  const double most_s = std::max(kLeastAhead_s, interval_s);
  Motion out = predicted(newest, age_s + std::min(since_arrival_s, most_s));
  if (since_arrival_s > most_s) out.velocity_m_s = out.angular_velocity_rad_s = Vec3(0.0);
  return out;
}

}  // namespace neritic::testbed
