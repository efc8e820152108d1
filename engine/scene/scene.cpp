// Loads a scene: includes, keys, models, places, copies, labels; each step a file of its own.
#include "engine/scene/scene.hpp"

#include <algorithm>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/core/refusal.hpp"
#include "engine/core/text.hpp"
#include "engine/scene/flock_motion.hpp"
#include "engine/scene/model_lights.hpp"
#include "engine/scene/motion.hpp"
#include "engine/scene/scene_copies.hpp"
#include "engine/scene/scene_draft.hpp"
#include "engine/scene/scene_reader.hpp"
#include "engine/scene/small_targets.hpp"

namespace neritic::scene {
namespace {

Status find_clips(SceneDraft& draft, const std::vector<std::shared_ptr<const Model>>& models) {
  for (ObjectDraft& object : draft.objects) {
    if (object.clip.empty()) continue;
    const Model& model = *models[static_cast<std::size_t>(object.object.model)];
    NERITIC_TRY(object.object.clip, find_clip(model, object.clip, object.place_clip));
  }
  return {};
}

// Gives every copy a label of its own, from 1.
Status number_instances(SceneDraft& draft) {
  std::size_t next = 1;
  for (ObjectDraft& object : draft.objects) {
    const std::size_t count = object.object.instance_count();
    if (count > kMaxInstances + 1 - next)
      return refusal(
          object.place,
          fmt::format("{} copies, which make {} instances in all", count, next - 1 + count),
          fmt::format("at most {} (16-bit labels)", kMaxInstances));
    object.object.instance = static_cast<std::uint16_t>(next);
    next += count;
  }
  return {};
}

// Vehicle settings in world coordinates.
// Beds move with the scene; layers keep their depth, as the surface does.
void move_out(Water& water, const Vec3& offset_m) {
  if (water.murk) water.murk->bed_depth_m -= offset_m.y;
  for (SiltSource& silt : water.silt) silt.bed_depth_m -= offset_m.y;
}

void move_out(Dynamics& dynamics, const Vec3& offset_m) {
  if (dynamics.tether_anchor_m) *dynamics.tether_anchor_m += offset_m;
  if (!dynamics.mission) return;
  Mission& mission = *dynamics.mission;
  const auto move_facing = [&offset_m](Facing& facing) {
    if (facing.look_at) facing.look_at->point_m += offset_m;
  };
  move_facing(mission.facing);
  mission.target.point_m += offset_m;
  for (MissionWaypoint& waypoint : mission.waypoints) {
    waypoint.position_m += offset_m;
    move_facing(waypoint.facing);
  }
}

void move_out(SceneDraft& draft, const Vec3& offset_m) {
  Scene& scene = draft.scene;
  if (scene.current) scene.current->origin_m += offset_m;
  if (scene.ambient && scene.ambient->bottom_depth_m) *scene.ambient->bottom_depth_m -= offset_m.y;
  if (scene.ambient && scene.ambient->skylight) {
    scene.ambient->skylight->low_m += offset_m;
    scene.ambient->skylight->high_m += offset_m;
  }
  if (scene.world_from_lab) scene.world_from_lab->position_m += offset_m;
  if (scene.water) move_out(*scene.water, offset_m);
  const auto moved = [&offset_m](Mount mount) {
    if (mount.object >= 0) return mount;
    mount.pose.position_m += offset_m;
    if (mount.track)
      for (Track::Place& place : mount.track->places) place.position_m += offset_m;
    return mount;
  };
  for (ObjectDraft& object : draft.objects) {
    object.object.mount = moved(object.object.mount);
    if (object.object.dynamics) move_out(*object.object.dynamics, offset_m);
    // Into the copies, so that object_from_copy is all there is to a copy.
    for (Mat4& copy : object.object.copies) copy = glm::scale(copy, object.object.scale);
    if (!object.object.copies.empty()) object.object.scale = Vec3(1.0);
    scene.objects.push_back(std::move(object.object));
  }
  const auto move_sensors = [&moved](auto& from, auto& to) {
    for (auto& sensor : from) {
      sensor.sensor.mount = moved(sensor.sensor.mount);
      to.push_back(std::move(sensor.sensor));
    }
  };
  move_sensors(draft.cameras, scene.cameras);
  move_sensors(draft.sonars, scene.sonars);
  move_sensors(draft.lamps, scene.lamps);
}

// The quality of sonars: as asked for, else as their file says, else chosen.
void choose_sampling(Scene& scene, const std::string& asked) {
  constexpr std::size_t kFew = 4;
  const bool few = scene.sonars.size() <= kFew;
  const char* level = few ? "standard" : "draft";
  std::vector<std::string> chosen;
  for (Sonar& sonar : scene.sonars) {
    if (!asked.empty()) {
      sonar.quality = asked;
      sonar.max_error = 0.0;
      sonar.quality_chosen = false;
    } else if (sonar.quality_chosen) {
      sonar.quality = level;
      if (few) sonar.least_target_m = least_target_m(scene, sonar);
      chosen.push_back(sonar.name);
    }
  }
  if (chosen.empty()) return;
  scene.notes.push_back(fmt::format("{}: {}: no quality is named, so \"{}\" it is; {}", scene.path,
                                    fmt::join(chosen, ", "), level,
                                    few ? "quality = \"draft\" is faster"
                                        : fmt::format("at most {} sonars get \"standard\"", kFew)));
}

// Names to indices, and the copies at time 0.
Status resolve_flocks(Scene& scene) {
  for (Object& object : scene.objects) {
    if (!object.flock) continue;
    for (const std::string& name : object.flock->avoid_names) {
      const auto at = std::ranges::find(scene.objects, name, &Object::name);
      if (at == scene.objects.end())
        return refusal(object.flock->place_avoid, fmt::format("\"{}\"", name),
                       "the name of an object of the scene");
      object.flock->avoid.push_back(static_cast<std::size_t>(at - scene.objects.begin()));
    }
  }
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    if (scene.objects[i].flock) scene.objects[i].copies = flock_copies(MotionSource(scene), i, 0.0);
  return {};
}

}  // namespace

Pose Scene::world_from(const Mount& mount, double time_s) const {
  return MotionSource(*this).world_from(mount, time_s);
}

Mat4 Scene::world_from_copy(const Object& object, std::size_t copy, double time_s) const {
  const Mat4 world_from_object = to_matrix(world_from(object.mount, time_s));
  const bool single = object.copies.empty();
  return glm::scale(single ? world_from_object : world_from_object * object.copies.at(copy),
                    object.scale);
}

Result<Scene> load_scene(const std::filesystem::path& path, const SceneOptions& options) {
  NERITIC_TRY(const SceneSource source, read_scene_source(path, options.text, options.added));
  NERITIC_TRY(SceneDraft draft, read_draft(source));
  NERITIC_TRY(LoadedModels loaded, load_models(draft.requests));
  for (ObjectDraft& object : draft.objects)
    if (object.request) object.object.model = loaded.model_of_request[*object.request];
  NERITIC_TRY_STATUS(find_clips(draft, loaded.models));
  NERITIC_TRY_STATUS(place_all(draft, loaded.models));
  NERITIC_TRY_STATUS(scatter_all(draft, loaded.models));
  NERITIC_TRY_STATUS(number_instances(draft));
  move_out(draft, options.offset_m);
  for (const auto& model : loaded.models)
    for (const std::string& note : model->notes)
      if (std::find(draft.scene.notes.begin(), draft.scene.notes.end(), note) ==
          draft.scene.notes.end())
        draft.scene.notes.push_back(note);
  draft.scene.models = std::move(loaded.models);
  NERITIC_TRY_STATUS(resolve_water_sources(draft.scene));
  NERITIC_TRY_STATUS(resolve_water_column(draft.scene));
  NERITIC_TRY_STATUS(resolve_flocks(draft.scene));
  choose_model_lights(draft.scene);
  choose_sampling(draft.scene, options.sonar_quality);
  return std::move(draft.scene);
}

}  // namespace neritic::scene
