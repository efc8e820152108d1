// A scene for tests of what moves by physics: a wall whose face is at x = -4, and an underwater
// vehicle that starts 4 m east of it.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {

// vehicle: more keys of the vehicle "rov", its mission and sensors.
inline scene::Scene wall_scene(const std::string& vehicle) {
  const test::ScratchFolder scratch;
  const std::string dynamics =
      (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
  EXPECT_TRUE(write_text(scratch / "s.toml", R"([physics]
[sun]
[[objects]]
name = "wall"
class = "structure"
shape = "box"
size_m = [1, 20, 40]
position_m = [-4.5, -10, 0]
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.5, 0.3, 0.5]
dynamics = ")" + dynamics + "\"\nposition_m = [0, -10, 0]\n" +
                                                 vehicle)
                  .ok());
  return scene::load_scene(scratch / "s.toml").value();
}

// The vehicle flies along the wall, at which its sonar looks askew. The sonar hears Doppler and
// motion within the ping.
inline scene::Scene scene_of_flight() {
  scene::Scene scene = wall_scene(R"(yaw_deg = 60
mission = { waypoints = [ { position_m = [-2, -10, -20] } ] }
[[vehicles.cameras]]
name = "eye"
position_m = [0, 0, -0.3]
width = 64
height = 36
[[vehicles.sonars]]
name = "sonar"
position_m = [0.4, 0, -0.3]
range_m = [0.5, 10]
azimuth_deg = 40
elevation_deg = 10
bins = [400, 64, 32]
rate_hz = 4
)");
  scene.sonars[0].terms.frequency_hz = 750e3;
  scene.sonars[0].terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 60e3};
  scene.sonars[0].terms.motion =
      scene::SonarMotion{.within_ping = true, .doppler = true, .pulse_s = 500e-6};
  return scene;
}

}  // namespace neritic::testbed
