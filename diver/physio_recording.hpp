// A recording of a diver's signals, as every reader gives it: evenly spaced samples of one channel,
// whatever the file. Missing samples are NaN; the analysis refuses and counts them. Plain values;
// any thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::diver {

// Limits of a recording: no file may ask for more memory than some 2 GiB, or for a rate that no
// device has.
inline constexpr double kLeastRate_hz = 0.1, kMostRate_hz = 1e6;
inline constexpr std::size_t kMostSamples = std::size_t{1} << 28;

struct Recording {
  std::string channel;  // its name, where the file gives one
  double rate_hz = 0.0;
  double frame_hz = 0.0;        // of a WFDB record: its annotations count frames
  double start_s = 0.0;         // the time of the first sample, by the file's own clock
  std::vector<double> samples;  // NaN: missing
  std::uint64_t refused = 0;    // rows that the reader could not use: time stood still or went back
  std::uint64_t missing = 0;    // of samples: where the file's times leap
  double seconds() const { return static_cast<double>(samples.size()) / rate_hz; }
};

// One beat of a reference beside a recording.
struct BeatAnnotation {
  double time_s = 0.0;  // from the recording's first sample
  int code = 0;         // of the WFDB's list: 1 normal, 5 ventricular, 8 atrial premature, ...
};
// Whether the code is a beat's, and one of a normally conducted sinus beat (N, L, R).
bool is_beat(int code);
bool is_normal_beat(int code);

}  // namespace neritic::diver
