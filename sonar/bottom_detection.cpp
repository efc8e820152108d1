#include "sonar/bottom_detection.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"
#include "sonar/levels.hpp"

namespace neritic::sonar {
namespace {

struct Run {
  std::uint32_t first, end;  // bins [first, end)
};

// The run around peak whose bins reach level; at most max_gap below it in a row.
Run run_around(std::span<const double> echo, std::uint32_t peak, double level,
               std::uint32_t max_gap) {
  Run run{peak, peak + 1};
  for (std::uint32_t i = peak, gap = 0; i-- > 0 && gap <= max_gap;) {
    gap = echo[i] >= level ? 0 : gap + 1;
    if (gap == 0) run.first = i;
  }
  for (std::uint32_t i = peak + 1, gap = 0; i < echo.size() && gap <= max_gap; ++i) {
    gap = echo[i] >= level ? 0 : gap + 1;
    if (gap == 0) run.end = i + 1;
  }
  return run;
}

// Centre of gravity over [first, end) in bins, bin centres at +0.5.
double centre_of_gravity(std::span<const double> echo, std::uint32_t first, std::uint32_t end) {
  double sum = 0.0, moment = 0.0;
  for (std::uint32_t i = first; i < end; ++i) {
    sum += echo[i];
    moment += echo[i] * (i + 0.5);
  }
  return moment / sum;
}

// One beam's echo, [range]; nothing where it is silent.
std::optional<BottomDetection> detect(const BeamGrid& grid, std::span<const double> echo,
                                      const BottomDetectionOptions& options) {
  const auto n = static_cast<std::uint32_t>(echo.size());
  const auto peak =
      static_cast<std::uint32_t>(std::max_element(echo.begin(), echo.end()) - echo.begin());
  if (!(echo[peak] > std::max(options.floor, 0.0))) return std::nullopt;
  const double level = std::max(options.relative_threshold * echo[peak], options.floor);
  const Run run = run_around(echo, peak, level, options.max_gap_bins);
  const std::uint32_t first = run.first > 0 ? run.first - 1 : 0, end = std::min(run.end + 1, n);
  BottomDetection out;
  out.intensity = static_cast<float>(echo[peak]);
  out.echo_bins = run.end - run.first;
  double at_bins = 0.0;
  if (out.echo_bins <= options.amplitude_bins) {
    const double before = peak > 0 ? echo[peak - 1] : 0.0,
                 after = peak + 1 < n ? echo[peak + 1] : 0.0;
    at_bins = peak + 0.5 + sub_bin_offset(before, echo[peak], after);
  } else {
    out.method = DetectionMethod::kCentreOfGravity;
    at_bins = centre_of_gravity(echo, first, end);
  }
  out.range_m = grid.limits.range_min_m + at_bins * grid.range_step_m();
  double all = 0.0, part = 0.0;
  for (std::uint32_t i = 0; i < n; ++i) {
    all += echo[i];
    if (i >= first && i < end) part += echo[i];
  }
  out.quality = static_cast<float>(part / all);
  if (out.quality < options.least_quality) return std::nullopt;
  return out;
}

}  // namespace

Status validate(const BottomDetectionOptions& options) {
  if (!(options.relative_threshold > 0.0 && options.relative_threshold <= 1.0))
    return refusal("bottom detection",
                   fmt::format("relative threshold {}", options.relative_threshold),
                   "above 0, at most 1");
  if (!(options.floor >= 0.0) || !std::isfinite(options.floor))
    return refusal("bottom detection", fmt::format("floor {}", options.floor), "0 or more");
  if (!(options.least_quality >= 0.0 && options.least_quality <= 1.0))
    return refusal("bottom detection", fmt::format("least quality {}", options.least_quality),
                   "0 to 1");
  return {};
}

double sub_bin_offset(double before, double at, double after, double side_level) {
  if (std::min(before, after) >= side_level * at) {
    const double bend = 2.0 * at - before - after;
    return bend > 0.0 ? std::clamp((after - before) / (2.0 * bend), -0.5, 0.5) : 0.0;
  }
  return std::clamp((after - before) / (before + at + after), -0.5, 0.5);
}

std::vector<BottomDetection> detect_bottom(const BeamGrid& grid, std::span<const float> intensity,
                                           const BottomDetectionOptions& options) {
  const std::size_t rows = grid.bins.range, beams = grid.bins.azimuth;
  NERITIC_CHECK(intensity.size() == rows * beams, "{} values for {} x {} bins", intensity.size(),
                rows, beams);
  std::vector<BottomDetection> out;
  // Columns are turned into rows by blocks that keep their cache lines.
  constexpr std::size_t kBlock = 16;
  std::vector<double> block(kBlock * rows);
  for (std::size_t from = 0; from < beams; from += kBlock) {
    const std::size_t count = std::min(kBlock, beams - from);
    for (std::size_t row = 0; row < rows; ++row)
      for (std::size_t k = 0; k < count; ++k)
        block[k * rows + row] = heard(intensity[row * beams + from + k]);
    for (std::size_t k = 0; k < count; ++k)
      if (auto found =
              detect(grid, std::span<const double>(block).subspan(k * rows, rows), options)) {
        found->beam = static_cast<std::uint32_t>(from + k);
        out.push_back(*found);
      }
  }
  return out;
}

Vec3 detection_point(const BeamGrid& grid, const BottomDetection& detection) {
  return detection.range_m * direction(grid.azimuth_rad(detection.beam), 0.0);
}

std::uint16_t detected_class(const BeamGrid& grid, std::span<const std::uint16_t> labels,
                             const BottomDetection& detection) {
  const std::int64_t bins = grid.bins.range;
  NERITIC_CHECK(labels.size() == static_cast<std::size_t>(bins) * grid.bins.azimuth,
                "{} labels for {} x {} bins", labels.size(), bins, grid.bins.azimuth);
  const double step_m = (grid.limits.range_max_m - grid.limits.range_min_m) / grid.bins.range;
  const auto middle =
      static_cast<std::int64_t>(std::floor((detection.range_m - grid.limits.range_min_m) / step_m));
  for (std::int64_t off = 0; off <= detection.echo_bins / 2 + 1; ++off)
    for (const std::int64_t bin : {middle - off, middle + off})
      if (bin >= 0 && bin < bins)
        if (const std::uint16_t label =
                labels[static_cast<std::size_t>(bin) * grid.bins.azimuth + detection.beam];
            label != 0)
          return label;
  return 0;
}

std::vector<BottomDetection> nadir_detections(const BeamGrid& grid,
                                              std::span<const BottomDetection> detections,
                                              const Pose& world_from_sonar, double half_angle_rad) {
  const double least = std::cos(half_angle_rad);
  std::vector<BottomDetection> out;
  for (const BottomDetection& d : detections)
    if (-(world_from_sonar.rotation * direction(grid.azimuth_rad(d.beam), 0.0)).y >= least)
      out.push_back(d);
  return out;
}

}  // namespace neritic::sonar
