#include "tools/tradeoff/measure.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace neritic::tools {

ImageError compare(std::span<const float> image, const Truth& truth, double range_span_m) {
  const std::size_t rows = truth.bins.range, columns = truth.bins.azimuth;
  const double step_mm = range_span_m / static_cast<double>(rows) * 1000.0;
  double total = 0.0, found = 0.0, difference = 0.0, moved = 0.0, weight = 0.0;
  for (std::size_t c = 0; c < columns; ++c) {
    double column_truth = 0.0, column_found = 0.0;
    for (std::size_t r = 0; r < rows; ++r) {
      const double a = image[r * columns + c], b = truth.intensity[r * columns + c];
      difference += std::abs(a - b);
      column_found += a;
      column_truth += b;
    }
    total += column_truth;
    found += column_found;
    if (!(column_truth > 0.0) || !(column_found > 0.0)) continue;
    // Earth mover's distance between the column's energies, each scaled to 1: the area between
    // their sums from the nearest range on.
    double ahead = 0.0, distance = 0.0;
    for (std::size_t r = 0; r < rows; ++r) {
      ahead +=
          image[r * columns + c] / column_found - truth.intensity[r * columns + c] / column_truth;
      distance += std::abs(ahead);
    }
    moved += distance * step_mm * column_truth;
    weight += column_truth;
  }
  if (!(total > 0.0)) return {};
  return {found / total - 1.0, difference / total, weight > 0.0 ? moved / weight : 0.0};
}

Result<Point> measure_gather(gpu::Device& device, const sonar::BeamGrid& grid,
                             std::span<const sonar::SonarInput> inputs, sonar::Gather gather,
                             const Truth& truth, int repeats) {
  NERITIC_TRY(const auto run, sonar::ImageGather::create(device, grid, inputs, gather));
  std::vector<double> times;
  Point point;
  for (int i = 0; i < repeats + 1; ++i) {
    NERITIC_TRY(const sonar::SonarImage image, run->run());
    if (i == 0) {  // the first run also compiles
      point.error =
          compare(image.intensity, truth, grid.limits.range_max_m - grid.limits.range_min_m);
      continue;
    }
    double ms = 0.0;
    for (const gpu::PassTime& pass : run->pass_times())
      if (pass.name.rfind("sonar", 0) == 0) ms += pass.ms;
    times.push_back(ms > 0.0 ? ms : run->wall_ms());
  }
  // The least: other programs on the machine can only add.
  point.gather_ms = *std::min_element(times.begin(), times.end());
  point.gather = sonar::name_of(gather);
  point.width = inputs[0].width;
  point.height = inputs[0].height;
  point.bins = grid.bins;
  return point;
}

std::size_t knee_of(std::span<const double> cost, std::span<const double> error) {
  const auto [cheap, dear] = std::minmax_element(cost.begin(), cost.end());
  const double cost_from = *cheap, cost_span = std::max(*dear - *cheap, 1e-12);
  const double error_from = error[static_cast<std::size_t>(dear - cost.begin())];
  const double error_span = error[static_cast<std::size_t>(cheap - cost.begin())] - error_from;
  std::size_t best = static_cast<std::size_t>(cheap - cost.begin());
  double farthest = 0.0;
  for (std::size_t i = 0; i < cost.size(); ++i) {
    const double x = (cost[i] - cost_from) / cost_span;
    const double y = error_span > 0.0 ? (error[i] - error_from) / error_span : 1.0;
    const double below = (1.0 - x) - y;
    if (below > farthest) {
      farthest = below;
      best = i;
    }
  }
  return best;
}

}  // namespace neritic::tools
