#include "diver/flutter_kick.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// Angle of the last part of a leg (blade or foot) away from the line of the foot's sole.
double tip_angle(const Body& body) {
  const Vec3 along = body.parts[body.edges[0].part].segment_from_part[0];
  return std::atan2(-along.x, along.z);
}

struct LegLengths {
  double upper_m, lower_m, foot_m;
};
LegLengths leg_lengths(const Body& body) {
  const Part& tip = body.parts[body.edges[0].part];
  const Vec3 end = tip.start_m + tip.length_m * tip.segment_from_part[0];
  return {std::abs(body.segments[kLeftLowerLeg].joint_m.x),
          std::abs(body.segments[kLeftFoot].joint_m.x), std::hypot(end.x, end.z)};
}

double chord_angle(double rise_m, double length_m) {
  return std::asin(std::clamp(rise_m / length_m, -0.95, 0.95));
}

}  // namespace

void set_flutter(JointAngles& joints, const Body& body, const FlutterKick& kick, double phase_rad) {
  const LegLengths leg = leg_lengths(body);
  const double knee_m = leg.upper_m, ankle_m = knee_m + leg.lower_m, tip_m = ankle_m + leg.foot_m;
  const double wave_number = 2.0 * kPi / kick.wavelength_m;
  // Hips flex so far that the ankles stay on the line on average.
  const double hip_mean = kick.knee_rad * leg.lower_m / (leg.upper_m + leg.lower_m);
  for (const bool right : {false, true}) {
    const double phase = phase_rad + (right ? kPi : 0.0);
    const double amplitude_m = kick.amplitude_m * (1.0 + (right ? -0.5 : 0.5) * kick.left_more);
    const auto rise = [&](double x_m) {
      return amplitude_m * std::pow(x_m / tip_m, kick.exponent) *
             std::sin(phase - wave_number * x_m);
    };
    const double upper = chord_angle(rise(knee_m), leg.upper_m);
    const double lower = chord_angle(rise(ankle_m) - rise(knee_m), leg.lower_m);
    const double foot = chord_angle(rise(tip_m) - rise(ankle_m), leg.foot_m);
    const auto joint = [&](Segment left_one) -> Vec3& {
      return joints[joint_of(right ? kMirror[left_one] : left_one)];
    };
    joint(kLeftUpperLeg).y =
        upper + hip_mean + kick.lift_rad + (right ? -1.0 : 1.0) * kick.twist_rad;
    joint(kLeftLowerLeg).y = std::min(0.0, lower - upper - kick.knee_rad);
    joint(kLeftFoot).y = std::max(-kick.pointed_rad, foot - lower + (kick.knee_rad - hip_mean) -
                                                         (0.5 * kPi - tip_angle(body)));
  }
}

JointAngles streamlined(const Body& body) {
  JointAngles joints{};
  joints[joint_of(kHead)].y = radians(40.0);
  for (const Segment foot : {kLeftFoot, kRightFoot})
    joints[joint_of(foot)].y = -(0.5 * kPi - tip_angle(body));
  return joints;
}

}  // namespace neritic::diver
