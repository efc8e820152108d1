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

namespace {

// Pixels that a metre takes at one metre ahead, in the finest of a set's views.
double pixels_at_a_metre(const ViewSet& views) {
  double most = 0.0;
  for (const ViewDesc& view : views.views) {
    const FrustumTangents& t = view.tangents;
    most = std::max({most, views.width / (t.right - t.left), views.height / (t.top - t.bottom)});
  }
  return most;
}

// Whether a grain, lit as the water about it is, changes a pixel by less than half a level of 255:
// its soft spot has twice the light of its middle spread over a disk of 0.75 pixels at least
// (shaders/particles.vert).
bool fades_away(const WorldParticle& grain, double distance_m, double pixels) {
  const double own = grain.radius_m * pixels / std::max(distance_m, 1e-3);
  return 2.0 * own * own / (own * own + 0.56) * grain.opacity < 0.003;
}

}  // namespace

bool has_particles(const scene::Scene& scene) {
  return scene.water &&
         (scene.water->snow || !scene.water->bubbles.empty() || !scene.water->silt.empty());
}

ViewParticles view_particles(const scene::MotionSource& motion, SnowField& field,
                             std::uint64_t seed, const ViewSet& views, double time_s,
                             double snow_share) {
  ViewParticles out;
  // The phase of bubbles' wobble now, in 256ths of a turn.
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
  // Before a lamp a grain may be far brighter than the water.
  const bool dim = motion.scene().lamps.empty() && motion.scene().model_lights.empty();
  const double pixels = pixels_at_a_metre(views);
  struct Key {
    double distance2_m2;
    std::uint32_t index;
    bool bubble;
  };
  std::vector<Key> seen;
  seen.reserve(all.size());
  for (std::uint32_t i = 0; i < all.size(); ++i) {
    const Vec3 at = all[i].position_m - origin;
    if (dim && all[i].kind == shared::kParticleSnow && fades_away(all[i], glm::length(at), pixels))
      continue;
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
