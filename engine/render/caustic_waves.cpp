#include "engine/render/caustic_waves.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/core/random.hpp"

namespace neritic::render {
namespace {

constexpr double kGravity_m_s2 = 9.81;
constexpr double kTension_m3_s2 = 7.4e-5;  // of clean water over its density
constexpr int kWindWaves = 24;
constexpr double kLongest_m = 3.0, kShortest_m = 0.12;
constexpr std::uint64_t kStream = 0x63617573;  // "caus"

std::vector<scene::Caustics::Wave> waves_of_wind(const scene::Caustics& caustics,
                                                 std::uint64_t seed) {
  const double longest_m = std::min(kLongest_m, caustics.tile_m);
  const double shortest_m = std::min(kShortest_m, 0.5 * longest_m);
  const double slope2 = 0.5 * (0.003 + 0.00512 * caustics.wind_m_s) / kWindWaves;
  std::vector<scene::Caustics::Wave> waves;
  for (int i = 0; i < kWindWaves; ++i) {
    const double length_m =
        longest_m * std::pow(shortest_m / longest_m, double(i) / (kWindWaves - 1));
    const double aside = (random_uniform({seed, kStream, 0}, i) * 2.0 - 1.0) * radians(60.0);
    waves.push_back({std::sqrt(2.0 * slope2) * length_m / (2.0 * kPi), length_m,
                     caustics.direction_rad + aside});
  }
  return waves;
}

}  // namespace

shared::CausticsParams caustics_params(const scene::Caustics& caustics, const Vec3& to_sun_air,
                                       double time_s, std::uint64_t seed) {
  shared::CausticsParams params{};
  params.texels = caustics.texels;
  params.tile_m = static_cast<float>(caustics.tile_m);
  params.first_m = shared::kCausticFirst_m;
  params.step = shared::kCausticStep;
  params.end_level = shared::kCausticLevels;
  params.travel_air = Vec3f(-to_sun_air);
  const bool named = !caustics.waves.empty();
  const double whole = 2.0 * kPi / caustics.tile_m;
  for (const scene::Caustics::Wave& wave : named ? caustics.waves : waves_of_wind(caustics, seed)) {
    const double k = 2.0 * kPi / wave.wavelength_m;
    // From north (-z) towards east (+x).
    double x = std::round(k * std::sin(wave.direction_rad) / whole),
           z = std::round(-k * std::cos(wave.direction_rad) / whole);
    if (x == 0.0 && z == 0.0) z = -1.0;
    const double repeats_k = whole * std::hypot(x, z);
    const double rate =
        std::sqrt(kGravity_m_s2 * repeats_k + kTension_m3_s2 * repeats_k * repeats_k * repeats_k);
    const double phase = named ? 0.0 : 2.0 * kPi * random_uniform({seed, kStream, 1}, params.count);
    shared::CausticWave& out = params.waves[params.count++];
    out.wave_number = {static_cast<float>(whole * x), static_cast<float>(whole * z)};
    // As steep as it was named.
    out.amplitude_m = static_cast<float>(wave.amplitude_m * k / repeats_k);
    out.angle_rad = static_cast<float>(std::remainder(phase - rate * time_s, 2.0 * kPi));
  }
  return params;
}

std::pair<std::uint32_t, std::uint32_t> caustic_levels(double least_depth_m, double most_depth_m) {
  // As the shade pass chooses them, widened by its rounding.
  const auto low = [](double depth_m, double margin) {
    const double at = std::log(std::max(depth_m, 1e-3) / double(shared::kCausticFirst_m)) /
                          std::log(double(shared::kCausticStep)) +
                      margin;
    return static_cast<std::uint32_t>(std::clamp(at, 0.0, double(shared::kCausticLevels - 2)));
  };
  if (!(least_depth_m <= most_depth_m)) return {0, shared::kCausticLevels};
  return {low(least_depth_m, -1e-3), low(most_depth_m, 1e-3) + 2};
}

}  // namespace neritic::render
