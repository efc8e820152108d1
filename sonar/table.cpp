#include "sonar/table.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::sonar {

Status validate(std::span<const SonarRow> rows, const std::string& name,
                const TableLimits& limits) {
  if (rows.empty()) return refusal(name, "no row", "at least one");
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const SonarRow& row = rows[i];
    if (!(row.x >= limits.x_min && row.x <= limits.x_max && row.y >= limits.y_min &&
          row.y <= limits.y_max))
      return refusal(fmt::format("{}: row {}", name, i + 1), fmt::format("{}, {}", row.x, row.y),
                     fmt::format("[{:g}, {:g}] and [{:g}, {:g}]", limits.x_min, limits.x_max,
                                 limits.y_min, limits.y_max));
    if (i > 0 && !(row.x > rows[i - 1].x))
      return refusal(fmt::format("{}: row {}", name, i + 1),
                     fmt::format("{} after {}", row.x, rows[i - 1].x), "rising values");
  }
  return {};
}

double interpolate(std::span<const SonarRow> rows, double x) {
  NERITIC_CHECK(!rows.empty(), "interpolating in a table without rows");
  if (std::isnan(x)) return x;
  const auto above = std::upper_bound(rows.begin(), rows.end(), x,
                                      [](double v, const SonarRow& row) { return v < row.x; });
  if (above == rows.begin()) return rows.front().y;
  if (above == rows.end()) return rows.back().y;
  const SonarRow &a = *(above - 1), &b = *above;
  return a.y + (b.y - a.y) * ((x - a.x) / (b.x - a.x));
}

}  // namespace neritic::sonar
