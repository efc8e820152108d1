#include "engine/render/particles.hpp"

#include <algorithm>
#include <cmath>
#include <span>

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

// Kinds have pipelines of their own, so they follow one another. The errors where snow or silt
// floats behind a bubble, and snow among silt, are too small to be seen.
enum class Layer { kBubbleSpots, kBubbles, kSnowBehind, kSilt, kSnowBefore };

Layer layer_of(std::uint32_t kind) {
  if (kind == shared::kParticleSilt) return Layer::kSilt;
  return kind == shared::kParticleBubble ? Layer::kBubbles : Layer::kBubbleSpots;
}

// Particles in a row that are drawn together.
struct Drawn {
  Layer layer;
  double distance2_m2;
  std::size_t first, count;
  bool operator<(const Drawn& other) const {
    if (layer != other.layer) return layer < other.layer;
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
    // The lowest byte of a bubble's seed turns with its swing; its kind changes with its size.
    const std::uint64_t of_it = mix64(particle.seed >> 8);
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
  const double pixels = pixels_at_a_metre(views);
  std::vector<shared::Particle> placed;
  std::vector<Drawn> drawn;
  if (water.snow) {
    out.kinds.push_back(shared::kParticleSnow);
    std::vector<SnowField::Run> cells;
    snow.place(*water.snow, seed, sight, time_s, snow_share, dim ? pixels : 0.0, placed, cells);
    for (const SnowField::Run& cell : cells)
      drawn.push_back({Layer::kSnowBefore, cell.distance2_m2, cell.first, cell.count});
    out.shutter_s = water.snow->shutter_s;
  }
  if (!water.bubbles.empty())
    out.kinds.insert(out.kinds.end(), {shared::kParticleBubbleSpot, shared::kParticleBubble});
  if (!water.silt.empty()) out.kinds.push_back(shared::kParticleSilt);
  const std::size_t snow_cells = drawn.size();
  std::vector<double> silt_m2;  // squared distances
  std::vector<WorldParticle> others;
  for (std::size_t i = 0; i < water.bubbles.size(); ++i)
    bubbles.append(motion, water.bubbles[i], i, seed, time_s, others, &sight);
  for (std::size_t i = 0; i < water.silt.size(); ++i)
    add_silt(motion, water.silt[i], i, seed, time_s, others);
  for (const WorldParticle& particle : others) {
    const Vec3 at = particle.position_m - sight.origin_m();
    if (!(particle.opacity > 0.0 && sight.may_see(at, particle.radius_m + kSpotRoom_m))) continue;
    const bool bubble = particle.kind == shared::kParticleBubble;
    const double distance2_m2 = glm::dot(at, at);
    const bool spot =
        bubble && particle.radius_m * pixels < shared::kBubbleSpot_px * std::sqrt(distance2_m2);
    const std::uint32_t kind = spot ? shared::kParticleBubbleSpot : particle.kind;
    drawn.push_back({layer_of(kind), distance2_m2, placed.size(), 1});
    if (drawn.back().layer == Layer::kSilt) silt_m2.push_back(distance2_m2);
    placed.push_back({Vec3f(at), static_cast<float>(particle.radius_m),
                      Vec3f(particle.velocity_m_s * out.shutter_s),
                      static_cast<float>(particle.opacity), kind,
                      bubble ? wobbling(particle.seed, swing) : particle.seed});
  }
  if (!silt_m2.empty()) {
    const auto middle = silt_m2.begin() + static_cast<std::ptrdiff_t>(silt_m2.size() / 2);
    std::ranges::nth_element(silt_m2, middle);
    for (Drawn& snow_cell : std::span(drawn).first(snow_cells))
      if (snow_cell.distance2_m2 > *middle) snow_cell.layer = Layer::kSnowBehind;
  }
  std::ranges::sort(drawn, std::less{});
  out.particles.reserve(placed.size());
  for (const Drawn& some : drawn)
    out.particles.insert(out.particles.end(), placed.begin() + std::ptrdiff_t(some.first),
                         placed.begin() + std::ptrdiff_t(some.first + some.count));
  if (spot_px > 0.0) thin_out(out.particles, spot_px, pixels);
  if (skylight)
    for (shared::Particle& particle : out.particles) {
      const double open = skylight->at(sight.origin_m() + Vec3(particle.position));
      particle.kind |= static_cast<std::uint32_t>(std::lround(255.0 * (1.0 - open)))
                       << shared::kParticleShadeShift;
    }
  return out;
}

}  // namespace neritic::render
