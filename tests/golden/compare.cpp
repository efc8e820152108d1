#include "tests/golden/compare.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <numeric>

#include "engine/core/check.hpp"

namespace neritic::test {
namespace {

// The most marked pixels that hang together by sides or corners.
std::size_t largest_patch(std::vector<bool> marked, std::uint32_t width, std::uint32_t height) {
  std::size_t largest = 0;
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < marked.size(); ++first) {
    if (!marked[first]) continue;
    std::size_t size = 0;
    marked[first] = false;
    open.assign(1, first);
    while (!open.empty()) {
      const auto x = static_cast<std::int64_t>(open.back() % width);
      const auto y = static_cast<std::int64_t>(open.back() / width);
      open.pop_back();
      ++size;
      for (std::int64_t ny = std::max<std::int64_t>(y - 1, 0);
           ny <= std::min<std::int64_t>(y + 1, height - 1); ++ny)
        for (std::int64_t nx = std::max<std::int64_t>(x - 1, 0);
             nx <= std::min<std::int64_t>(x + 1, width - 1); ++nx) {
          const auto next = static_cast<std::size_t>(ny * width + nx);
          if (!marked[next]) continue;
          marked[next] = false;
          open.push_back(next);
        }
    }
    largest = std::max(largest, size);
  }
  return largest;
}

// The place and size of the largest difference of two lines of sums, over the golden's largest.
std::pair<std::size_t, double> worst_line(const std::vector<double>& actual,
                                          const std::vector<double>& golden) {
  const double largest = *std::ranges::max_element(golden);
  std::pair<std::size_t, double> worst{0, 0.0};
  for (std::size_t i = 0; i < golden.size(); ++i) {
    const double off = std::abs(actual[i] - golden[i]) / std::max(largest, 1e-300);
    if (std::isnan(off)) return {i, off};
    if (off > worst.second) worst = {i, off};
  }
  return worst;
}

}  // namespace

PictureDifference difference_of(const ImageU8& actual, const ImageU8& golden, int level,
                                const std::vector<bool>& mask) {
  NERITIC_CHECK(actual.width == golden.width && actual.height == golden.height &&
                    actual.channels == golden.channels,
                "pictures of one size are compared");
  const std::size_t pixels = std::size_t{actual.width} * actual.height;
  PictureDifference out;
  std::vector<std::int64_t> sums(actual.channels, 0);
  std::vector<bool> differs(pixels, false);
  for (std::size_t pixel = 0; pixel < pixels; ++pixel)
    for (std::uint32_t channel = 0; channel < actual.channels; ++channel) {
      const std::size_t i = pixel * actual.channels + channel;
      const int d = int(actual.data[i]) - int(golden.data[i]);
      sums[channel] += d;
      out.worst = std::max(out.worst, std::abs(d));
      if (std::abs(d) > level) differs[pixel] = true;
    }
  const auto pixel_count = static_cast<double>(pixels);
  out.fraction = static_cast<double>(std::ranges::count(differs, true)) / pixel_count;
  for (const std::int64_t sum : sums) out.means.push_back(static_cast<double>(sum) / pixel_count);
  std::vector<bool> masked(pixels, false);
  for (std::size_t pixel = 0; pixel < mask.size(); ++pixel)
    if (mask[pixel] && differs[pixel]) {
      masked[pixel] = true;
      differs[pixel] = false;
    }
  out.masked_patch_px = largest_patch(std::move(masked), actual.width, actual.height);
  out.patch_px = largest_patch(std::move(differs), actual.width, actual.height);
  return out;
}

std::vector<bool> mask_of(const ImageU16& labels, std::uint16_t value) {
  std::vector<bool> mask(std::size_t{labels.width} * labels.height, false);
  for (std::uint32_t y = 0; y < labels.height; ++y)
    for (std::uint32_t x = 0; x < labels.width; ++x) {
      if (labels.at(x, y) != value) continue;
      for (std::uint32_t ny = y - (y > 0); ny <= std::min(y + 1, labels.height - 1); ++ny)
        for (std::uint32_t nx = x - (x > 0); nx <= std::min(x + 1, labels.width - 1); ++nx)
          mask[std::size_t{ny} * labels.width + nx] = true;
    }
  return mask;
}

std::vector<std::string> faults_of(const PictureDifference& difference,
                                   const PictureLimits& limits) {
  std::vector<std::string> faults;
  if (difference.fraction > limits.fraction)
    faults.push_back(fmt::format(
        "{:.3g} % of the pixels differ by more than {} levels, the worst by {}; accepted: {:g} %",
        100.0 * difference.fraction, limits.level, difference.worst, 100.0 * limits.fraction));
  for (std::size_t channel = 0; channel < difference.means.size(); ++channel)
    if (std::abs(difference.means[channel]) > limits.mean)
      faults.push_back(fmt::format("channel {} differs by {:+.3f} levels in the mean; accepted: {}",
                                   channel, difference.means[channel], limits.mean));
  for (const auto& [patch_px, most_px] : {std::pair{difference.patch_px, limits.patch_px},
                                          {difference.masked_patch_px, limits.masked_patch_px}})
    if (patch_px > most_px)
      faults.push_back(
          fmt::format("a patch of {} pixels differs by more than {} levels; accepted: {}", patch_px,
                      limits.level, most_px));
  return faults;
}

double SonarSums::total() const {
  return std::accumulate(rows.begin(), rows.end(), 0.0);
}

SonarSums sums_of(std::span<const float> image, std::size_t rows, std::size_t columns) {
  NERITIC_CHECK(image.size() == rows * columns, "an image of other limits");
  SonarSums sums{0, std::vector<double>(rows, 0.0), std::vector<double>(columns, 0.0)};
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t column = 0; column < columns; ++column) {
      const float value = image[row * columns + column];
      sums.heard += value != 0.0f;
      sums.rows[row] += value;
      sums.columns[column] += value;
    }
  return sums;
}

std::vector<std::string> faults_of(const SonarSums& actual, const SonarSums& golden,
                                   const SumLimits& limits) {
  if (actual.rows.size() != golden.rows.size() || actual.columns.size() != golden.columns.size())
    return {fmt::format("{} rows of {} columns; accepted: {} of {}", actual.rows.size(),
                        actual.columns.size(), golden.rows.size(), golden.columns.size())};
  std::vector<std::string> faults;
  const double off = (actual.total() - golden.total()) / std::max(golden.total(), 1e-300);
  if (!(std::abs(off) <= limits.total))
    faults.push_back(
        fmt::format("the sum differs by {:+.3g} of it; accepted: {:g}", off, limits.total));
  const auto cells = static_cast<double>(golden.rows.size() * golden.columns.size());
  const double heard =
      (static_cast<double>(actual.heard) - static_cast<double>(golden.heard)) / cells;
  if (std::abs(heard) > limits.heard)
    faults.push_back(fmt::format("{} cells are heard, of the golden {}; accepted: {:g} of all off",
                                 actual.heard, golden.heard, limits.heard));
  const auto check = [&](const char* name, const std::vector<double>& a,
                         const std::vector<double>& b) {
    const auto [at, worst] = worst_line(a, b);
    if (!(worst <= limits.line))
      faults.push_back(
          fmt::format("{} {}: {:.6g}, of the golden {:.6g}: off by {:.3g} of its largest; "
                      "accepted: {:g}",
                      name, at, a[at], b[at], worst, limits.line));
  };
  check("row", actual.rows, golden.rows);
  check("column", actual.columns, golden.columns);
  return faults;
}

nlohmann::json to_json(const SonarSums& sums) {
  // Six digits: the limits ask for three.
  const auto rounded = [](std::vector<double> values) {
    for (double& value : values) value = std::strtod(fmt::format("{:.6g}", value).c_str(), nullptr);
    return values;
  };
  return {{"heard", sums.heard}, {"rows", rounded(sums.rows)}, {"columns", rounded(sums.columns)}};
}

SonarSums sums_from(const nlohmann::json& json) {
  return {json["heard"], json["rows"], json["columns"]};
}

}  // namespace neritic::test
