// The effect of a diver's groups of inputs in a step (human_world.hpp).
#include "diver/frames.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {
namespace {

// The attitude of a segment: root, then each joint of the chain.
Quat attitude_of_chain(const diver::HumanState& state,
                       std::initializer_list<diver::Segment> chain) {
  Quat q = state.root.attitude;
  for (const diver::Segment segment : chain) q = q * state.limbs.rotation[diver::joint_of(segment)];
  return q;
}

Quat joint_towards(const Quat& ned_from_parent, const Quat& world_from_child) {
  return glm::normalize(glm::conjugate(ned_from_parent) *
                        diver::ned_from_standing(world_from_child));
}

void move_hands(const DiverInputs& inputs, const diver::HumanState& state,
                diver::JointRotations& joints) {
  using namespace diver;
  if (inputs.hands_by_pose == 0) {
    joints[joint_of(kLeftHand)] = inputs.hands.wrist[0];
    joints[joint_of(kRightHand)] = inputs.hands.wrist[1];
    return;
  }
  const HandPoses& hands = inputs.hand_poses;
  if ((hands.tracked & 1) != 0)
    joints[joint_of(kLeftHand)] =
        joint_towards(attitude_of_chain(state, {kAbdomen, kThorax, kLeftUpperArm, kLeftForearm}),
                      hands.world_from_hand[0].rotation);
  if ((hands.tracked & 2) != 0)
    joints[joint_of(kRightHand)] =
        joint_towards(attitude_of_chain(state, {kAbdomen, kThorax, kRightUpperArm, kRightForearm}),
                      hands.world_from_hand[1].rotation);
}

diver::GazeState gaze_ned(const Gaze& gaze) {
  diver::GazeState state = gaze.state;
  state.direction = ned_from_world(state.direction);
  state.fixation = ned_from_world(state.fixation);
  return state;
}

// The swimmer, a recording, or the limbs' posture as it is.
void move_body(const PhysicsHuman& human, const DiverInputs& inputs, Authority authority,
               double now_s, double dt_s, HumanPhysics& state, diver::HumanInputs& acting) {
  if (authority == Authority::kLive) {
    acting.joints = inputs.body.joints;
    acting.other_power_w = inputs.body.other_power_w;
  } else if (authority == Authority::kRecording && human.recording) {
    acting.joints = human.recording->at(now_s, human.repeat);
  } else if (authority == Authority::kNobody) {
    acting.joints = state.human.held.joints;
  } else {
    diver::swim(human.body, human.file.swimmer, swim_goal(human, state), state.human, state.swimmer,
                dt_s, acting);
  }
}

}  // namespace

diver::HumanInputs acting_inputs(const PhysicsHuman& human, const DiverInputs& inputs,
                                 std::uint64_t step, double dt_s, HumanPhysics& state) {
  for (std::size_t i = 0; i < kDiverGroups; ++i)
    state.groups[i] = next_group(state.groups[i], inputs.control[i], step, dt_s);
  const auto authority = [&](DiverGroup group) {
    return acting(inputs.of(group), state.groups[static_cast<std::size_t>(group)].phase);
  };
  const auto live = [&](DiverGroup group) { return authority(group) == Authority::kLive; };
  const double now_s = static_cast<double>(step) * dt_s;
  const Quat straight(1.0, 0.0, 0.0, 0.0);

  diver::HumanInputs out;
  move_body(human, inputs, authority(DiverGroup::kBody), now_s, dt_s, state, out);
  if (live(DiverGroup::kHands)) {
    move_hands(inputs, state.human, out.joints);
  } else if (authority(DiverGroup::kHands) == Authority::kNobody) {
    for (const diver::Segment hand : {diver::kLeftHand, diver::kRightHand})
      out.joints[diver::joint_of(hand)] = straight;
  }
  if (live(DiverGroup::kHead))
    out.joints[diver::joint_of(diver::kHead)] =
        joint_towards(attitude_of_chain(state.human, {diver::kAbdomen, diver::kThorax}),
                      inputs.head.world_from_head.rotation);
  else if (authority(DiverGroup::kHead) == Authority::kNobody)
    out.joints[diver::joint_of(diver::kHead)] = straight;

  const Authority buttons = authority(DiverGroup::kButtons);
  if (buttons == Authority::kLive)
    out.buttons = inputs.buttons.pressed;
  else if (buttons == Authority::kRecording && human.buttons)
    out.buttons = human.buttons->at(now_s).value_or(out.buttons);
  else if (buttons == Authority::kNobody)
    out.buttons = 0;

  if (live(DiverGroup::kBreath)) {
    out.ventilation_l_min = inputs.breath.ventilation_l_min;
    out.breath_bias_m3 = inputs.breath.bias_m3;
    out.hold_breath = inputs.breath.hold;
    out.instruments.breath = inputs.breath.monitor;
  } else if (authority(DiverGroup::kBreath) == Authority::kNobody) {
    out.breath_bias_m3 = 0.0;
  }
  if (live(DiverGroup::kHeart)) out.instruments.heart = inputs.heart.state;
  if (live(DiverGroup::kGaze)) out.instruments.gaze = gaze_ned(inputs.gaze);

  const Authority gas = authority(DiverGroup::kGas);
  if (gas == Authority::kLive)
    out.tank = inputs.gas.tank;
  else if (gas == Authority::kNobody)
    out.tank = state.human.held.tank;
  else if (human.file.gas_switching.by_plan)
    out.tank = state.tank;
  return out;
}

}  // namespace neritic::testbed
