// Bubbles and silt: each particle's place follows in closed form from when and where it was set
// free.
#include <algorithm>

#include "engine/core/random.hpp"
#include "engine/render/particles.hpp"

namespace neritic::render {
namespace {

constexpr std::uint64_t kBubbleStream = 0x627562, kSiltStream = 0x73696c74;
constexpr double kFreeFall_m_s2 = 9.81, kDensity_kg_m3 = 1026.0, kAir_pa = 101325.0;
// Surface tension of sea water, N/m.
constexpr double kTension_n_m = 0.0735;
// Deviation of the logarithm of bubbles' radii: a few large caps among many small ones.
constexpr double kBubbleSpread = 0.8;
// Bubbles of a smaller diameter slow down in proportion.
constexpr double kSmall_m = 1.3e-3;
// Share of a breath that breathing out takes, and the most bubbles that stand for one.
constexpr double kOutShare = 0.45, kMostBubbles = 400.0;
// The plume drags water up with it, m/s.
constexpr double kPlumeRise_m_s = 0.12;
// Silt: seconds from puff to puff; its first radius; how it spreads (m^2/s).
constexpr double kPuffEvery_s = 0.4, kPuff_m = 0.10, kPuffSpread_m2_s = 2e-3;

double bounded_normal(const RandomKey& key, std::uint64_t index) {
  return std::clamp(normal_of(random_uniform(key, index), random_uniform(key, index + 1)), -2.5,
                    2.5);
}

// A turbulent plume widens by about a tenth of its height: its radius.
double plume_m(double rise_m) {
  return 0.02 + 0.09 * rise_m;
}

// Where a bubble is that left a place age_s ago.
WorldParticle risen(const scene::BubbleSource& source, const Vec3& from_m, double radius_m,
                    double age_s, const RandomKey& key, std::uint64_t index) {
  WorldParticle bubble;
  const double speed = bubble_speed_m_s(radius_m) + kPlumeRise_m_s;
  const double rise_m = speed * age_s;
  const double turn = 2.0 * kPi * random_uniform(key, index);
  const double off = std::sqrt(random_uniform(key, index + 1)) * plume_m(rise_m);
  // Ellipsoidal bubbles swing by about their own width, some five times a second.
  const double swing = 2.0 * kPi * (5.0 * age_s + random_uniform(key, index + 2));
  const double side = 1.5 * radius_m * std::sin(swing);
  const double c = std::cos(turn), s = std::sin(turn);  // those of twice the turn follow from them
  bubble.position_m =
      from_m + Vec3(off * c + side * (c * c - s * s), rise_m, off * s + side * 2.0 * s * c);
  bubble.velocity_m_s = Vec3(0.0, speed, 0.0);
  const auto pressure = [](double y_m) {
    return kAir_pa + kDensity_kg_m3 * kFreeFall_m_s2 * std::max(-y_m, 0.0);
  };
  // Boyle: the volume grows as the pressure falls.
  bubble.radius_m = radius_m * std::cbrt(pressure(from_m.y) / pressure(bubble.position_m.y));
  bubble.opacity = glm::smoothstep(source.height_m, 0.75 * source.height_m, rise_m) *
                   glm::smoothstep(0.0, 0.1, age_s);
  bubble.kind = shared::kParticleBubble;
  bubble.seed = static_cast<std::uint32_t>(random_bits(key, index + 3));
  return bubble;
}

}  // namespace

double bubble_speed_m_s(double radius_m) {
  // Mendelson 1967, AIChE Journal 13, 250: like a wave as long as the bubble's girth; for diameters
  // over 1.3 mm. Smaller ones slow down in proportion.
  const double diameter_m = std::max(2.0 * radius_m, kSmall_m);
  const double speed = std::sqrt(2.0 * kTension_n_m / (kDensity_kg_m3 * diameter_m) +
                                 0.5 * kFreeFall_m_s2 * diameter_m);
  return speed * std::min(2.0 * radius_m / kSmall_m, 1.0);
}

void add_bubbles(const scene::MotionSource& motion, const scene::BubbleSource& source,
                 std::uint64_t number, std::uint64_t seed, double time_s,
                 std::vector<WorldParticle>& out, const SphereCulling* sight) {
  const bool leaks = source.breath_s <= 0.0;
  const double period_s = leaks ? 1.0 : source.breath_s;
  const double out_s = leaks ? period_s : kOutShare * period_s;
  // Mean volume of a lognormal radius.
  double radius_m = source.median_radius_m;
  const double mean_m3 = 4.0 / 3.0 * kPi * radius_m * radius_m * radius_m *
                         std::exp(4.5 * kBubbleSpread * kBubbleSpread);
  double count = source.flow_m3_s * period_s / mean_m3;
  if (count > kMostBubbles) {
    radius_m *= std::cbrt(count / kMostBubbles);
    count = kMostBubbles;
  }
  const RandomKey own{seed, kBubbleStream, number};
  const double first_s = period_s * random_uniform(own, 0);
  // The slowest there can be: sqrt(a / d + b d) is least at d = sqrt(a / b), and less for the
  // smallest.
  const double smallest_m = radius_m * std::exp(-2.5 * kBubbleSpread);
  const double slowest_m_s =
      std::sqrt(2.0 * std::sqrt(kTension_n_m / kDensity_kg_m3 * kFreeFall_m_s2)) *
          std::min(2.0 * smallest_m / kSmall_m, 1.0) +
      kPlumeRise_m_s;
  const double oldest_s = source.height_m / slowest_m_s + period_s;
  const auto last = static_cast<std::int64_t>(std::floor((time_s - first_s) / period_s));
  const auto breaths = static_cast<std::int64_t>(std::ceil(oldest_s / period_s));
  for (std::int64_t breath = last - breaths; breath <= last; ++breath) {
    const RandomKey key{seed, kBubbleStream ^ mix64(number + 1),
                        static_cast<std::uint64_t>(breath)};
    // A fraction of a bubble is one by chance.
    const auto n = static_cast<std::uint64_t>(std::floor(count + random_uniform(key, 0)));
    for (std::uint64_t i = 0; i < n; ++i) {
      const std::uint64_t index = 16 * (i + 1);
      const double born_s =
          first_s + period_s * static_cast<double>(breath) + out_s * random_uniform(key, index);
      const double age_s = time_s - born_s;
      if (age_s <= 0.0) continue;
      const double own_m = radius_m * std::exp(kBubbleSpread * bounded_normal(key, index + 1));
      const double rise_m = (bubble_speed_m_s(own_m) + kPlumeRise_m_s) * age_s;
      if (rise_m > source.height_m) continue;
      const Vec3 from_m =
          motion.world_from_object(static_cast<std::size_t>(source.object), born_s) *
          source.position_m;
      // About where it is, with room for the plume's width, its swing and its growth.
      if (sight && !sight->may_see(from_m + Vec3(0.0, rise_m, 0.0) - sight->origin_m(),
                                   plume_m(rise_m) + 10.0 * own_m + kSpotRoom_m))
        continue;
      const WorldParticle bubble = risen(source, from_m, own_m, age_s, key, index + 4);
      if (bubble.position_m.y < -bubble.radius_m) out.push_back(bubble);
    }
  }
}

void add_silt(const scene::MotionSource& motion, const scene::SiltSource& source,
              std::uint64_t number, std::uint64_t seed, double time_s,
              std::vector<WorldParticle>& out) {
  const auto object = static_cast<std::size_t>(source.object);
  const auto place_at = [&](double t_s) {
    return motion.world_from_object(object, t_s) * source.position_m;
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
    const Vec3 at = place_at(born_s);
    const double height_m = at.y + source.bed_depth_m;
    if (height_m >= source.reach_m) continue;
    const double near = 1.0 - std::max(height_m, 0.0) / source.reach_m;
    const double speed = glm::length(at - place_at(born_s - kPuffEvery_s)) / kPuffEvery_s;
    const double strength = near * near * (0.3 + 0.7 * std::min(speed / 0.3, 1.0));
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
