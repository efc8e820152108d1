// The CPU's part of a ping and its image: the table of a sound speed profile at several sizes, and
// counts of 8 and 16 bits. Each is compared with the exact values. Any thread.
#pragma once

#include <span>

#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {

// Tables for a sonar at depth_m: milliseconds to make one (bent rays), and the mean error of the
// range heard along straight rays over a resolution cell (c / 2B).
std::vector<TermPoint> profile_tables(const scene::Sonar& sonar, double depth_m);

// power: of a calibrated image. Counts over 80 dB below its strongest cell; error as of an image.
std::vector<TermPoint> counts_of(std::span<const float> power);

}  // namespace neritic::tools
