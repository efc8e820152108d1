#include "engine/render/particles.hpp"

#include <algorithm>

#include "engine/core/random.hpp"
#include "shared/bubble.h"

namespace neritic::render {
namespace {

constexpr std::uint64_t kSnowStream = 0x736e6f77;
// Mean number of particles in a cell of the lattice.
constexpr double kCellMean = 24.0;
// Particles fade in between these distances from the eye: nearer there is the camera's housing.
constexpr double kNearest_m = 0.20, kNear_m = 0.80;

std::uint64_t word(std::int64_t cell) {
  return static_cast<std::uint64_t>(cell);
}

// A normal number of two uniform ones (Box and Muller 1958).
double normal(double u, double v) {
  return std::sqrt(-2.0 * std::log(1.0 - u)) * std::cos(2.0 * kPi * v);
}

double smooth(double low, double high, double x) {
  const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

}  // namespace

std::vector<WorldParticle> snow_around(const scene::Snow& snow, std::uint64_t seed,
                                       const Vec3& center_m, double time_s, const ViewSet* views,
                                       double share) {
  std::vector<WorldParticle> out;
  if (!(snow.density_m3 > 0.0 && share > 0.0)) return out;
  const double cell_m = std::clamp(std::cbrt(kCellMean / snow.density_m3), 0.1, 2.0);
  // A number of slots, each taken by chance: the count has a binomial spread.
  const double mean = snow.density_m3 * cell_m * cell_m * cell_m;
  const auto slots = static_cast<std::uint64_t>(std::ceil(2.0 * mean + 1.0));
  const double taken = mean / static_cast<double>(slots);
  const double half_m = 0.5 * std::sqrt(3.0) * cell_m;  // of a cell's diagonal
  const double widest_m = 0.5 * snow.diameter_m * std::exp(2.0 * snow.spread) + 0.02;
  const Vec3 drift_m = snow.drift_m_s * time_s;
  const Vec3 center = center_m - drift_m;  // in the water's own frame
  const auto low = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((center[axis] - snow.range_m) / cell_m));
  };
  const auto high = [&](int axis) {
    return static_cast<std::int64_t>(std::floor((center[axis] + snow.range_m) / cell_m));
  };
  for (std::int64_t y = low(1); y <= high(1); ++y)
    for (std::int64_t z = low(2); z <= high(2); ++z)
      for (std::int64_t x = low(0); x <= high(0); ++x) {
        // Most cells lie beside or behind the views, or out of range.
        const Vec3 middle = cell_m * (Vec3(x, y, z) + 0.5) - center;
        if (glm::length(middle) >= snow.range_m + half_m) continue;
        if (views &&
            !any_view_sees(*views, middle + center_m - views->origin_m(), half_m + widest_m))
          continue;
        const RandomKey key{seed, kSnowStream ^ mix64(word(y)), mix64(word(x)) ^ (word(z) << 1)};
        for (std::uint64_t i = 0; i < slots; ++i) {
          if (random_uniform(key, 8 * i) >= taken) continue;
          const auto look = static_cast<std::uint32_t>(random_bits(key, 8 * i + 7));
          if (!(look * 0x1p-32 < share)) continue;
          const Vec3 place = cell_m * (Vec3(x, y, z) + Vec3(random_uniform(key, 8 * i + 1),
                                                            random_uniform(key, 8 * i + 2),
                                                            random_uniform(key, 8 * i + 3)));
          const Vec3 at = place - center;
          const double range_m = glm::length(at);
          const Vec3 position = center_m + at;
          if (range_m >= snow.range_m || position.y >= 0.0) continue;
          WorldParticle particle;
          particle.position_m = position;
          particle.velocity_m_s = snow.drift_m_s;
          particle.radius_m =
              0.5 * snow.diameter_m *
              std::exp(snow.spread * std::clamp(normal(random_uniform(key, 8 * i + 4),
                                                       random_uniform(key, 8 * i + 5)),
                                                -2.5, 2.0));
          particle.opacity = (0.10 + 0.50 * random_uniform(key, 8 * i + 6)) *
                             (1.0 - smooth(0.7 * snow.range_m, snow.range_m, range_m)) *
                             smooth(kNearest_m, kNear_m, range_m);
          particle.kind = shared::kParticleSnow;
          particle.seed = look;
          out.push_back(particle);
        }
      }
  return out;
}

namespace {

// A bubble's look (shared/bubble.h): its own, turned on by the swing now.
std::uint32_t wobbling(std::uint32_t look, std::uint32_t swing) {
  return (look & ~255u) | ((look + swing) & 255u);
}

}  // namespace

bool has_particles(const scene::Scene& scene) {
  return scene.water &&
         (scene.water->snow || !scene.water->bubbles.empty() || !scene.water->silt.empty());
}

ViewParticles view_particles(const scene::MotionSource& motion, std::uint64_t seed,
                             const ViewSet& views, double time_s, double snow_share) {
  ViewParticles out;
  // Of bubbles' wobble now, in 256ths of a turn.
  const double swings = time_s * shared::kWobble_hz;
  const auto swing = static_cast<std::uint32_t>(256.0 * (swings - std::floor(swings)));
  const scene::Water& water = *motion.scene().water;
  const Vec3 origin = views.origin_m();
  std::vector<WorldParticle> all;
  if (water.snow) {
    all = snow_around(*water.snow, seed, origin, time_s, &views, snow_share);
    out.shutter_s = water.snow->shutter_s;
  }
  for (std::size_t i = 0; i < water.bubbles.size(); ++i)
    add_bubbles(motion, water.bubbles[i], i, seed, time_s, all);
  for (std::size_t i = 0; i < water.silt.size(); ++i)
    add_silt(motion, water.silt[i], i, seed, time_s, all);
  std::vector<std::pair<double, shared::Particle>> seen;
  for (const WorldParticle& particle : all) {
    const Vec3 at = particle.position_m - origin;
    // Blur and streaks make a spot wider than it is.
    if (particle.opacity <= 0.0 || !any_view_sees(views, at, particle.radius_m + 0.02)) continue;
    seen.push_back({glm::dot(at, at),
                    {Vec3f(at), static_cast<float>(particle.radius_m),
                     Vec3f(particle.velocity_m_s * out.shutter_s),
                     static_cast<float>(particle.opacity), particle.kind,
                     particle.kind == shared::kParticleBubble ? wobbling(particle.seed, swing)
                                                              : particle.seed}});
  }
  // Bubbles first: they have a pipeline of their own. What little is wrong where silt or snow
  // floats behind one, nobody sees.
  std::stable_sort(seen.begin(), seen.end(), [](const auto& a, const auto& b) {
    const bool first = a.second.kind == shared::kParticleBubble;
    const bool second = b.second.kind == shared::kParticleBubble;
    return first != second ? first : a.first > b.first;
  });
  out.particles.reserve(seen.size());
  for (const auto& [distance2, particle] : seen) out.particles.push_back(particle);
  return out;
}

}  // namespace neritic::render
