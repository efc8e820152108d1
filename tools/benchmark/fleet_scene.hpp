// A scene of any number of vehicles and divers, made of one of each: a lattice 3 m apart in a
// current, every vehicle on a round of two waypoints of its own, every diver on a swim.
#pragma once

#include <algorithm>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::bench {

// assets: the folder. folder: where the scene's file is written.
inline Result<scene::Scene> fleet_scene(const std::string& assets,
                                        const std::filesystem::path& folder, std::size_t vehicles,
                                        std::size_t divers) {
  NERITIC_TRY_STATUS(write_text(folder / "fleet.toml", fmt::format(R"(title = "fleet"
[physics]
[current]
kind = "power_law"
velocity_m_s = [0.2, 0, 0.1]
depth_m = 60
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.57, 0.26, 0.46]
dynamics = "{0}/vehicles/bluerov2_heavy_dynamics.toml"
position_m = [0, -10, 0]
mission = {{ repeat = true, waypoints = [ {{ position_m = [0, -10.5, -1] }}, {{ position_m = [1, -10, 0] }} ] }}
[[objects]]
name = "diver"
class = "diver"
model = "{0}/models/diver.glb"
human = "{0}/divers/recreational.toml"
position_m = [0, -10, 0]
pitch_deg = -90
swim = {{ waypoints_m = [[0, -10, -60]] }}
)",
                                                                   assets)));
  NERITIC_TRY(scene::Scene scene, scene::load_scene(folder / "fleet.toml"));
  const auto is_vehicle = [](const scene::Object& object) { return object.dynamics.has_value(); };
  const scene::Object rov = *std::ranges::find_if(scene.objects, is_vehicle);
  const scene::Object diver =
      *std::ranges::find_if(scene.objects, [](const auto& object) { return bool(object.human); });
  scene.objects.clear();
  for (std::size_t i = 0; i < vehicles + divers; ++i) {
    constexpr std::size_t kColumns = 20;
    const Vec3 off_m = 3.0 * Vec3(double(i % kColumns), -double(i / kColumns / kColumns),
                                  double(i / kColumns % kColumns));
    scene::Object object = i < vehicles ? rov : diver;
    object.name += fmt::format("_{}", i);
    object.instance = static_cast<std::uint16_t>(i + 1);
    object.mount.pose.position_m += off_m;
    if (object.dynamics)
      for (auto& waypoint : object.dynamics->mission->waypoints) waypoint.position_m += off_m;
    if (object.human)
      for (Vec3& point : object.human->swim->waypoints_m) point += off_m;
    scene.objects.push_back(std::move(object));
  }
  return scene;
}

}  // namespace neritic::bench
