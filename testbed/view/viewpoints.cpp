#include "testbed/view/viewpoints.hpp"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/animation.hpp"

namespace neritic::testbed {
namespace {

using Kind = Viewpoint::Kind;

// A chase starts behind, to starboard and above. It turns after the course of the chased in about
// this time, so that no stroke of a fin shakes the picture.
constexpr double kChaseYaw_rad = radians(35.0), kChasePitch_rad = radians(-16.0);
constexpr double kFollow_s = 0.6;
constexpr double kLongestGap_s = 1.0;  // after which it does not turn, but is behind at once
constexpr double kChaseRoom = 1.25;    // distance over that at which the ball fills the picture
constexpr double kLeastAway_m = 1.8, kLeastAway = 0.8, kMostAway = 8.0;
constexpr double kNearer = 1.15;  // a click of the wheel
// Of a diver's head by keys; slow frames turn it by as much as this time.
constexpr double kHeadTurn_rad_s = radians(45.0), kLongestTurn_s = 0.5;

// The bounds of a box's corners, carried into another frame.
void add_corners(scene::Bounds& bounds, const Mat4& to, const scene::Bounds& own) {
  for (int corner = 0; corner < 8; ++corner)
    bounds.add(
        Vec3(to * Vec4((corner & 1 ? own.max : own.min).x, (corner & 2 ? own.max : own.min).y,
                       (corner & 4 ? own.max : own.min).z, 1.0)));
}

Viewpoint chase_of(const scene::Scene& scene, const Participant& participant) {
  Viewpoint out{
      .kind = Kind::kChase, .name = "chase:" + participant.name, .mount = participant.mount};
  const scene::Object& object = scene.objects[static_cast<std::size_t>(participant.mount.object)];
  if (object.model < 0) return out;
  const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
  const scene::Bounds own =
      scene::model_bounds(model, scene::evaluate_pose(model, object.clip, object.clip_offset_s));
  if (own.empty()) return out;
  scene::Bounds bounds;
  const Mat4 object_from_world = glm::inverse(to_matrix(scene.world_from(object.mount)));
  for (std::size_t copy = 0; copy < object.instance_count(); ++copy)
    add_corners(bounds, object_from_world * scene.world_from_copy(object, copy), own);
  out.middle_m = 0.5 * (bounds.min + bounds.max);
  out.radius_m = 0.5 * glm::length(bounds.max - bounds.min);
  return out;
}

bool moves(const DiveInput& input) {
  return input.move.x != 0.0 || input.move.y != 0.0 || input.move.z != 0.0;
}

}  // namespace

int carrier_of(const scene::Scene& scene, const scene::Mount& mount) {
  int carrier = mount.object;
  while (carrier >= 0 && scene.objects[static_cast<std::size_t>(carrier)].mount.object >= 0)
    carrier = scene.objects[static_cast<std::size_t>(carrier)].mount.object;
  return carrier;
}

bool has_body(const Participant& participant) {
  const std::string_view kind = participant.kind;
  return kind != "camera" && kind != "sonar";
}

std::vector<Viewpoint> viewpoints_of(const scene::Scene& scene) {
  NERITIC_CHECK(!scene.cameras.empty(), "no camera");
  std::vector<Viewpoint> out;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i)
    out.push_back({Kind::kCamera, scene.cameras[i].name, i, scene.cameras[i].mount});
  for (const Participant& participant : participants_of(scene))
    if (has_body(participant)) out.push_back(chase_of(scene, participant));
  out.push_back({.name = "free"});
  for (Viewpoint& viewpoint : out) viewpoint.carrier = carrier_of(scene, viewpoint.mount);
  return out;
}

std::size_t first_viewpoint(const scene::Scene& scene) {
  const auto all = viewpoints_of(scene);
  const auto chase = [&](const auto& of_kind) {
    return std::ranges::find_if(all, [&](const Viewpoint& viewpoint) {
      return viewpoint.kind == Kind::kChase &&
             of_kind(scene.objects[static_cast<std::size_t>(viewpoint.mount.object)]);
    });
  };
  auto found = chase([](const scene::Object& object) { return object.human.has_value(); });
  if (found == all.end())
    found = chase([](const scene::Object& object) { return object.dynamics.has_value(); });
  return found == all.end() ? 0 : static_cast<std::size_t>(found - all.begin());
}

std::size_t own_viewpoint(const scene::Scene& scene) {
  const auto diver = std::ranges::find_if(
      scene.objects, [](const scene::Object& object) { return object.human.has_value(); });
  const auto all = viewpoints_of(scene);
  const auto own = std::ranges::find_if(all, [&](const Viewpoint& viewpoint) {
    return viewpoint.kind == Kind::kCamera && diver != scene.objects.end() &&
           viewpoint.carrier == diver - scene.objects.begin();
  });
  return own == all.end() ? first_viewpoint(scene) : static_cast<std::size_t>(own - all.begin());
}

Result<std::size_t> viewpoint_named(const std::string& name, const scene::Scene& scene) {
  std::vector<std::string> known;
  for (const Viewpoint& viewpoint : viewpoints_of(scene)) known.push_back(viewpoint.name);
  const auto found = std::ranges::find(known, name);
  if (found == known.end())
    return refusal("--view", fmt::format("'{}'", name), fmt::format("{}", fmt::join(known, ", ")));
  return static_cast<std::size_t>(found - known.begin());
}

ViewChoice::ViewChoice(const scene::Scene& scene, std::size_t begin)
    : all_(viewpoints_of(scene)),
      begin_(begin),
      chosen_(begin),
      first_pose_(scene.world_from(scene.cameras.front().mount)),
      eye_(first_pose_),
      vertical_fov_rad_(scene.cameras.front().vertical_fov_rad) {
  NERITIC_CHECK(begin < all_.size(), "viewpoint {} of {}", begin, all_.size());
  follow(scene::MotionSource(scene), 0.0);
}

void ViewChoice::choose(std::size_t viewpoint) {
  chosen_ = viewpoint;
  look_yaw_rad_ = look_pitch_rad_ = 0.0;
  away_ = 1.0;
  chasing_ = in_head_ = false;
}

void ViewChoice::choose_on(int carrier) {
  const auto on = std::ranges::find_if(
      all_, [&](const Viewpoint& viewpoint) { return viewpoint.carrier == carrier; });
  if (on != all_.end()) choose(static_cast<std::size_t>(on - all_.begin()));
}

void ViewChoice::take(const DiveInput& input, double elapsed_s, bool flying, int swum) {
  swum_ = swum;
  const auto count = static_cast<int>(all_.size());
  if (input.view_step != 0)
    choose(static_cast<std::size_t>(
        ((static_cast<int>(chosen_) + input.view_step) % count + count) % count));
  if (input.reset) {
    choose(begin_);
    eye_.start_at(first_pose_);
  }
  if (!flying && viewpoint().kind != Kind::kFree && moves(input)) choose(all_.size() - 1);
  if (viewpoint().kind == Kind::kFree) {
    DiveInput own = input;
    if (flying) own.move = Vec3(0.0);
    eye_.update(own, elapsed_s);
  } else if (in_head_ && swum_ >= 0) {
    turn_head(input, elapsed_s);
  } else {
    look_round(input, elapsed_s);
  }
}

void ViewChoice::turn_head(const DiveInput& input, double elapsed_s) {
  DiveInput own = input;
  own.move = Vec3(0.0);
  eye_.update(own, elapsed_s);
  // A stick that looks is no key that turns.
  const double keys = input.look_rate.x != 0.0 ? 0.0 : input.turn;
  eye_.turn(std::clamp(input.move.x + keys, -1.0, 1.0) * kHeadTurn_rad_s *
            std::min(elapsed_s, kLongestTurn_s));
}

void ViewChoice::look_round(const DiveInput& input, double elapsed_s) {
  const Vec2 turn_rad = turn_rad_of(input, elapsed_s);
  look_yaw_rad_ = std::remainder(look_yaw_rad_ - turn_rad.x, 2.0 * kPi);
  look_pitch_rad_ = std::clamp(look_pitch_rad_ - turn_rad.y, -kMaxPitch_rad, kMaxPitch_rad);
  away_ = std::clamp(away_ * std::pow(kNearer, -input.wheel), kLeastAway, kMostAway);
}

// Behind the chased, which stays in the middle of the picture.
Pose ViewChoice::chase(const scene::MotionSource& motion, double time_s) {
  const Viewpoint& chased = viewpoint();
  const Pose world_from_chased = motion.world_from(chased.mount, time_s);
  const double course = course_of(world_from_chased.rotation, chase_yaw_rad_);
  const double passed_s = time_s - chased_s_;
  if (!chasing_ || passed_s < 0.0 || passed_s > kLongestGap_s) {
    chase_yaw_rad_ = course;
  } else {
    chase_yaw_rad_ += std::remainder(course - chase_yaw_rad_, 2.0 * kPi) *
                      (1.0 - std::exp(-passed_s / kFollow_s));
  }
  chasing_ = true;
  chased_s_ = time_s;
  const double pitch = std::clamp(kChasePitch_rad + look_pitch_rad_, -kMaxPitch_rad, kMaxPitch_rad);
  const Quat rotation =
      from_yaw_pitch_roll(chase_yaw_rad_ + kChaseYaw_rad + look_yaw_rad_, pitch, 0.0);
  const double fills_m = chased.radius_m / std::sin(0.5 * vertical_fov_rad_);
  const double away_m = std::max(kLeastAway_m, fills_m * kChaseRoom) * away_;
  const Vec3 middle_m = world_from_chased * chased.middle_m;
  return {middle_m + rotation * Vec3(0.0, 0.0, away_m), rotation};
}

void ViewChoice::follow(const scene::MotionSource& motion, double time_s) {
  if (viewpoint().kind == Kind::kFree) {
    world_from_view_ = eye_.world_from_view();
    return;
  }
  if (viewpoint().kind == Kind::kCamera) {
    world_from_view_ = motion.world_from(viewpoint().mount, time_s);
    if (look_yaw_rad_ != 0.0 || look_pitch_rad_ != 0.0)
      world_from_view_ =
          world_from_view_ * Pose{{}, from_yaw_pitch_roll(look_yaw_rad_, look_pitch_rad_, 0.0)};
    const bool swum = swum_ >= 0 && carrier() == swum_;
    if (swum && in_head_) world_from_view_.rotation = eye_.world_from_view().rotation;
    in_head_ = swum;
  } else {
    world_from_view_ = chase(motion, time_s);
  }
  eye_.start_at(world_from_view_);
}

}  // namespace neritic::testbed
