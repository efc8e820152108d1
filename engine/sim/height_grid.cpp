// A seabed's triangles, rays and heights.
#include "engine/sim/height_grid.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::sim {

Result<HeightGrid> HeightGrid::build(std::uint32_t columns, std::uint32_t rows, double cell_m,
                                     std::span<const float> heights_m, const std::string& name) {
  if (columns < 2 || rows < 2 || heights_m.size() != std::size_t{columns} * rows)
    return refusal(name, fmt::format("{} heights for {} x {}", heights_m.size(), rows, columns),
                   "at least 2 x 2, one each");
  if (heights_m.size() > std::size_t{1} << 30)
    return refusal(name, fmt::format("{} heights", heights_m.size()), "up to 2^30");
  if (!std::isfinite(cell_m) || cell_m <= 0.0)
    return refusal(name, fmt::format("cells of {} m", cell_m), "above 0");
  for (std::size_t i = 0; i < heights_m.size(); ++i)
    if (std::isinf(heights_m[i]))
      return refusal(fmt::format("{}: height {}", name, i), "infinity", "numbers, NaN for none");
  HeightGrid grid;
  grid.columns_ = columns;
  grid.rows_ = rows;
  grid.cell_m_ = cell_m;
  grid.heights_.assign(heights_m.begin(), heights_m.end());
  for (std::uint32_t row = 0; row + 1 < rows; ++row)
    for (std::uint32_t column = 0; column + 1 < columns; ++column) {
      Box box;
      for (const Corner& at : {Corner{column, row}, Corner{column + 1, row},
                               Corner{column, row + 1}, Corner{column + 1, row + 1}})
        if (grid.present(at[0], at[1])) box.add(grid.sample(at[0], at[1]));
      grid.low_.push_back(static_cast<float>(box.low.y));
      grid.high_.push_back(static_cast<float>(box.high.y));
      if (!box.empty()) grid.bounds_.add(box);
    }
  return grid;
}

Vec3 HeightGrid::sample(std::uint32_t column, std::uint32_t row) const {
  return {(column - 0.5 * (columns_ - 1.0)) * cell_m_,
          heights_[std::size_t{row} * columns_ + column], (row - 0.5 * (rows_ - 1.0)) * cell_m_};
}

bool HeightGrid::present(std::uint32_t column, std::uint32_t row) const {
  return !std::isnan(heights_[std::size_t{row} * columns_ + column]);
}

HeightGrid::Span HeightGrid::cells_between(double low, double high, std::uint32_t samples) const {
  const double cells = samples - 1.0;
  const double first = std::floor(low / cell_m_ + 0.5 * cells);
  const double last = std::floor(high / cell_m_ + 0.5 * cells);
  if (!(last >= 0.0) || !(first < cells)) return {};
  return {static_cast<std::uint32_t>(std::max(first, 0.0)),
          static_cast<std::uint32_t>(std::min(last + 1.0, cells))};
}

std::optional<std::array<HeightGrid::Corner, 3>> HeightGrid::corners(std::uint32_t index) const {
  const std::uint32_t column = index / 2 % (columns_ - 1), row = index / 2 / (columns_ - 1);
  const Corner nw{column, row}, ne{column + 1, row}, sw{column, row + 1}, se{column + 1, row + 1};
  const auto has = [&](const Corner& at) { return present(at[0], at[1]); };
  const bool second = index % 2 == 1;
  const std::array<Corner, 3> triangle =
      has(sw) && has(ne) ? (second ? std::array{ne, sw, se} : std::array{nw, sw, ne})
                         : (second ? std::array{nw, se, ne} : std::array{nw, sw, se});
  for (const Corner& corner : triangle)
    if (!has(corner)) return std::nullopt;
  return triangle;
}

std::optional<std::uint32_t> HeightGrid::with_edge(std::int64_t column, std::int64_t row,
                                                   const Corner& a, const Corner& b,
                                                   std::uint32_t but) const {
  if (column < 0 || row < 0 || column + 1 >= columns_ || row + 1 >= rows_) return std::nullopt;
  const auto cell = static_cast<std::uint32_t>(row * (columns_ - 1) + column);
  for (std::uint32_t index = 2 * cell; index < 2 * cell + 2; ++index) {
    if (index == but) continue;
    const auto triangle = corners(index);
    if (!triangle) continue;
    if (std::count(triangle->begin(), triangle->end(), a) +
            std::count(triangle->begin(), triangle->end(), b) ==
        2)
      return index;
  }
  return std::nullopt;
}

std::optional<Triangle> HeightGrid::triangle(std::uint32_t index, double scale,
                                             const Vec3& offset) const {
  const auto own = corners(index);
  if (!own) return std::nullopt;
  Triangle out;
  out.index = index;
  for (std::size_t i = 0; i < 3; ++i)
    out.corner[i] = sample((*own)[i][0], (*own)[i][1]) * scale + offset;
  return out;
}

void HeightGrid::link(Triangle& triangle, double scale, const Vec3& offset) const {
  const std::uint32_t index = triangle.index;
  const auto own = *corners(index);
  const std::int64_t column = index / 2 % (columns_ - 1), row = index / 2 / (columns_ - 1);
  for (std::size_t i = 0; i < 3; ++i) {
    const Corner &a = own[i], &b = own[(i + 1) % 3];
    // Across an edge along x lies the cell in the next or previous row, along z in the next or
    // previous column, across the cut the cell itself.
    std::int64_t next_column = column, next_row = row;
    if (a[1] == b[1]) next_row += a[1] == row ? -1 : 1;
    if (a[0] == b[0]) next_column += a[0] == column ? -1 : 1;
    const auto other = with_edge(next_column, next_row, a, b, index);
    if (!other) continue;
    const auto across = *corners(*other);
    for (const Corner& corner : across)
      if (corner != a && corner != b)
        triangle.across[i] = sample(corner[0], corner[1]) * scale + offset;
    triangle.shared[i] = true;
    triangle.owned[i] = index < *other;
  }
}

std::optional<HeightGrid::Hit> HeightGrid::cast(const Vec3& origin, const Vec3& direction,
                                                double max_distance) const {
  // The part of the ray within the grid's box.
  double from = 0.0, to = max_distance;
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0.0) {
      if (origin[axis] < bounds_.low[axis] || origin[axis] > bounds_.high[axis])
        return std::nullopt;
      continue;
    }
    const double a = (bounds_.low[axis] - origin[axis]) / direction[axis];
    const double b = (bounds_.high[axis] - origin[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  // Its ends widened by what rounding may have cost.
  const double slack = 1e-9 * (1.0 + std::abs(from) + glm::length(bounds_.half()));
  from = std::max(from - slack, 0.0);
  to = std::min(to + slack, max_distance);
  // Piece by piece, each over a few cells, until one has the nearest hit. A piece's box may meet
  // cells that the ray enters later, hence the test of its end.
  const double along_ground = std::hypot(direction.x, direction.z);
  const double piece = along_ground > 0.0 ? 4.0 * cell_m_ / along_ground : to - from + 1.0;
  std::optional<Hit> nearest;
  for (double at = from; at <= to; at += piece) {
    Box box;
    box.add(origin + direction * at);
    box.add(origin + direction * std::min(at + piece, to));
    overlapping(box.grown(slack), [&](std::uint32_t index) {
      const auto seen = triangle(index, 1.0, -origin);
      if (!seen) return;
      const double limit = nearest ? nearest->distance : max_distance;
      const auto distance = ray_distance(*seen, Vec3(0.0), direction, limit);
      if (distance && (!nearest || *distance < limit || index < nearest->triangle))
        nearest = Hit{index, *distance};
    });
    if (nearest && nearest->distance <= at + piece) return nearest;
  }
  return nearest;
}

std::optional<double> HeightGrid::height(double x, double z) const {
  const Span columns = cells_between(x, x, columns_), rows = cells_between(z, z, rows_);
  if (columns.first == columns.end || rows.first == rows.end) return std::nullopt;
  const std::uint32_t cell = rows.first * (columns_ - 1) + columns.first;
  for (std::uint32_t index = 2 * cell; index < 2 * cell + 2; ++index) {
    const auto seen = triangle(index, 1.0, Vec3(0.0));
    if (!seen) continue;
    const double above = bounds_.high.y + 1.0;
    const auto distance =
        ray_distance(*seen, Vec3(x, above, z), Vec3(0.0, -1.0, 0.0), above - bounds_.low.y + 1.0);
    if (distance) return above - *distance;
  }
  return std::nullopt;
}

}  // namespace neritic::sim
