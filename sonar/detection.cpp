#include "sonar/detection.hpp"

#include <cmath>

#include "sonar/acoustics.hpp"
#include "sonar/head.hpp"
#include "sonar/levels.hpp"

namespace neritic::sonar {
namespace {

constexpr double kFalseAlarms = 1e-7;  // a bin

}  // namespace

std::vector<float> noise_by_row(const Ping& ping) {
  std::vector<float> out;
  if (!(ping.noise_power > 0.0f)) return out;
  for (const glm::vec2& gain : ping.gains) out.push_back(ping.noise_power * gain.y);
  return out;
}

std::vector<float> detection_floor(const scene::SonarDetection& detection,
                                   std::span<const float> noise_by_row) {
  const double above =
      detection.floor_db ? power_from_db(*detection.floor_db) : -std::log(kFalseAlarms);
  std::vector<float> floor;
  for (const float noise : noise_by_row) floor.push_back(static_cast<float>(above * noise));
  return floor;
}

std::vector<BottomDetection> detect_bottom(const BeamGrid& grid, std::span<const float> intensity,
                                           const scene::SonarDetection& detection,
                                           std::span<const float> floor) {
  BottomDetectionOptions options;
  options.relative_threshold = detection.threshold.value_or(options.relative_threshold);
  options.least_quality = detection.quality;
  return detect_bottom(grid, above_floor(intensity, floor), options);
}

EchoTraceOptions echo_trace_options(const BeamGrid& grid, const scene::SonarTerms& terms,
                                    std::vector<float> floor) {
  EchoTraceOptions options{.n_range = grid.bins.range,
                           .range_min_m = grid.limits.range_min_m,
                           .range_max_m = grid.limits.range_max_m,
                           .floor_by_bin = std::move(floor)};
  options.relative_threshold = terms.detection.threshold.value_or(options.relative_threshold);
  if (const auto taps = pulse_taps(terms, grid); taps.ok() && !taps->energy.empty())
    options.pulse_bins = 1.0 / taps->energy[taps->reach];  // they sum to 1
  return options;
}

SidescanOptions sidescan_options(const BeamGrid& grid, const scene::SonarTerms& terms,
                                 std::vector<float> floor) {
  SidescanOptions options{.n_range = grid.bins.range,
                          .range_min_m = grid.limits.range_min_m,
                          .range_max_m = grid.limits.range_max_m,
                          .floor_by_bin = std::move(floor),
                          .tracking_pings = terms.detection.pings,
                          .levels = terms.level.has_value()};
  options.relative_threshold = terms.detection.threshold.value_or(options.relative_threshold);
  return options;
}

}  // namespace neritic::sonar
