#include "sonar/quality.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/refusal.hpp"
#include "sonar/acoustics_pulse.hpp"
#include "sonar/beam_grid.hpp"
#include "sonar/head_pattern.hpp"

namespace neritic::sonar {
namespace {

using scene::SonarKind;

// name, pixels a cell, columns, rows, range bins a resolution cell, error, ms: from
// `neritic tradeoff sonar` in assets/scenes/harbour.toml, llvmpipe on two cores of an AMD EPYC; the
// error is the larger of the sweep's and of what Sonar/QualityTruth finds.
constexpr QualityLevel kImaging[] = {
    {"draft", 1, 3.98, 0.83, 1, 0.0452, 48.6},
    {"standard", 0.7, 11.94, 0.83, 2, 0.0165, 151.4},
    {"reference", 1, 23.88, 3.33, 2, 0.0092, 355.2},
};
constexpr QualityLevel kProfiling[] = {
    {"draft", 0.5, 1.99, 32, 4, 0.0485, 12.0},
    {"standard", 0.7, 7.96, 8, 4, 0.0197, 41.5},
    {"reference", 1, 7.96, 8, 8, 0.0096, 109.2},
};
// With so few columns things of a few cells read up to 2 dB too low: the draft's level is off by
// 1.2 dB (rms of twelve balls of 6 to 50 cm), the others' by 0.1.
constexpr QualityLevel kEchoSounder[] = {
    {"draft", 1, 16, 64, 2, 0.0418, 2.3},
    {"standard", 1, 128, 64, 4, 0.0104, 7.3},
    {"reference", 1, 128, 128, 6, 0.0082, 12.0},
};
constexpr QualityLevel kSideScan[] = {
    {"draft", 1.4, 2, 0.41, 1, 0.0268, 4.8},
    {"standard", 1.4, 4, 0.41, 1, 0.0197, 5.8},
    {"reference", 1.4, 6, 0.81, 2, 0.0095, 11.5},
};
constexpr QualityLevel kMechanical[] = {
    {"draft", 0.7, 13.35, 3.23, 1, 0.0460, 8.5},
    {"standard", 1, 22.25, 3.23, 2, 0.0172, 20.1},
    {"reference", 1.4, 35.6, 6.45, 2, 0.0085, 56.2},
};

constexpr double kMostFiner = 1e4;  // keeps a forged ratio from overflowing

bool rows_are_counts(SonarKind kind) {
  return kind == SonarKind::kProfiling || kind == SonarKind::kEchoSounder;
}

// Range resolution, m: the pulse's, or one bin if the sonar names no pulse.
double range_cell_m(const scene::Sonar& s) {
  const auto& spread = s.terms.range_spread;
  if (!spread) return (s.range_max_m - s.range_min_m) / s.bins_range;
  return range_resolution_m(sound_speed_of(s.terms.water, 0.0), spread->bandwidth_hz);
}

Result<double> half_power_width_rad(const scene::Sonar& sonar) {
  const scene::SonarPattern& pattern = *sonar.terms.beam.azimuth;
  if (pattern.shape != scene::BeamShape::kTable) return pattern.half_power_rad;
  const auto patterns = head_patterns(sonar);
  if (!patterns.ok()) return bad_input("sonar {}: beam: {}", sonar.name, patterns.error().message);
  return patterns->azimuth->half_power_width_rad();
}

Result<std::uint32_t> columns_for(const scene::Sonar& sonar, const QualityLevel& level) {
  double columns = level.columns;
  if (sonar.kind != SonarKind::kEchoSounder && sonar.terms.beam.azimuth) {
    const double beam_rad = sonar.kind == SonarKind::kMechanical ? sonar.step_rad
                            : sonar.kind == SonarKind::kSideScan
                                ? sonar.azimuth_rad
                                : sonar.azimuth_rad / sonar.bins_azimuth;
    NERITIC_TRY(const double width_rad, half_power_width_rad(sonar));
    columns *= beam_rad / width_rad;
  }
  return static_cast<std::uint32_t>(std::clamp(std::ceil(columns - 1e-6), 1.0, double{kMaxBins}));
}

// The most that a level that nobody named may cost: cells of [range][columns], and columns times
// rows.
constexpr double kMostChosenCells = 8e6, kMostChosenSamples = 4e6, kMostChosenColumns = 8192;

std::uint32_t& columns_of(scene::Sonar& sonar) {
  return sonar.kind == SonarKind::kEchoSounder ? sonar.bins_azimuth : sonar.terms.beam.samples;
}

std::uint32_t rows_for(const scene::Sonar& sonar, const QualityLevel& level) {
  const double span_m = sonar.range_max_m - sonar.range_min_m;
  const double rows =
      rows_are_counts(sonar.kind) ? level.rows : level.rows * span_m / range_cell_m(sonar);
  return static_cast<std::uint32_t>(std::clamp(std::ceil(rows), 1.0, double{kMaxBins}));
}

// Where a target at the farthest range is smaller than a cell, cells that are finer: it would be
// between them in single pings.
Status hear_small_targets(scene::Sonar& sonar, double beams) {
  if (!(sonar.least_target_m > 0.0)) return {};
  const auto patterns = head_patterns(sonar);
  if (!patterns.ok()) return bad_input("sonar {}: beam: {}", sonar.name, patterns.error().message);
  const bool cone = sonar.kind == SonarKind::kEchoSounder;
  const double beam_rad = cone                                   ? 2.0 * sonar.semi_angle_rad
                          : sonar.kind == SonarKind::kMechanical ? sonar.step_rad
                                                                 : sonar.azimuth_rad / beams;
  const double high_rad = cone ? beam_rad : sonar.elevation_rad;
  const double cell_rad = target_cell_rad(sonar, *patterns);
  const auto count = [&](double span_rad) {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(span_rad / cell_rad), 1.0, double{kMaxBins}));
  };
  const double most_columns =
      std::floor(std::min(kMostChosenColumns, kMostChosenCells / sonar.bins_range) / beams);
  std::uint32_t& columns = columns_of(sonar);
  const std::uint32_t before = columns, rows = sonar.bins_elevation;
  columns = std::max(columns, std::min(count(beam_rad), static_cast<std::uint32_t>(most_columns)));
  sonar.bins_elevation = std::max(rows, count(high_rad));
  const double heard_rad = 2.0 * heard_half_rad(high_rad / 2.0, *patterns);
  if (columns != before || sonar.bins_elevation != rows || heard_rad / cell_rad > kMostWidenedRows)
    sonar.gbuffer_scale = std::max(sonar.gbuffer_scale, 1.0);
  return {};
}

// A level that nobody named: the range bins stay, and nothing becomes coarser than the file says.
Status apply_chosen(scene::Sonar& sonar, const QualityLevel& level) {
  const bool many_beams = sonar.kind == SonarKind::kImaging || sonar.kind == SonarKind::kProfiling;
  const double beams = many_beams ? sonar.bins_azimuth : 1.0;
  NERITIC_TRY(const std::uint32_t columns, columns_for(sonar, level));
  const double most_columns =
      std::floor(std::min(kMostChosenColumns, kMostChosenCells / sonar.bins_range) / beams);
  std::uint32_t& own = columns_of(sonar);
  own = std::max(own, static_cast<std::uint32_t>(std::min<double>(columns, most_columns)));
  const auto most_rows = static_cast<std::uint32_t>(kMostChosenSamples / (beams * own));
  sonar.bins_elevation =
      std::max(sonar.bins_elevation, std::min(rows_for(sonar, level), most_rows));
  sonar.gbuffer_scale = level.gbuffer_scale;
  return hear_small_targets(sonar, beams);
}

}  // namespace

std::span<const QualityLevel> quality_levels(SonarKind kind) {
  switch (kind) {
    case SonarKind::kImaging:
      return kImaging;
    case SonarKind::kProfiling:
      return kProfiling;
    case SonarKind::kEchoSounder:
      return kEchoSounder;
    case SonarKind::kSideScan:
      return kSideScan;
    case SonarKind::kMechanical:
      return kMechanical;
  }
  return {};
}

Result<const QualityLevel*> quality_level(const scene::Sonar& sonar) {
  if (sonar.quality.empty() && !(sonar.max_error > 0.0)) return nullptr;
  if (!sonar.quality.empty() && sonar.max_error > 0.0)
    return refusal(fmt::format("sonar {}", sonar.name),
                   fmt::format("quality '{}' and max_error {:g}", sonar.quality, sonar.max_error),
                   "one of them");
  const auto levels = quality_levels(sonar.kind);
  if (!sonar.quality.empty()) {
    for (const QualityLevel& level : levels)
      if (sonar.quality == level.name) return &level;
    return refusal(fmt::format("sonar {}: quality", sonar.name), fmt::format("'{}'", sonar.quality),
                   "draft, standard or reference");
  }
  // Levels rise in cost as they fall in error.
  for (const QualityLevel& level : levels)
    if (level.error <= sonar.max_error) return &level;
  return refusal(
      fmt::format("sonar {}: max_error", sonar.name), fmt::format("{:g}", sonar.max_error),
      fmt::format("at least {:g} for kind {}", levels.back().error, scene::name_of(sonar.kind)));
}

Status apply_quality(scene::Sonar& sonar) {
  NERITIC_TRY(const QualityLevel* level, quality_level(sonar));
  if (level == nullptr) return {};
  if (sonar.quality_chosen) return apply_chosen(sonar, *level);
  const double span_m = sonar.range_max_m - sonar.range_min_m, cell_m = range_cell_m(sonar);
  const double least_bins = level->bins_a_cell * span_m / cell_m;
  // The last of a measured sensor's bins may be a fraction.
  if (sonar.terms.range_spread)
    sonar.bins_range *= static_cast<std::uint32_t>(
        std::clamp(std::ceil(0.99 * least_bins / sonar.bins_range), 1.0, kMostFiner));
  if (sonar.bins_range > kMaxBins)
    return refusal(fmt::format("sonar {}", sonar.name),
                   fmt::format("quality {} over {:g} m, which needs {} range bins", level->name,
                               span_m, sonar.bins_range),
                   fmt::format("at most {}", kMaxBins));
  sonar.gbuffer_scale = level->gbuffer_scale;
  sonar.bins_elevation = rows_for(sonar, *level);
  NERITIC_TRY(columns_of(sonar), columns_for(sonar, *level));
  return {};
}

}  // namespace neritic::sonar
