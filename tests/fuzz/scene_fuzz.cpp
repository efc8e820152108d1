// Any bytes as a scene file: an Error in one line, or a scene whose references lead somewhere and
// whose places are finite. The file lies in a scratch folder among the sensors and vehicles that
// the scenes of assets/ include; named models become spheres, so that a mutation costs a
// millisecond, not a loading.
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/fuzz/replay.hpp"

namespace {
namespace fs = std::filesystem;
using namespace neritic;

std::string with_spheres(std::string text) {
  const std::string model = "model = \"../models/", sphere = "shape = \"sphere\"";
  for (auto at = text.find(model); at != text.npos; at = text.find(model, at + sphere.size())) {
    const auto end = text.find_first_of("\"\n", at + model.size());
    text.replace(at, (end == text.npos ? text.size() : end + (text[end] == '"')) - at, sphere);
  }
  return text;
}

void write(const fs::path& path, const std::string& text) {
  const Status written = write_text(path, text);
  NERITIC_CHECK(written.ok(), "{}", written.error().message);
}

// ROOT/scenes, and ROOT/sensors and ROOT/vehicles filled from assets/. Removed at the end.
struct Folder {
  fs::path root = fs::temp_directory_path() / ("neritic_scene_fuzz_" + std::to_string(::getpid()));
  Folder() {
    fs::create_directories(root / "scenes");
    fs::copy(fs::path(NERITIC_ASSETS) / "scenes" / "instances.csv", root / "scenes");
    const auto wreck = read_text(fs::path(NERITIC_ASSETS) / "scenes" / "wreck.toml");
    NERITIC_CHECK(wreck.ok(), "{}", wreck.error().message);
    write(root / "scenes" / "wreck.toml", with_spheres(*wreck));  // which mission.toml includes
    for (const char* name : {"sensors", "vehicles"}) {
      fs::create_directories(root / name);
      for (const auto& entry : fs::directory_iterator(fs::path(NERITIC_ASSETS) / name)) {
        if (entry.path().extension() != ".toml") continue;
        const auto text = read_text(entry.path());
        NERITIC_CHECK(text.ok(), "{}", text.error().message);
        write(root / name / entry.path().filename(), with_spheres(*text));
      }
    }
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(root, ignored);
  }
};

void check_mount(const scene::Scene& scene, const scene::Mount& mount) {
  NERITIC_CHECK(mount.object >= -1 && mount.object < static_cast<int>(scene.objects.size()),
                "mount on object {}", mount.object);
  if (mount.joint >= 0) {
    const int model = mount.object < 0 ? -1 : scene.objects[std::size_t(mount.object)].model;
    NERITIC_CHECK(
        model >= 0 && std::size_t(mount.joint) < scene.models[std::size_t(model)]->nodes.size(),
        "joint {} of object {}", mount.joint, mount.object);
  }
  const Pose pose = scene.world_from(mount);
  for (int i = 0; i < 3; ++i) NERITIC_CHECK(std::isfinite(pose.position_m[i]), "position");
  NERITIC_CHECK(std::abs(glm::length(pose.rotation) - 1.0) < 1e-6, "rotation");
}

void check_aim(const scene::Scene& scene, const scene::Aim& aim) {
  NERITIC_CHECK(aim.object >= -1 && aim.object < static_cast<int>(scene.objects.size()),
                "aim at object {}", aim.object);
  for (int i = 0; i < 3; ++i) NERITIC_CHECK(std::isfinite(aim.point_m[i]), "aim");
}

void check_physics(const scene::Scene& scene) {
  NERITIC_CHECK(scene.physics || !scene.current, "a current without physics");
  for (const scene::Object& object : scene.objects) {
    NERITIC_CHECK(scene.physics || object.collision == scene::Collision::kNone, "solid");
    if (!object.dynamics) continue;
    NERITIC_CHECK(scene.physics && object.model >= 0 && object.mount.object < 0, "dynamics");
    if (!object.dynamics->mission) continue;
    const scene::Mission& mission = *object.dynamics->mission;
    for (const scene::Aim& aim : {mission.target, mission.between_a, mission.between_b})
      check_aim(scene, aim);
    for (const scene::MissionWaypoint& waypoint : mission.waypoints)
      if (waypoint.facing.look_at) check_aim(scene, *waypoint.facing.look_at);
    NERITIC_CHECK((mission.kind == scene::Mission::Kind::kWaypoints) == !mission.waypoints.empty(),
                  "{} waypoints", mission.waypoints.size());
  }
}

void check_scene(const scene::Scene& scene) {
  check_physics(scene);
  std::set<std::string> cameras, sonars;
  std::set<std::size_t> instances;
  for (const scene::Object& object : scene.objects) {
    NERITIC_CHECK(object.model < static_cast<int>(scene.models.size()), "model {}", object.model);
    check_mount(scene, object.mount);
    if (object.model < 0) continue;
    for (std::size_t i = 0; i < object.instance_count(); ++i)
      NERITIC_CHECK(instances.insert(object.instance + i).second, "instance label {} twice",
                    object.instance + i);
  }
  for (const scene::Lamp& lamp : scene.lamps) check_mount(scene, lamp.mount);
  for (const scene::Camera& camera : scene.cameras) {
    check_mount(scene, camera.mount);
    NERITIC_CHECK(cameras.insert(camera.name).second, "camera {} twice", camera.name);
  }
  for (const scene::Sonar& sonar : scene.sonars) {
    check_mount(scene, sonar.mount);
    NERITIC_CHECK(sonars.insert(sonar.name).second, "sonar {} twice", sonar.name);
  }
}

}  // namespace

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Folder folder;
  const fs::path path = folder.root / "scenes" / "scene.toml";
  write(path, with_spheres(std::string(reinterpret_cast<const char*>(data), size)));
  const auto scene = scene::load_scene(path);
  if (scene.ok()) {
    check_scene(*scene);
  } else {
    const std::string& message = scene.error().message;
    NERITIC_CHECK(!message.empty() && message.find('\n') == message.npos, "{}", message);
  }
  return 0;
}
