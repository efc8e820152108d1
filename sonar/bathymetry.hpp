// A chart of the bottom that grows with each ping: per cell the mean depth, its spread and the
// number of soundings. Sums are exact integers (positions and depths in steps of 2^-16 m), so that
// the same soundings give the same bits in any order. World frame: Y up, depth = -y. One owner, one
// thread; write_bathymetry: any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::sonar {

// Rows from north (-z) to south, columns from west (-x) to east, as heightfields are.
struct BathymetryGrid {
  double cell_m = 1.0;
  std::int64_t first_column = 0, first_row = 0;  // cell (0, 0) has its corner at these * cell_m
  std::uint32_t columns = 0, rows = 0;
  std::vector<std::uint32_t> count;            // [rows][columns] soundings
  std::vector<double> mean_m;                  // depth; NaN where count is 0
  std::vector<float> deviation_m;              // of the depths in a cell, population; NaN alike
  std::vector<std::array<float, 2>> centroid;  // mean x, z of a cell's soundings, 0 to 1 across it

  std::size_t cells() const { return count.size(); }
  double west_m() const { return static_cast<double>(first_column) * cell_m; }
  double north_m() const { return static_cast<double>(first_row) * cell_m; }
};

class Bathymetry {
 public:
  // cell_m > 0 and finite (CHECKed).
  explicit Bathymetry(double cell_m);

  // A sounding at its point in the world. Points that are not finite, deeper or higher than 1e6 m
  // or more than 2^30 cells from the origin are left out and counted.
  void add(const Vec3& point_world_m);
  void add(std::span<const Vec3> points_world_m);
  std::uint64_t soundings() const { return soundings_; }
  std::uint64_t left_out() const { return left_out_; }

  // The box of all cells that were sounded. kBadInput where it holds more than 2^26 cells; no
  // soundings give a grid of 0 x 0.
  Result<BathymetryGrid> grid() const;

 private:
  struct Cell {
    std::int64_t count = 0, depth = 0, x = 0, z = 0;  // sums; x, z within the cell
    __int128 squares = 0;                             // of depths
  };
  static constexpr std::int64_t kTile = 32;  // cells a side that are allocated together
  using Tile = std::vector<Cell>;            // [kTile][kTile]
  Tile& tile_of(std::int64_t column, std::int64_t row);

  double cell_m_;
  std::map<std::array<std::int64_t, 2>, Tile> tiles_;  // by row, column of tiles
  std::array<std::int64_t, 2> last_key_{};
  Tile* last_ = nullptr;
  std::uint64_t soundings_ = 0, left_out_ = 0;
};

// The chart: colours by depth under light from the north-west, scale bar, legend. RGB, at
// most height_px high. A grid without soundings gives an empty chart.
ImageU8 draw_bathymetry(const BathymetryGrid& grid, const std::string& title = "BATHYMETRY",
                        std::uint32_t height_px = 900);

// bathymetry.npy float64 [rows, columns] (mean depth, NaN: none), bathymetry_deviation.npy float32,
// bathymetry_count.npy uint32, bathymetry.png and, last, bathymetry.json: cell size, corner, bounds
// and facts.
Status write_bathymetry(const std::filesystem::path& folder, const BathymetryGrid& grid,
                        const nlohmann::json& facts);

}  // namespace neritic::sonar
