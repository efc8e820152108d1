#include "diver/kinematics.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// The part of a joint's rotation in the body's middle plane.
Quat in_plane(const Quat& q) {
  const double length = std::hypot(q.w, q.y);
  return length > 0.0 ? Quat(q.w / length, 0.0, q.y / length, 0.0) : Quat(1.0, 0.0, 0.0, 0.0);
}

}  // namespace

Quat about(int axis, double angle_rad) {
  Vec3 v(0.0);
  v[axis] = std::sin(0.5 * angle_rad);
  return {std::cos(0.5 * angle_rad), v.x, v.y, v.z};
}

Posture posture_of(const Body& body, const JointRotations& joints, const JointRates& rates) {
  Posture out;
  const bool planar = body.model == Model::kPlanar;
  for (std::size_t i = 1; i < kSegments; ++i) {
    const SegmentPose& parent = out[kParent[i]];
    SegmentPose& pose = out[i];
    const std::size_t joint = joint_of(static_cast<Segment>(i));
    const Vec3 arm = parent.body_from_segment * body.segments[i].joint_m;
    pose.origin_m = parent.origin_m + arm;
    pose.velocity_m_s = parent.velocity_m_s + glm::cross(parent.angular_rad_s, arm);
    pose.body_from_segment = parent.body_from_segment;
    pose.angular_rad_s = parent.angular_rad_s;
    if (!body.moves[i]) continue;
    const Quat turn = planar ? in_plane(joints[joint]) : joints[joint];
    const Vec3 rate = planar ? Vec3(0.0, rates[joint].y, 0.0) : rates[joint];
    pose.body_from_segment = parent.body_from_segment * glm::mat3_cast(turn);
    pose.angular_rad_s += pose.body_from_segment * rate;
  }
  return out;
}

JointRotations rotations_of(const JointAngles& angles) {
  JointRotations out;
  for (std::size_t i = 0; i < kJoints; ++i)
    out[i] = about(1, angles[i].y) * about(2, angles[i].z) * about(0, angles[i].x);
  return out;
}

JointAngles angles_of(const JointRotations& rotations) {
  JointAngles out;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Mat3 r = glm::mat3_cast(rotations[i]);  // R_y R_z R_x, columns first
    const double abduction = std::asin(std::clamp(r[0][1], -1.0, 1.0));
    const bool square = std::abs(r[0][1]) > 1.0 - 1e-12;
    out[i].z = abduction;
    out[i].y = square ? std::atan2(r[2][0], r[2][2]) : std::atan2(-r[0][2], r[0][0]);
    out[i].x = square ? 0.0 : std::atan2(-r[2][1], r[1][1]);
  }
  return out;
}

JointRotations rotations_of(const std::array<Quat, kSegments>& common_from_segment) {
  JointRotations out;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Segment child = child_of(i);
    out[i] = glm::conjugate(common_from_segment[kParent[child]]) * common_from_segment[child];
  }
  return out;
}

JointRotations mirrored(const JointRotations& rotations) {
  JointRotations out;
  for (std::size_t i = 0; i < kJoints; ++i) {
    const Quat& q = rotations[joint_of(kMirror[child_of(i)])];
    out[i] = {q.w, -q.x, q.y, -q.z};
  }
  return out;
}

MassProperties mass_properties(const Body& body, const Posture& posture) {
  SpatialMass sum;
  for (std::size_t i = 0; i < kSegments; ++i)
    sum +=
        shifted(rotated(body.segments[i].rigid, posture[i].body_from_segment), posture[i].origin_m);
  MassProperties out;
  out.mass_kg = sum.a[0][0];
  // B = -m S(centre).
  out.centre_m = Vec3(-sum.b[1][2], -sum.b[2][0], -sum.b[0][1]) / out.mass_kg;
  const Mat3 s = cross_matrix(out.centre_m);
  out.inertia_kg_m2 = sum.c + out.mass_kg * s * s;
  return out;
}

}  // namespace neritic::diver
