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
  // Appends the snow within range_m of a point, as snow_around says. Other settings or another seed
  // than the call before it forget all cells.
  void append(const scene::Snow& snow, std::uint64_t seed, const Vec3& center_m, double time_s,
              const ViewSet* views, double share, std::vector<WorldParticle>& out);
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

  const std::vector<Grain>& grains_of(const Place& place);
  void forget_unused();

  std::unordered_map<Place, Cell, HashOf> cells_;
  double density_m3_ = -1.0, diameter_m_ = 0.0, spread_ = 0.0;
  std::uint64_t seed_ = 0, calls_ = 0;
};

}  // namespace neritic::render
