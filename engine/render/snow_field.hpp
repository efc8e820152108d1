// Marine snow, cell by cell of a lattice in the water: the grains of a cell follow from the seed
// and its place alone, so a cell that stays in sight is made once and kept. One thread at a time.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "engine/render/particles.hpp"

namespace neritic::render {

class SnowField {
 public:
  // Finds the cells in sight, within range_m of its origin, for place; sight must outlive that.
  // share: of the grains. faint_pixels: that a metre takes at one metre ahead; if not 0, grains too
  // faint to be seen there are left out. Other settings or another seed than the call before it
  // forget all cells.
  void find(const scene::Snow& snow, std::uint64_t seed, const SphereCulling& sight, double time_s,
            double share, double faint_pixels);
  // Appends the snow of the cells found whose middle lies farther than that, and of which no call
  // placed it, relative to the origin of the sight, cell by cell from far to near.
  void place(double beyond2_m2, std::vector<shared::Particle>& out);
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

  // Values that all grains of a call share; lengths are from the point that is looked from.
  struct Water {
    Water(const scene::Snow& snow, const Vec3& center_m, double time_s, double share);
    double cell_m, half_m, widest_m;  // a cell's side, half its diagonal, what grains stick out
    Vec3 center_m;                    // in the water's own frame
    double surface_m, range_m, fades_m, share;  // surface: how high above the point
    Vec3 middle_of(const Place& place) const {
      return cell_m * (Vec3(place.x, place.y, place.z) + 0.5) - center_m;
    }
  };
  struct Found {
    Place place;
    Vec3 middle_m{0.0};
    Cell* cell = nullptr;
    std::span<const Grain> grains;  // the cell's
  };
  // A found cell's number, and how far off its middle is.
  struct Turn {
    double distance2_m2 = 0.0;
    std::size_t which = 0;
  };

  void begin(const scene::Snow& snow, std::uint64_t seed);
  template <typename Narrow, typename Visit>
  static void visit_cells(const Water& water, const Narrow& narrow, const Visit& visit);
  template <typename Visit>
  static void visit_grains(const Water& water, std::span<const Grain> grains, const Vec3& middle_m,
                           const Visit& visit);
  Cell& cell_of(const Place& place);
  void forget_unused(std::size_t seen);

  std::unordered_map<Place, Cell, HashOf> cells_;
  double density_m3_ = -1.0, diameter_m_ = 0.0, spread_ = 0.0;
  std::uint64_t seed_ = 0, calls_ = 0;
  // Results of the newest find().
  std::vector<Found> found_, before_;  // in the order of their places; of the find before
  std::vector<Turn> turns_;            // from far to near
  std::size_t placed_ = 0;             // turns
  std::size_t grains_ = 0;             // that the find before placed
  const SphereCulling* sight_ = nullptr;
  std::optional<Water> water_;
  Vec3f moved_m_{0.0f};
  double faint_pixels_ = 0.0;
  SphereCulling::Part part_;
};

}  // namespace neritic::render
