// Curves from the rows of a dive, for its plots. Pure functions; any thread.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "tools/common/plot.hpp"

namespace neritic::tools {

// More points than this a line are not told apart.
inline constexpr std::size_t kMostPoints = 1500;

// Of the rows for which of(row) holds, thinned out.
template <class Row>
Series series_from(const std::vector<Row>& rows, const std::function<bool(const Row&)>& of,
                   const std::string& name, const sonar::Color& color,
                   const std::function<double(const Row&)>& x,
                   const std::function<double(const Row&)>& y) {
  Series series{name, color, {}, {}};
  series.marked = false;
  std::size_t count = 0;
  for (const Row& row : rows) count += of(row) ? 1 : 0;
  const std::size_t every = count / kMostPoints + 1;
  std::size_t seen = 0;
  for (const Row& row : rows) {
    if (!of(row) || (seen++ % every != 0 && seen != count)) continue;
    series.x.push_back(x(row));
    series.y.push_back(y(row));
  }
  return series;
}

// An axis that holds all values of all lines, with some room; what is not finite counts nothing.
Axis roomy_axis(const std::string& label, const std::vector<Series>& all,
                const std::vector<double> Series::*values, double least_span);
// Lines over time in a box; headroom: of the height above them, for the legend.
void draw_over_time(sonar::Canvas& canvas, const Box& box, const std::string& title,
                    const std::string& label, const std::vector<Series>& lines, double least_span,
                    double headroom = 0.0);

}  // namespace neritic::tools
