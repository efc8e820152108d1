#include "sonar/head_pattern.hpp"

#include <algorithm>
#include <cmath>

#include "sonar/acoustics.hpp"

namespace neritic::sonar {
namespace {

// A beam's taps leave out at most this share of its pattern's power.
constexpr double kPatternTruncated = 0.005;

Result<BeamPattern> pattern_of(const scene::SonarPattern& pattern) {
  if (pattern.shape != BeamShape::kTable)
    return BeamPattern::of_half_power_width(pattern.shape, pattern.half_power_rad);
  SonarTable degrees_db = pattern.table;
  for (SonarRow& row : degrees_db) row.x = degrees(row.x);
  return BeamPattern::of_table(std::move(degrees_db));
}

// Places at which a pattern is looked at over a width: one, but where it has lobes narrower than
// that.
int places_over(const BeamPattern& pattern, double width_rad) {
  constexpr double kMostPlaces = 256.0;
  const double widths = width_rad / pattern.second_null_rad();
  return widths < 0.25 ? 1 : static_cast<int>(std::min(std::ceil(16.0 * widths), kMostPlaces));
}

}  // namespace

double heard_half_rad(double half_rad, const HeadPatterns& patterns) {
  // An aperture much narrower than its pattern still cuts the wedge, at this number of apertures.
  constexpr double kMostApertures = 9.0;
  if (!patterns.upright()) return half_rad;
  return std::min(std::max(half_rad, patterns.upright()->second_null_rad()),
                  std::max(half_rad, std::min(kMaxElevation_rad / 2.0, kMostApertures * half_rad)));
}

double target_cell_rad(const scene::Sonar& sonar, const HeadPatterns& patterns) {
  // A pixel of this share of a target's width has its centre on it wherever it lies: 1 / sqrt(2) of
  // it, and half as much again where pixels and cells do not meet.
  constexpr double kTargetCell = 0.47;
  // The most samples of all columns and rows. A sonar of one beam pings more often to see as much,
  // and has fewer.
  constexpr double kMostTargetSamples = 8e6, kMostOfOneBeam = 2e6;
  using Kind = scene::SonarKind;
  if (!sonar.quality_chosen || !(sonar.least_target_m > 0.0)) return 0.0;
  const bool many = sonar.kind == Kind::kImaging || sonar.kind == Kind::kProfiling;
  const double wide_rad = sonar.kind == Kind::kEchoSounder
                              ? 2.0 * heard_half_rad(sonar.semi_angle_rad, patterns)
                          : sonar.kind == Kind::kMechanical ? sonar.step_rad
                                                            : sonar.azimuth_rad;
  const double high_rad = sonar.kind == Kind::kEchoSounder
                              ? wide_rad
                              : 2.0 * heard_half_rad(sonar.elevation_rad / 2.0, patterns);
  return std::max(kTargetCell * sonar.least_target_m / sonar.range_max_m,
                  std::sqrt(wide_rad * high_rad / (many ? kMostTargetSamples : kMostOfOneBeam)));
}

double sound_speed_of(const scene::SonarWater& water, double depth_m) {
  if (water.sound_speed_m_s) return *water.sound_speed_m_s;
  const double depth_of_m = std::clamp(water.depth_m.value_or(depth_m), 0.0, 12000.0);
  const SeaWater there = water.at(depth_of_m);
  return sound_speed_mackenzie_m_s({there.temperature_c, there.salinity_psu, depth_of_m, water.ph});
}

Result<HeadPatterns> head_patterns(const scene::Sonar& sonar) {
  HeadPatterns out;
  const scene::SonarBeam& beam = sonar.terms.beam;
  if (beam.azimuth) {
    NERITIC_TRY(out.azimuth, pattern_of(*beam.azimuth));
  }
  if (beam.elevation) {
    NERITIC_TRY(out.elevation, pattern_of(*beam.elevation));
  }
  out.cone = sonar.kind == scene::SonarKind::kEchoSounder;
  out.cone_rad = sonar.semi_angle_rad;
  if (out.upright())
    out.cone_rad =
        std::max(out.cone_rad, std::min(out.upright()->second_null_rad(), kMaxElevation_rad / 2.0));
  out.azimuth_two_way = beam.two_way.value_or(sonar.kind != scene::SonarKind::kImaging &&
                                              sonar.kind != scene::SonarKind::kProfiling);
  out.flat = beam.steering == scene::SonarBeam::Steering::kFlat;
  return out;
}

double HeadPatterns::across(double off_rad, double axis_rad) const {
  if (!azimuth) return 1.0;
  const double off = std::remainder(off_rad, 2.0 * kPi);
  const double a =
      flat ? azimuth->steered_amplitude(axis_rad + off, axis_rad) : azimuth->amplitude(off);
  return azimuth_two_way ? a * std::abs(a) : a;
}

double HeadPatterns::across_column(double off_rad, double axis_rad, double column_rad) const {
  const int places = azimuth ? places_over(*azimuth, column_rad) : 1;
  const double middle = across(off_rad, axis_rad);
  if (places == 1) return middle;
  double power = 0.0;
  for (int i = 0; i < places; ++i) {
    const double a = across(off_rad + ((i + 0.5) / places - 0.5) * column_rad, axis_rad);
    power += a * a / places;
  }
  return std::copysign(std::sqrt(power), middle);
}

double HeadPatterns::power_of_cell(const BeamGrid& grid, std::uint32_t column,
                                   std::uint32_t row) const {
  const double theta = grid.azimuth_rad(column), phi = grid.elevation_rad(row);
  const int up = upright() ? places_over(*upright(), grid.elevation_step_rad()) : 1;
  const int aside = upright() && cone ? places_over(*upright(), grid.azimuth_step_rad()) : 1;
  double sum = 0.0;
  for (int i = 0; i < up; ++i)
    for (int k = 0; k < aside; ++k)
      sum += power(theta + ((k + 0.5) / aside - 0.5) * grid.azimuth_step_rad(),
                   phi + ((i + 0.5) / up - 0.5) * grid.elevation_step_rad());
  return sum / (up * aside);
}

double HeadPatterns::power(double azimuth_rad, double elevation_rad) const {
  if (!cone) return elevation ? elevation->two_way_power(elevation_rad) : 1.0;
  if (!upright()) return 1.0;
  const double off =
      std::acos(std::clamp(std::cos(azimuth_rad) * std::cos(elevation_rad), -1.0, 1.0));
  return upright()->two_way_power(off);
}

double cone_share(const BeamGrid& grid, std::uint32_t column, std::uint32_t row, double semi_rad) {
  constexpr int kSteps = 4;
  const double edge = std::cos(semi_rad);
  int inside = 0;
  for (int i = 0; i < kSteps; ++i)
    for (int k = 0; k < kSteps; ++k) {
      const double theta =
          grid.azimuth_rad(column) + ((i + 0.5) / kSteps - 0.5) * grid.azimuth_step_rad();
      const double phi =
          grid.elevation_rad(row) + ((k + 0.5) / kSteps - 0.5) * grid.elevation_step_rad();
      inside += std::cos(theta) * std::cos(phi) >= edge;
    }
  return double(inside) / (kSteps * kSteps);
}

std::uint32_t pattern_reach(const HeadPatterns& patterns, double axis_rad, double column_rad) {
  const auto half_turn = static_cast<std::uint32_t>(kPi / column_rad);
  std::vector<double> power(half_turn + 1);
  double total = 0.0;
  for (std::uint32_t i = 0; i <= half_turn; ++i) {
    const double left = patterns.across(-(i * column_rad), axis_rad),
                 right = patterns.across(i * column_rad, axis_rad);
    power[i] = i == 0 ? right * right : left * left + right * right;
    total += power[i];
  }
  double beyond = total - power[0];
  std::uint32_t reach = 0;
  while (reach < half_turn && beyond > kPatternTruncated * total) beyond -= power[++reach];
  if (patterns.azimuth->shape() == BeamShape::kTable) return reach;
  const double lobes = std::ceil(patterns.azimuth->second_null_rad() / column_rad);
  return std::max(reach, std::min(half_turn, static_cast<std::uint32_t>(lobes)));
}

}  // namespace neritic::sonar
