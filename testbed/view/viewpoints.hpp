// From where a person of `dive` may look: through each camera of the scene, mounted ones riding
// along, from behind each participant, and freely. Plain values; rendering thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/scene/motion.hpp"
#include "testbed/sensors/participants.hpp"
#include "testbed/view/dive_camera.hpp"

namespace neritic::testbed {

struct Viewpoint {
  enum class Kind { kCamera, kChase, kFree };
  Kind kind = Kind::kFree;
  std::string name;        // a camera's; "chase:" and a participant's; "free"
  std::size_t camera = 0;  // whose lens and exposure it has
  scene::Mount mount;      // of the camera, or on the participant
  int carrier = -1;        // the object that carries it, and stands on none; -1: the world
  // kChase: a ball around what is drawn of the participant, in its frame.
  Vec3 middle_m{0.0};
  double radius_m = 0.5;
};

// Not a camera or a sonar, which have no body to look at.
bool has_body(const Participant& participant);

// The object that carries a mount and stands on none; -1: the world.
int carrier_of(const scene::Scene& scene, const scene::Mount& mount);

// Cameras, chases of all that moves by physics, track or clip, free. Precondition: a camera.
std::vector<Viewpoint> viewpoints_of(const scene::Scene& scene);
// Where a dive begins that names no view: behind the first diver that moves by physics, else the
// first such vehicle, else at the first camera.
std::size_t first_viewpoint(const scene::Scene& scene);
// Where a dive begins in which the first diver that moves by physics is swum by keys: the first
// camera that the diver carries, else behind. first_viewpoint() without such a diver.
std::size_t own_viewpoint(const scene::Scene& scene);
// The viewpoint of that name; kBadInput with all names.
Result<std::size_t> viewpoint_named(const std::string& name, const scene::Scene& scene);

// The chosen viewpoint, and where its eye is.
class ViewChoice {
 public:
  // begin: of viewpoints_of(scene), where the dive begins and Home leads back to.
  ViewChoice(const scene::Scene& scene, std::size_t begin);

  const Viewpoint& viewpoint() const { return all_[chosen_]; }
  const std::vector<Viewpoint>& all() const { return all_; }
  void choose(std::size_t viewpoint);
  // The first that the object carries: a camera, else its chase.
  void choose_on(int carrier);
  // Keys of a frame: another viewpoint, the way back, looking round. Moving leaves any other
  // viewpoint for the free one, from where its eye is, unless the keys fly a vehicle. swum: the
  // object of a diver whom the keys swim; -1: none. Out of the eyes of that diver the view turns as
  // a head does, in the world and level, by mouse and keys.
  void take(const DiveInput& input, double elapsed_s, bool flying, int swum = -1);
  // Puts the eye where everything is at that time. A mounted camera's is its pose in `motion`, bit
  // for bit, until the user looks round, or swims the diver that carries it.
  void follow(const scene::MotionSource& motion, double time_s);

  const Pose& world_from_view() const { return world_from_view_; }
  // The eye as angles and a place; its roll is left out.
  const FreeCamera& eye() const { return eye_; }
  int carrier() const { return viewpoint().carrier; }
  // Where the view out of the eyes of the swum diver points, as it was shown last; nothing: another
  // view was.
  std::optional<Quat> world_from_eyes() const {
    return in_head_ ? std::optional(world_from_view_.rotation) : std::nullopt;
  }

 private:
  void look_round(const DiveInput& input, double elapsed_s);
  void turn_head(const DiveInput& input, double elapsed_s);
  Pose chase(const scene::MotionSource& motion, double time_s);

  std::vector<Viewpoint> all_;
  std::size_t begin_, chosen_;
  Pose first_pose_;  // of the free viewpoint
  FreeCamera eye_;
  Pose world_from_view_;
  double vertical_fov_rad_;                           // of the camera whose lens it has
  double look_yaw_rad_ = 0.0, look_pitch_rad_ = 0.0;  // looking round; of a chase: its place
  double away_ = 1.0;                                 // of a chase: distance over that at the start
  double chase_yaw_rad_ = 0.0, chased_s_ = 0.0;       // smoothed course of the chased, and when
  bool chasing_ = false;                              // those are known
  int swum_ = -1;                                     // the object of the diver whom the keys swim
  bool in_head_ = false;                              // the view turns as the head of that diver
};

}  // namespace neritic::testbed
