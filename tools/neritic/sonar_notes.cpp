#include "tools/neritic/sonar_notes.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/log.hpp"

namespace neritic::tools {
namespace {

// Whether the image looks where the wedge does, of a fine grid of the wedge's directions.
bool covers(const sonar::SonarInput& in, double azimuth_rad, double elevation_rad) {
  const Vec3 d(std::cos(elevation_rad) * std::sin(azimuth_rad), std::sin(elevation_rad),
               -std::cos(elevation_rad) * std::cos(azimuth_rad));
  if (!(d.z < 0.0)) return false;
  const Intrinsics& k = in.intrinsics;
  const double u = k.cx + k.fx * d.x / -d.z, v = k.cy - k.fy * d.y / -d.z;
  // Half a pixel is no gap: pinholes given for pixel centres at integers end there.
  return u >= -0.5 && v >= -0.5 && u <= in.width + 0.5 && v <= in.height + 0.5;
}

double covered_part(const sonar::BeamGrid& grid, const sonar::SonarInput& in) {
  constexpr int kSteps = 64;
  const sonar::Limits& l = grid.limits;
  int inside = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j)
      inside += covers(in, glm::mix(l.azimuth_min_rad, l.azimuth_max_rad, (i + 0.5) / kSteps),
                       glm::mix(l.elevation_min_rad, l.elevation_max_rad, (j + 0.5) / kSteps));
  return static_cast<double>(inside) / (kSteps * kSteps);
}

std::string percent(double part) {
  return part < 0.005 ? "less than 1" : fmt::format("{:.0f}", 100.0 * part);
}

}  // namespace

bool in_aperture(const sonar::Limits& limits, const Vec3& direction) {
  const double azimuth_rad = std::atan2(direction.x, -direction.z),
               elevation_rad = std::asin(direction.y / glm::length(direction));
  return azimuth_rad >= limits.azimuth_min_rad && azimuth_rad <= limits.azimuth_max_rad &&
         elevation_rad >= limits.elevation_min_rad && elevation_rad <= limits.elevation_max_rad;
}

Coverage coverage_of(const sonar::BeamGrid& grid, const sonar::SonarInput& in) {
  const sonar::Limits& l = grid.limits;
  Coverage out;
  const Intrinsics& k = in.intrinsics;
  std::size_t directions = 0;
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      // Open water is seen too.
      directions += in_aperture(l, {(u + 0.5 - k.cx) / k.fx, (k.cy - v - 0.5) / k.fy, -1.0});
      const std::optional<Vec3> p = sonar::point_of(in, u, v);
      if (!p) continue;
      const double range_m = glm::length(*p);
      const bool first = out.farthest_m == 0.0;
      out.nearest_m = first ? range_m : std::min(out.nearest_m, range_m);
      out.farthest_m = std::max(out.farthest_m, range_m);
      if (!in_aperture(l, *p)) continue;
      ++out.in_aperture;
      if (!(range_m >= l.range_min_m && range_m < l.range_max_m)) continue;
      ++out.in_wedge;
      if (in.normals.empty()) continue;
      const double* n = &in.normals[3 * (std::size_t{v} * in.width + u)];
      const auto cosine = sonar::incidence({n[0], n[1], n[2]}, *p, in.normals_face_sensor);
      out.no_normal += !cosine;
      out.facing_away += cosine && *cosine == 0.0;
    }
  out.pixels_per_cell = static_cast<double>(directions) /
                        (static_cast<double>(grid.bins.azimuth) * grid.bins.elevation);
  out.of_wedge = covered_part(grid, in);
  out.azimuth_rad = {std::atan(-k.cx / k.fx), std::atan((in.width - k.cx) / k.fx)};
  out.elevation_rad = {std::atan((k.cy - in.height) / k.fy), std::atan(k.cy / k.fy)};
  return out;
}

std::optional<std::string> coverage_note(const sonar::BeamGrid& grid, const Coverage& coverage,
                                         bool published) {
  const sonar::Limits& l = grid.limits;
  if (coverage.farthest_m == 0.0)
    return "no pixel has a depth (0, NaN, infinity and negative numbers are none), so the sonar "
           "hears nothing";
  // Cells that look into the image find pixels beside a swath that is thinner than one.
  if (coverage.in_aperture == 0 && (published || coverage.of_wedge == 0.0))
    return "no pixel with a depth lies within --azimuth and --elevation, so the sonar hears "
           "nothing";
  if (coverage.in_wedge == 0 && coverage.in_aperture > 0)
    return fmt::format(
        "nothing lies between {:g} and {:g} m, so the sonar hears nothing: the image holds ranges "
        "of {:.3g} to {:.3g} m (--range, --depth-scale)",
        l.range_min_m, l.range_max_m, coverage.nearest_m, coverage.farthest_m);
  // A cone's corners, and a few pixels at the edges, are no matter.
  if (coverage.of_wedge < 0.95)
    return fmt::format(
        "the images cover {} % of the wedge of {:.3g} x {:.3g} degrees that is asked for: they "
        "look {:.3g} to {:.3g} degrees across and {:.3g} to {:.3g} upwards, and beyond that the "
        "sonar hears nothing (--azimuth, --elevation)",
        percent(coverage.of_wedge), degrees(l.azimuth_max_rad - l.azimuth_min_rad),
        degrees(l.elevation_max_rad - l.elevation_min_rad), degrees(coverage.azimuth_rad[0]),
        degrees(coverage.azimuth_rad[1]), degrees(coverage.elevation_rad[0]),
        degrees(coverage.elevation_rad[1]));
  // Pixels do not fall evenly: below two a cell some cells have none.
  if (published && coverage.pixels_per_cell < 2.0)
    return fmt::format(
        "{:.2g} pixels a cell of {} x {} (azimuth, elevation): cells without a pixel stay silent, "
        "as in the published algorithm; --gather plane (--method gpu) fills them, fewer --bins "
        "avoid them",
        coverage.pixels_per_cell, grid.bins.azimuth, grid.bins.elevation);
  return std::nullopt;
}

std::optional<std::string> normals_note(const Coverage& coverage, bool estimated) {
  // Axes that are swapped turn half of a scene away; real maps' noise and outlines a few percent.
  constexpr double kMany = 0.25;
  const double all = static_cast<double>(coverage.in_wedge);
  const double away = static_cast<double>(coverage.facing_away) / std::max(all, 1.0);
  const double none = static_cast<double>(coverage.no_normal) / std::max(all, 1.0);
  if (away > kMany)
    return fmt::format(
        "{} % of the pixels in the wedge have normals that face away from the sensor, so they are "
        "silent (--axes, --normals-sign unknown)",
        percent(away));
  if (none <= kMany) return std::nullopt;
  if (estimated)
    return fmt::format(
        "no normal could be estimated for {} % of the pixels in the wedge, which have no neighbour "
        "across or above, so they are silent (--normals)",
        percent(none));
  return fmt::format(
      "{} % of the pixels in the wedge have no normal (zero, NaN or -1,-1,-1), so they are silent "
      "(without --normals they are estimated from the depth)",
      percent(none));
}

std::optional<std::string> noise_note(const sonar::NormalEstimate& estimate) {
  if (estimate.width_px == 0) return std::nullopt;
  return fmt::format(
      "the depth is noisy by about {:.2g} mm, which would tilt normals from neighbouring pixels by "
      "{:.0f} degrees: they come from planes fitted to {} x {} pixels, off by about {:.1f} "
      "(--normals are better)",
      1e3 * estimate.noise_m, degrees(estimate.error_of_neighbours_rad), estimate.width_px,
      estimate.width_px, degrees(estimate.error_rad));
}

std::optional<std::string> smoothing_note(const sonar::SmoothedDepth& smoothed, double bin_m) {
  if (smoothed.width_px == 0) return std::nullopt;
  return fmt::format(
      "the depth is noisy by about {:.2g} mm, {:.2g} range bins, and the published gather counts a "
      "cell once in each bin that its pixels lie in: depths come from planes fitted to {} x {} "
      "pixels, noisy by about {:.2g} mm",
      1e3 * smoothed.noise_m, smoothed.noise_m / bin_m, smoothed.width_px, smoothed.width_px,
      1e3 * smoothed.left_m);
}

bool SonarNotes::first(About about) {
  const std::lock_guard lock(mutex_);
  const unsigned bit = 1u << static_cast<unsigned>(about);
  const bool is_first = (said_ & bit) == 0;
  said_ |= bit;
  return is_first;
}

void SonarNotes::say(std::string line) {
  const std::lock_guard lock(mutex_);
  if (!hold_)
    log_warn("{}", line);
  else
    held_.push_back(std::move(line));
}

void SonarNotes::release() {
  const std::lock_guard lock(mutex_);
  for (const std::string& line : held_) log_warn("{}", line);
  held_.clear();
  hold_ = false;
}

}  // namespace neritic::tools
