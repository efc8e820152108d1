// The sonar's wedge and its bins, and how many pinhole views cover it. Sonar axes: x to starboard,
// y up, z backwards. Range r = |p|, azimuth theta = atan2(p.x, -p.z) positive to starboard,
// elevation phi = asin(p.y / r). Pure functions of plain values; any thread.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"
#include "engine/scene/sonar_settings.hpp"

namespace neritic::sonar {

// Widest apertures: a full turn, and 120 degrees of elevation (a pinhole's tangents stay sane).
inline constexpr double kMaxAzimuth_rad = 2.0 * kPi;
inline constexpr double kMaxElevation_rad = radians(120.0);
inline constexpr std::uint32_t kMaxBins = scene::kMaxSonarBins;

struct Limits {
  double range_min_m = 1.0, range_max_m = 5.0;
  double azimuth_min_rad = radians(-45.0), azimuth_max_rad = radians(45.0);
  double elevation_min_rad = radians(-14.0), elevation_max_rad = radians(14.0);
};

struct Bins {
  std::uint32_t range = 500, azimuth = 500, elevation = 500;
};

struct BeamGrid {
  Limits limits;
  Bins bins;

  double range_step_m() const { return (limits.range_max_m - limits.range_min_m) / bins.range; }
  double azimuth_step_rad() const {
    return (limits.azimuth_max_rad - limits.azimuth_min_rad) / bins.azimuth;
  }
  double elevation_step_rad() const {
    return (limits.elevation_max_rad - limits.elevation_min_rad) / bins.elevation;
  }
  // Centre of an azimuth column / elevation row / range row.
  double azimuth_rad(std::uint32_t column) const {
    return limits.azimuth_min_rad + (column + 0.5) * azimuth_step_rad();
  }
  double elevation_rad(std::uint32_t row) const {
    return limits.elevation_min_rad + (row + 0.5) * elevation_step_rad();
  }
  double range_m(std::uint32_t row) const {
    return limits.range_min_m + (row + 0.5) * range_step_m();
  }
};

// A grid of full apertures that lie symmetrically about dead ahead.
BeamGrid symmetric_grid(double range_min_m, double range_max_m, double azimuth_rad,
                        double elevation_rad, const Bins& bins);

// kBadInput that names the limit, what was found and what is accepted.
Status validate(const BeamGrid& grid);

// floor((v - min) / (max - min) * n) for v in [min, max); nothing outside (nor for NaN).
inline std::optional<std::uint32_t> bin_index(double v, double min, double max, std::uint32_t n) {
  if (!(v >= min && v < max)) return std::nullopt;
  const double index = std::floor((v - min) / (max - min) * n);
  // (v - min) / (max - min) may round up to 1 for v just below max.
  return index < n ? static_cast<std::uint32_t>(index) : n - 1;
}

// A point in bins; nothing where it lies outside the wedge or at the origin.
struct CellIndex {
  std::uint32_t range, azimuth, elevation;
};
std::optional<CellIndex> cell_of(const BeamGrid& grid, const Vec3& point_m);

// Unit direction of a bearing and elevation.
inline Vec3 direction(double azimuth_rad, double elevation_rad) {
  const double c = std::cos(elevation_rad);
  return {c * std::sin(azimuth_rad), std::sin(elevation_rad), -c * std::cos(azimuth_rad)};
}

// One pinhole view of the wedge: its axis points at azimuth yaw_rad (positive to starboard), level.
struct Sector {
  double yaw_rad = 0.0;
  double azimuth_min_rad = 0.0, azimuth_max_rad = 0.0;  // the part of the wedge it answers for
  std::uint32_t first_column = 0, end_column = 0;       // columns whose centres lie in that part
  FrustumTangents tangents;                             // covers its part, corners included
};
// Sonar axes from the axes of a view whose axis has azimuth yaw_rad: a turn about +y by -yaw.
Mat3 sonar_from_view(double yaw_rad);

// As few equal sectors as keep each at most kMaxSectorAzimuth_rad wide. At azimuth theta off a
// view's axis, elevation phi needs tan(phi) / cos(theta) of vertical reach.
inline constexpr double kMaxSectorAzimuth_rad = radians(100.0);
std::vector<Sector> plan_sectors(const BeamGrid& grid);

// Size of one sector's G-buffer at pixels_per_cell (linear), which holds where the pinhole is
// coarsest, its axis. Capped at max_extent a side.
struct PixelSize {
  std::uint32_t width = 1, height = 1;
};
PixelSize gbuffer_size(const BeamGrid& grid, const Sector& sector, double pixels_per_cell,
                       std::uint32_t max_extent = kMaxPictureSide);

// The same for what beams sample: sides that lean (render::ViewDesc), so that each row of pixels is
// shifted against the next by an irrational part of a pixel. A thing narrower than a pixel then
// falls between some rows' pixels, not between all or none: its energy is right on average over its
// height. The view is at most a quarter, or four pixels, wider for it.
struct LeaningView {
  FrustumTangents tangents;  // of the leaning sides
  double lean = 0.0;         // in tangents
  PixelSize size;
};
LeaningView leaning_view(const BeamGrid& grid, const Sector& sector, double pixels_per_cell,
                         std::uint32_t max_extent = kMaxPictureSide);

}  // namespace neritic::sonar
