#include "sonar/beam_spread.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::sonar {
namespace {

double power(double amplitude, Ways ways) {
  const double one_way = amplitude * amplitude;
  return ways == Ways::kOneWay ? one_way : one_way * one_way;
}

// Amplitude towards theta of a beam at axis, on a grid whose array faces middle.
double heard(const BeamPattern& pattern, Steering steering, double theta_rad, double axis_rad,
             double middle_rad) {
  return steering == Steering::kElectronic
             ? pattern.steered_amplitude(theta_rad - middle_rad, axis_rad - middle_rad)
             : pattern.amplitude(std::remainder(theta_rad - axis_rad, 2.0 * kPi));
}

// How many midpoints sample an angle: 16 a lobe, 5 at least, and an odd number, so that the axis is
// one.
int samples_over(double width_rad, const BeamPattern& pattern) {
  const double lobes = width_rad / pattern.half_power_width_rad();
  return 2 * static_cast<int>(std::clamp(8.0 * lobes, 2.0, 32768.0)) + 1;
}

template <class F>
double average(const F& f, double center, double width, int samples) {
  double sum = 0.0;
  for (int i = 0; i < samples; ++i) sum += f(center + width * ((i + 0.5) / samples - 0.5));
  return sum / samples;
}

struct Builder {
  const BeamPattern& pattern;
  const BeamGrid& grid;
  const BeamSpreadOptions& options;
  double step_rad = grid.azimuth_step_rad();
  double middle_rad = 0.5 * (grid.limits.azimuth_min_rad + grid.limits.azimuth_max_rad);
  std::int64_t beams = grid.bins.azimuth;
  bool wraps = step_rad * static_cast<double>(beams) > 2.0 * kPi - 1e-9;
  int samples = samples_over(step_rad, pattern);

  double center_rad(std::int64_t index) const {
    return grid.limits.azimuth_min_rad + (static_cast<double>(index) + 0.5) * step_rad;
  }
  double amplitude(std::int64_t beam, double theta_rad) const {
    return heard(pattern, options.steering, theta_rad, center_rad(beam), middle_rad);
  }
  // Power that a beam hears from a column, unscaled.
  double raw(std::int64_t beam, std::int64_t column) const {
    return average([&](double theta) { return power(amplitude(beam, theta), options.ways); },
                   center_rad(column), step_rad, samples);
  }
  // The beam exactly opposite, on a full turn of an even number, is left out: only an
  // omnidirectional one would hear it.
  std::int64_t max_reach() const { return wraps ? (beams - 1) / 2 : beams - 1; }

  // Shares of one column's energy by distance between beam and column, both sides together.
  std::vector<double> by_distance(std::int64_t column) const {
    std::vector<double> shares(static_cast<std::size_t>(max_reach()) + 1, 0.0);
    double sum = 0.0;
    for (std::int64_t d = -max_reach(); d <= max_reach(); ++d) {
      const std::int64_t beam = column + d;
      if (!wraps && (beam < 0 || beam >= beams)) continue;
      const double energy = raw(beam, column);
      shares[static_cast<std::size_t>(std::abs(d))] += energy;
      sum += energy;
    }
    for (double& share : shares) share /= sum;
    return shares;
  }
};

// Grows reach until no more than max_truncated of the column's energy lies beyond; what does.
double grow_reach(const std::vector<double>& shares, double max_truncated, std::uint32_t& reach) {
  double beyond = 0.0;
  for (std::size_t d = shares.size(); d-- > std::size_t{reach} + 1;) {
    if (beyond + shares[d] > max_truncated) {
      reach = static_cast<std::uint32_t>(d);
      break;
    }
    beyond += shares[d];
  }
  return beyond;
}

void scale_columns(BeamSpread& spread) {
  const std::int64_t beams = spread.beams, reach = spread.reach, taps = spread.taps();
  for (std::int64_t column = 0; column < beams; ++column) {
    const auto each_tap = [&](const auto& visit) {
      for (std::int64_t t = 0; t < taps; ++t) {
        std::int64_t beam = column - (t - reach);
        if (spread.wraps) beam = (beam + beams) % beams;
        if (beam >= 0 && beam < beams) visit(spread.energy[beam * taps + t]);
      }
    };
    double sum = 0.0;
    each_tap([&](double energy) { sum += energy; });
    each_tap([&](double& energy) { energy /= sum; });
  }
}

void fill_taps(const Builder& builder, BeamSpread& spread) {
  const std::int64_t reach = spread.reach, taps = spread.taps();
  spread.energy.assign(static_cast<std::size_t>(builder.beams * taps), 0.0);
  spread.amplitude.assign(spread.energy.size(), 0.0);
  const bool turned = builder.options.steering == Steering::kTurned;
  for (std::int64_t t = 0; t < taps; ++t) {
    double raw = 0.0, sign = 1.0;
    for (std::int64_t beam = 0; beam < builder.beams; ++beam) {
      const std::int64_t column = beam + t - reach;
      // Turned patterns are alike for all beams.
      if (beam == 0 || !turned) {
        raw = builder.raw(beam, column);
        if (builder.options.ways == Ways::kOneWay)
          sign = builder.amplitude(beam, builder.center_rad(column));
      }
      if (!spread.wraps && (column < 0 || column >= builder.beams)) continue;
      spread.energy[beam * taps + t] = raw;
      spread.amplitude[beam * taps + t] = sign;
    }
  }
  scale_columns(spread);
  for (std::size_t i = 0; i < spread.energy.size(); ++i)
    spread.amplitude[i] = std::copysign(std::sqrt(spread.energy[i]), spread.amplitude[i]);
}

}  // namespace

Result<BeamSpread> beam_spread(const BeamPattern& pattern, const BeamGrid& grid,
                               const BeamSpreadOptions& options) {
  NERITIC_TRY_STATUS(validate(grid));
  if (!(options.max_truncated > 0.0 && options.max_truncated < 1.0))
    return bad_input("beam spread: truncation {}; accepted: a number in (0, 1)",
                     options.max_truncated);
  const Builder builder{pattern, grid, options};
  const double span_rad = grid.limits.azimuth_max_rad - grid.limits.azimuth_min_rad;
  if (options.steering == Steering::kElectronic && span_rad > kPi + 1e-9)
    return bad_input("beam spread: {} degrees of azimuth; accepted of a steered array: up to 180",
                     degrees(span_rad));

  BeamSpread spread;
  spread.beams = grid.bins.azimuth;
  spread.wraps = builder.wraps;
  // The narrowest beams are in the middle, the widest at the edges; a column at the edge has
  // neighbours on one side only. The three tell the reach of all.
  std::vector<std::vector<double>> shares;
  for (const std::int64_t column : {std::int64_t{0}, builder.beams / 2, builder.beams - 1}) {
    shares.push_back(builder.by_distance(column));
    if (!(shares.back()[0] > 0.0))
      return bad_input(
          "beam spread: the pattern hears nothing on its axis; accepted: one that does");
    grow_reach(shares.back(), options.max_truncated, spread.reach);
  }
  for (const auto& column : shares)
    spread.truncated =
        std::max(spread.truncated, grow_reach(column, options.max_truncated, spread.reach));
  const std::size_t size = std::size_t{spread.beams} * spread.taps();
  if (size > kMaxSpreadTaps)
    return bad_input(
        "beam spread: {} beams of {} taps; accepted: {} together, so a narrower "
        "pattern, fewer beams or a larger truncation than {}",
        spread.beams, spread.taps(), kMaxSpreadTaps, options.max_truncated);

  fill_taps(builder, spread);
  return spread;
}

std::vector<double> elevation_power(const BeamPattern& pattern, const BeamGrid& grid, Ways ways,
                                    double axis_rad) {
  std::vector<double> rows(grid.bins.elevation);
  const double step = grid.elevation_step_rad();
  const int samples = samples_over(step, pattern);
  for (std::uint32_t row = 0; row < grid.bins.elevation; ++row)
    rows[row] = average([&](double phi) { return power(pattern.amplitude(phi - axis_rad), ways); },
                        grid.elevation_rad(row), step, samples);
  return rows;
}

}  // namespace neritic::sonar
