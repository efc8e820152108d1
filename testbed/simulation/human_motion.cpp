// The step of a diver: what the groups of inputs make of it, limbs, contacts, dive computer
// (human_world.hpp).
#include <algorithm>
#include <cmath>

#include "diver/frames.hpp"
#include "diver/reach.hpp"
#include "diver/swimmer_constants.hpp"
#include "engine/sim/motion.hpp"
#include "testbed/samples/riding.hpp"
#include "testbed/simulation/human_world.hpp"
#include "testbed/simulation/periods.hpp"

namespace neritic::testbed {
namespace {

// Beyond a waypoint, this multiple of the acceptance is near enough.
constexpr double kPassed = 3.0;

std::size_t waypoint_index(const PhysicsHuman& human, const HumanPhysics& state) {
  const std::size_t count = human.waypoints_ned_m.size();
  return human.repeat ? state.arrived % count : std::min<std::size_t>(state.arrived, count - 1);
}

bool swims_on(const PhysicsHuman& human, const HumanPhysics& state) {
  return !human.waypoints_ned_m.empty() &&
         (human.repeat || state.arrived < human.waypoints_ned_m.size());
}

void follow_plan(const PhysicsHuman& human, HumanPhysics& state) {
  if (!swims_on(human, state)) return;
  const Vec3& to = human.waypoints_ned_m[waypoint_index(human, state)];
  const Vec3 off = state.human.root.position_ned_m - to, leg = to - state.leg_from_ned_m;
  const double distance = glm::length(off);
  const bool passed = glm::dot(off, leg) > 0.0 && distance < kPassed * human.acceptance_m;
  if (distance >= human.acceptance_m && !passed) return;
  ++state.arrived;
  state.leg_from_ned_m = to;
}

// The least speed through the water at which a swimmer steers, also on a way well up or down, where
// fins make the rate and hold the pitch (at 0.1 m/s one rises at 30 m a minute); and the most that
// a plan may ask.
constexpr double kSteerage_m_s = 0.1, kClimbing_m_s = 0.4, kMostSwim_m_s = 1.2;

// Coulomb's, of a diver on a vehicle: that of a scene's things.
constexpr double kHumanFriction = sim::Surface{}.friction;

// How long before the end of the step the dive computer's sample in it is due; none: it is not.
std::optional<double> since_sample_s(std::uint64_t step, double dt_s) {
  const auto samples = [&](std::uint64_t steps) {
    return periods_at(steps, dt_s, diver::kComputerSample_s);
  };
  const std::uint64_t last = samples(step + 1);
  if (last == samples(step)) return std::nullopt;
  const double since_s =
      static_cast<double>(step + 1) * dt_s - static_cast<double>(last) * diver::kComputerSample_s;
  return since_s > 1e-9 ? since_s : 0.0;
}
}  // namespace

double through_water_m_s(double over_ground_m_s, const Vec3& way_ned, const Vec3& current_ned_m_s) {
  const Vec3 level(way_ned.x, way_ned.y, 0.0);
  const double length = glm::length(level);
  if (!(length > 0.0)) return over_ground_m_s;
  const Vec3 drift(current_ned_m_s.x, current_ned_m_s.y, 0.0);
  return glm::length(over_ground_m_s / length * level - drift);
}

diver::SwimGoal swim_goal(const PhysicsHuman& human, const HumanPhysics& state) {
  if (!swims_on(human, state)) return {state.leg_from_ned_m, 0.0};
  const Vec3& to = human.waypoints_ned_m[waypoint_index(human, state)];
  if (human.speed_over == scene::SpeedOver::kWater) return {to, human.speed_m_s};
  const Vec3 way = to - state.human.root.position_ned_m;
  const Vec3 current = diver::steady_current_ned_m_s(state.human.held);
  const double speed_m_s = through_water_m_s(human.speed_m_s, way, current);
  // One whom the current carries along still steers.
  const bool climbs = current != Vec3(0.0) && std::abs(way.z) > diver::swimming::kWellOff_m;
  return {to, std::clamp(speed_m_s, climbs ? kClimbing_m_s : kSteerage_m_s, kMostSwim_m_s)};
}

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

// Head and hands go where they are tracked; a suit's wrists are joints already. Elbows and spine
// swing about their ways no faster than eased limbs.
void follow_tracking(const PhysicsHuman& human, const DiverInputs& inputs, bool head, bool hands,
                     double dt_s, const diver::HumanState& state, diver::BendSides& sides,
                     diver::JointRotations& joints) {
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
  joints = diver::reach(human.body, joints, targets, kFastestEase_rad_s * dt_s, sides);
}

// As the arm lies, but the wrist there, a place in the world.
void reach_out(const PhysicsHuman& human, const Vec3& to_m, const diver::HumanState& state,
               diver::JointRotations& joints) {
  const diver::Posture posture = diver::posture_of(human.body, joints, {});
  diver::ReachTargets targets;
  targets.hands[1] = diver::body_from_hand(posture, true);
  targets.hands[1]->position_m = place_in_body(state, {to_m, {}});
  joints = diver::reach(human.body, joints, targets);
}

diver::GazeState gaze_ned(const Gaze& gaze) {
  diver::GazeState state = gaze.state;
  state.direction = ned_from_world(state.direction);
  state.fixation = ned_from_world(state.fixation);
  return state;
}

// Whether what acts on the group is another than in the step before: an authority, or a source.
bool changed(const GroupState& before, const GroupState& now) {
  const Authority acts = acting(now);
  return acts != acting(before) || (acts == Authority::kLive && now.source != before.source);
}

// The parts of the limbs that poses place, and whether muscles move them at all: a hand that
// ceases to be tracked, an arm that reaches out and limbs that go slack change who moves them too.
std::uint64_t moved_parts(const DiverInputs& inputs, bool head, bool hands, bool reaches,
                          bool conscious) {
  std::uint64_t parts = conscious ? 0 : 1;
  if (reaches) parts |= 32;
  if (hands && inputs.hands_by_pose == 0) parts |= 2;
  if (hands && inputs.hands_by_pose != 0) parts |= (inputs.hand_poses.tracked & 3) << 2;
  if (head && (inputs.head.placed & kHeadPlaced)) parts |= 16;
  return parts;
}

// The source of each joint. A tracked head in its place also moves the spine; all other joints are
// the body's.
SourcesOfJoints sources_of_joints(const DiverInputs& inputs, bool head, bool hands) {
  SourcesOfJoints out;
  out.fill(kBodySource);
  const auto give = [&](LimbSource source, std::initializer_list<diver::Segment> segments) {
    for (const diver::Segment segment : segments) out[diver::joint_of(segment)] = source;
  };
  using namespace diver;
  if (head) give(kHeadSource, {kHead});
  if (head && (inputs.head.placed & kHeadPlaced)) give(kHeadSource, {kAbdomen, kThorax});
  if (!hands) return out;
  if (inputs.hands_by_pose == 0)
    give(kHandsSource, {kLeftHand, kRightHand});
  else
    give(kPosed,
         {kLeftUpperArm, kLeftForearm, kLeftHand, kRightUpperArm, kRightForearm, kRightHand});
  return out;
}

// Counts the sources whose limbs jump in this step. Whether one did.
bool count_jumps(const DiverInputs& inputs, const std::array<GroupState, kDiverGroups>& before,
                 const diver::JointRotations& joints, double dt_s, HumanPhysics& state) {
  constexpr std::array kGroups{DiverGroup::kBody, DiverGroup::kHead, DiverGroup::kHands};
  static_assert(kGroups.size() == kLimbSources);
  std::uint64_t live = 0, fresh = 0;
  for (std::size_t i = 0; i < kLimbSources; ++i) {
    const auto group = static_cast<std::size_t>(kGroups[i]);
    const GroupState& now = state.groups[group];
    if (acting(now) != Authority::kLive) continue;
    live |= std::uint64_t{1} << i;
    if (now.heard != before[group].heard) fresh |= std::uint64_t{1} << i;
  }
  const SourcesOfJoints sources =
      sources_of_joints(inputs, live >> kHeadSource & 1, live >> kHandsSource & 1);
  const std::uint64_t jumped =
      note_jumps(state.ease, state.human.held.joints, joints, sources, live, fresh, dt_s);
  for (std::size_t i = 0; i < kLimbSources; ++i)
    state.groups[static_cast<std::size_t>(kGroups[i])].jumps += jumped >> i & 1;
  return jumped != 0;
}

// Where slack muscles let limbs go: straight.
void relax(double share, diver::JointRotations& joints) {
  constexpr double kThere = 1e-9;
  for (Quat& q : joints) {
    const Quat straight(q.w < 0.0 ? -1.0 : 1.0, 0.0, 0.0, 0.0);
    q = glm::normalize(q + share * (straight - q));
    if (glm::length(Vec3(q.x, q.y, q.z)) < kThere) q = Quat(1.0, 0.0, 0.0, 0.0);
  }
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
    state.swimmer = {};  // limp: no button, breath by itself, limbs from where they are
    acting.joints = state.human.held.joints;
    relax(diver::slack_share(dt_s), acting.joints);
  } else {
    diver::SwimGoal goal = swim_goal(human, state);
    goal.speed_m_s *= able.strength;
    diver::swim(human.body, human.file.swimmer, goal, state.human, state.swimmer, dt_s, acting);
    if (able.slack > 0.0) relax(able.slack, acting.joints);
  }
}

}  // namespace

diver::HumanInputs acting_inputs(const PhysicsHuman& human, const DiverInputs& inputs,
                                 std::uint64_t step, double dt_s, const Ability& able,
                                 HumanPhysics& state) {
  const std::array<GroupState, kDiverGroups> before = state.groups;
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
  const bool reaches = able.hand_to_m && able.conscious && !hands &&
                       authority(DiverGroup::kHands) == Authority::kAutopilot;

  const auto another = [&](DiverGroup group) {
    const auto i = static_cast<std::size_t>(group);
    return changed(before[i], state.groups[i]);
  };
  const std::uint64_t parts = moved_parts(inputs, head, hands, reaches, able.conscious);
  const bool others = another(DiverGroup::kBody) || another(DiverGroup::kHands) ||
                      another(DiverGroup::kHead) || parts != state.ease.parts;
  const auto place_limbs = [&](diver::JointRotations& joints) {
    if (hands || head)
      follow_tracking(human, inputs, head, hands, dt_s, state.human, state.sides, joints);
    if (reaches) reach_out(human, *able.hand_to_m, state.human, joints);
  };
  // Where the ease brings limbs to another posture, elbows and spine are at once on the side that
  // this posture has: two turns at a time would be too fast.
  if (others) state.ease.paces = {}, state.sides = {};
  const diver::JointRotations unplaced = out.joints;
  place_limbs(out.joints);
  const bool jumped = count_jumps(inputs, others ? state.groups : before, out.joints, dt_s, state);
  if (jumped && (hands || head)) {
    state.sides = {};
    out.joints = unplaced;
    place_limbs(out.joints);
  }
  if (others || jumped) begin_ease(state.ease, state.human.held.joints, out.joints, dt_s);
  state.ease.parts = parts;
  step_ease(state.ease, out.joints, dt_s);

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

HumanStep free_human(const PhysicsHuman& human, const DiverInputs& inputs,
                     const diver::WaterFlow& water, std::uint64_t step, double dt_s,
                     const Ability& able, diver::BorrowedTank* borrowed, HumanPhysics& state) {
  follow_plan(human, state);
  diver::HumanInputs acting = acting_inputs(human, inputs, step, dt_s, able, state);
  acting.current_ned_m_s = water.current_m_s;
  acting.waves_ned_m_s = water.waves_m_s;
  acting.current_change_ned_m_s2 = water.change_m_s2;
  acting.water_acceleration_ned_m_s2 = water.acceleration_m_s2;
  const diver::RootState before = state.human.root;
  // Under waves the body floats and breathes as where the still water has that pressure.
  state.human.root.position_ned_m.z += water.head_m;
  state.human =
      diver::step(human.body, state.human, acting, dt_s, diver::kLongestSubstep_s, borrowed);
  state.human.root.position_ned_m.z -= water.head_m;
  const diver::RootState& after = state.human.root;
  const Mat6 mass = diver::matrix_of(
      diver::momentum_of(human.body, diver::posture_of(human.body, state.human.limbs.rotation, {}),
                         diver::gas_load(human.body, state.human))
          .mass);
  return {world_from_ned(inverse(mass)).m,
          world_pose(before.position_ned_m, before.attitude),
          {world_pose(after.position_ned_m, after.attitude),
           {world_from_ned(after.velocity.linear()), world_from_ned(after.velocity.angular())}}};
}

sim::PairBody pair_body(const PhysicsHuman& human, const HumanStep& moving) {
  return {human.shape, moving.inverse_mass, moving.before, moving.free};
}

bool part_from_vehicle(const PhysicsHuman& human, HumanStep& moving, const VehicleStep& vehicle,
                       rov::State& free, sim::PairMemory& memory) {
  sim::PairBody a = pair_body(vehicle, free), b = pair_body(human, moving);
  if (!sim::part_bodies(a, b, kHumanFriction, vehicle.dt_s, memory)) return false;
  set_motion(a.free, free);
  moving.free = b.free;
  return true;
}

bool part_humans(const PhysicsHuman& a, HumanStep& moving_a, const PhysicsHuman& b,
                 HumanStep& moving_b, double dt_s, sim::PairMemory& memory) {
  sim::PairBody pair_a = pair_body(a, moving_a), pair_b = pair_body(b, moving_b);
  if (!sim::part_bodies(pair_a, pair_b, kHumanFriction, dt_s, memory)) return false;
  moving_a.free = pair_a.free;
  moving_b.free = pair_b.free;
  return true;
}

void end_human(const PhysicsHuman& human, const sim::StaticWorld& solid, const HumanStep& moving,
               bool parted, double head_m, std::uint64_t step, double dt_s, const Ability& able,
               sim::ContactMemory& memory, HumanPhysics& state) {
  sim::MotionReport report;
  const sim::BodyMotion moved = sim::move_body(solid, human.shape, moving.inverse_mass,
                                               moving.before, moving.free, dt_s, memory, &report);
  diver::RootState& after = state.human.root;
  after.position_ned_m = ned_from_world(moved.world_from_body.position_m);
  after.attitude = ned_from_world(moved.world_from_body.rotation);
  after.velocity =
      vec6(ned_from_world(moved.velocity.linear), ned_from_world(moved.velocity.angular));
  state.contact.near_points = static_cast<std::uint64_t>(report.contacts);
  state.contact.touched_steps += report.touched || parted ? 1 : 0;
  state.contact.deepest_m = std::max(state.contact.deepest_m, report.deepest_m);
  state.contact.impulse_n_s = report.impulse_n_s;
  const auto since_s = since_sample_s(step, dt_s);
  if (!since_s) return;
  const double sink_m_s = (after.attitude * after.velocity.linear()).z;
  const double depth_m = after.position_ned_m.z + head_m - *since_s * sink_m_s;
  diver::DiveComputerState& computer = state.human.life.computer;
  // Out of a tank that the diver has not got nothing comes; without any there is the air above.
  const std::uint64_t tank = state.human.held.tank;
  const bool none = human.body.tank_count > 0 && tank >= human.body.tank_count;
  const bool known = tank < human.computer->settings().gases.size();
  const bool unfed = none || state.human.life.lungs.unfed_s > 0.0;
  computer =
      human.computer->step(computer, {depth_m, known ? tank : computer.last.gas, unfed ? 0U : 1U},
                           diver::kComputerSample_s);
  if (!able.conscious) return;  // who reaches for nothing
  diver::GasSwitching switching = human.file.gas_switching;
  switching.reaction_s = std::min(switching.reaction_s * able.slowing, diver::kMostReaction_s);
  state.tank = diver::step_gas_switch(switching, human.computer->settings().gases, human.body,
                                      state.human.life.tanks, computer, tank, depth_m, sink_m_s,
                                      diver::kComputerSample_s, state.gas_switch);
}

}  // namespace neritic::testbed
