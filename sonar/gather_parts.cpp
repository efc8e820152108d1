// How a gather's work is cut into dispatches. A processor's driver (llvmpipe) lets all loops of a
// thread together take 65 535 turns and leaves them then, without a word: a thread that walks a
// column of a large image, or of many bins, would lose the rest.
#include <algorithm>
#include <cmath>

#include "sonar/gather.hpp"

namespace neritic::sonar {
namespace {

constexpr std::uint64_t kMostTurns = 60000;

// For a row: turns of the thread that takes most, the most pixels of a column across, and the rows
// of pixels that any column looks at. A pixel more on either side than the shader's, which rounds
// its floats otherwise.
struct RowOfCells {
  std::uint64_t turns = 1, across = 1;
  std::uint32_t first_v = 0, end_v = 0;
};

class PublishedRows {
 public:
  PublishedRows(const BeamGrid& grid, std::span<const Sector> sectors, const GBufferLayout& layout)
      : layout_(layout), rows_(row_table(grid)) {
    for (const shared::SonarColumn& c : column_table(grid, sectors, layout, Mat3(1.0))) {
      if (c.first_pixel >= c.end_pixel) continue;
      const double a = secant(c.first_pixel), b = secant(c.end_pixel - 1);
      const bool across_axis =
          c.first_pixel < layout.intrinsics.cx && c.end_pixel > layout.intrinsics.cx;
      columns_.push_back({across_axis ? 1.0 : std::min(a, b), std::max(a, b),
                          static_cast<std::uint64_t>(c.end_pixel - c.first_pixel)});
    }
  }

  RowOfCells at(std::uint32_t row) const {
    RowOfCells out;
    out.first_v = layout_.height;
    for (const Column& c : columns_) {
      const double low = rows_[row].z, high = rows_[row].w;
      const std::uint32_t first = below(std::min(-c.inner * high, -c.outer * high) * fy() - 1.0);
      const std::uint32_t end = below(std::max(-c.inner * low, -c.outer * low) * fy() + 1.0);
      if (first >= end) continue;
      out.turns = std::max<std::uint64_t>(out.turns, 1 + (end - first) * (c.across + 1));
      out.across = std::max(out.across, c.across);
      out.first_v = std::min(out.first_v, first);
      out.end_v = std::max(out.end_v, end);
    }
    return out;
  }

 private:
  struct Column {
    double inner, outer;  // 1 / cos of the pixels nearest to the axis and farthest from it
    std::uint64_t across;
  };
  double fy() const { return layout_.intrinsics.fy; }
  double secant(int u) const {
    const double tx = (u + 0.5 - layout_.intrinsics.cx) / layout_.intrinsics.fx;
    return std::sqrt(1.0 + tx * tx);
  }
  // Rows of pixels above a place below the axis.
  std::uint32_t below(double pixels) const {
    const double v = std::floor(layout_.intrinsics.cy - 0.5 + pixels) + 1.0;
    return static_cast<std::uint32_t>(std::clamp(v, 0.0, static_cast<double>(layout_.height)));
  }

  const GBufferLayout& layout_;
  std::vector<glm::vec4> rows_;
  std::vector<Column> columns_;
};

// Rows of cells while they fit; of a cell with too many pixels, its rows of pixels from the last
// to the first, as the shader takes them, with no other cell in between.
std::vector<GatherPart> published_parts(const BeamGrid& grid, std::span<const Sector> sectors,
                                        const GBufferLayout& layout) {
  const PublishedRows rows(grid, sectors, layout);
  std::vector<GatherPart> parts;
  GatherPart part{0, 0, 0, layout.height};
  std::uint64_t turns = 0;
  const auto close = [&](std::uint32_t end_row) {
    part.end_row = end_row;
    if (part.first_row < end_row) parts.push_back(part);
    part.first_row = end_row;
    turns = 0;
  };
  for (std::uint32_t row = 0; row < grid.bins.elevation; ++row) {
    const RowOfCells cells = rows.at(row);
    if (turns + cells.turns > kMostTurns) close(row);
    turns += cells.turns;
    if (cells.turns <= kMostTurns) continue;
    const auto high =
        static_cast<std::uint32_t>(std::max<std::uint64_t>(1, kMostTurns / (cells.across + 1)));
    for (std::uint32_t end_v = cells.end_v; end_v > cells.first_v;) {
      const std::uint32_t first_v = std::max(cells.first_v, end_v > high ? end_v - high : 0);
      parts.push_back({row, row + 1, first_v, end_v});
      end_v = first_v;
    }
    part.first_row = row + 1;
    turns = 0;
  }
  close(grid.bins.elevation);
  return parts;
}

}  // namespace

std::vector<GatherPart> gather_parts(const BeamGrid& grid, std::span<const Sector> sectors,
                                     const GBufferLayout& layout, const GatherOptions& options) {
  if (options.gather == Gather::kPublished) return published_parts(grid, sectors, layout);
  const std::uint32_t n_rows = grid.bins.elevation;
  // Scatterers are known when all rows are.
  if (options.echo && options.echo->coherent) return {{0, n_rows, 0, layout.height}};
  // Rows' footprints abut, so a surface takes a turn a bin; the eight columns that a processor
  // takes together may differ.
  std::uint64_t turns = 4 * std::uint64_t{n_rows};
  if (footprint_of(grid, options) != shared::kSonarFootprintNone)
    turns += 8 * std::uint64_t{grid.bins.range};
  const auto n_parts = static_cast<std::uint32_t>((turns + kMostTurns - 1) / kMostTurns);
  const std::uint32_t rows_a_part = (n_rows + n_parts - 1) / n_parts;
  std::vector<GatherPart> parts;
  for (std::uint32_t row = 0; row < n_rows; row += rows_a_part)
    parts.push_back({row, std::min(row + rows_a_part, n_rows), 0, layout.height});
  return parts;
}

}  // namespace neritic::sonar
