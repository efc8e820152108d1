#include "testbed/devices/suit_posture.hpp"

#include <algorithm>
#include <cmath>

#include "diver/kinematics.hpp"

namespace neritic::testbed {
namespace {

using diver::Segment;

// Wire axes from those of a diver who stands and faces x: forward (to the head) is z, starboard
// -y, down (out of the belly) x.
const Quat kWireFromStanding = glm::quat_cast(Mat3(Vec3(0, 0, 1), Vec3(0, -1, 0), Vec3(1, 0, 0)));

// The segment of a diver at the wire's rest posture, from that at the diver's own: arms are spread
// about the axis out of the belly.
Quat rest_of(Segment segment) {
  const bool arm = segment >= diver::kLeftUpperArm && segment <= diver::kRightHand;
  return arm ? glm::angleAxis(-diver::side_of(segment) * kPi / 2.0, Vec3(0, 0, 1))
             : Quat(1, 0, 0, 0);
}

constexpr std::array<MvnSegment, diver::kSegments> kMvnOf{kMvnPelvis,
                                                          kMvnL3,
                                                          kMvnT8,
                                                          kMvnHead,
                                                          kMvnLeftUpperArm,
                                                          kMvnLeftForearm,
                                                          kMvnLeftHand,
                                                          kMvnRightUpperArm,
                                                          kMvnRightForearm,
                                                          kMvnRightHand,
                                                          kMvnLeftUpperLeg,
                                                          kMvnLeftLowerLeg,
                                                          kMvnLeftFoot,
                                                          kMvnRightUpperLeg,
                                                          kMvnRightLowerLeg,
                                                          kMvnRightFoot};

Quat rotation_of(const net::MxtpPose& pose) {
  const auto& q = pose.rotation;
  return glm::normalize(Quat(q[0], q[1], q[2], q[3]));
}
net::Float4 floats_of(const Quat& q) {
  return {static_cast<float>(q.w), static_cast<float>(q.x), static_cast<float>(q.y),
          static_cast<float>(q.z)};
}

// Segments of a hand: the carpus, then three of the thumb and four of each finger.
std::size_t first_of_finger(std::size_t finger) {
  return finger == 0 ? 1 : 4 * finger;
}

// Along the finger from the hand: to the left of a person with arms spread, or to the right.
Vec3 along_finger(std::size_t hand, const Quat& rotation) {
  return rotation * Vec3(0, hand == 0 ? 1 : -1, 0);
}

double bend(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

diver::JointRotations joints_of(const net::SuitFrame& frame) {
  std::array<Quat, diver::kSegments> wire_from;
  for (std::size_t i = 0; i < diver::kSegments; ++i)
    wire_from[i] =
        rotation_of(frame.body[kMvnOf[i]]) * kWireFromStanding * rest_of(static_cast<Segment>(i));
  const Quat l5 = rotation_of(frame.body[kMvnL5]), l3 = rotation_of(frame.body[kMvnL3]);
  wire_from[diver::kAbdomen] = glm::slerp(l5, l3, 0.5) * kWireFromStanding;
  return diver::rotations_of(wire_from);
}

HandJoints hands_of(const net::SuitFrame& frame, const diver::JointRotations& joints) {
  HandJoints out;
  out.wrist = {joints[diver::joint_of(diver::kLeftHand)],
               joints[diver::joint_of(diver::kRightHand)]};
  if (!frame.has_hands) return out;
  for (std::size_t hand = 0; hand < 2; ++hand)
    for (std::size_t finger = 0; finger < 5; ++finger) {
      const std::size_t first = first_of_finger(finger), bends = finger == 0 ? 2 : 3;
      double sum = 0.0;
      for (std::size_t k = 0; k < bends; ++k)
        sum += bend(along_finger(hand, rotation_of(frame.hands[hand][first + k])),
                    along_finger(hand, rotation_of(frame.hands[hand][first + k + 1])));
      out.flexion_rad[5 * hand + finger] = sum / static_cast<double>(bends);
    }
  return out;
}

net::SuitFrame suit_frame(const diver::JointRotations& joints,
                          const std::array<double, 10>& flexion, const Quat& wire_from_body) {
  static const diver::Body body = diver::make_body({}).value();
  const diver::Posture posture = diver::posture_of(body, joints, {});
  std::array<Quat, diver::kSegments> turned;
  std::array<Vec3, diver::kSegments> origin;
  for (std::size_t i = 0; i < diver::kSegments; ++i) {
    const auto segment = static_cast<Segment>(i);
    turned[i] =
        glm::normalize(wire_from_body * glm::quat_cast(posture[i].body_from_segment) *
                       glm::conjugate(rest_of(segment)) * glm::conjugate(kWireFromStanding));
    origin[i] = wire_from_body * posture[i].origin_m;
  }
  net::SuitFrame out;
  const auto put = [&](net::MxtpPose& pose, std::uint32_t id, const Quat& q, const Vec3& p) {
    pose = {id,
            {static_cast<float>(p.x), static_cast<float>(p.y), static_cast<float>(p.z)},
            floats_of(q)};
  };
  constexpr std::array<Segment, net::kMxtpBodySegments> kSegmentOf{
      diver::kPelvis,        diver::kAbdomen,      diver::kAbdomen,   diver::kThorax,
      diver::kThorax,        diver::kHead,         diver::kHead,      diver::kThorax,
      diver::kRightUpperArm, diver::kRightForearm, diver::kRightHand, diver::kThorax,
      diver::kLeftUpperArm,  diver::kLeftForearm,  diver::kLeftHand,  diver::kRightUpperLeg,
      diver::kRightLowerLeg, diver::kRightFoot,    diver::kRightFoot, diver::kLeftUpperLeg,
      diver::kLeftLowerLeg,  diver::kLeftFoot,     diver::kLeftFoot};
  for (std::size_t i = 0; i < net::kMxtpBodySegments; ++i)
    put(out.body[i], static_cast<std::uint32_t>(i + 1), turned[kSegmentOf[i]],
        origin[kSegmentOf[i]]);
  out.has_hands = true;
  std::uint32_t id = net::kMxtpBodySegments + 1;
  for (std::size_t hand = 0; hand < 2; ++hand) {
    const Segment segment = hand == 0 ? diver::kLeftHand : diver::kRightHand;
    put(out.hands[hand][0], id++, turned[segment], origin[segment]);
    for (std::size_t finger = 0; finger < 5; ++finger) {
      // Palms face down where arms are spread: a bent finger points down, about the axis ahead.
      const double angle = (hand == 0 ? -1.0 : 1.0) * flexion[5 * hand + finger];
      Quat q = turned[segment];
      for (std::size_t k = 0; k < (finger == 0 ? 3u : 4u); ++k) {
        if (k > 0) q = q * glm::angleAxis(angle, Vec3(1, 0, 0));
        put(out.hands[hand][first_of_finger(finger) + k], id++, q, origin[segment]);
      }
    }
  }
  return out;
}

}  // namespace neritic::testbed
