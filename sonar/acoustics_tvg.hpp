// Time varied gain: what a receiver adds to an echo's level by its range. A plain value; pure
// functions; any thread.
#pragma once

#include <filesystem>

#include "sonar/acoustics_csv.hpp"

namespace neritic::sonar {

// Gain = spreading_log * log10(r / 1 m) + (absorption ? 2 alpha r : 0), or the table's.
struct Tvg {
  // 40 makes point targets level over range, 30 areas cut out by beam and pulse, 20 volumes.
  double spreading_log = 0.0;
  bool compensate_absorption = false;
  Table range_gain;  // metres to dB, linear, its ends held; where given, nothing else counts

  // dB. Ranges below kNearestRange_m (acoustics.hpp) count as that. NaN for NaN.
  double gain_db(double range_m, double absorption_db_m) const;
};

// kBadInput where spreading_log lies outside [0, 80] or the table is wrong.
Status validate(const Tvg& tvg);
// A table of range_m,gain_db: ranges rising from 0, gains in [-300, 300] dB.
Result<Tvg> read_tvg(const std::filesystem::path& path);

}  // namespace neritic::sonar
