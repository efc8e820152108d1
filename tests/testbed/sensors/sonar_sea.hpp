// A small sea with any sonar in it, and every term at once: what tests of extremes and of equal
// bits share.
#pragma once

#include "engine/scene/shapes.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {

inline constexpr scene::SonarKind kSonarKinds[] = {
    scene::SonarKind::kImaging, scene::SonarKind::kProfiling, scene::SonarKind::kEchoSounder,
    scene::SonarKind::kSideScan, scene::SonarKind::kMechanical};

inline void add_object(scene::Scene& scene, scene::Model model, const Vec3& at,
                       std::uint16_t class_id) {
  scene::Object object = object_of(scene, std::move(model), at);
  object.class_id = class_id;
  scene.objects.push_back(object);
}

inline scene::Sonar small_sonar(scene::SonarKind kind = scene::SonarKind::kImaging) {
  scene::Sonar sonar;
  sonar.name = "sonar";
  sonar.kind = kind;
  sonar.range_min_m = 0.5;
  sonar.range_max_m = 12.0;
  sonar.azimuth_rad = radians(60.0);
  sonar.elevation_rad = radians(40.0);
  sonar.bins_range = 100;
  sonar.bins_azimuth = 32;
  sonar.bins_elevation = 48;
  return sonar;
}

inline scene::SonarTerms every_term() {
  scene::SonarTerms t;
  t.frequency_hz = 450e3;
  t.level = scene::SonarLevel{.tvg_log = 30.0, .tvg_absorption = true};
  t.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(4.0)};
  t.beam.elevation =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = radians(30.0)};
  t.beam.samples = 2;
  t.range_spread = scene::SonarRangeSpread{};
  t.speckle = scene::SonarSpeckle{.shape = 2.0};
  t.noise = scene::SonarNoise{};
  t.ghosts = scene::SonarGhosts{.surface = true, .bottom_m = 9.0};
  t.profile = scene::SonarProfile{{{0.0, 1520.0}, {4.0, 1490.0}, {50.0, 1480.0}}, true};
  t.motion = scene::SonarMotion{.within_ping = true, .doppler = true};
  t.labels.energy = true;
  t.output.bits = 16;
  return t;
}

// Those again in the other shapes that patterns, steering and gain can have, each with a kind that
// takes it.
inline std::vector<std::pair<scene::SonarKind, scene::SonarTerms>> other_shapes() {
  using Shape = scene::BeamShape;
  scene::SonarTerms flat = every_term();
  flat.beam.steering = scene::SonarBeam::Steering::kFlat;
  flat.level->tvg_log = 0.0;
  flat.level->tvg_table = {{0.5, 0.0}, {3.0, 18.0}, {12.0, 30.0}};
  scene::SonarTerms table = every_term();
  table.beam.azimuth->shape = Shape::kTable;
  table.beam.azimuth->table = {{0.0, 0.0}, {0.05, -3.0}, {0.12, -20.0}, {0.2, -50.0}};
  scene::SonarTerms piston = every_term();
  piston.beam.elevation->shape = Shape::kPiston;
  return {{scene::SonarKind::kImaging, flat},
          {scene::SonarKind::kMechanical, table},
          {scene::SonarKind::kEchoSounder, piston}};
}

// A sonar 4 m under the surface, underway and turning, a sphere before it and a floor below.
inline scene::Scene some_sea(scene::Sonar sonar) {
  scene::Scene scene;
  scene.path = "test";
  add_object(scene, scene::make_sphere(1.0, 48), {0.5, -4.0, -5.0}, 12);
  add_object(scene, scene::make_box({80.0, 1.0, 80.0}), {0.0, -8.5, 0.0}, 1);
  add_object(scene, scene::make_sphere(0.7, 48), {6.0, -6.0, 0.0}, 2);
  scene::Track track;
  for (const double t : {-1.0, 1.0}) {
    track.places.push_back({t, Vec3(0.4 * t, -4.0, -1.5 * t)});
    track.attitudes.push_back({t, glm::angleAxis(0.2 * t, Vec3(0, 1, 0))});
  }
  sonar.mount.pose.position_m = {0.0, -4.0, 0.0};
  sonar.mount.track = track;
  scene.sonars = {std::move(sonar)};
  return scene;
}

}  // namespace neritic::testbed
