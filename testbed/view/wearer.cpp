#include "testbed/view/wearer.hpp"

#include <algorithm>

#include "diver/frames.hpp"
#include "diver/jacket.hpp"
#include "diver/reach.hpp"
#include "testbed/instruments/instrument_data.hpp"
#include "testbed/samples/riding.hpp"
#include "testbed/view/dive_camera.hpp"

namespace neritic::testbed {
namespace {

constexpr double kPush = 0.1;                         // of a stick: less is its rest
constexpr double kSpeed_m_s = 0.5, kFast_m_s = 0.68;  // with full gear (diver/swimmer.hpp)
// Up and down as fast as asked, with a stick pushed to its end: 9 m a minute is the most that the
// NOAA Diving Manual teaches (30 feet), 15 m the most that a dive computer allows deep down; it
// warns near the surface. Let go of, the way up or down ends within kSettle_s.
constexpr double kClimb_m_s = 9.0 / 60.0, kFastClimb_m_s = 15.0 / 60.0, kSettle_s = 2.5;
constexpr double kAhead_m = 5.0;  // of the place that is swum to
constexpr double kLongestStep_s = 0.05;
// By keys: a turn aims so far beside the course, and one without a push ahead swims so slowly.
constexpr double kTurn_rad = radians(60.0), kTurningShare = 0.4;
// The stage follows a body that is turned by more than this off it, as slowly as this. Strokes sway
// a body by up to 20 degrees; what turns faster makes wearers sick.
constexpr double kSway_rad = radians(30.0), kStageFollow_s = 1.5,
                 kMostStageTurn_rad_s = radians(15.0);
constexpr double kStageTurn_rad_s = radians(60.0), kLongestStageTurn_s = 0.1;
// A wearer who looks farther off the body than a neck turns brings the body round.
constexpr double kNeck_rad = radians(75.0), kAhead_rad = radians(20.0);

// A limb comes from where it is to where it is tracked in this time, and a hand that is far off in
// longer, at a swimmer's pace (simulation/joint_ease.hpp). So slow a limb turns the body little.
constexpr double kEase_s = 1.0;
constexpr double kSteepest = 1.5;  // slope of smoothstep in its middle

// From 0 to 1, without a jolt at either end.
double eased(double since_s) {
  return glm::smoothstep(0.0, kEase_s, since_s);
}

double most_climb_m_s(const DiveInput& input) {
  return input.fast ? kFastClimb_m_s : kClimb_m_s;
}

double off_rad(double to_rad, double from_rad) {
  return std::remainder(to_rad - from_rad, 2.0 * kPi);
}

}  // namespace

Wearer::Wearer(LivePhysics& physics)
    : physics_(&physics), gaze_(diver::headset_gaze(diver::GazeMethod::kVelocity)) {
  const diver::Body& body = human().body;
  const Vec3 eyes =
      diver::body_from_eyes(body, diver::posture_of(body, diver::straight_joints(), {})).position_m;
  eyes_m_ = diver::standing_axes(eyes);
}

// The wearer begins facing where the diver's crown points, of a swimmer, or the chest, of one
// upright.
Pose Wearer::world_from_stage(const scene::MotionSource& motion, double time_s) {
  scene::Mount hips;
  hips.object = static_cast<int>(human().object);
  const Pose body = motion.world_from(hips, time_s);
  world_from_body_ = body;
  const double course_rad = course_of(body.rotation, followed_rad_);
  if (!followed_s_ || time_s < *followed_s_) {
    followed_rad_ = course_rad;
    added_rad_ = 0.0;
  } else if (!swims_ || by_keys_) {
    const double off = off_rad(course_rad, followed_rad_), passed_s = time_s - *followed_s_;
    const double beyond = std::copysign(std::max(std::abs(off) - kSway_rad, 0.0), off);
    const double most = kMostStageTurn_rad_s * passed_s;
    followed_rad_ += std::clamp(beyond * -std::expm1(-passed_s / kStageFollow_s), -most, most);
  }
  followed_s_ = time_s;
  return {body * eyes_m_, from_yaw_pitch_roll(followed_rad_ + added_rad_, 0.0, 0.0)};
}

void Wearer::take(const xr::DisplayFrame& frame, const DiveInput& input,
                  const std::optional<Quat>& world_from_eyes, double speed, double elapsed_s) {
  world_from_head_ = frame.world_from_head;
  if (world_from_head_)
    added_rad_ -= std::clamp(input.look_rate.x + input.turn, -1.0, 1.0) * kStageTurn_rad_s *
                  std::min(elapsed_s, kLongestStageTurn_s);
  tracked_ = frame.tracked;
  input_ = input;
  world_from_eyes_ = world_from_head_ || !by_keys_ ? std::nullopt : world_from_eyes;
  fresh_ = true;
  // Seldom frames are no silence.
  if (hold_.frame(now_ns(), speed)) told_.fill(false);
}

void Wearer::send(SampleInbox& inbox, PayloadKind kind, const Payload& payload,
                  TimeNs captured_ns) {
  const TimeNs now = now_ns();
  const StreamId stream = physics_->world().streams().id(OwnerSort::kDiver, 0, kind);
  inbox.push({{stream, *source_, sequences_[static_cast<std::size_t>(kind)]++,
               std::min(captured_ns, now), now},
              payload});
}

bool Wearer::is_others(DiverGroup group) const {
  return physics_->world().start_inputs().humans()[0].of(group).authority == Authority::kLive;
}

// Once a group, and anew with another hold. A device that the scene names keeps its group.
void Wearer::claim(SampleInbox& inbox, DiverGroup group) {
  if (std::exchange(told_[static_cast<std::size_t>(group)], true)) return;
  claimed_[static_cast<std::size_t>(group)] = true;
  if (is_others(group)) return;
  Event event{.group = static_cast<std::uint64_t>(group)};
  event.authority = static_cast<std::uint64_t>(Authority::kLive);
  event.source = *source_;
  event.hold_s = hold_.scene_s();
  send(inbox, PayloadKind::kEvent, event, now_ns());
}

// Gives back what was swum by keys, to the scene's choice.
void Wearer::let_go(SampleInbox& inbox) {
  swims_ = views_ = false;
  for (const DiverGroup group :
       {DiverGroup::kBody, DiverGroup::kButtons, DiverGroup::kBreath, DiverGroup::kGaze})
    let_go(inbox, group);
}

void Wearer::let_go(SampleInbox& inbox, DiverGroup group) {
  told_[static_cast<std::size_t>(group)] = false;
  if (!std::exchange(claimed_[static_cast<std::size_t>(group)], false)) return;
  const GroupControl& chosen = physics_->world().start_inputs().humans()[0].of(group);
  if (chosen.authority == Authority::kLive) return;
  Event event{.group = static_cast<std::uint64_t>(group)};
  event.authority = static_cast<std::uint64_t>(chosen.authority);
  event.source = chosen.source;
  event.hold_s = chosen.hold_s;
  send(inbox, PayloadKind::kEvent, event, now_ns());
}

void Wearer::swim_by_keys(bool on) {
  by_keys_ = on;
  yaw_rad_ = course_of(diver::standing_pose(Vec3(0.0), state().human.root.attitude).rotation);
}

// With the first key that moves him; at once a diver who would follow a plan. Before, he hovers by
// himself, each step, as seldom frames cannot make him.
bool Wearer::begins_by_keys() const {
  const bool turns = !world_from_eyes_ && std::abs(input_.move.x + input_.turn) > kPush;
  const bool moves = -input_.move.z > kPush || std::abs(input_.move.y) > kPush;
  return by_keys_ && (moves || turns || !human().waypoints_ned_m.empty());
}

// A turn alone leaves a diver to the plan that he follows.
bool Wearer::begins_by_sticks() const {
  const bool turns = std::abs(input_.look_rate.x + input_.turn) > kPush;
  return world_from_head_ &&
         (glm::length(input_.move) > kPush || (turns && human().waypoints_ned_m.empty()));
}

void Wearer::begin_swimming(double scene_time_s) {
  swims_ = true;
  began_by_keys_ = by_keys_;
  swimmer_ = state().swimmer;
  stays_ned_m_ = state().human.root.position_ned_m;
  settles_s_ = 0.0;
  swum_s_ = scene_time_s;
}

// In the frame of the body with which it rides.
Pose Wearer::riding(const Pose& world_from_tracked) const {
  return world_from_body_ ? inverse(*world_from_body_) * world_from_tracked : world_from_tracked;
}

// In its tracked place until the wearer swims: then it comes back to where a straight body has it,
// and turns alone.
HeadPose Wearer::head_pose(double scene_time_s) {
  HeadPose out{riding(*world_from_head_), kHeadPlaced | (world_from_body_ ? kHeadRides : 0)};
  if (!swims_ || by_keys_) {
    let_go_s_.reset();
    return out;
  }
  if (!let_go_s_ || scene_time_s < *let_go_s_) let_go_s_ = scene_time_s;
  const double share = eased(scene_time_s - *let_go_s_);
  if (world_from_body_ && share < 1.0)
    out.world_from_head.position_m = glm::mix(out.world_from_head.position_m, eyes_m_, share);
  else
    out.placed &= ~kHeadPlaced;
  return out;
}

Wearer::Begun Wearer::begin_hand(bool right, const Pose& tracked, double scene_time_s) const {
  const diver::Posture posture = diver::posture_of(human().body, state().human.limbs.rotation, {});
  const Pose from = riding(world_from_wrist(human(), state(), right));
  const auto round = [&](const Vec3& place_m) {
    return diver::round_shoulder(posture, right, diver::standing_axes(place_m));
  };
  Begun begun{.at_s = scene_time_s, .off = round(from.position_m) - round(tracked.position_m)};
  begun.turned_off = glm::normalize(glm::conjugate(tracked.rotation) * from.rotation);
  if (begun.turned_off.w < 0.0) begun.turned_off = -begun.turned_off;
  const double turned_rad = 2.0 * std::acos(std::min(1.0, begun.turned_off.w));
  const double widest_rad = std::max(turned_rad, std::hypot(begun.off.x, begun.off.y));
  begun.lasts_s = std::max(kEase_s, kSteepest * widest_rad / kFastestEase_rad_s);
  return begun;
}

// Round the shoulder: on a straight way a hand would go through it or the chest.
Pose Wearer::eased_hand(bool right, const Pose& tracked, const Begun& begun,
                        double scene_time_s) const {
  const double left_s = begun.lasts_s - (scene_time_s - begun.at_s);
  if (!(left_s > 0.0)) return tracked;
  const double share = glm::smoothstep(0.0, begun.lasts_s, left_s);
  const diver::Posture posture = diver::posture_of(human().body, state().human.limbs.rotation, {});
  const Vec3 round =
      diver::round_shoulder(posture, right, diver::standing_axes(tracked.position_m)) +
      share * begun.off;
  return {diver::standing_axes(diver::wrist_round_shoulder(posture, right, round)),
          tracked.rotation * glm::slerp(Quat(1.0, 0.0, 0.0, 0.0), begun.turned_off, share)};
}

// Without the body's frame a change of source is eased by the step alone.
HandPoses Wearer::hand_poses(double scene_time_s) {
  HandPoses out;
  for (std::size_t i = 0; i < 2; ++i) {
    std::optional<Begun>& begun = hands_begun_[i];
    if (!tracked_.hands[i] || !world_from_body_) begun.reset();
    if (!tracked_.hands[i]) continue;
    const bool right = i == 1;
    Pose hand = riding(*tracked_.hands[i]);
    if (world_from_body_) {
      if (!begun || scene_time_s < begun->at_s) begun = begin_hand(right, hand, scene_time_s);
      hand = eased_hand(right, hand, *begun, scene_time_s);
    }
    out.world_from_hand[i] = hand;
    out.tracked |= std::uint64_t{1} << i;
  }
  if (out.tracked != 0 && world_from_body_) out.tracked |= kHandsRide;
  return out;
}

Status Wearer::poll(SampleInbox& inbox, double scene_time_s) {
  if (swims_) swim(inbox, scene_time_s);
  if (!std::exchange(fresh_, false)) return {};
  const bool ends = !by_keys_ && ((swims_ && began_by_keys_) || views_);
  if (!world_from_head_ && input_.jacket == 0 && !by_keys_ && !ends) return {};
  if (!source_) {
    NERITIC_TRY(source_, inbox.open("wearer"));
  }
  const TimeNs now = now_ns();
  if (world_from_head_) {
    claim(inbox, DiverGroup::kHead);
    send(inbox, PayloadKind::kHeadPose, head_pose(scene_time_s), now);
  }
  if (const HandPoses hands = hand_poses(scene_time_s); hands.tracked != 0) {
    claim(inbox, DiverGroup::kHands);
    send(inbox, PayloadKind::kHandPoses, hands, now);
  }
  if (tracked_.gaze) send_gaze(inbox, *tracked_.gaze);
  if (world_from_eyes_)
    send_view(inbox, now);
  else if (by_keys_ && !tracked_.gaze)
    let_go(inbox, DiverGroup::kGaze);
  if (ends)
    let_go(inbox);
  else if (!swims_ && (begins_by_keys() || begins_by_sticks()))
    begin_swimming(scene_time_s);
  if (input_.jacket != 0 && !swims_) {
    claim(inbox, DiverGroup::kButtons);
    send(inbox, PayloadKind::kButtons, JacketButtons{input_.jacket}, now);
  }
  return {};
}

void Wearer::send_gaze(SampleInbox& inbox, const xr::Tracked::Gaze& gaze) {
  if (gaze.sampled_ns == gazed_ns_) return;  // the tracker is slower than the display
  gazed_ns_ = gaze.sampled_ns;
  diver::GazeEvents events;
  gaze_.push({1e-9 * static_cast<double>(gaze.sampled_ns), gaze.pose.rotation * Vec3(0, 0, -1)},
             events);
  claim(inbox, DiverGroup::kGaze);
  send(inbox, PayloadKind::kGaze, Gaze{gaze_.state()}, gaze.sampled_ns);
}

// A window has no eye tracker: the gaze is where the middle of the view points, without events of
// an eye. A view that turns as fast as a saccade looks at nothing.
void Wearer::send_view(SampleInbox& inbox, TimeNs now) {
  const double time_s = 1e-9 * static_cast<double>(now), passed_s = time_s - viewed_.time_s;
  const Vec3 ahead = *world_from_eyes_ * Vec3(0, 0, -1);
  const bool first = !claimed_[static_cast<std::size_t>(DiverGroup::kGaze)] || !(passed_s > 0.0);
  viewed_.velocity_rad_s = first ? 0.0 : diver::angle_between(viewed_.direction, ahead) / passed_s;
  const bool rests = viewed_.velocity_rad_s < diver::GazeSettings().velocity_rad_s;
  viewed_.fixated_s = rests && !first ? viewed_.fixated_s + passed_s : 0.0;
  viewed_.time_s = time_s;
  viewed_.direction = viewed_.fixation = ahead;
  viewed_.now = rests ? diver::GazeClass::kFixation : diver::GazeClass::kSaccade;
  views_ = true;
  claim(inbox, DiverGroup::kGaze);
  send(inbox, PayloadKind::kGaze, Gaze{viewed_}, now);
}

// Towards where the head looks and the sticks push.
std::optional<diver::SwimGoal> Wearer::pushed() const {
  if (!world_from_head_ || !(glm::length(input_.move) > kPush)) return std::nullopt;
  const Vec3 push = world_from_head_->rotation * Vec3(input_.move.x, 0.0, input_.move.z) +
                    Vec3(0.0, input_.move.y, 0.0);
  const double share = std::min(1.0, glm::length(push));
  const double speed_m_s = share * (input_.fast ? kFast_m_s : kSpeed_m_s);
  std::optional<double> climb_m_s;
  if (std::abs(push.y) > kPush) {
    const double most_m_s = share * most_climb_m_s(input_);
    climb_m_s = std::clamp(push.y / glm::length(push) * speed_m_s, -most_m_s, most_m_s);
  }
  return diver::SwimGoal{state().human.root.position_ned_m +
                             diver::ned_from_world(push) * (kAhead_m / std::max(share, kPush)),
                         speed_m_s, climb_m_s};
}

// In a curve towards where the head looks, once that is too far aside.
std::optional<diver::SwimGoal> Wearer::turned() {
  if (!world_from_head_) return std::nullopt;
  const Vec3 starboard = world_from_head_->rotation * Vec3(1, 0, 0);
  const double looks_rad = std::atan2(-starboard.z, starboard.x);
  const double course_rad =
      course_of(diver::standing_pose(Vec3(0.0), state().human.root.attitude).rotation, looks_rad);
  const double off = off_rad(looks_rad, course_rad);
  turns_body_ = std::abs(off) > (turns_body_ ? kAhead_rad : kNeck_rad);
  if (!turns_body_) return std::nullopt;
  const double yaw_rad = course_rad + std::clamp(off, -kTurn_rad, kTurn_rad);
  const Vec3 push = from_yaw_pitch_roll(yaw_rad, 0.0, 0.0) * Vec3(0.0, 0.0, -kAhead_m);
  return diver::SwimGoal{state().human.root.position_ned_m + diver::ned_from_world(push),
                         kTurningShare * kSpeed_m_s};
}

// Ahead, up and down along the course, which the other keys turn. Without a key he stays there.
// Where his own view is shown, those keys turn the view (ViewChoice), and ahead is where it points.
diver::SwimGoal Wearer::pushed_by_keys() {
  const double turn = world_from_eyes_ ? 0.0 : std::clamp(input_.move.x + input_.turn, -1.0, 1.0);
  const double ahead = std::max(0.0, -input_.move.z), up = input_.move.y;
  if (!(std::abs(turn) > kPush || ahead > kPush || std::abs(up) > kPush))
    return {stays_ned_m_, 0.0};
  const double course =
      course_of(diver::standing_pose(Vec3(0.0), state().human.root.attitude).rotation, yaw_rad_);
  if (std::abs(turn) > kPush) yaw_rad_ = course - turn * kTurn_rad;
  if (world_from_eyes_) {
    const Vec3 starboard = *world_from_eyes_ * Vec3(1, 0, 0);
    yaw_rad_ = std::atan2(-starboard.z, starboard.x);
  }
  const double level =
      std::max({ahead, kTurningShare * std::abs(turn), kTurningShare * std::abs(up)});
  const Vec3 push = from_yaw_pitch_roll(yaw_rad_, 0.0, 0.0) * Vec3(0.0, up, -level);
  const double share = std::min(1.0, glm::length(push));
  return {
      state().human.root.position_ned_m + diver::ned_from_world(glm::normalize(push)) * kAhead_m,
      share * (input_.fast ? kFast_m_s : kSpeed_m_s),
      std::abs(up) > kPush ? std::optional(up * most_climb_m_s(input_)) : std::nullopt};
}

// Where nothing asks for a way up or down, one that was let go of ends first; from there on the
// depth is held, at rest and ahead.
void Wearer::hold_depth(diver::SwimGoal& goal, double dt_s) {
  if (goal.climb_m_s)
    settles_s_ = kSettle_s;
  else if (settles_s_ > 0.0)
    goal.climb_m_s = 0.0;
  if (goal.climb_m_s)
    stays_ned_m_.z = state().human.root.position_ned_m.z;
  else
    goal.target_ned_m.z = stays_ned_m_.z;
  settles_s_ -= dt_s;
}

// The swimmer's own kick; without a push the diver stays at the place. The buttons trim too, as
// under the autopilot.
void Wearer::swim(SampleInbox& inbox, double scene_time_s) {
  const double dt_s = std::min(scene_time_s - swum_s_, kLongestStep_s);
  if (!(dt_s > 0.0)) return;
  swum_s_ = scene_time_s;
  const diver::HumanState& body = state().human;
  std::optional<diver::SwimGoal> pushed_to = by_keys_ ? pushed_by_keys() : pushed();
  if (!pushed_to) pushed_to = turned();
  diver::SwimGoal goal = pushed_to.value_or(diver::SwimGoal{stays_ned_m_, 0.0});
  const Vec3& place = body.root.position_ned_m;
  if (goal.speed_m_s > 0.0) stays_ned_m_ = {place.x, place.y, stays_ned_m_.z};
  hold_depth(goal, dt_s);
  diver::HumanInputs limbs;
  diver::swim(human().body, human().file.swimmer, goal, body, swimmer_, dt_s, limbs);
  const TimeNs now = now_ns();
  claim(inbox, DiverGroup::kBody);
  send(inbox, PayloadKind::kBodyJoints, BodyJoints{limbs.joints, limbs.other_power_w}, now);
  claim(inbox, DiverGroup::kButtons);
  const std::uint64_t pressed = input_.jacket != 0 ? input_.jacket : limbs.buttons;
  send(inbox, PayloadKind::kButtons, JacketButtons{pressed}, now);
  claim(inbox, DiverGroup::kBreath);
  if (!is_others(DiverGroup::kBreath))  // a monitor's breath is its own
    send(inbox, PayloadKind::kBreath, Breath{.bias_m3 = limbs.breath_bias_m3}, now);
}

}  // namespace neritic::testbed
