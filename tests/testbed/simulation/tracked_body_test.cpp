// Head and hands as a headset and its controllers track them: the drawn diver meets them.
#include "diver/frames.hpp"
#include "diver/reach.hpp"
#include "engine/scene/animation.hpp"
#include "tests/testbed/simulation/devices.hpp"

namespace neritic::testbed {
namespace {

struct Drawn {
  Pose hand;
  Vec3 eyes_m;
  Quat head;
};

// Places on the drawn model: the right hand, and the eyes behind its mask.
Drawn drawn_diver(const TestDive& dive) {
  const PhysicsHuman& human = dive.world->humans()[0];
  const HumanPhysics& state = dive.state().humans()[0];
  const scene::Model& model =
      *dive.scene.models[static_cast<std::size_t>(dive.scene.objects[human.object].model)];
  const scene::NodeKey key = drawn_joints(human, state, 0.0);
  const scene::ModelPose pose = scene::evaluate_pose(model, {human.nodes, &key}, 0.0);
  const Mat4 world = to_matrix(drawn_pose(state));
  const auto node = [&](diver::Segment segment) {
    return world * pose.model_from_node[static_cast<std::size_t>(human.nodes[segment])];
  };
  // The model's arms are spread where its nodes' axes are parallel.
  const double half = 0.5 * human.arms_spread_rad;
  const Quat hang(std::cos(half), 0.0, 0.0, std::sin(half));
  const auto rotation = [](const Mat4& m) {
    return glm::normalize(glm::quat_cast(
        Mat3(glm::normalize(Vec3(m[0])), glm::normalize(Vec3(m[1])), glm::normalize(Vec3(m[2])))));
  };
  const Mat4 hand = node(diver::kRightHand), head = node(diver::kHead);
  const double height_m = human.body.height_m;
  return {{Vec3(hand[3]), rotation(hand) * hang},
          Vec3(head * Vec4(0.0, diver::kEyesAbove * height_m / human.scale,
                           -diver::kEyesInFront * height_m / human.scale, 1.0)),
          rotation(head)};
}

double degrees_between(const Quat& a, const Quat& b) {
  const Quat q = glm::conjugate(a) * b;
  return degrees(2.0 * std::atan2(std::hypot(q.x, q.y, q.z), std::abs(q.w)));
}

// A wearer who looks around, leans and waves at 0.25 Hz, tracked at 80 Hz, on a diver who swims by
// itself.
TEST(TrackedBody, DrawnHeadAndHandsMeetWhatIsTracked) {
  TestDive dive = dive_of(hover_text("head = \"headset\", hands = \"headset\""));
  Device head(dive, "headset", "diver/head"), hands(dive, "headset", "diver/hand_poses");
  double eyes_m = 0.0, hand_m = 0.0, head_deg = 0.0, hand_deg = 0.0;
  for (int step = 0; step < 8 * 240; ++step) {
    const double t = double(step) / 240.0, phase = 2.0 * kPi * 0.25 * t;
    // In the space that goes with the hips.
    const HumanPhysics& state = dive.state().humans()[0];
    const Pose world_from_body =
        world_pose(state.human.root.position_ned_m, state.human.root.attitude);
    const Pose world_from_stage{world_from_body.position_m,
                                world_from_body.rotation * diver::body_from_standing()};
    const Pose stage_from_eyes{Vec3(0.05 * std::sin(phase), 0.765, -0.12 - 0.03 * std::cos(phase)),
                               glm::angleAxis(0.5 * std::sin(phase), Vec3(0, 1, 0))};
    const Pose stage_from_hand{
        Vec3(0.25 + 0.08 * std::cos(phase), 0.30 + 0.08 * std::sin(phase), -0.35),
        glm::angleAxis(radians(80.0) + 0.2 * std::sin(phase), Vec3(1, 0, 0))};
    const Pose world_from_eyes = world_from_stage * stage_from_eyes;
    const Pose world_from_hand = world_from_stage * stage_from_hand;
    if (step % 3 == 0) {
      head.say(HeadPose{world_from_eyes, 1});
      hands.say(HandPoses{{Pose{}, world_from_hand}, 2});
    }
    if (t > 2.0) {
      const Drawn drawn = drawn_diver(dive);
      eyes_m = std::max(eyes_m, glm::distance(drawn.eyes_m, world_from_eyes.position_m));
      hand_m = std::max(hand_m, glm::distance(drawn.hand.position_m, world_from_hand.position_m));
      head_deg = std::max(head_deg, degrees_between(drawn.head, world_from_eyes.rotation));
      hand_deg = std::max(hand_deg, degrees_between(drawn.hand.rotation, world_from_hand.rotation));
    }
    dive.simulation->advance(1);
  }
  EXPECT_LT(eyes_m, 0.020);
  EXPECT_LT(hand_m, 0.020);
  EXPECT_LT(head_deg, 3.0);
  EXPECT_LT(hand_deg, 3.0);
}

}  // namespace
}  // namespace neritic::testbed
