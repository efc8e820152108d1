// Marine snow, cell by cell of a lattice in the water: the grains of a cell follow from the seed
// and its place alone, so a cell that stays in sight is made once and kept. One thread at a time.
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "engine/render/particles.hpp"

namespace neritic::render {

class SnowField {
 public:
  // A cell's grains among those placed, and how far off its middle is.
  struct Run {
    double distance2_m2 = 0.0;
    std::size_t first = 0, count = 0;
  };

  // Places the snow in sight, within range_m of its origin and relative to it, cell by cell; share:
  // of the grains. faint_pixels: that a metre takes at one metre ahead; if not 0, grains too faint
  // to be seen there are left out. Other settings or another seed than the call before it forget
  // all cells.
  void place(const scene::Snow& snow, std::uint64_t seed, const SphereCulling& sight, double time_s,
             double share, double faint_pixels, std::vector<shared::Particle>& out,
             std::vector<Run>& runs);
  // All of it around a point, as snow_around says.
  void append(const scene::Snow& snow, std::uint64_t seed, const Vec3& center_m, double time_s,
              double share, std::vector<WorldParticle>& out);
  std::size_t cells() const { return cells_.size(); }

 private:
  struct Grain {
    Vec3 place_m{0.0};  // in the water's own frame
    double radius_m = 0.0, opacity = 0.0;
    std::uint32_t look = 0;
  };
  struct Place {
    std::int64_t x = 0, y = 0, z = 0;
    bool operator==(const Place&) const = default;
  };
  struct HashOf {
    std::size_t operator()(const Place& p) const;
  };
  struct Cell {
    std::vector<Grain> grains;
    std::uint64_t used = 0;  // the call that saw it last
  };

  void begin(const scene::Snow& snow, std::uint64_t seed);
  template <typename Wanted, typename Visit>
  void visit(const scene::Snow& snow, const Vec3& center_m, double time_s, double share,
             const Wanted& wanted, const Visit& visit_grain);
  const std::vector<Grain>& grains_of(const Place& place);
  void forget_unused();

  std::unordered_map<Place, Cell, HashOf> cells_;
  double density_m3_ = -1.0, diameter_m_ = 0.0, spread_ = 0.0;
  std::uint64_t seed_ = 0, calls_ = 0;
  std::size_t placed_ = 0;  // by the call before
};

}  // namespace neritic::render
