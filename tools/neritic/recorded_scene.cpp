#include "tools/neritic/recorded_scene.hpp"

#include <chrono>

#include "engine/core/log.hpp"
#include "engine/core/refusal.hpp"
#include "engine/render/water_optics.hpp"
#include "testbed/simulation/human_world.hpp"
#include "tools/neritic/load_scene.hpp"

namespace neritic::tools {
using namespace testbed;

namespace {

// The objects of a scene that its physics moves: participants, things and drawn tethers.
std::vector<bool> moved_in(const scene::Scene& scene) {
  std::vector<bool> moved;
  for (const scene::Object& object : scene.objects)
    moved.push_back(object.dynamics || object.human || object.thing || !object.inputs.empty());
  for (const scene::Object& object : scene.objects)
    if (object.dynamics && object.dynamics->tether) moved[object.dynamics->tether->object] = true;
  return moved;
}

std::vector<std::string> node_names(const scene::Scene& scene, const scene::Object& object) {
  std::vector<std::string> names;
  if (object.model >= 0)
    for (const scene::Node& node : scene.models[static_cast<std::size_t>(object.model)]->nodes)
      names.push_back(node.name);
  return names;
}

// The nodes of this object's model are moved, not the object alone.
bool poses_nodes(const scene::Scene& scene, const scene::Object& object) {
  if (object.human) return true;
  if (object.dynamics || object.model < 0 || !object.copies.empty()) return false;
  if (object.inputs.empty()) return !object.thing;  // a tether
  std::string_view missing;
  drawn_joints_of(*scene.models[static_cast<std::size_t>(object.model)], missing);
  return missing.empty();
}

// The place in `physics` of each object of `shown`, with the participants where those of their
// names are.
Result<std::vector<std::size_t>> places_of(const scene::Scene& shown, const scene::Scene& physics,
                                           const std::string& path) {
  std::vector<std::optional<std::size_t>> places(shown.objects.size());
  const std::vector<bool> taken = moved_in(physics);
  std::vector<std::string> missing;
  for (std::size_t i = 0; i < physics.objects.size(); ++i) {
    const scene::Object& mover = physics.objects[i];
    if (!taken[i]) continue;
    const auto same = std::ranges::find(shown.objects, mover.name, &scene::Object::name);
    if (same == shown.objects.end()) {
      missing.push_back(mover.name);
      continue;
    }
    if (poses_nodes(physics, mover) && node_names(shown, *same) != node_names(physics, mover))
      return refusal(path, fmt::format("{} with another model than was recorded", mover.name),
                     "a model with the same nodes");
    places[static_cast<std::size_t>(same - shown.objects.begin())] = i;
  }
  if (!missing.empty())
    log_warn("{}: nothing here is named {}, as in the recording: not shown", path,
             fmt::join(missing, " or "));
  std::size_t next = 0;
  std::vector<std::size_t> out;
  for (const auto& place : places) {
    if (!place)
      while (next < taken.size() && taken[next]) ++next;
    out.push_back(place ? *place : next++);
  }
  return out;
}

// Moves each object to its place, and what refers to it; a place that nothing has is empty.
void renumber(scene::Scene& scene, const std::vector<std::size_t>& places, std::size_t least) {
  std::size_t count = least;
  for (const std::size_t place : places) count = std::max(count, place + 1);
  std::vector<scene::Object> objects(count);
  for (std::size_t i = 0; i < places.size(); ++i) objects[places[i]] = std::move(scene.objects[i]);
  scene.objects = std::move(objects);
  const auto follow = [&](scene::Mount& mount) {
    if (mount.object >= 0)
      mount.object = static_cast<int>(places[static_cast<std::size_t>(mount.object)]);
  };
  for (scene::Object& object : scene.objects) follow(object.mount);
  for (scene::Camera& camera : scene.cameras) follow(camera.mount);
  for (scene::Sonar& sonar : scene.sonars) follow(sonar.mount);
  for (scene::Lamp& lamp : scene.lamps) follow(lamp.mount);
  for (scene::ModelLight& light : scene.model_lights) light.object = places[light.object];
}

}  // namespace

Result<scene::Scene> shown_scene(const SampleLog& log, const std::string& file,
                                 const std::string& path, const std::string& size,
                                 const ShownChanges& changes, const scene::Scene& physics,
                                 const scene::SceneOptions& options) {
  scene::SceneOptions all = options;
  for (const std::string& more : changes.added) all.added.emplace_back(more);
  NERITIC_TRY(scene::Scene shown, changes.scene.empty()
                                      ? recorded_scene(log, file, path, size, all)
                                      : load_scene_or_model(changes.scene, size, all));
  NERITIC_TRY(const auto places, places_of(shown, physics, shown.path));
  renumber(shown, places, physics.objects.size());
  NERITIC_TRY_STATUS(set_water(shown, changes.water, shown.path));
  return shown;
}

Result<scene::Scene> recorded_scene(const SampleLog& log, const std::string& file,
                                    const std::string& path, const std::string& size,
                                    scene::SceneOptions options) {
  if (path.empty()) {
    if (log.scene_text.empty())
      return refusal(file, "a recording without its scene",
                     "one with it, or SCENE beside --replay");
    options.text = log.scene_text;
  }
  NERITIC_TRY(scene::Scene scene,
              load_scene_or_model(path.empty() ? log.scene_path : path, size, options));
  scene.seed = log.seed;
  return scene;
}

Status set_water(scene::Scene& scene, const std::string& water, const std::string& path) {
  if (water.empty()) return {};
  if (!scene.water)
    return refusal("--water", fmt::format("{}, which names no water", path),
                   "a scene with a table [water]");
  // The types are written in capitals; a flag may be typed in any.
  std::string type = water;
  std::transform(type.begin(), type.end(), type.begin(),
                 [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  if (const auto known = render::jerlov_optics(type); !known.ok())
    return bad_input("--water: {}", known.error().message);
  scene.water->type = type;
  return {};
}

Result<SampleLog> read_recording(const std::string& file) {
  NERITIC_TRY(SampleLog log, read_sample_log(file));
  if (log.steps() == 0) return refusal(file, "a recording of 0 steps", "1 step or more");
  if (!log.whole)
    log_warn("{}: {}; its {} whole steps are replayed", file,
             log.damage.empty() ? "its run was cut off" : log.damage, log.steps());
  return log;
}

Result<std::optional<SavedState>> start_of(const SampleLog& log, const std::string& file,
                                           const PhysicsWorld& world) {
  std::optional<SavedState> start;
  if (!log.start_state.empty()) {
    NERITIC_TRY(start, parse_state(world.state_format(), log.start_state, file));
  }
  return start;
}

Result<std::unique_ptr<Replay>> Replay::of(SampleLog log, const std::string& file,
                                           const PhysicsWorld& world) {
  const std::uint64_t first = log.first_step;
  NERITIC_TRY(RecordedSource source, source_of(world, std::move(log), file, first));
  // The hashes stay where they are when the source moves.
  const std::span<const std::uint64_t> hashes = source.log().hashes;
  return std::make_unique<Replay>(
      Replay{std::move(source), RecordingCheck(hashes, file, first), file});
}

void Replay::tell() const {
  fmt::print("{}: {} of {} steps, each with the hash that was recorded\n", file,
             check.equal_steps(), steps());
}

Result<RecordingOptions> recording_options(const std::string& scene, bool on_clock) {
  NERITIC_TRY(RecordingOptions options, recording_of_scene(scene));
  if (on_clock)
    options.recorded_at_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(
                                 std::chrono::system_clock::now().time_since_epoch())
                                 .count();
  options.on_failure = [](const std::string& line) {
    log_warn("{}; the run goes on without a recording", line);
  };
  return options;
}

}  // namespace neritic::tools
