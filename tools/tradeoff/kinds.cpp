#include "tools/tradeoff/kinds.hpp"

#include <algorithm>

#include "engine/core/check.hpp"

namespace neritic::tools {
namespace {

using scene::Sonar;
using scene::SonarKind;
using Shape = scene::BeamShape;

scene::SonarPattern pattern(Shape shape, double half_power_rad) {
  return {.shape = shape, .half_power_rad = half_power_rad, .table = {}};
}

// Bins of half a resolution cell of c / 2B: what the pulse asks for. Coarser ones put a return in
// their middle, which at a whole cell alone is 2.5 % of error.
std::uint32_t rows_over(double range_m) {
  constexpr double kResolution_m = 0.025;
  return static_cast<std::uint32_t>(std::lround(range_m / (kResolution_m / 2.0)));
}

// A thermocline of 20 m/s within 2 m: what a summer day makes of a harbour.
scene::SonarProfile thermocline(bool bent) {
  return {{{0.0, 1520.0}, {1.5, 1518.0}, {3.5, 1500.0}, {20.0, 1498.0}}, bent};
}

scene::SonarLevel calibrated() {
  scene::SonarLevel level;
  level.source_level_db = 190.0;
  level.tvg_log = 20.0;  // half of the spreading is left, so that ranges differ
  return level;
}

Sonar sensor(const Sonar& like, SonarKind kind, double range_max_m, double elevation_rad) {
  Sonar s;
  s.name = "sonar";
  s.kind = kind;
  s.range_min_m = std::min(0.5, like.range_min_m);
  s.range_max_m = range_max_m;
  s.elevation_rad = elevation_rad;
  s.bins_range = rows_over(range_max_m - s.range_min_m);
  s.terms.frequency_hz = 600e3;
  s.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 30e3};
  return s;
}

KindSetting imaging(const Sonar& like, const Pose& place) {
  Sonar s = sensor(like, SonarKind::kImaging, like.range_max_m, like.elevation_rad);
  s.range_min_m = like.range_min_m;
  s.bins_range = rows_over(s.range_max_m - s.range_min_m);
  s.azimuth_rad = like.azimuth_rad;
  s.bins_azimuth = 360;
  s.terms.beam.azimuth = pattern(Shape::kHamming, s.azimuth_rad / 90.0);
  s.terms.beam.elevation = pattern(Shape::kSinc, s.elevation_rad);
  return {s, {0.5, 2, 1000}, {{place, 0}}};
}

KindSetting profiling(const Sonar& like, const Pose& down, double altitude_m) {
  Sonar s = sensor(like, SonarKind::kProfiling, 1.8 * altitude_m, radians(1.5));
  s.azimuth_rad = radians(90.0);
  s.bins_azimuth = 256;
  s.terms.beam.azimuth = pattern(Shape::kHamming, radians(0.7));
  s.terms.beam.elevation = pattern(Shape::kSinc, radians(0.7));
  return {s, {0.5, 2, 16}, {{down, 0}}};
}

KindSetting echo_sounder(const Sonar& like, const std::vector<Shot>& shots, double altitude_m) {
  Sonar s = sensor(like, SonarKind::kEchoSounder, 1.5 * altitude_m, radians(25.0));
  s.terms.beam.elevation = pattern(Shape::kSinc, radians(12.0));
  return {s, {0.5, 64, 64}, shots};
}

KindSetting side_scan(const Sonar& like, const std::vector<Shot>& shots) {
  Sonar s = sensor(like, SonarKind::kSideScan, like.range_max_m, radians(60.0));
  s.azimuth_rad = radians(1.0);
  s.bins_azimuth = 1;
  s.terms.beam.azimuth = pattern(Shape::kSinc, radians(1.0));
  s.terms.beam.elevation = pattern(Shape::kSinc, radians(50.0));
  return {s, {0.5, 4, 1000}, shots};
}

KindSetting mechanical(const Sonar& like, const Pose& place) {
  Sonar s = sensor(like, SonarKind::kMechanical, like.range_max_m, radians(25.0));
  s.azimuth_rad = 2.0 * kPi;
  s.step_rad = radians(0.9);
  s.bins_azimuth = 1;
  s.terms.beam.azimuth = pattern(Shape::kSinc, radians(2.0));
  s.terms.beam.elevation = pattern(Shape::kSinc, radians(25.0));
  KindSetting out{s, {0.5, 4, 1000}, {}};
  for (const std::uint32_t step : {160u, 175u, 200u, 212u, 240u})
    out.shots.push_back({place, step});
  return out;
}

// Places along a line ahead, level or looking down.
std::vector<Shot> along(const Pose& pose, const Vec3& ahead, int count) {
  std::vector<Shot> shots;
  for (int i = 0; i < count; ++i) {
    shots.push_back({pose, static_cast<std::uint32_t>(i)});
    shots.back().world_from_sonar.position_m += ahead * (0.8 * i);
  }
  return shots;
}

}  // namespace

Sonar with_knobs(Sonar sonar, const Knobs& knobs) {
  sonar.gbuffer_scale = knobs.scale;
  sonar.gather = knobs.gather;
  if (knobs.bins_range > 0) sonar.bins_range = knobs.bins_range;
  sonar.bins_elevation = knobs.rows;
  if (sonar.kind == SonarKind::kEchoSounder)
    sonar.bins_azimuth = knobs.columns;
  else
    sonar.terms.beam.samples = knobs.columns;
  return sonar;
}

Pose place_of(const scene::Scene& scene) {
  NERITIC_CHECK(!scene.sonars.empty(), "a scene with a sonar is needed");
  return scene.world_from(scene.sonars.front().mount);
}

std::vector<KindSetting> kind_settings(const scene::Scene& scene, double altitude_m) {
  const Sonar& like = scene.sonars.front();
  const Pose place = place_of(scene);
  // Level, on the same heading; and looking straight down with the fan across it.
  Vec3 ahead = place.rotation * Vec3(0, 0, -1);
  ahead.y = 0.0;
  ahead = glm::length(ahead) > 1e-6 ? glm::normalize(ahead) : Vec3(0, 0, -1);
  const Pose level{place.position_m, glm::angleAxis(std::atan2(-ahead.x, -ahead.z), Vec3(0, 1, 0))};
  const Pose down{place.position_m, level.rotation * glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0))};
  return {imaging(like, place), profiling(like, down, altitude_m),
          echo_sounder(like, along(down, ahead, 6), altitude_m),
          side_scan(like, along(level, ahead, 4)), mechanical(like, place)};
}

std::vector<TermCase> term_cases(const KindSetting& kind) {
  using Judge = TermCase::Judge;
  const Sonar base = with_knobs(kind.base, kind.middle);
  std::vector<TermCase> cases;
  const auto add = [&](const std::string& name, const Sonar& from, Judge judge, auto change) {
    TermCase c{name, from, from, judge};
    change(c.with.terms);
    cases.push_back(std::move(c));
  };
  // Those of the point spread are on in the base.
  const auto add_off = [&](const std::string& name, auto change) {
    TermCase c{name, base, base, Judge::kImage};
    change(c.without.terms);
    cases.push_back(std::move(c));
  };
  if (base.terms.beam.azimuth) add_off("azimuth pattern", [](auto& t) { t.beam.azimuth.reset(); });
  add_off("elevation pattern", [](auto& t) { t.beam.elevation.reset(); });
  add_off("range spread", [](auto& t) { t.range_spread.reset(); });
  add("level", base, Judge::kShape, [](auto& t) { t.level = calibrated(); });
  add("ghosts", base, Judge::kImage,
      [](auto& t) { t.ghosts = scene::SonarGhosts{.surface = true}; });
  add("profile, straight", base, Judge::kImage, [](auto& t) { t.profile = thermocline(false); });
  add("profile, bent", base, Judge::kImage, [](auto& t) { t.profile = thermocline(true); });
  add("motion in ping", base, Judge::kImage,
      [](auto& t) { t.motion = scene::SonarMotion{.within_ping = true}; });
  add("doppler", base, Judge::kImage,
      [](auto& t) { t.motion = scene::SonarMotion{.doppler = true}; });
  add("all of these", base, Judge::kShape, [](auto& t) {
    t.level = calibrated();
    t.ghosts = scene::SonarGhosts{.surface = true};
    t.profile = thermocline(false);
    t.motion = scene::SonarMotion{.within_ping = true, .doppler = true};
  });
  add("speckle", base, Judge::kSpeckle, [](auto& t) { t.speckle = scene::SonarSpeckle{}; });
  Sonar levelled = base;
  levelled.terms.level = calibrated();
  // Its level is set where the echoes' is known.
  add("noise", levelled, Judge::kNoise, [](auto& t) { t.noise = scene::SonarNoise{60.0}; });
  add("labels by energy", base, Judge::kCost, [](auto& t) { t.labels.energy = true; });
  return cases;
}

scene::Mount moving_mount(const Pose& p) {
  scene::Mount mount;
  mount.pose = p;
  scene::Track track;
  for (const double t : {-1.0, 1.0}) {
    track.places.push_back({t, p.position_m + t * kTrackVelocity_m_s});
    track.attitudes.push_back({t, glm::angleAxis(t * kTrackYaw_rad_s, Vec3(0, 1, 0)) * p.rotation});
  }
  mount.track = std::move(track);
  return mount;
}

}  // namespace neritic::tools
