// A sensor written as JSON is the sensor: as a scene again it reads the same.
#include "sonar/terms_json.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

// JSON as a TOML value: objects become inline tables.
std::string toml_of(const nlohmann::json& json) {
  std::string text;
  if (json.is_object()) {
    for (const auto& [key, value] : json.items())
      text += fmt::format("{}{} = {}", text.empty() ? "" : ", ", key, toml_of(value));
    return "{ " + text + " }";
  }
  if (json.is_array()) {
    for (const auto& value : json) text += (text.empty() ? "" : ", ") + toml_of(value);
    return "[" + text + "]";
  }
  return json.dump();
}

scene::Sonar read_back(const nlohmann::json& sensor) {
  std::string text = "[[sonars]]\nname = \"sonar\"\n";
  for (const auto& [key, value] : sensor.items())
    text += fmt::format("{} = {}\n", key, toml_of(value));
  const test::ScratchFolder folder;
  EXPECT_TRUE(write_text(folder / "scene.toml", text).ok());
  auto scene = scene::load_scene(folder / "scene.toml");
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message) << "\n" << text;
  return scene.ok() ? scene->sonars.at(0) : scene::Sonar{};
}

scene::Sonar sensor_of(const std::string& keys) {
  const test::ScratchFolder folder;
  EXPECT_TRUE(write_text(folder / "scene.toml", "[[sonars]]\n" + keys).ok());
  auto scene = scene::load_scene(folder / "scene.toml");
  EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
  return scene.ok() ? scene->sonars.at(0) : scene::Sonar{};
}

TEST(SonarTermsJson, ReadsBackAsTheSameSensor) {
  for (const char* keys :
       {"", "quality = 'draft'\nlabels = {energy = true, coco = true}",
        "kind = 'profiling'\nfrequency_hz = 4e5\nbandwidth_hz = 3e4\nelevation_deg = 0.7\n"
        "water = {temperature_c = 4, ph = 7.9, depth_m = 30, sound_speed_m_s = 1475}\n"
        "level = {source_level_db = 215, absorption = 0.1, tvg = 30, gain_db = -3}\n"
        "beam = {azimuth = 'hamming', azimuth_deg = 0.7, samples = 3, steering = 'flat', "
        "two_way = false, elevation = [[-3, -20], [0, 0], [3.5, -21]]}\n"
        "noise = {wind_m_s = 7, shipping = 0.1, self_db = 50}\nspeckle = {shape = 3}\n"
        "ghosts = {surface = true, surface_reflection = 0.7, bottom_m = 12}\n"
        "sound_speed = {profile = [[0, 1500], [40, 1480]], rays = 'bent'}\n"
        "motion = {within_ping = true, doppler = true, pulse_s = 2e-3}\n"
        "labels = {energy = true}\noutput = {bits = 8, floor_db = 30, span_db = 90}\n"
        "detection = {threshold = 0.3, floor_db = 6, quality = 0.2}",
        "kind = 'echosounder'\nsemi_angle_deg = 7.3\nbeam = {elevation = 'piston', elevation_deg = "
        "14.6}\n"
        "level = {absorption = 'ainslie-mccolm', tvg = [[1, 0], [10, 40]]}\nnoise = {level_db = "
        "50}",
        "kind = 'sidescan'\ndepression_deg = 31\nrange_spread = {window = 'none'}\n"
        "level = {absorption = 'none', spreading = false, tvg = 20, tvg_absorption = true}\n"
        "output = {floor_db = 90, span_db = 60}\n"
        "detection = {pings = 9}\nmax_error = 0.03\ngather = 'nearest'\npicture_camera = 'eye'",
        "kind = 'mechanical'\nazimuth_deg = 270\nstep_deg = 1.8\ngbuffer_scale = 2\nrate_hz = 7\n"
        "speckle = {}"}) {
    const scene::Sonar sensor = sensor_of(keys);
    const nlohmann::json json = sonar::sensor_json(sensor);
    const scene::Sonar again = read_back(json);
    EXPECT_EQ(sonar::sensor_json(again).dump(), json.dump()) << keys;
    EXPECT_EQ(again.terms.level, sensor.terms.level) << keys;
    EXPECT_EQ(again.terms.noise, sensor.terms.noise) << keys;
    EXPECT_EQ(again.terms.water, sensor.terms.water) << keys;
    EXPECT_EQ(again.terms.ghosts, sensor.terms.ghosts) << keys;
    EXPECT_EQ(again.terms.output, sensor.terms.output) << keys;
    EXPECT_EQ(again.terms.detection, sensor.terms.detection) << keys;
    EXPECT_EQ(again.terms.output, sensor.terms.output) << keys;
    EXPECT_EQ(again.picture_camera, sensor.picture_camera) << keys;
    EXPECT_NEAR(again.azimuth_rad, sensor.azimuth_rad, 1e-12) << keys;
  }
  EXPECT_TRUE(sonar::terms_json(scene::SonarTerms{}).empty());
}

}  // namespace
}  // namespace neritic
