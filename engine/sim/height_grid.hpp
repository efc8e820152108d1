// The seabed as a grid of heights that things collide with, in its own frame: y up, centred on the
// origin in x and z, row 0 at -z; cells are cut from their low x, high z corner to their high x,
// low z corner, where a height is missing the other way, and triangles with a missing corner are
// holes. Solid below. Immutable; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/sim/triangle.hpp"

namespace neritic::sim {

class HeightGrid {
 public:
  // heights_m [rows][columns], NaN where there are none; at least 2 x 2. name stands in messages.
  static Result<HeightGrid> build(std::uint32_t columns, std::uint32_t rows, double cell_m,
                                  std::span<const float> heights_m, const std::string& name);

  std::size_t triangle_count() const { return cells() * 2; }  // holes included
  const Box& bounds() const { return bounds_; }

  // Triangle 2 c or 2 c + 1 of cell c, times scale and moved by offset; nothing where it is a hole.
  // link() adds what lies across its edges.
  std::optional<Triangle> triangle(std::uint32_t index, double scale, const Vec3& offset) const;
  void link(Triangle& triangle, double scale, const Vec3& offset) const;

  // Calls found(index) for the triangles whose cell and heights the box overlaps, in rows.
  template <class Found>
  void overlapping(const Box& box, Found&& found) const {
    const Span z = cells_between(box.low.z, box.high.z, rows_),
               x = cells_between(box.low.x, box.high.x, columns_);
    for (std::uint32_t row = z.first; row < z.end; ++row)
      for (std::uint32_t column = x.first; column < x.end; ++column) {
        const std::uint32_t cell = row * (columns_ - 1) + column;
        if (low_[cell] > box.high.y || high_[cell] < box.low.y) continue;
        found(2 * cell), found(2 * cell + 1);
      }
  }

  struct Hit {
    std::uint32_t triangle = 0;
    double distance = 0.0;
  };
  std::optional<Hit> cast(const Vec3& origin, const Vec3& direction, double max_distance) const;

  // The surface's height over a point; nothing beside the grid and over holes.
  std::optional<double> height(double x, double z) const;

 private:
  struct Span {
    std::uint32_t first = 0, end = 0;
  };
  std::size_t cells() const { return std::size_t{columns_ - 1} * (rows_ - 1); }
  // Cells of an axis with this number of samples that meet [low, high].
  Span cells_between(double low, double high, std::uint32_t samples) const;
  Vec3 sample(std::uint32_t column, std::uint32_t row) const;
  bool present(std::uint32_t column, std::uint32_t row) const;
  // Corners of a cell's triangle as (column, row).
  using Corner = std::array<std::uint32_t, 2>;
  std::optional<std::array<Corner, 3>> corners(std::uint32_t index) const;
  // The triangle of this cell that has both corners.
  std::optional<std::uint32_t> with_edge(std::int64_t column, std::int64_t row, const Corner& a,
                                         const Corner& b, std::uint32_t but) const;

  std::uint32_t columns_ = 0, rows_ = 0;
  double cell_m_ = 1.0;
  std::vector<float> heights_;
  std::vector<float> low_, high_;  // of each cell's present corners; low above high: none
  Box bounds_;
};

}  // namespace neritic::sim
