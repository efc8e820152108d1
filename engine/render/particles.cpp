#include "engine/render/particles.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/random.hpp"
#include "engine/render/bubble_field.hpp"
#include "engine/render/skylight.hpp"
#include "engine/render/snow_field.hpp"
#include "shared/bubble.h"

namespace neritic::render {
namespace {

// A bubble's look (shared/bubble.h): its own, turned on by the swing now.
std::uint32_t wobbling(std::uint32_t look, std::uint32_t swing) {
  return (look & ~255u) | ((look + swing) & 255u);
}

// Particles in a row that are drawn together; bubbles come before all others.
struct Drawn {
  bool bubble;
  double distance2_m2;
  std::size_t first, count;
  bool operator<(const Drawn& other) const {
    if (bubble != other.bubble) return bubble;
    return distance2_m2 != other.distance2_m2 ? distance2_m2 > other.distance2_m2
                                              : first < other.first;
  }
};

// Pixels that a metre takes at one metre ahead, in the finest of a set's views.
double pixels_at_a_metre(const ViewSet& views) {
  double most = 0.0;
  for (const ViewDesc& view : views.views) {
    const FrustumTangents& t = view.tangents;
    most = std::max({most, views.width / (t.right - t.left), views.height / (t.top - t.bottom)});
  }
  return most;
}

constexpr double kLeastShare = 0.25;  // of the smallest spots

// Leaves some of the spots out that are smaller than so many pixels, always the same of each size,
// and lets the others have their light.
void thin_out(std::vector<shared::Particle>& particles, double spot_px, double pixels) {
  std::erase_if(particles, [&](shared::Particle& particle) {
    const double range_m = std::max(1e-3, double(glm::length(particle.position)));
    const double own_px = particle.radius_m * pixels / range_m;
    if (!(own_px < spot_px)) return false;
    const double share = std::max(own_px / spot_px, kLeastShare);
    // The lowest byte of a bubble's seed turns with its swing.
    const std::uint64_t of_it = mix64((particle.seed >> 8) + (std::uint64_t{particle.kind} << 32));
    if (static_cast<double>(of_it) * 0x1p-64 >= share) return true;
    particle.opacity = static_cast<float>(particle.opacity / share);
    return false;
  });
}

}  // namespace

std::vector<WorldParticle> snow_around(const scene::Snow& snow, std::uint64_t seed,
                                       const Vec3& center_m, double time_s, double share) {
  std::vector<WorldParticle> out;
  SnowField().append(snow, seed, center_m, time_s, share, out);
  return out;
}

bool has_particles(const scene::Scene& scene) {
  return scene.water &&
         (scene.water->snow || !scene.water->bubbles.empty() || !scene.water->silt.empty());
}

ViewParticles view_particles(const scene::MotionSource& motion, SnowField& snow,
                             BubbleField& bubbles, std::uint64_t seed, const ViewSet& views,
                             double time_s, double snow_share, double spot_px,
                             const SkylightGrid* skylight) {
  ViewParticles out;
  // The phase of bubbles' wobble now, in 256ths of a turn.
  const double swings = time_s * shared::kWobble_hz;
  const auto swing = static_cast<std::uint32_t>(256.0 * (swings - std::floor(swings)));
  const scene::Water& water = *motion.scene().water;
  const SphereCulling sight(views);
  // Before a lamp a grain may be far brighter than the water.
  const bool dim = motion.scene().lamps.empty() && motion.scene().model_lights.empty();
  std::vector<shared::Particle> placed;
  std::vector<Drawn> drawn;
  if (water.snow) {
    std::vector<SnowField::Run> cells;
    snow.place(*water.snow, seed, sight, time_s, snow_share, dim ? pixels_at_a_metre(views) : 0.0,
               placed, cells);
    for (const SnowField::Run& cell : cells)
      drawn.push_back({false, cell.distance2_m2, cell.first, cell.count});
    out.shutter_s = water.snow->shutter_s;
  }
  std::vector<WorldParticle> others;
  for (std::size_t i = 0; i < water.bubbles.size(); ++i)
    bubbles.append(motion, water.bubbles[i], i, seed, time_s, others, &sight);
  for (std::size_t i = 0; i < water.silt.size(); ++i)
    add_silt(motion, water.silt[i], i, seed, time_s, others);
  for (const WorldParticle& particle : others) {
    const Vec3 at = particle.position_m - sight.origin_m();
    if (!(particle.opacity > 0.0 && sight.may_see(at, particle.radius_m + kSpotRoom_m))) continue;
    const bool bubble = particle.kind == shared::kParticleBubble;
    drawn.push_back({bubble, glm::dot(at, at), placed.size(), 1});
    placed.push_back({Vec3f(at), static_cast<float>(particle.radius_m),
                      Vec3f(particle.velocity_m_s * out.shutter_s),
                      static_cast<float>(particle.opacity), particle.kind,
                      bubble ? wobbling(particle.seed, swing) : particle.seed});
  }
  // Bubbles first: they have a pipeline of their own. The error where silt or snow floats behind
  // a bubble is too small to be seen.
  std::ranges::sort(drawn, std::less{});
  out.particles.reserve(placed.size());
  for (const Drawn& some : drawn)
    out.particles.insert(out.particles.end(), placed.begin() + std::ptrdiff_t(some.first),
                         placed.begin() + std::ptrdiff_t(some.first + some.count));
  if (spot_px > 0.0) thin_out(out.particles, spot_px, pixels_at_a_metre(views));
  if (skylight)
    for (shared::Particle& particle : out.particles) {
      const double open = skylight->at(sight.origin_m() + Vec3(particle.position));
      particle.kind |= static_cast<std::uint32_t>(std::lround(255.0 * (1.0 - open)))
                       << shared::kParticleShadeShift;
    }
  return out;
}

}  // namespace neritic::render
