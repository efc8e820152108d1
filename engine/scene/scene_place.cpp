// Turns the names that placements mention into indices, and look_at into rotations. Positions hang
// on parents; a look_at hangs on the target's position only, so two things may face each other; of
// what moves, the position at time 0. A chain that returns to itself is refused. One thread.
#include <map>
#include <set>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/motion.hpp"
#include "engine/scene/scene_draft.hpp"

namespace neritic::scene {
namespace {

class Placer {
 public:
  Placer(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models)
      : draft_(draft), models_(models) {}

  Status place() {
    for (std::size_t i = 0; i < draft_.objects.size(); ++i) {
      const ObjectDraft& object = draft_.objects[i];
      const auto [at, is_new] = index_.emplace(object.object.name, static_cast<int>(i));
      if (!is_new) return twice(object.place, object.object.name);
      names_.push_back(object.object.name);
    }
    NERITIC_TRY_STATUS(check_sensor_names());
    for (ObjectDraft& object : draft_.objects) {
      NERITIC_TRY_STATUS(hang(object.placement, object.object.mount));
    }
    pose_state_.assign(draft_.objects.size(), State::kOpen);
    for (std::size_t i = 0; i < draft_.objects.size(); ++i) NERITIC_TRY_STATUS(settle(i));
    for (auto& camera : draft_.cameras)
      NERITIC_TRY_STATUS(place_sensor(camera.placement, camera.sensor.mount));
    for (auto& sonar : draft_.sonars)
      NERITIC_TRY_STATUS(place_sensor(sonar.placement, sonar.sensor.mount));
    for (auto& lamp : draft_.lamps)
      NERITIC_TRY_STATUS(place_sensor(lamp.placement, lamp.sensor.mount));
    return {};
  }

 private:
  enum class State { kOpen, kBusy, kDone };

  static Error twice(const std::string& place, const std::string& name) {
    return refusal(place, fmt::format("\"{}\" a second time", name), "a name of its own");
  }

  Status check_sensor_names() const {
    std::set<std::string> views, eyes, lamps;  // a view's name is a folder's
    for (const auto& camera : draft_.cameras) {
      if (!views.insert(camera.sensor.name).second) return twice(camera.place, camera.sensor.name);
      if (camera.sensor.stereo_baseline_m > 0.0)
        for (const char* side : {"_left", "_right"}) eyes.insert(camera.sensor.name + side);
    }
    for (const auto& sonar : draft_.sonars)
      if (!views.insert(sonar.sensor.name).second) return twice(sonar.place, sonar.sensor.name);
    for (const auto& camera : draft_.cameras) NERITIC_TRY_STATUS(no_eye(eyes, camera));
    for (const auto& sonar : draft_.sonars) NERITIC_TRY_STATUS(no_eye(eyes, sonar));
    for (const auto& lamp : draft_.lamps)
      if (!lamps.insert(lamp.sensor.name).second) return twice(lamp.place, lamp.sensor.name);
    return {};
  }

  // A stereo camera's outputs carry the names of its eyes.
  template <class Sensor>
  static Status no_eye(const std::set<std::string>& eyes, const MountedDraft<Sensor>& view) {
    if (!eyes.contains(view.sensor.name)) return {};
    return refusal(view.place,
                   fmt::format("\"{}\", the name of a stereo camera's eye", view.sensor.name),
                   "another");
  }

  Result<int> find(const std::string& name, const std::string& place) const {
    if (name.empty()) return -1;
    if (const auto at = index_.find(name); at != index_.end()) return at->second;
    return refusal(
        place, fmt::format("\"{}\"", printable(name)),
        fmt::format(
            "the name of an object or vehicle{}",
            names_.empty() ? std::string() : fmt::format(" (nearest: {})", nearest(name, names_))));
  }

  Mount& mount_of(std::size_t i) { return draft_.objects[i].object.mount; }

  // On which object, and on which of its joints.
  Status hang(const PlacementDraft& placement, Mount& mount) const {
    NERITIC_TRY(mount.object, find(placement.on, placement.place_on));
    if (placement.joint.empty()) return {};
    const Object& carrier = draft_.objects[static_cast<std::size_t>(mount.object)].object;
    NERITIC_TRY(mount.joint, find_joint(carrier, models_, placement.joint, placement.place_joint));
    return {};
  }

  // Settles the object's parent: then its position in the world is known.
  Status settle_parent(std::size_t i) {
    const int parent = mount_of(i).object;
    if (parent < 0) return {};
    return settle(static_cast<std::size_t>(parent));
  }

  // Settles the object's pose: its parents first, then what it looks at.
  Status settle(std::size_t i) {
    ObjectDraft& object = draft_.objects[i];
    if (pose_state_[i] == State::kDone) return {};
    if (pose_state_[i] == State::kBusy || ++depth_ > kMaxDepth)
      return refusal(
          object.placement.on.empty() ? object.placement.place_look_at : object.placement.place_on,
          fmt::format("{}, which hangs on itself through on or look_at", object.object.name),
          fmt::format("no such loop, at most {} steps", kMaxDepth));
    pose_state_[i] = State::kBusy;
    NERITIC_TRY_STATUS(settle_parent(i));
    NERITIC_TRY_STATUS(put(object.placement, object.object.mount));
    pose_state_[i] = State::kDone;
    --depth_;
    return {};
  }

  // The placement's pose in its parent's frame. The parent is settled.
  Result<Pose> resolve(const PlacementDraft& placement, const Mount& mount) {
    if (placement.look_at_m) return look_at(placement.pose.position_m, *placement.look_at_m);
    if (placement.look_at.empty()) return placement.pose;
    NERITIC_TRY(const int target, find(placement.look_at, placement.place_look_at));
    const auto target_index = static_cast<std::size_t>(target);
    NERITIC_TRY_STATUS(settle_parent(target_index));
    const Vec3 target_in_world = world_from_carrier(draft_, models_, mount_of(target_index)) *
                                 draft_.objects[target_index].placement.pose.position_m;
    const Vec3 target_m = inverse(world_from_carrier(draft_, models_, mount)) * target_in_world;
    if (target_m == placement.pose.position_m)
      return refusal(placement.place_look_at,
                     fmt::format("{} at the place from which it is looked at", placement.look_at),
                     "another place");
    return look_at(placement.pose.position_m, target_m);
  }

  // Gives a mount whose parent is settled its pose and, where it moves, its track.
  Status put(const PlacementDraft& placement, Mount& mount) {
    NERITIC_TRY(mount.pose, resolve(placement, mount));
    if (!placement.track) return {};
    mount.track = make_track(*placement.track, mount.pose.rotation);
    mount.pose = mount.pose_at(0.0);
    return {};
  }

  Status place_sensor(const PlacementDraft& placement, Mount& mount) {
    NERITIC_TRY_STATUS(hang(placement, mount));
    return put(placement, mount);
  }

  static constexpr int kMaxDepth = 64;
  SceneDraft& draft_;
  const std::vector<std::shared_ptr<const Model>>& models_;
  std::map<std::string, int> index_;
  std::vector<std::string_view> names_;
  std::vector<State> pose_state_;
  int depth_ = 0;
};

}  // namespace

Result<int> find_joint(const Object& object,
                       const std::vector<std::shared_ptr<const Model>>& models,
                       const std::string& name, const std::string& place) {
  const std::string found = fmt::format("\"{}\"", printable(name));
  if (object.model < 0 || object.instance_count() > 1)
    return refusal(place, fmt::format("{} of {}", found, object.name),
                   "a node of an object that is drawn once");
  const Model& model = *models[static_cast<std::size_t>(object.model)];
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < model.nodes.size(); ++i) {
    if (model.nodes[i].name == name) return static_cast<int>(i);
    names.push_back(model.nodes[i].name);
  }
  return refusal(place, found,
                 fmt::format("a node of {}'s model{}", object.name,
                             names.empty() ? std::string()
                                           : fmt::format(" (nearest: \"{}\")",
                                                         printable(nearest(name, names)))));
}

Pose world_from_carrier(const SceneDraft& draft,
                        const std::vector<std::shared_ptr<const Model>>& models,
                        const Mount& mount) {
  Pose pose;
  for (const Mount* at = &mount; at->object >= 0;) {
    const Object& carrier = draft.objects[static_cast<std::size_t>(at->object)].object;
    if (at->joint >= 0) {
      const Model& model = *models[static_cast<std::size_t>(carrier.model)];
      pose = object_from_joint(evaluate_node(model, at->joint, carrier.clip, carrier.clip_offset_s),
                               carrier.scale) *
             pose;
    }
    pose = carrier.mount.pose * pose;
    at = &carrier.mount;
  }
  return pose;
}

Status place_all(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models) {
  return Placer(draft, models).place();
}

}  // namespace neritic::scene
