#include "tools/neritic/sonar_notes.hpp"

#include <cmath>

namespace neritic::tools {

Coverage coverage_of(const sonar::BeamGrid& grid, const sonar::SonarInput& in) {
  const sonar::Limits& l = grid.limits;
  Coverage out;
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const std::optional<Vec3> p = sonar::point_of(in, u, v);
      if (!p) continue;
      const double range_m = glm::length(*p);
      const bool first = out.farthest_m == 0.0;
      out.nearest_m = first ? range_m : std::min(out.nearest_m, range_m);
      out.farthest_m = std::max(out.farthest_m, range_m);
      const double azimuth_rad = std::atan2(p->x, -p->z), elevation_rad = std::asin(p->y / range_m);
      if (azimuth_rad < l.azimuth_min_rad || azimuth_rad > l.azimuth_max_rad ||
          elevation_rad < l.elevation_min_rad || elevation_rad > l.elevation_max_rad)
        continue;
      ++out.in_aperture;
      if (range_m >= l.range_min_m && range_m < l.range_max_m) ++out.in_wedge;
    }
  out.pixels_per_cell = static_cast<double>(out.in_aperture) /
                        (static_cast<double>(grid.bins.azimuth) * grid.bins.elevation);
  return out;
}

std::optional<std::string> coverage_note(const sonar::BeamGrid& grid, const Coverage& coverage,
                                         bool published) {
  const sonar::Limits& l = grid.limits;
  if (coverage.farthest_m == 0.0) return "no pixel has a depth (0, NaN, infinity and negative numbers are none), so the sonar hears nothing";
  if (coverage.in_aperture == 0)
    return "no pixel with a depth lies within --azimuth and --elevation, so the sonar hears "
           "nothing";
  if (coverage.in_wedge == 0)
    return fmt::format(
        "nothing lies between {:g} and {:g} m, so the sonar hears nothing: the image holds ranges "
        "of {:.3g} to {:.3g} m (--range, --depth-scale)",
        l.range_min_m, l.range_max_m, coverage.nearest_m, coverage.farthest_m);
  // Pixels do not fall evenly: below two a cell some cells have none.
  if (published && coverage.pixels_per_cell < 2.0)
    return fmt::format(
        "{:.2g} pixels a cell of {} x {} (azimuth, elevation): cells without a pixel stay silent, "
        "as in the published algorithm; --gather plane fills them, fewer --bins avoid them",
        coverage.pixels_per_cell, grid.bins.azimuth, grid.bins.elevation);
  return std::nullopt;
}

}  // namespace neritic::tools
