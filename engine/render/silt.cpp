// Silt: each puff's place follows in closed form from when and where it was raised.
#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "engine/render/particles.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kSiltStream = 0x73696c74;
// All loose sediment goes up where a fin, or water that a thruster drives, passes so fast.
constexpr double kRaises_m_s = 0.3;
// Seconds from puff to puff; its first radius; how it spreads (m^2/s).
constexpr double kPuffEvery_s = 0.4, kPuff_m = 0.10, kPuffSpread_m2_s = 2e-3;

}  // namespace

void add_silt(const scene::MotionSource& motion, const scene::SiltSource& source,
              std::uint64_t number, std::uint64_t seed, double time_s,
              std::vector<WorldParticle>& out) {
  const auto object = static_cast<std::size_t>(source.object);
  const auto place_at = [&](double t_s) {
    return motion.place_of(object, source.joint, source.position_m, t_s);
  };
  const double life_s = 2.0 * source.hang_s;
  const auto last = static_cast<std::int64_t>(std::floor(time_s / kPuffEvery_s));
  for (std::int64_t puff = last; static_cast<double>(last - puff) * kPuffEvery_s < life_s; --puff) {
    const double born_s = kPuffEvery_s * static_cast<double>(puff);
    const double age_s = time_s - born_s;
    // Older puffs are so wide that every other one is enough, then every fourth: the rest fade out.
    const double left = puff % 2 != 0   ? glm::smoothstep(8.0, 4.0, age_s)
                        : puff % 4 != 0 ? glm::smoothstep(24.0, 16.0, age_s)
                                        : 1.0;
    if (left <= 0.0) continue;
    const scene::FollowedPlace place = place_at(born_s);
    const Vec3 at = place.position_m;
    const double height_m = at.y + source.bed_depth_m;
    const double near = std::clamp(1.0 - height_m / source.reach_m, 0.0, 1.0);
    const double speed_m_s =
        near > 0.0 ? glm::length(at - place_at(born_s - kPuffEvery_s).position_m) / kPuffEvery_s
                   : 0.0;
    const double strength = std::max(near * near * std::min(speed_m_s / kRaises_m_s, 1.0),
                                     std::min(place.wash_m_s / kRaises_m_s, 1.0));
    if (!(strength > 0.0)) continue;
    const RandomKey key{seed, kSiltStream ^ mix64(number), static_cast<std::uint64_t>(puff)};
    WorldParticle cloud;
    const double radius_m = std::sqrt(kPuff_m * kPuff_m + 4.0 * kPuffSpread_m2_s * age_s);
    const double turn = 2.0 * kPi * random_uniform(key, 0);
    const double out_m =
        0.25 * (1.0 - std::exp(-age_s / 1.5)) + 0.01 * age_s * random_uniform(key, 1);
    const double up_m = 0.5 * strength * (1.0 - std::exp(-age_s / 2.0)) * random_uniform(key, 2) +
                        0.6 * radius_m - 0.004 * age_s;
    cloud.position_m = Vec3(at.x + out_m * std::cos(turn),
                            std::max(-source.bed_depth_m + up_m, -source.bed_depth_m + 0.05),
                            at.z + out_m * std::sin(turn));
    cloud.radius_m = radius_m;
    // Its particles spread over a wider cloud, and settle.
    cloud.opacity = 0.75 * std::sqrt(strength) * std::pow(kPuff_m / radius_m, 0.7) *
                    std::exp(-age_s / source.hang_s) * glm::smoothstep(0.0, 0.5, age_s) * left;
    cloud.kind = shared::kParticleSilt;
    cloud.seed = static_cast<std::uint32_t>(random_bits(key, 3));
    if (cloud.opacity > 0.01) out.push_back(cloud);
  }
}

}  // namespace neritic::render
