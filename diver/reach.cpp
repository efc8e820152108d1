#include "diver/reach.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// Less than this share of a straight arm counts as no length.
constexpr double kSmall = 1e-6;

struct Arm {
  Segment upper, fore, hand;
};
constexpr std::array<Arm, 2> kArms{
    {{kLeftUpperArm, kLeftForearm, kLeftHand}, {kRightUpperArm, kRightForearm, kRightHand}}};

// The shortest turn from one unit vector to another.
Quat turn_between(const Vec3& from, const Vec3& to) {
  const Vec3 axis = glm::cross(from, to);
  const double w = 1.0 + glm::dot(from, to);
  if (w > 1e-9) return glm::normalize(Quat(w, axis.x, axis.y, axis.z));
  const Vec3 aside = std::abs(from.x) < 0.5 ? Vec3(1, 0, 0) : Vec3(0, 1, 0);
  const Vec3 half_turn = glm::normalize(glm::cross(from, aside));
  return {0.0, half_turn.x, half_turn.y, half_turn.z};
}

double angle_of(const Quat& q) {
  return 2.0 * std::atan2(std::hypot(q.x, q.y, q.z), std::abs(q.w));
}

// Turned back along the shortest way until its angle is at most the bound.
Quat bounded(const Quat& q, double most_rad) {
  const double angle = angle_of(q);
  if (angle <= most_rad) return q;
  return glm::slerp(Quat(1.0, 0.0, 0.0, 0.0), q, most_rad / angle);
}

// The part of v across a unit vector, as a unit vector; none if v has next to no such part.
std::optional<Vec3> across(const Vec3& v, const Vec3& unit, double least) {
  const Vec3 rest = v - glm::dot(v, unit) * unit;
  const double length = glm::length(rest);
  if (!(length > least)) return std::nullopt;
  return rest / length;
}

// At most so long, in the same direction; finite for any finite v.
Vec3 shortened(const Vec3& v, double most_m) {
  const double scale = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
  if (!(scale > most_m)) return v * std::min(1.0, most_m / std::max(glm::length(v), 1e-300));
  return v / scale * (most_m / glm::length(v / scale));
}

Vec3 eyes_in_head(const Body& body) {
  return {kEyesAbove * body.height_m, 0.0, kEyesInFront * body.height_m};
}

// Two bones from one joint to a place: the unit vectors along them. The joint between them points
// to `aside`, a unit vector across the way. The way's length is that of a triangle, or the bones
// are as straight or as folded as they get.
struct Bones {
  Vec3 first, second;
};
Bones bones_to(const Vec3& ahead, double way_m, double first_m, double second_m,
               const Vec3& aside) {
  const double along = std::clamp(
      (first_m * first_m + way_m * way_m - second_m * second_m) / (2.0 * first_m * way_m), -1.0,
      1.0);
  const Vec3 first = ahead * along + aside * std::sqrt(1.0 - along * along);
  const Vec3 second = ahead * way_m - first * first_m;
  return {first, glm::normalize(second)};
}

// Bends the lumbar and the thoracic joint until the neck is at its place. The spine bends to the
// side to which it is bent; a straight one slumps to the back.
void lean(const Body& body, const Vec3& neck_m, JointRotations& joints) {
  constexpr double kBent = 0.02;  // share of the abdomen's length that counts as bent
  const Posture posture = posture_of(body, joints, {});
  const Mat3 abdomen = posture[kAbdomen].body_from_segment;
  const Mat3 thorax = posture[kThorax].body_from_segment;
  const double lower_m = body.segments[kThorax].joint_m.x;
  const double upper_m = body.segments[kHead].joint_m.x;
  const Vec3 way = shortened(neck_m - posture[kAbdomen].origin_m, 10.0);
  const double asked_m = glm::length(way);
  if (!(asked_m > kSmall)) return;  // no spine folds that far
  const Vec3 ahead = way / asked_m;
  const double way_m = std::clamp(asked_m, std::abs(lower_m - upper_m) + kSmall, lower_m + upper_m);
  const Vec3 aside = across(abdomen[0], ahead, kBent)
                         .value_or(across(-abdomen[2], ahead, kBent).value_or(abdomen[1]));
  const Bones bones = bones_to(ahead, way_m, lower_m, upper_m, aside);

  const Quat pelvis = glm::quat_cast(posture[kPelvis].body_from_segment);
  const auto most = [&](Segment segment) {
    return std::max(kSpineBend, angle_of(joints[joint_of(segment)]));
  };
  const double lumbar = most(kAbdomen), thoracic = most(kThorax);
  const Quat turned = turn_between(abdomen[0], bones.first) * glm::quat_cast(abdomen);
  joints[joint_of(kAbdomen)] = bounded(glm::normalize(glm::conjugate(pelvis) * turned), lumbar);
  const Quat below = pelvis * joints[joint_of(kAbdomen)];
  const Quat over = turn_between(thorax[0], bones.second) * glm::quat_cast(thorax);
  joints[joint_of(kThorax)] = bounded(glm::normalize(glm::conjugate(below) * over), thoracic);
}

// Shoulder, elbow and wrist. The elbow is a hinge about starboard; the forearm twists.
void bend_arm(const Body& body, const Arm& arm, const Pose& target, JointRotations& joints) {
  const Posture posture = posture_of(body, joints, {});
  const double upper_m = glm::length(body.segments[arm.fore].joint_m);
  const double fore_m = glm::length(body.segments[arm.hand].joint_m);
  const Vec3 shoulder = posture[arm.upper].origin_m;
  const Mat3& was = posture[arm.upper].body_from_segment;

  const Vec3 way = shortened(target.position_m - shoulder, 10.0);
  const double asked_m = glm::length(way);
  const double straight_m = upper_m + fore_m;
  const Vec3 ahead = asked_m > kSmall * straight_m ? way / asked_m : -was[0];
  const double folded_m = std::sqrt(upper_m * upper_m + fore_m * fore_m +
                                    2.0 * upper_m * fore_m * std::cos(kElbowBend));
  const double reach_m = std::clamp(asked_m, folded_m, straight_m);

  // To which side the elbow points: as before, else opposite to where the forearm bends, else
  // anywhere across.
  const double least = 1e-3;
  Vec3 aside = across(-was[0], ahead, least)
                   .value_or(across(-was[2], ahead, least)
                                 .value_or(across(was[1], ahead, least).value_or(was[1])));
  const auto [upper, fore] = bones_to(ahead, reach_m, upper_m, fore_m, aside);
  const Vec3 front =
      across(fore, upper, kSmall).value_or(across(-aside, upper, kSmall).value_or(was[2]));
  const Mat3 body_from_upper(-upper, glm::cross(front, -upper), front);
  const double bend = std::atan2(glm::dot(fore, front), glm::dot(fore, upper));

  const Quat thorax = glm::quat_cast(posture[kThorax].body_from_segment);
  const Quat shoulder_turn = glm::quat_cast(body_from_upper);
  joints[joint_of(arm.upper)] = glm::normalize(glm::conjugate(thorax) * shoulder_turn);
  const Quat elbow = about(1, bend);
  const Quat left = glm::normalize(glm::conjugate(shoulder_turn * elbow) * target.rotation);
  const double sign = left.w < 0.0 ? -1.0 : 1.0;
  const double twist =
      std::clamp(2.0 * std::atan2(sign * left.x, sign * left.w), -kForearmTwist, kForearmTwist);
  joints[joint_of(arm.fore)] = glm::normalize(elbow * about(0, twist));
  joints[joint_of(arm.hand)] = glm::normalize(about(0, -twist) * left);
}

}  // namespace

JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets) {
  JointRotations out = joints;
  if (targets.head) {
    if (targets.eyes_m) lean(body, *targets.eyes_m - *targets.head * eyes_in_head(body), out);
    const Posture posture = posture_of(body, out, {});
    out[joint_of(kHead)] = glm::normalize(
        glm::conjugate(glm::quat_cast(posture[kThorax].body_from_segment)) * *targets.head);
  }
  for (std::size_t i = 0; i < 2; ++i)
    if (targets.hands[i] && body.moves[kArms[i].upper])
      bend_arm(body, kArms[i], *targets.hands[i], out);
  return out;
}

Pose body_from_eyes(const Body& body, const Posture& posture) {
  const SegmentPose& head = posture[kHead];
  return {head.origin_m + head.body_from_segment * eyes_in_head(body),
          glm::quat_cast(head.body_from_segment)};
}

Pose body_from_hand(const Posture& posture, bool right) {
  const SegmentPose& hand = posture[right ? kRightHand : kLeftHand];
  return {hand.origin_m, glm::quat_cast(hand.body_from_segment)};
}

}  // namespace neritic::diver
