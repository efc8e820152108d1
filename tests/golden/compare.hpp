// How a picture or a sonar's image differs from its golden: measures, and the faults beyond limits.
// README.md says how the limits were measured. Pure functions; any thread.
#pragma once

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <vector>

#include "engine/core/image.hpp"

namespace neritic::test {

struct PictureLimits {
  int level = 5;            // a pixel differs if a channel does by more than this
  double fraction = 0.004;  // of all pixels that may differ
  double mean = 0.3;        // signed difference of a channel, mean over the picture, levels of 255
  std::size_t patch_px = 12;         // pixels that differ and touch, corners included
  std::size_t masked_patch_px = 12;  // the same of masked pixels
};

struct PictureDifference {
  double fraction = 0.0;
  std::size_t patch_px = 0;  // the largest of the pixels that are not masked
  std::size_t masked_patch_px = 0;
  int worst = 0;              // largest difference of any channel
  std::vector<double> means;  // a channel each, actual minus golden
};

// mask: empty, or whether each pixel's patches are counted apart. Precondition: equal sizes and
// channels.
PictureDifference difference_of(const ImageU8& actual, const ImageU8& golden, int level,
                                const std::vector<bool>& mask = {});

// The pixels of one value, and those that touch them.
std::vector<bool> mask_of(const ImageU16& labels, std::uint16_t value);

// One line a limit that is exceeded; empty: alike.
std::vector<std::string> faults_of(const PictureDifference& difference,
                                   const PictureLimits& limits);

// The sums of a sonar's image: the plain cosine's, or of power in uPa^2.
struct SonarSums {
  std::uint64_t heard = 0;            // cells that are not zero
  std::vector<double> rows, columns;  // by range, nearest first; by bearing, port first
  double total() const;
};

struct SumLimits {
  double total = 1e-3;  // difference of the totals over the golden's: 0.004 dB
  double line = 0.005;  // of a row's or column's sum over the golden's largest row or column
  double heard = 1e-4;  // difference of the heard cells over all cells
};

// image: [rows][columns].
SonarSums sums_of(std::span<const float> image, std::size_t rows, std::size_t columns);
std::vector<std::string> faults_of(const SonarSums& actual, const SonarSums& golden,
                                   const SumLimits& limits);

nlohmann::json to_json(const SonarSums& sums);
SonarSums sums_from(const nlohmann::json& json);

}  // namespace neritic::test
