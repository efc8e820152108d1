#include "testbed/view/wearer.hpp"

#include <algorithm>

#include "diver/frames.hpp"
#include "diver/jacket.hpp"
#include "diver/reach.hpp"
#include "testbed/view/dive_camera.hpp"

namespace neritic::testbed {
namespace {

// A frame that sends nothing for so long has let go (kDiverHold_s is of the same order).
constexpr double kHold_s = 0.5;
constexpr double kPush = 0.1;                         // of a stick: less is its rest
constexpr double kSpeed_m_s = 0.5, kFast_m_s = 0.68;  // with full gear (diver/swimmer.hpp)
constexpr double kAhead_m = 5.0;                      // of the place that is swum to
constexpr double kLongestStep_s = 0.05;

}  // namespace

Wearer::Wearer(LivePhysics& physics)
    : physics_(&physics), gaze_(diver::headset_gaze(diver::GazeMethod::kVelocity)) {
  const diver::Body& body = human().body;
  const Vec3 eyes =
      diver::body_from_eyes(body, diver::posture_of(body, diver::straight_joints(), {})).position_m;
  eyes_m_ = {eyes.y, eyes.x, -eyes.z};  // of forward, starboard, down (diver/frames.hpp)
}

// The wearer faces where the diver's crown points, of a swimmer, or the chest, of one upright.
Pose Wearer::world_from_stage(const scene::MotionSource& motion, double time_s) const {
  scene::Mount hips;
  hips.object = static_cast<int>(human().object);
  const Pose body = motion.world_from(hips, time_s);
  const Vec3 ahead = body.rotation * Vec3(0, 1, -1);
  return {body * eyes_m_, from_yaw_pitch_roll(std::atan2(-ahead.x, -ahead.z), 0.0, 0.0)};
}

void Wearer::take(const xr::DisplayFrame& frame, const DiveInput& input) {
  world_from_head_ = frame.world_from_head;
  tracked_ = frame.tracked;
  input_ = input;
  fresh_ = true;
}

void Wearer::send(SampleInbox& inbox, PayloadKind kind, const Payload& payload,
                  TimeNs captured_ns) {
  const TimeNs now = now_ns();
  const StreamId stream = physics_->world().streams().id(OwnerSort::kDiver, 0, kind);
  inbox.push({{stream, *source_, sequences_[static_cast<std::size_t>(kind)]++,
               std::min(captured_ns, now), now},
              payload});
}

// Once a group. A device that the scene names keeps its group.
void Wearer::claim(SampleInbox& inbox, DiverGroup group) {
  if (std::exchange(claimed_[static_cast<std::size_t>(group)], true)) return;
  if (physics_->world().start_inputs().humans()[0].of(group).authority == Authority::kLive) return;
  Event event{.group = static_cast<std::uint64_t>(group)};
  event.authority = static_cast<std::uint64_t>(Authority::kLive);
  event.source = *source_;
  event.hold_s = kHold_s;
  send(inbox, PayloadKind::kEvent, event, now_ns());
}

Status Wearer::poll(SampleInbox& inbox, double scene_time_s) {
  if (swims_) swim(inbox, scene_time_s);
  if (!std::exchange(fresh_, false)) return {};
  if (!world_from_head_ && input_.jacket == 0) return {};
  if (!source_) {
    NERITIC_TRY(source_, inbox.open("wearer"));
  }
  const TimeNs now = now_ns();
  if (world_from_head_) {
    claim(inbox, DiverGroup::kHead);
    send(inbox, PayloadKind::kHeadPose, HeadPose{*world_from_head_, 1}, now);
  }
  HandPoses hands;
  for (std::size_t i = 0; i < 2; ++i) {
    if (!tracked_.hands[i]) continue;
    hands.world_from_hand[i] = *tracked_.hands[i];
    hands.tracked |= std::uint64_t{1} << i;
  }
  if (hands.tracked != 0) {
    claim(inbox, DiverGroup::kHands);
    send(inbox, PayloadKind::kHandPoses, hands, now);
  }
  if (tracked_.gaze) send_gaze(inbox, *tracked_.gaze);
  pushes_ = world_from_head_ && glm::length(input_.move) > kPush;
  if (pushes_ && !swims_) {
    swims_ = true;
    swimmer_ = state().swimmer;
    stays_ned_m_ = state().human.root.position_ned_m;
    swum_s_ = scene_time_s;
    claim(inbox, DiverGroup::kBody);
  }
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

// The swimmer's own kick, towards where the head looks and the sticks push; without a push the
// diver stays at the place. The buttons trim too, as under the autopilot.
void Wearer::swim(SampleInbox& inbox, double scene_time_s) {
  const double dt_s = std::min(scene_time_s - swum_s_, kLongestStep_s);
  if (!(dt_s > 0.0)) return;
  swum_s_ = scene_time_s;
  const diver::HumanState& body = state().human;
  diver::SwimGoal goal{stays_ned_m_, 0.0};
  if (pushes_ && world_from_head_) {
    const Vec3 push = world_from_head_->rotation * Vec3(input_.move.x, 0.0, input_.move.z) +
                      Vec3(0.0, input_.move.y, 0.0);
    const double share = std::min(1.0, glm::length(push));
    stays_ned_m_ = body.root.position_ned_m;
    goal = {stays_ned_m_ + diver::ned_from_world(push) * (kAhead_m / std::max(share, kPush)),
            share * (input_.fast ? kFast_m_s : kSpeed_m_s)};
  }
  diver::HumanInputs limbs;
  diver::swim(human().body, human().file.swimmer, goal, body, swimmer_, dt_s, limbs);
  const TimeNs now = now_ns();
  send(inbox, PayloadKind::kBodyJoints, BodyJoints{limbs.joints, limbs.other_power_w}, now);
  claim(inbox, DiverGroup::kButtons);
  const std::uint64_t pressed = input_.jacket != 0 ? input_.jacket : limbs.buttons;
  send(inbox, PayloadKind::kButtons, JacketButtons{pressed}, now);
}

}  // namespace neritic::testbed
