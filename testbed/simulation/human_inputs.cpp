// The effect of a diver's groups of inputs in a step (human_world.hpp).
#include "diver/frames.hpp"
#include "diver/reach.hpp"
#include "testbed/samples/riding.hpp"
#include "testbed/simulation/human_world.hpp"

namespace neritic::testbed {
namespace {

// Body axes of a diver, from a pose in the world of something in a standing person's axes.
Quat body_from_tracked(const diver::HumanState& state, const Pose& tracked) {
  return glm::normalize(glm::conjugate(state.root.attitude) *
                        diver::ned_from_standing(tracked.rotation));
}
Vec3 place_in_body(const diver::HumanState& state, const Pose& tracked) {
  return glm::conjugate(state.root.attitude) *
         (diver::ned_from_world(tracked.position_m) - state.root.position_ned_m);
}

// In the world, of a pose that rides with the body or is there already.
Pose world_from(const diver::HumanState& state, const Pose& pose, bool rides) {
  return rides ? diver::standing_pose(state.root.position_ned_m, state.root.attitude) * pose : pose;
}

// Head and hands go where they are tracked; a suit's wrists are joints already.
void follow_tracking(const PhysicsHuman& human, const DiverInputs& inputs, bool head, bool hands,
                     const diver::HumanState& state, diver::JointRotations& joints) {
  diver::ReachTargets targets;
  if (head) {
    const Pose tracked =
        world_from(state, inputs.head.world_from_head, inputs.head.placed & kHeadRides);
    targets.head = body_from_tracked(state, tracked);
    if (inputs.head.placed & kHeadPlaced) targets.eyes_m = place_in_body(state, tracked);
  }
  if (hands && inputs.hands_by_pose == 0) {
    joints[diver::joint_of(diver::kLeftHand)] = inputs.hands.wrist[0];
    joints[diver::joint_of(diver::kRightHand)] = inputs.hands.wrist[1];
  } else if (hands) {
    for (std::size_t i = 0; i < 2; ++i) {
      if ((inputs.hand_poses.tracked >> i & 1) == 0) continue;
      const Pose tracked = world_from(state, inputs.hand_poses.world_from_hand[i],
                                      inputs.hand_poses.tracked & kHandsRide);
      targets.hands[i] = {place_in_body(state, tracked), body_from_tracked(state, tracked)};
    }
  }
  joints = diver::reach(human.body, joints, targets);
}

diver::GazeState gaze_ned(const Gaze& gaze) {
  diver::GazeState state = gaze.state;
  state.direction = ned_from_world(state.direction);
  state.fixation = ned_from_world(state.fixation);
  return state;
}

// The swimmer, a recording, or the limbs' posture as it is.
void move_body(const PhysicsHuman& human, const DiverInputs& inputs, Authority authority,
               double now_s, double dt_s, const Ability& able, HumanPhysics& state,
               diver::HumanInputs& acting) {
  if (authority == Authority::kLive) {
    acting.joints = inputs.body.joints;
    acting.other_power_w = inputs.body.other_power_w;
  } else if (authority == Authority::kRecording && human.recording) {
    acting.joints = human.recording->at(now_s, human.repeat);
  } else if (authority == Authority::kNobody) {
    acting.joints = state.human.held.joints;
  } else if (!able.conscious) {
    state.swimmer = {};  // limp: limbs straight, no button, breath by itself
  } else {
    diver::SwimGoal goal = swim_goal(human, state);
    goal.speed_m_s *= able.strength;
    diver::swim(human.body, human.file.swimmer, goal, state.human, state.swimmer, dt_s, acting);
  }
}

}  // namespace

diver::HumanInputs acting_inputs(const PhysicsHuman& human, const DiverInputs& inputs,
                                 std::uint64_t step, double dt_s, const Ability& able,
                                 HumanPhysics& state) {
  for (std::size_t i = 0; i < kDiverGroups; ++i)
    state.groups[i] = next_group(state.groups[i], inputs.control[i], step, dt_s);
  const auto authority = [&](DiverGroup group) {
    return acting(inputs.of(group), state.groups[static_cast<std::size_t>(group)].phase);
  };
  const auto live = [&](DiverGroup group) { return authority(group) == Authority::kLive; };
  const double now_s = static_cast<double>(step) * dt_s;
  const Quat straight(1.0, 0.0, 0.0, 0.0);

  diver::HumanInputs out;
  move_body(human, inputs, authority(DiverGroup::kBody), now_s, dt_s, able, state, out);
  out.other_power_w += diver::work_of_heat_w(able.shiver_w);
  const bool hands = live(DiverGroup::kHands), head = live(DiverGroup::kHead);
  if (authority(DiverGroup::kHands) == Authority::kNobody)
    for (const diver::Segment hand : {diver::kLeftHand, diver::kRightHand})
      out.joints[diver::joint_of(hand)] = straight;
  if (authority(DiverGroup::kHead) == Authority::kNobody)
    out.joints[diver::joint_of(diver::kHead)] = straight;
  if (hands || head) follow_tracking(human, inputs, head, hands, state.human, out.joints);

  if (able.hand_to_m && able.conscious && !hands &&
      authority(DiverGroup::kHands) == Authority::kAutopilot) {
    // As the arm lies, but the wrist there.
    const diver::Posture posture = diver::posture_of(human.body, out.joints, {});
    diver::ReachTargets targets;
    targets.hands[1] = diver::body_from_hand(posture, true);
    targets.hands[1]->position_m = place_in_body(state.human, {*able.hand_to_m, {}});
    out.joints = diver::reach(human.body, out.joints, targets);
  }

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
  if (able.holds_breath) out.hold_breath = 1;
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
