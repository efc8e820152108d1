#include "engine/render/sea_waves.hpp"

#include <algorithm>

namespace neritic::render {
namespace {

// Height over its deviation that a normal number exceeds with that probability: Abramowitz and
// Stegun 1964, 26.2.23 (error below 4.5e-4).
double exceeded_by(double share) {
  if (!(share > 1e-12)) return 8.0;
  if (share >= 0.5) return 0.0;
  const double t = std::sqrt(-2.0 * std::log(share));
  return t - (2.515517 + t * (0.802853 + t * 0.010328)) /
                 (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308)));
}

}  // namespace

shared::Waves gpu_waves(const SeaWaves& sea, const Vec3& origin_m, double time_s) {
  shared::Waves out{};
  const std::size_t count = std::min<std::size_t>(sea.waves().size(), shared::kMaxWaves);
  out.count = static_cast<std::uint32_t>(count);
  for (std::size_t i = 0; i < count; ++i) {
    const SeaWave& wave = sea.waves()[i];
    out.waves[i] = {Vec2f(wave.wave_number_m), static_cast<float>(wave.amplitude_m),
                    static_cast<float>(SeaWaves::angle_rad(wave, origin_m.x, origin_m.z, time_s))};
  }
  out.height_rms_m = static_cast<float>(sea.height_rms_m());
  out.slope2 = static_cast<float>(sea.slope2());
  out.fine_slope2 = static_cast<float>(sea.fine_slope2());
  out.foam_height_m =
      static_cast<float>(exceeded_by(sea.foam_share()) * std::max(sea.height_rms_m(), 1e-3));
  // The pattern repeats after 4096 cells of foam_noise's coarser grid.
  out.foam_shift = Vec2f(static_cast<float>(std::fmod(3.0 * origin_m.x, 4096.0)),
                         static_cast<float>(std::fmod(3.0 * origin_m.z, 4096.0)));
  out.eye_height_m = static_cast<float>(sea.height_m(origin_m.x, origin_m.z, time_s));
  out.eye_slope = Vec2f(sea.slope(origin_m.x, origin_m.z, time_s));
  return out;
}

}  // namespace neritic::render
