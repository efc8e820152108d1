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

// Turned from `last` about the way by at most that angle; all the way where last has no part
// across.
Vec3 swung(const Vec3& last, const Vec3& wanted, const Vec3& ahead, double most_rad) {
  const std::optional<Vec3> from = across(last, ahead, kSmall);
  if (!from) return wanted;
  const double angle_rad =
      std::atan2(glm::dot(glm::cross(*from, wanted), ahead), glm::dot(*from, wanted));
  if (std::abs(angle_rad) <= most_rad) return wanted;
  return glm::angleAxis(std::copysign(most_rad, angle_rad), ahead) * *from;
}

// Bends the lumbar and the thoracic joint until the neck is at its place. The spine bends to the
// side to which it is bent; a straight one slumps to the back.
void lean(const Body& body, const Vec3& neck_m, double most_swing_rad, Vec3& side,
          JointRotations& joints) {
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
  const Vec3 bent = across(abdomen[0], ahead, kBent)
                        .value_or(across(-abdomen[2], ahead, kBent).value_or(abdomen[1]));
  const Vec3 aside = swung(side, bent, ahead, most_swing_rad);
  side = aside;
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

// The arm of the posture to start from: the way from shoulder to wrist, and the side to which the
// elbow points, unit vectors in body axes. A nearly straight arm's elbow points away from where its
// hinge bends the forearm, also where a sensor says that it is bent backwards a little.
struct ArmWay {
  Vec3 ahead, aside;
};
ArmWay way_of(const Posture& posture, const Arm& arm) {
  constexpr double kHinge = 0.05;  // sine of the bend up to which the hinge decides
  const Mat3& upper = posture[arm.upper].body_from_segment;
  const Vec3 way = posture[arm.hand].origin_m - posture[arm.upper].origin_m;
  const double length_m = glm::length(way);
  const Vec3 ahead = length_m > kSmall ? way / length_m : -upper[0];
  const Vec3 bent = -upper[0] + kHinge * glm::cross(ahead, upper[1]);
  return {ahead,
          across(bent, ahead, kSmall).value_or(across(upper[2], ahead, kSmall).value_or(upper[1]))};
}

// A direction in front of the shoulder, in the thorax's axes: ahead of the chest, a little up and
// outwards. A side that is carried along with the way over this direction has no value in the
// opposite one alone (a tangent field on a sphere has at least one such place). That is as far
// behind the back as an arm goes, and for a wearer who stands while the diver lies prone above and
// behind the head. From an arm that hangs, elbow to the back, it gives the elbows that Soechting
// and Flanders measured (1989, Errors in pointing are due to approximations in sensorimotor
// transformations, Journal of Neurophysiology 62, 595), to 14 degrees RMS; outwards by 0.1 or 0.3
// rather than 0.2: 15 and 17.
Vec3 in_front(bool right) {
  return glm::normalize(Vec3(0.5, right ? 0.2 : -0.2, 0.84));
}

// Axes of which the first points in front.
Mat3 body_from_front(const Posture& posture, bool right) {
  const Vec3 front = in_front(right), aside = glm::normalize(glm::cross(Vec3(1, 0, 0), front));
  return posture[kThorax].body_from_segment * Mat3(front, aside, glm::cross(front, aside));
}

// From shoulder to wrist. Nearer to the shoulder than an arm folds no wrist comes: there the
// direction changes into the one in front, so that a hand may pass before the shoulder.
Vec3 direction_of(const Vec3& way, double length_m, double folded_m, const Vec3& front) {
  const Vec3 mixed = way + std::max(0.0, folded_m - length_m) * front;
  const double mixed_m = glm::length(mixed);
  return mixed_m > kSmall * folded_m ? mixed / mixed_m : front;
}

// The share of a hand's turn that the forearm twists by; the wrist turns the rest. Farther than the
// forearm twists it comes back, and is straight where the hand is turned about, or points back
// along the forearm: on either side of both the twist would have the opposite sign.
double forearm_twist(const Quat& forearm_from_hand) {
  constexpr double kPointsBack = 0.5;  // cosine of half the angle from which on it comes back
  const double sign = forearm_from_hand.w < 0.0 ? -1.0 : 1.0;
  const double turned_rad =
      2.0 * std::atan2(sign * forearm_from_hand.x, sign * forearm_from_hand.w);
  const double twisted_rad = std::min(
      std::abs(turned_rad), kForearmTwist * (kPi - std::abs(turned_rad)) / (kPi - kForearmTwist));
  const double along = std::hypot(forearm_from_hand.x, forearm_from_hand.w);
  return std::copysign(twisted_rad, turned_rad) * std::min(1.0, along / kPointsBack);
}

// Shoulder, elbow and wrist. The elbow is a hinge about starboard; the forearm twists.
void bend_arm(const Body& body, bool right, const Pose& target, double most_swing_rad, Vec3& side,
              JointRotations& joints) {
  const Arm& arm = kArms[right];
  const Posture posture = posture_of(body, joints, {});
  const double upper_m = glm::length(body.segments[arm.fore].joint_m);
  const double fore_m = glm::length(body.segments[arm.hand].joint_m);
  const Mat3& thorax = posture[kThorax].body_from_segment;

  const Vec3 way = shortened(target.position_m - posture[arm.upper].origin_m, 10.0);
  const double folded_m = std::sqrt(upper_m * upper_m + fore_m * fore_m +
                                    2.0 * upper_m * fore_m * std::cos(kElbowBend));
  const double asked_m = glm::length(way);
  const double reach_m = std::clamp(asked_m, folded_m, upper_m + fore_m);
  const Vec3 front = thorax * in_front(right);
  const Vec3 ahead = direction_of(way, asked_m, folded_m, front);

  const ArmWay before = way_of(posture, arm);
  const Quat carried =
      turn_between(front, ahead) * glm::conjugate(turn_between(front, before.ahead));
  const Vec3 aside = swung(thorax * side, carried * before.aside, ahead, most_swing_rad);
  side = glm::transpose(thorax) * aside;
  const auto [upper, fore] = bones_to(ahead, reach_m, upper_m, fore_m, aside);
  const Vec3 inside =
      across(fore, upper, kSmall).value_or(across(-aside, upper, kSmall).value_or(ahead));
  const Mat3 body_from_upper(-upper, glm::cross(inside, -upper), inside);
  const double bend = std::atan2(glm::dot(fore, inside), glm::dot(fore, upper));

  const Quat shoulder_turn = glm::quat_cast(body_from_upper);
  joints[joint_of(arm.upper)] =
      glm::normalize(glm::conjugate(glm::quat_cast(thorax)) * shoulder_turn);
  const Quat elbow = about(1, bend);
  const Quat left = glm::normalize(glm::conjugate(shoulder_turn * elbow) * target.rotation);
  const double twist = forearm_twist(left);
  joints[joint_of(arm.fore)] = glm::normalize(elbow * about(0, twist));
  joints[joint_of(arm.hand)] = glm::normalize(about(0, -twist) * left);
}

}  // namespace

JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets) {
  BendSides sides;
  return reach(body, joints, targets, 2.0 * kPi, sides);
}

JointRotations reach(const Body& body, const JointRotations& joints, const ReachTargets& targets,
                     double most_swing_rad, BendSides& sides) {
  JointRotations out = joints;
  if (!targets.head || !targets.eyes_m) sides.spine = Vec3(0.0);
  if (targets.head) {
    if (targets.eyes_m)
      lean(body, *targets.eyes_m - *targets.head * eyes_in_head(body), most_swing_rad, sides.spine,
           out);
    const Posture posture = posture_of(body, out, {});
    out[joint_of(kHead)] = glm::normalize(
        glm::conjugate(glm::quat_cast(posture[kThorax].body_from_segment)) * *targets.head);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    if (targets.hands[i] && body.moves[kArms[i].upper])
      bend_arm(body, i == 1, *targets.hands[i], most_swing_rad, sides.elbows[i], out);
    else
      sides.elbows[i] = Vec3(0.0);
  }
  return out;
}

Vec3 round_shoulder(const Posture& posture, bool right, const Vec3& wrist_m) {
  const Vec3 way = wrist_m - posture[kArms[right].upper].origin_m;
  const Vec3 seen = glm::transpose(body_from_front(posture, right)) * way;
  const double beside = std::hypot(seen.y, seen.z);
  const double angle_rad = std::atan2(beside, seen.x);
  const double share = beside > 0.0 ? angle_rad / beside : 0.0;
  return {share * seen.y, share * seen.z, glm::length(way)};
}

Vec3 wrist_round_shoulder(const Posture& posture, bool right, const Vec3& round) {
  const double angle_rad = std::hypot(round.x, round.y);
  const double share = angle_rad > 0.0 ? std::sin(angle_rad) / angle_rad : 0.0;
  const Vec3 direction(std::cos(angle_rad), share * round.x, share * round.y);
  return posture[kArms[right].upper].origin_m +
         round.z * (body_from_front(posture, right) * direction);
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
