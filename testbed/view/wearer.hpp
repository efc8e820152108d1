// A person as the scene's first diver: head, hands, gaze and swimming of a headset's wearer, and
// in a window the jacket's buttons, swimming by keys and where the view points, become samples of
// the source "wearer", as those of any other device. The stage goes with the diver's body, level,
// so that the wearer's eyes are the diver's; it turns by the wearer's stick, and with a body that
// turns off it, but not with its strokes. Hands that begin to be tracked come to their place within
// two seconds, from where the body had them. A wearer who swims turns the head alone: a head in its
// tracked place bends the spine, by which a swimmer steers. Rendering thread.
#pragma once

#include <optional>

#include "diver/gaze_events.hpp"
#include "diver/swimmer.hpp"
#include "engine/scene/motion.hpp"
#include "engine/xr/display.hpp"
#include "testbed/motion/live_physics.hpp"
#include "testbed/samples/source.hpp"
#include "testbed/view/dive_input.hpp"
#include "testbed/view/host_hold.hpp"

namespace neritic::testbed {

class Wearer final : public SampleSource {
 public:
  // Precondition: the scene has a diver that moves by physics.
  explicit Wearer(LivePhysics& physics);

  // Where the stage lies for a head that is where the wearer recentred. From then on what is
  // tracked rides with the body: a step between two frames moves both.
  Pose world_from_stage(const scene::MotionSource& motion, double time_s);
  // The wearer's acts in this frame; frame.world_from_head tells whether he is tracked.
  // world_from_eyes: in a window, the view out of the eyes of the diver whom the keys swim: the
  // gaze is where its middle points, and ahead is there. Nothing: another view is shown. speed:
  // seconds of the scene in one of the host. elapsed_s: since the frame before.
  void take(const xr::DisplayFrame& frame, const DiveInput& input,
            const std::optional<Quat>& world_from_eyes = {}, double speed = 1.0,
            double elapsed_s = 0.0);
  // The stage faces where the body does.
  void face_ahead() { followed_s_.reset(); }
  // Without a headset: the keys swim the diver from now on, or no longer. Ahead is where he swims,
  // or where his own view points.
  void swim_by_keys(bool on);
  bool swum_by_keys() const { return by_keys_; }
  std::size_t object() const { return human().object; }
  // Sends it, once a frame, and the limbs of whoever swims by hand. The wearer gets authority over
  // groups of inputs that no other device has. kBadInput if the inbox has no room for the source.
  Status poll(SampleInbox& inbox, double scene_time_s) override;

 private:
  void send(SampleInbox& inbox, PayloadKind kind, const Payload& payload, TimeNs captured_ns);
  bool is_others(DiverGroup group) const;  // a device's that the scene names
  void claim(SampleInbox& inbox, DiverGroup group);
  void let_go(SampleInbox& inbox);
  void let_go(SampleInbox& inbox, DiverGroup group);
  bool begins_by_keys() const;
  bool begins_by_sticks() const;
  void begin_swimming(double scene_time_s);
  void hold_depth(diver::SwimGoal& goal, double dt_s);
  std::optional<diver::SwimGoal> pushed() const;
  std::optional<diver::SwimGoal> turned();
  diver::SwimGoal pushed_by_keys();
  Pose riding(const Pose& world_from_tracked) const;
  HeadPose head_pose(double scene_time_s);
  struct Begun;
  Begun begin_hand(bool right, const Pose& tracked, double scene_time_s) const;
  Pose eased_hand(bool right, const Pose& tracked, const Begun& begun, double scene_time_s) const;
  HandPoses hand_poses(double scene_time_s);
  void swim(SampleInbox& inbox, double scene_time_s);
  void send_gaze(SampleInbox& inbox, const xr::Tracked::Gaze& gaze);
  void send_view(SampleInbox& inbox, TimeNs now);
  const PhysicsHuman& human() const { return physics_->world().humans().front(); }
  const HumanPhysics& state() const { return physics_->shown().humans()[0]; }

  LivePhysics* physics_;
  std::optional<SourceId> source_;  // opened with the first sample
  Vec3 eyes_m_;  // of a straight body, in a standing person's axes, from the hips
  std::optional<Pose> world_from_head_;
  std::optional<Pose> world_from_body_;  // the hips when the stage was placed
  // The stage's yaw: of the body, without its sway, and what the stick added.
  double followed_rad_ = 0.0, added_rad_ = 0.0;
  std::optional<double> followed_s_;  // when that of the body was taken
  bool turns_body_ = false;           // towards where the head looks
  xr::Tracked tracked_;
  // A hand that is tracked: since when, in the scene's time, how long it comes to its place, and
  // how far off it was then, as its arm sees it (diver/reach.hpp), riding with the body.
  struct Begun {
    double at_s = 0.0, lasts_s = 0.0;
    Vec3 off{0.0};
    Quat turned_off{1.0, 0.0, 0.0, 0.0};
  };
  std::array<std::optional<Begun>, 2> hands_begun_;
  std::optional<double> let_go_s_;  // when the head of one who swims was let go of its place
  DiveInput input_;
  bool fresh_ = false;                                 // those were not sent yet
  HostHold hold_;                                      // of what is claimed
  std::array<bool, kDiverGroups> claimed_{}, told_{};  // told_: with the hold as it is now
  std::array<std::uint64_t, kPayloadKinds> sequences_{};
  diver::GazeMonitor gaze_;
  TimeNs gazed_ns_ = 0;
  std::optional<Quat> world_from_eyes_;  // of a window's view out of them
  diver::GazeState viewed_;              // where that pointed last
  bool views_ = false;                   // it was sent as gaze
  // Swimming by hand, from the first push on.
  bool swims_ = false, by_keys_ = false, began_by_keys_ = false;
  double yaw_rad_ = 0.0;  // by keys: the course that is held
  diver::SwimmerState swimmer_;
  Vec3 stays_ned_m_{0.0};   // its depth is held too while he swims level
  double settles_s_ = 0.0;  // until the way up or down that was let go of has ended
  double swum_s_ = 0.0;
};

}  // namespace neritic::testbed
