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

// Kinds have pipelines of their own, so they follow one another. The errors where snow or silt
// floats behind a bubble, and snow among silt, are too small to be seen.
enum class Layer { kBubbleSpots, kBubbles, kSilt };

Layer layer_of(std::uint32_t kind) {
  if (kind == shared::kParticleSilt) return Layer::kSilt;
  return kind == shared::kParticleBubble ? Layer::kBubbles : Layer::kBubbleSpots;
}

// A particle among those placed.
struct Drawn {
  Layer layer;
  double distance2_m2;
  std::size_t which;
  bool operator<(const Drawn& other) const {
    if (layer != other.layer) return layer < other.layer;
    return distance2_m2 != other.distance2_m2 ? distance2_m2 > other.distance2_m2
                                              : which < other.which;
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
  if (water.snow) {
    out.kinds.push_back(shared::kParticleSnow);
    snow.find(*water.snow, seed, sight, time_s, snow_share, dim ? pixels : 0.0);
    out.shutter_s = water.snow->shutter_s;
  }
  if (!water.bubbles.empty())
    out.kinds.insert(out.kinds.end(), {shared::kParticleBubbleSpot, shared::kParticleBubble});
  if (!water.silt.empty()) out.kinds.push_back(shared::kParticleSilt);
  std::vector<WorldParticle> others;
  for (std::size_t i = 0; i < water.bubbles.size(); ++i)
    bubbles.append(motion, water.bubbles[i], i, seed, time_s, others, &sight);
  for (std::size_t i = 0; i < water.silt.size(); ++i)
    add_silt(motion, water.silt[i], i, seed, time_s, others);
  std::vector<shared::Particle> placed;
  std::vector<Drawn> drawn;
  for (const WorldParticle& particle : others) {
    const Vec3 at = particle.position_m - sight.origin_m();
    if (!(particle.opacity > 0.0 && sight.may_see(at, particle.radius_m + kSpotRoom_m))) continue;
    const bool bubble = particle.kind == shared::kParticleBubble;
    const double distance2_m2 = glm::dot(at, at);
    const bool spot =
        bubble && particle.radius_m * pixels < shared::kBubbleSpot_px * std::sqrt(distance2_m2);
    const std::uint32_t kind = spot ? shared::kParticleBubbleSpot : particle.kind;
    drawn.push_back({layer_of(kind), distance2_m2, placed.size()});
    placed.push_back({Vec3f(at), static_cast<float>(particle.radius_m),
                      Vec3f(particle.velocity_m_s * out.shutter_s),
                      static_cast<float>(particle.opacity), kind,
                      bubble ? wobbling(particle.seed, swing) : particle.seed});
  }
  std::ranges::sort(drawn, std::less{});
  const auto silt = std::ranges::find(drawn, Layer::kSilt, &Drawn::layer);
  for (auto some = drawn.begin(); some != silt; ++some)
    out.particles.push_back(placed[some->which]);
  if (silt != drawn.end()) {
    // From far to near: that in the middle of them.
    const std::ptrdiff_t count = drawn.end() - silt;
    if (water.snow) snow.place((silt + (count - 1 - count / 2))->distance2_m2, out.particles);
    for (auto some = silt; some != drawn.end(); ++some)
      out.particles.push_back(placed[some->which]);
  }
  if (water.snow) snow.place(-1.0, out.particles);
  if (spot_px > 0.0) thin_out(out.particles, spot_px, pixels);
  if (skylight)
    for (shared::Particle& particle : out.particles) {
      const double open = skylight->at(sight.origin_m() + Vec3(particle.position));
      // Rounded; it may be less than nought by rounding alone, and is cut to nought then.
      const double shade = 255.0 * (1.0 - open);
      const auto whole = static_cast<int>(shade);
      particle.kind |= static_cast<std::uint32_t>(whole + (shade - whole >= 0.5 ? 1 : 0))
                       << shared::kParticleShadeShift;
    }
  return out;
}

}  // namespace neritic::render
