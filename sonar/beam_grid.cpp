#include "sonar/beam_grid.hpp"

#include <algorithm>

#include "engine/core/refusal.hpp"

namespace neritic::sonar {
namespace {

Status check_range(const char* what, double min, double max, double lowest, double highest,
                   double widest, double to_user, const char* unit) {
  if (!std::isfinite(min) || !std::isfinite(max) || !(min < max))
    return refusal(what, fmt::format("{:g} to {:g} {}", min * to_user, max * to_user, unit),
                   "two increasing numbers");
  if (min < lowest - 1e-9 || max > highest + 1e-9 || max - min > widest + 1e-9)
    return refusal(what, fmt::format("{:g} to {:g} {}", min * to_user, max * to_user, unit),
                   fmt::format("limits from {:g} to {:g}, at most {:g} apart", lowest * to_user,
                               highest * to_user, widest * to_user));
  return {};
}

Status check_bins(const char* what, std::uint32_t n) {
  if (n < 1 || n > kMaxBins)
    return refusal(fmt::format("bins in {}", what), fmt::format("{}", n),
                   fmt::format("1 to {}", kMaxBins));
  return {};
}

}  // namespace

BeamGrid symmetric_grid(double range_min_m, double range_max_m, double azimuth_rad,
                        double elevation_rad, const Bins& bins) {
  return {{range_min_m, range_max_m, -azimuth_rad / 2, azimuth_rad / 2, -elevation_rad / 2,
           elevation_rad / 2},
          bins};
}

Status validate(const BeamGrid& grid) {
  const Limits& l = grid.limits;
  const double degree = degrees(1.0);
  // 1e6 m: beyond any sonar, and floats still tell ranges apart.
  NERITIC_TRY_STATUS(check_range("range", l.range_min_m, l.range_max_m, 0.0, 1e6, 1e6, 1.0, "m"));
  NERITIC_TRY_STATUS(check_range("azimuth", l.azimuth_min_rad, l.azimuth_max_rad, -kPi, kPi,
                                 kMaxAzimuth_rad, degree, "degrees"));
  NERITIC_TRY_STATUS(check_range("elevation", l.elevation_min_rad, l.elevation_max_rad,
                                 radians(-80.0), radians(80.0), kMaxElevation_rad, degree,
                                 "degrees"));
  NERITIC_TRY_STATUS(check_bins("range", grid.bins.range));
  NERITIC_TRY_STATUS(check_bins("azimuth", grid.bins.azimuth));
  return check_bins("elevation", grid.bins.elevation);
}

std::optional<CellIndex> cell_of(const BeamGrid& grid, const Vec3& p) {
  const double r = std::sqrt(p.x * p.x + p.y * p.y + p.z * p.z);
  if (!(r > 0.0)) return std::nullopt;
  const Limits& l = grid.limits;
  const auto range = bin_index(r, l.range_min_m, l.range_max_m, grid.bins.range);
  if (!range) return std::nullopt;
  const auto azimuth =
      bin_index(std::atan2(p.x, -p.z), l.azimuth_min_rad, l.azimuth_max_rad, grid.bins.azimuth);
  if (!azimuth) return std::nullopt;
  const auto elevation =
      bin_index(std::asin(p.y / r), l.elevation_min_rad, l.elevation_max_rad, grid.bins.elevation);
  if (!elevation) return std::nullopt;
  return CellIndex{*range, *azimuth, *elevation};
}

Mat3 sonar_from_view(double yaw_rad) {
  if (yaw_rad == 0.0) return Mat3(1.0);
  const double c = std::cos(yaw_rad), s = std::sin(yaw_rad);
  // Columns: the view's x, y and z axes. -z of the view is (sin yaw, 0, -cos yaw).
  return Mat3(Vec3(c, 0, s), Vec3(0, 1, 0), Vec3(-s, 0, c));
}

std::vector<Sector> plan_sectors(const BeamGrid& grid) {
  const Limits& l = grid.limits;
  const double span = l.azimuth_max_rad - l.azimuth_min_rad;
  const auto count =
      std::max(1u, static_cast<std::uint32_t>(std::ceil(span / kMaxSectorAzimuth_rad - 1e-9)));
  const double half = span / count / 2.0;
  std::vector<Sector> sectors(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Sector& s = sectors[i];
    s.azimuth_min_rad = l.azimuth_min_rad + span * i / count;
    s.azimuth_max_rad = l.azimuth_min_rad + span * (i + 1) / count;
    // Exactly 0 for the one sector of a symmetric wedge, whose reference is then free of rotations.
    s.yaw_rad = l.azimuth_min_rad + span * (2 * i + 1) / (2.0 * count);
    s.first_column = i == 0 ? 0 : sectors[i - 1].end_column;
    // Column c's centre is at (c + 0.5) / n of the span.
    s.end_column = i + 1 == count
                       ? grid.bins.azimuth
                       : static_cast<std::uint32_t>(std::ceil(
                             static_cast<double>(i + 1) * grid.bins.azimuth / count - 0.5));
    // tan(phi) / cos(theta) is largest in size at the corners for elevations away from the horizon,
    // and on the axis for those on this side of it.
    const double edge = 1.0 / std::cos(half);
    const double top = std::tan(l.elevation_max_rad), bottom = std::tan(l.elevation_min_rad);
    s.tangents = {-std::tan(half), std::tan(half), bottom < 0.0 ? bottom * edge : bottom,
                  top > 0.0 ? top * edge : top};
  }
  return sectors;
}

PixelSize gbuffer_size(const BeamGrid& grid, const Sector& sector, double pixels_per_cell,
                       std::uint32_t max_extent) {
  const FrustumTangents& t = sector.tangents;
  const auto extent = [&](double tangent_span, double step_rad) {
    const double pixels = std::ceil(tangent_span / step_rad * pixels_per_cell - 1e-9);
    return static_cast<std::uint32_t>(std::clamp(pixels, 1.0, static_cast<double>(max_extent)));
  };
  return {extent(t.right - t.left, grid.azimuth_step_rad()),
          extent(t.top - t.bottom, grid.elevation_step_rad())};
}

LeaningView leaning_view(const BeamGrid& grid, const Sector& sector, double pixels_per_cell,
                         std::uint32_t max_extent) {
  // Shifts of 1 / (n + 0.618...) pixels a row: after n rows they begin to fill each other's gaps.
  // Beyond n = 4 things that lean by a fraction of a pixel a row are hit or missed whole as upright
  // ones were.
  constexpr double kGolden = 0.6180339887498949, kLeastRows = 4.0;
  constexpr double kMostWider = 0.25, kLeastWider_px = 4.0;
  const FrustumTangents& t = sector.tangents;
  LeaningView out;
  out.size = gbuffer_size(grid, sector, pixels_per_cell, max_extent);
  const double height = out.size.height;
  const double room_px = std::max(kMostWider * out.size.width, kLeastWider_px);
  const double shift_px =
      1.0 / (std::max(kLeastRows, std::ceil(height / room_px - kGolden)) + kGolden);
  const double wider_px = shift_px * height;
  out.size.width =
      std::min(max_extent, static_cast<std::uint32_t>(std::ceil(out.size.width + wider_px - 1e-9)));
  const double fx = (out.size.width - wider_px) / (t.right - t.left),
               fy = height / (t.top - t.bottom);
  out.lean = shift_px * fy / fx;
  out.tangents = {t.left - out.lean * t.top, t.right - out.lean * t.bottom, t.bottom, t.top};
  return out;
}

}  // namespace neritic::sonar
