#include "diver/breath_halves.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "diver/breath_rate.hpp"

namespace neritic::diver {
namespace {

constexpr std::size_t kQuarters = 4, kLeastBursts = 8;

// The mean level of that quarter of each burst's period.
std::vector<double> quarter_levels(const Levels& levels, double bursts_hz, std::size_t quarter) {
  std::vector<double> sums, counts;
  for (std::size_t i = 0; i < levels.size(); ++i) {
    const double turns = static_cast<double>(i) / kBreathFrames_hz * bursts_hz;
    if (static_cast<std::size_t>(kQuarters * (turns - std::floor(turns))) != quarter) continue;
    const auto burst = static_cast<std::size_t>(turns);
    if (burst >= sums.size()) {
      sums.resize(burst + 1);
      counts.resize(burst + 1);
    }
    sums[burst] += levels[i];
    counts[burst] += 1.0;
  }
  // The last period may not be whole.
  while (!sums.empty() && counts.back() < 0.5 * counts.front()) {
    sums.pop_back();
    counts.pop_back();
  }
  for (std::size_t i = 0; i < sums.size(); ++i) sums[i] /= std::max(counts[i], 1.0);
  return sums;
}

// y = a + b t + c t^2 + d (-1)^i + noise by least squares: (d over its error)^2.
double alternation_squared(std::vector<double> y) {
  constexpr std::size_t kColumns = 4;
  const auto product = [](const std::vector<double>& a, const std::vector<double>& b) {
    return std::inner_product(a.begin(), a.end(), b.begin(), 0.0);
  };
  const auto remove = [&](const std::vector<double>& column, std::vector<double>& from) {
    const double share = product(from, column) / product(column, column);
    for (std::size_t i = 0; i < from.size(); ++i) from[i] -= share * column[i];
    return share;
  };
  // Each column without what the ones before explain (Gram and Schmidt).
  std::array<std::vector<double>, kColumns> columns;
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double t = static_cast<double>(i) - 0.5 * static_cast<double>(y.size() - 1);
    const std::array<double, kColumns> row{1.0, t, t * t, i % 2 == 0 ? 1.0 : -1.0};
    for (std::size_t c = 0; c < kColumns; ++c) columns[c].push_back(row[c]);
  }
  double alternating = 0.0;
  for (std::size_t c = 0; c < kColumns; ++c) {
    for (std::size_t before = 0; before < c; ++before) remove(columns[before], columns[c]);
    alternating = remove(columns[c], y);
  }
  const double variance = product(y, y) / static_cast<double>(y.size() - kColumns);
  const double explained = alternating * alternating * product(columns.back(), columns.back());
  return variance > 0.0 ? explained / variance : 0.0;
}

}  // namespace

double alternation(const std::vector<Levels>& bands, double bursts_hz) {
  double most = 0.0;
  for (std::size_t quarter = 0; quarter < kQuarters; ++quarter) {
    double mean = 0.0;
    for (const Levels& band : bands) {
      std::vector<double> levels = quarter_levels(band, bursts_hz, quarter);
      if (levels.size() < kLeastBursts) return 0.0;
      mean += alternation_squared(std::move(levels)) / static_cast<double>(bands.size());
    }
    most = std::max(most, mean);
  }
  return most;
}

}  // namespace neritic::diver
