// Bubbles that leave a source breath by breath. What a bubble is follows from the seed, its source
// and its breath alone, so a breath is made once and kept while bubbles of it are seen; where it is
// then follows in closed form from when and where it left. One thread at a time.
#pragma once

#include <cstdint>
#include <limits>
#include <map>
#include <vector>

#include "engine/render/particles.hpp"

namespace neritic {
struct MixedKey;
}

namespace neritic::render {

class BubbleField {
 public:
  // Appends a source's bubbles at a time; number: of the source, for its randomness; sight: only
  // those that may lie in it.
  void append(const scene::MotionSource& motion, const scene::BubbleSource& source,
              std::uint64_t number, std::uint64_t seed, double time_s,
              std::vector<WorldParticle>& out, const SphereCulling* sight = nullptr);

 private:
  struct Plan;
  struct Part {
    double radius_m = 0.0, speed_m_s = 0.0;  // at the source; in still water, with its plume
    Vec3 way{0.0};                           // from the middle of the bubble that broke
    double phase = 0.0;                      // of its swing
    std::uint32_t look = 0;
  };
  struct Bubble {
    double born_s = 0.0, within = 0.0;  // within: its gulp, 0 to 1
    std::size_t gulp = 0;
    Vec2 off{0.0};  // from the plume's axis along x and z, in radii of the plume
    Part part;      // until it breaks
    // Ages: it breaks; all of it is too high to be seen.
    double broken_s = std::numeric_limits<double>::infinity(), gone_s = 0.0;
    double broken_at_m = 0.0;  // over the source
    std::size_t first_part = 0, parts = 0;
  };
  // Bubbles of a breath that leave together. Speeds are those of their parts too.
  struct Gulp {
    std::size_t first = 0, count = 0;  // bubbles
    double slowest_m_s = std::numeric_limits<double>::infinity(), fastest_m_s = 0.0;
    double widest_m = 0.0;  // radius
  };
  struct Breath {
    double begins_s = 0.0;
    std::vector<Bubble> bubbles;  // gulp by gulp
    std::vector<Part> parts;
    std::vector<Gulp> gulps;
  };
  struct Settings {
    std::uint64_t seed = 0;
    double breath_s = 0.0, flow_m3_s = 0.0, median_radius_m = 0.0, height_m = 0.0;
    bool operator==(const Settings&) const = default;
  };
  struct Kept {
    Settings settings;
    std::map<std::int64_t, Breath> breaths;
  };

  static Breath breath_of(const scene::BubbleSource& source, const Plan& plan, std::uint64_t number,
                          std::uint64_t seed, std::int64_t which);
  static void add_gulps(Breath& breath, const Plan& plan);
  static void add_parts(Breath& breath, Bubble& bubble, const MixedKey& key, std::uint64_t index);
  static void add_breath(const scene::MotionSource& motion, const scene::BubbleSource& source,
                         const Plan& plan, const Breath& breath, double time_s,
                         std::vector<WorldParticle>& out, const SphereCulling* sight);
  static void add_bubble(const scene::BubbleSource& source, const Plan& plan, const Breath& breath,
                         const Bubble& bubble, const Vec3& from_m, double time_s,
                         std::vector<WorldParticle>& out, const SphereCulling* sight);
  static void place(const scene::BubbleSource& source, const Vec3& from_m, const Vec2& off,
                    const Part& part, const Vec3& aside_m, double age_s, double rise_m,
                    double rise_m_s, std::vector<WorldParticle>& out);

  std::map<std::uint64_t, Kept> kept_;  // by source
};

}  // namespace neritic::render
