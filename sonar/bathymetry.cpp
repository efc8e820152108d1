#include "sonar/bathymetry.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/core/check.hpp"
#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/refusal.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic::sonar {
namespace {

constexpr double kSteps = 65536.0;  // a metre
constexpr double kMaxDepth_m = 1e6, kMaxCells = 1 << 30;
constexpr std::size_t kMaxGridCells = std::size_t{1} << 26;

std::int64_t floor_divide(std::int64_t a, std::int64_t b) {
  return a / b - (a % b < 0 ? 1 : 0);
}

// The population's deviation in metres from exact sums. Around the whole mean the integers stay
// small, so that a spread of millimetres at 10 km of depth keeps its digits.
double deviation_of(std::int64_t count, std::int64_t depth, __int128 squares) {
  const std::int64_t mean = floor_divide(depth, count);
  const __int128 about = squares - 2 * static_cast<__int128>(mean) * depth +
                         static_cast<__int128>(mean) * mean * count;
  const double n = static_cast<double>(count);
  const double rest = static_cast<double>(depth - mean * count) / n;
  return std::sqrt(std::max(0.0, static_cast<double>(about) / n - rest * rest)) / kSteps;
}

}  // namespace

Bathymetry::Bathymetry(double cell_m) : cell_m_(cell_m) {
  NERITIC_CHECK(cell_m > 0.0 && std::isfinite(cell_m), "cell of {} m", cell_m);
}

Bathymetry::Tile& Bathymetry::tile_of(std::int64_t column, std::int64_t row) {
  const std::array key{floor_divide(row, kTile), floor_divide(column, kTile)};
  if (last_ == nullptr || key != last_key_) {
    last_ = &tiles_[key];
    last_key_ = key;
    if (last_->empty()) last_->resize(kTile * kTile);
  }
  return *last_;
}

void Bathymetry::add(const Vec3& p) {
  const double across = p.x / cell_m_, down = p.z / cell_m_;
  if (!is_finite(p) || std::abs(p.y) > kMaxDepth_m || !(std::abs(across) < kMaxCells) ||
      !(std::abs(down) < kMaxCells)) {
    ++left_out_;
    return;
  }
  const double column = std::floor(across), row = std::floor(down);
  const auto c = static_cast<std::int64_t>(column), r = static_cast<std::int64_t>(row);
  Tile& tile = tile_of(c, r);
  Cell& cell = tile[static_cast<std::size_t>((r - floor_divide(r, kTile) * kTile) * kTile +
                                             (c - floor_divide(c, kTile) * kTile))];
  const std::int64_t depth = std::llround(-p.y * kSteps);
  ++cell.count;
  cell.depth += depth;
  cell.squares += static_cast<__int128>(depth) * depth;
  cell.x += std::llround((across - column) * kSteps);
  cell.z += std::llround((down - row) * kSteps);
  ++soundings_;
}

void Bathymetry::add(std::span<const Vec3> points_world_m) {
  for (const Vec3& p : points_world_m) add(p);
}

Result<BathymetryGrid> Bathymetry::grid() const {
  BathymetryGrid out;
  out.cell_m = cell_m_;
  constexpr auto kLeast = std::numeric_limits<std::int64_t>::min();
  std::int64_t west = -(kLeast + 1), north = west, east = kLeast, south = kLeast;
  const auto each_cell = [&](auto&& f) {
    for (const auto& [key, tile] : tiles_)
      for (std::int64_t i = 0; i < kTile * kTile; ++i)
        if (const Cell& cell = tile[static_cast<std::size_t>(i)]; cell.count > 0)
          f(key[1] * kTile + i % kTile, key[0] * kTile + i / kTile, cell);
  };
  each_cell([&](std::int64_t column, std::int64_t row, const Cell&) {
    west = std::min(west, column);
    east = std::max(east, column);
    north = std::min(north, row);
    south = std::max(south, row);
  });
  if (soundings_ == 0) return out;
  // At most 2^31 + 1 either way: the product fits.
  const auto columns = static_cast<std::uint64_t>(east - west + 1),
             rows = static_cast<std::uint64_t>(south - north + 1);
  if (columns * rows > kMaxGridCells)
    return refusal("bathymetry",
                   fmt::format("soundings over {} x {} cells of {} m", rows, columns, cell_m_),
                   fmt::format("at most {} cells in all", kMaxGridCells));
  out.first_column = west;
  out.first_row = north;
  out.columns = static_cast<std::uint32_t>(columns);
  out.rows = static_cast<std::uint32_t>(rows);
  const std::size_t cells = columns * rows;
  out.count.assign(cells, 0);
  out.mean_m.assign(cells, std::numeric_limits<double>::quiet_NaN());
  out.deviation_m.assign(cells, std::numeric_limits<float>::quiet_NaN());
  out.centroid.assign(cells, {0.5f, 0.5f});
  each_cell([&](std::int64_t column, std::int64_t row, const Cell& cell) {
    const auto at =
        static_cast<std::size_t>(row - north) * columns + static_cast<std::size_t>(column - west);
    const double n = static_cast<double>(cell.count);
    out.count[at] = static_cast<std::uint32_t>(std::min<std::int64_t>(cell.count, 0xffffffff));
    out.mean_m[at] = static_cast<double>(cell.depth) / n / kSteps;
    out.deviation_m[at] = static_cast<float>(deviation_of(cell.count, cell.depth, cell.squares));
    out.centroid[at] = {static_cast<float>(static_cast<double>(cell.x) / n / kSteps),
                        static_cast<float>(static_cast<double>(cell.z) / n / kSteps)};
  });
  return out;
}

Status write_bathymetry(const std::filesystem::path& folder, const BathymetryGrid& grid,
                        const nlohmann::json& facts) {
  NERITIC_TRY_STATUS(make_folder(folder));
  const std::size_t rows = grid.rows, columns = grid.columns, shape[] = {rows, columns};
  NERITIC_TRY_STATUS(
      write_npy(folder / "bathymetry.npy", std::span<const double>(grid.mean_m), {rows, columns}));
  NERITIC_TRY_STATUS(write_npy(folder / "bathymetry_deviation.npy",
                               std::span<const float>(grid.deviation_m), {rows, columns}));
  NERITIC_TRY_STATUS(write_npy(folder / "bathymetry_count.npy", NpyType::kUint32, shape,
                               std::as_bytes(std::span(grid.count))));
  NERITIC_TRY_STATUS(scene::write_png8(folder / "bathymetry.png", draw_bathymetry(grid)));
  nlohmann::json json = facts;
  json["cell_m"] = grid.cell_m;
  json["rows"] = grid.rows;
  json["columns"] = grid.columns;
  json["west_m"] = grid.west_m();
  json["north_m"] = grid.north_m();
  json["soundings"] = std::accumulate(grid.count.begin(), grid.count.end(), std::uint64_t{0});
  json["cells_sounded"] = grid.count.size() - static_cast<std::size_t>(std::count(
                                                  grid.count.begin(), grid.count.end(), 0u));
  json["layout"] =
      "[row, column]: row 0 is north (-z), column 0 west (-x); cell (0, 0) has its corner at "
      "x = west_m, z = north_m";
  json["units"] = "metres of depth, positive down from y = 0; NaN: no sounding";
  json["sums"] = "exact integers of 2^-16 m: the order of soundings changes nothing";
  return write_json(folder / "bathymetry.json", json);
}

}  // namespace neritic::sonar
