#include "engine/render/particles.hpp"

#include <algorithm>
#include <cmath>

#include "engine/render/snow_field.hpp"
#include "shared/bubble.h"

namespace neritic::render {
namespace {

constexpr double kSpotRoom_m = 0.02;  // blur and streaks make a spot wider than it is

// A bubble's look (shared/bubble.h): its own, turned on by the swing now.
std::uint32_t wobbling(std::uint32_t look, std::uint32_t swing) {
  return (look & ~255u) | ((look + swing) & 255u);
}

}  // namespace

std::vector<WorldParticle> snow_around(const scene::Snow& snow, std::uint64_t seed,
                                       const Vec3& center_m, double time_s, const ViewSet* views,
                                       double share) {
  std::vector<WorldParticle> out;
  SnowField().append(snow, seed, center_m, time_s, views, share, out);
  return out;
}

bool has_particles(const scene::Scene& scene) {
  return scene.water &&
         (scene.water->snow || !scene.water->bubbles.empty() || !scene.water->silt.empty());
}

ViewParticles view_particles(const scene::MotionSource& motion, SnowField& field,
                             std::uint64_t seed, const ViewSet& views, double time_s,
                             double snow_share) {
  ViewParticles out;
  // Of bubbles' wobble now, in 256ths of a turn.
  const double swings = time_s * shared::kWobble_hz;
  const auto swing = static_cast<std::uint32_t>(256.0 * (swings - std::floor(swings)));
  const scene::Water& water = *motion.scene().water;
  const Vec3 origin = views.origin_m();
  std::vector<WorldParticle> all;
  if (water.snow) {
    field.append(*water.snow, seed, origin, time_s, &views, snow_share, all);
    out.shutter_s = water.snow->shutter_s;
  }
  for (std::size_t i = 0; i < water.bubbles.size(); ++i)
    add_bubbles(motion, water.bubbles[i], i, seed, time_s, all);
  for (std::size_t i = 0; i < water.silt.size(); ++i)
    add_silt(motion, water.silt[i], i, seed, time_s, all);
  const SphereCulling culling(views);
  struct Key {
    double distance2_m2;
    std::uint32_t index;
    bool bubble;
  };
  std::vector<Key> seen;
  seen.reserve(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const Vec3 at = all[i].position_m - origin;
    if (all[i].opacity > 0.0 && culling.may_see(at, all[i].radius_m + kSpotRoom_m))
      seen.push_back({glm::dot(at, at), i, all[i].kind == shared::kParticleBubble});
  }
  // Bubbles first: they have a pipeline of their own. The error where silt or snow floats behind
  // a bubble is too small to be seen.
  std::sort(seen.begin(), seen.end(), [](const Key& a, const Key& b) {
    if (a.bubble != b.bubble) return a.bubble;
    return a.distance2_m2 != b.distance2_m2 ? a.distance2_m2 > b.distance2_m2 : a.index < b.index;
  });
  out.particles.reserve(seen.size());
  for (const Key& key : seen) {
    const WorldParticle& particle = all[key.index];
    out.particles.push_back(
        {Vec3f(particle.position_m - origin), static_cast<float>(particle.radius_m),
         Vec3f(particle.velocity_m_s * out.shutter_s), static_cast<float>(particle.opacity),
         particle.kind, key.bubble ? wobbling(particle.seed, swing) : particle.seed});
  }
  return out;
}

}  // namespace neritic::render
