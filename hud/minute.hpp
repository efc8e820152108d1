// The last minute of a diver's heart and lungs, a sample each quarter of a second. A plain value
// without allocation; any thread.
#pragma once

#include <array>

#include "hud/dive_data.hpp"

namespace neritic::hud {

struct Minute {
  static constexpr std::size_t kSamples = 240;
  static constexpr double kPeriod_s = 0.25;
  std::array<float, kSamples> heart_bpm = unknown(), lungs_l = unknown();  // oldest first
  double next_s = 0.0;
  bool begun = false;

  // Adds the samples that are due at data.time_s. A gap of more than the minute, or a time before
  // the last one, begins anew.
  void add(const DiveData& data);

 private:
  static constexpr std::array<float, kSamples> unknown() {
    std::array<float, kSamples> out{};
    for (float& v : out) v = std::numeric_limits<float>::quiet_NaN();
    return out;
  }
};

}  // namespace neritic::hud
