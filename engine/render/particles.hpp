// Where the particles of a scene's water are at an instant, in double, before any view is drawn:
// marine snow, bubbles, silt. Counter-based: the same seed, time and place give the same particles
// whoever looks. Pure functions; any thread.
#pragma once

#include <vector>

#include "engine/render/views.hpp"
#include "engine/scene/motion.hpp"
#include "shared/particles.h"

namespace neritic::render {

class BubbleField;
class SnowField;
struct SkylightGrid;

// A particle in the world.
struct WorldParticle {
  Vec3 position_m{0.0}, velocity_m_s{0.0};
  double radius_m = 0.0, opacity = 1.0;
  std::uint32_t kind = 0, seed = 0;
};

// Blur and streaks make a spot wider than its particle by this.
inline constexpr double kSpotRoom_m = 0.02;

// Snow within range_m of a point, that drifts and stays in the water while cameras move. share: of
// the snow.
std::vector<WorldParticle> snow_around(const scene::Snow& snow, std::uint64_t seed,
                                       const Vec3& center_m, double time_s, double share = 1.0);

// Speed at which a bubble rises in still water.
double bubble_speed_m_s(double radius_m);
// A source's silt at a time; number: of the source, for its randomness. Bubbles: bubble_field.hpp.
void add_silt(const scene::MotionSource& motion, const scene::SiltSource& source,
              std::uint64_t number, std::uint64_t seed, double time_s,
              std::vector<WorldParticle>& out);

// All particles that a view set sees at a time, relative to its origin, kind by kind, each kind
// from far to near; snow by the cells of its lattice, behind the silt and before it.
struct ViewParticles {
  std::vector<shared::Particle> particles;
  std::vector<std::uint32_t> kinds;  // that the scene's water may show at any time
  double shutter_s = 0.0;            // of the exposure, for streaks
};
bool has_particles(const scene::Scene& scene);
// snow, bubbles: what they keep from call to call. spot_px: those of a smaller radius in the
// picture are drawn in part (at least a quarter of them), each as much more opaque; 0: all are
// drawn. skylight: dims those that it leaves in the dark; nullptr: none.
ViewParticles view_particles(const scene::MotionSource& motion, SnowField& snow,
                             BubbleField& bubbles, std::uint64_t seed, const ViewSet& views,
                             double time_s, double snow_share = 1.0, double spot_px = 0.0,
                             const SkylightGrid* skylight = nullptr);

}  // namespace neritic::render
