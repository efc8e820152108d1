// The cost of each term of a sonar, one at a time and all together, on the sonar benchmark's scene.
#include <cmath>
#include <utility>

#include "engine/core/clock.hpp"
#include "engine/core/hash.hpp"
#include "sonar/write_sonar.hpp"
#include "tools/benchmark/groups.hpp"

namespace neritic::bench {
namespace {

using scene::SonarTerms;

SonarTerms every_term() {
  SonarTerms t;
  t.frequency_hz = 900e3;
  t.level = scene::SonarLevel{.tvg_log = 40.0, .tvg_absorption = true};
  t.beam.azimuth =
      scene::SonarPattern{.shape = scene::BeamShape::kHamming, .half_power_rad = radians(0.6)};
  t.beam.elevation = scene::SonarPattern{.half_power_rad = radians(20.0)};
  t.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 60e3};
  t.speckle = scene::SonarSpeckle{};
  t.noise = scene::SonarNoise{};
  t.ghosts = scene::SonarGhosts{.surface = true};
  t.profile = scene::SonarProfile{{{0.0, 1500.0}, {20.0, 1480.0}}, false};
  t.motion = scene::SonarMotion{.within_ping = true, .doppler = true};
  t.labels.energy = true;
  return t;
}

// The terms of which only one is named.
std::vector<std::pair<std::string, SonarTerms>> one_by_one() {
  const SonarTerms all = every_term();
  const auto with = [&](auto keep) {
    SonarTerms t;
    t.frequency_hz = all.frequency_hz;
    keep(t);
    return t;
  };
  return {
      {"plain", with([](SonarTerms&) {})},
      {"level", with([&](SonarTerms& t) { t.level = all.level; })},
      {"beam_elevation", with([&](SonarTerms& t) { t.beam.elevation = all.beam.elevation; })},
      {"beam_azimuth", with([&](SonarTerms& t) { t.beam.azimuth = all.beam.azimuth; })},
      {"range_spread", with([&](SonarTerms& t) { t.range_spread = all.range_spread; })},
      {"speckle", with([&](SonarTerms& t) { t.speckle = all.speckle; })},
      {"speckle_k", with([&](SonarTerms& t) { t.speckle = scene::SonarSpeckle{.shape = 2.0}; })},
      {"noise", with([&](SonarTerms& t) { t.level = all.level, t.noise = all.noise; })},
      {"ghosts", with([&](SonarTerms& t) { t.ghosts = all.ghosts; })},
      {"profile", with([&](SonarTerms& t) { t.profile = all.profile; })},
      {"profile_bent", with([&](SonarTerms& t) {
         t.profile = all.profile;
         t.profile->bent = true;
       })},
      {"motion", with([&](SonarTerms& t) { t.motion = scene::SonarMotion{.within_ping = true}; })},
      {"doppler", with([&](SonarTerms& t) {
         t.range_spread = all.range_spread;  // whose bandwidth a chirp sweeps
         t.motion = scene::SonarMotion{.doppler = true};
       })},
      {"labels_energy", with([&](SonarTerms& t) { t.labels = all.labels; })},
      {"all", all}};
}

// Ahead at 1.5 m/s, turning to port by 10 degrees a second.
scene::Track course_of(const Pose& place) {
  scene::Track course;
  for (const double t : {-1.0, 1.0}) {
    course.places.push_back({t, place.position_m + place.rotation * Vec3(0.0, 0.0, -1.5 * t)});
    course.attitudes.push_back(
        {t, glm::angleAxis(t * radians(10.0), Vec3(0, 1, 0)) * place.rotation});
  }
  return course;
}

// Output as counts costs the host, not the device: an image of the scene's size to 8 and 16
// bits.
Contender counts_of(const std::string& name, const std::vector<float>& power, std::uint32_t bits) {
  return {name, [&power, bits]() -> Result<Sample> {
            scene::SonarOutput output;
            output.bits = bits;
            output.floor_db = 0.0;
            output.span_db = 160.0;
            const TimeNs start = now_ns();
            const auto counts = sonar::quantize(power, output);
            const double ms = to_ms(now_ns() - start);
            Hash64 hash;
            hash.add_span(std::span<const std::uint16_t>(counts));
            return Sample{ms, {}, hash.hex()};
          }};
}

}  // namespace

Status bench_sonar_terms(Suite& suite, gpu::Device& device) {
  if (!suite.wants("sonar_terms")) return {};
  NERITIC_TRY(const scene::Scene base,
              scene::load_scene(suite.options().assets + "/scenes/benchmark_23k.toml"));
  std::vector<std::unique_ptr<testbed::Session>> sessions;
  std::vector<Contender> contenders;
  testbed::FrameRequest request;
  request.sonars = {0};
  request.capture = testbed::Capture{.color = false, .motion = false}.without_geometry();
  for (const auto& [name, terms] : one_by_one()) {
    scene::Scene scene = base;
    scene.sonars.at(0).terms = terms;
    // Under way and turning, or there is no motion to pay for.
    if (terms.motion) scene.sonars[0].mount.track = course_of(scene.sonars[0].mount.pose);
    NERITIC_TRY(auto session, testbed::Session::create(device, std::move(scene)));
    sessions.push_back(std::move(session));
    contenders.push_back(frames_of("sonar_terms/" + name, *sessions.back(), request));
  }
  // Echoes of all levels down from 160 dB.
  const scene::Sonar& sonar = base.sonars.at(0);
  std::vector<float> power(std::size_t{sonar.bins_range} * sonar.bins_azimuth);
  for (std::size_t i = 0; i < power.size(); ++i)
    power[i] = std::pow(10.0f, 16.0f * float(i) / float(power.size()));
  for (const std::uint32_t bits : {8u, 16u})
    contenders.push_back(counts_of(fmt::format("sonar_terms/counts_{}_bits", bits), power, bits));
  NERITIC_TRY_STATUS(suite.measure(std::move(contenders), 20));
  for (const auto& [name, terms] : one_by_one())
    if (name != "plain")
      suite.ratio("sonar_" + name + "_vs_plain", "sonar_terms/" + name, "sonar_terms/plain");
  return {};
}

}  // namespace neritic::bench
