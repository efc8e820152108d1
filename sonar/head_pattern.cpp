#include "sonar/head_pattern.hpp"

#include <algorithm>

#include "sonar/acoustics.hpp"

namespace neritic::sonar {
namespace {

Result<BeamPattern> pattern_of(const scene::SonarPattern& pattern) {
  using Shape = scene::SonarPattern::Shape;
  if (pattern.shape == Shape::kTable) {
    Table degrees_db;
    for (const auto& [angle_rad, db] : pattern.table)
      degrees_db.push_back({degrees(angle_rad), db});
    return BeamPattern::of_table(std::move(degrees_db));
  }
  return BeamPattern::of_half_power_width(
      pattern.shape == Shape::kHamming ? BeamKind::kHamming : BeamKind::kSinc,
      pattern.half_power_rad);
}

double power_of(double amplitude, bool two_way) {
  const double once = amplitude * amplitude;
  return two_way ? once * once : once;
}

}  // namespace

double sound_speed_of(const scene::SonarWater& water, double depth_m) {
  if (water.sound_speed_m_s) return *water.sound_speed_m_s;
  return sound_speed_mackenzie_m_s({water.temperature_c, water.salinity_psu,
                                    std::clamp(water.depth_m.value_or(depth_m), 0.0, 12000.0),
                                    water.ph});
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
  out.azimuth_two_way =
      sonar.kind != scene::SonarKind::kImaging && sonar.kind != scene::SonarKind::kProfiling;
  return out;
}

double HeadPatterns::across(double off_rad) const {
  if (!azimuth) return 1.0;
  const double a = azimuth->amplitude(std::remainder(off_rad, 2.0 * kPi));
  return azimuth_two_way ? a * std::abs(a) : a;
}

double HeadPatterns::power(double azimuth_rad, double elevation_rad) const {
  if (!cone) return elevation ? power_of(elevation->amplitude(elevation_rad), true) : 1.0;
  const auto& pattern = elevation ? elevation : azimuth;
  if (!pattern) return 1.0;
  const double off =
      std::acos(std::clamp(std::cos(azimuth_rad) * std::cos(elevation_rad), -1.0, 1.0));
  return power_of(pattern->amplitude(off), true);
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

std::uint32_t pattern_reach(const HeadPatterns& patterns, double column_rad, double max_truncated) {
  const auto half_turn = static_cast<std::uint32_t>(kPi / column_rad);
  std::vector<double> power(half_turn + 1);
  double total = 0.0;
  for (std::uint32_t i = 0; i <= half_turn; ++i) {
    const double a = patterns.across(i * column_rad);
    power[i] = a * a;
    total += power[i] * (i == 0 ? 1.0 : 2.0);
  }
  double beyond = total - power[0];
  std::uint32_t reach = 0;
  while (reach < half_turn && beyond > max_truncated * total) beyond -= 2.0 * power[++reach];
  return reach;
}

}  // namespace neritic::sonar
