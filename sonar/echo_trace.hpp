// The record of an echo sounder over a track: one range profile a ping, the first and the strongest
// return, and the range-time picture. Intensities are linear. One owner, one thread.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/image.hpp"
#include "engine/core/result.hpp"

namespace neritic::sonar {

struct EchoTraceOptions {
  std::uint32_t n_range = 500;
  double range_min_m = 0.0, range_max_m = 50.0;
  // A return begins in the first bin that reaches this part of the ping's strongest and the floor.
  double relative_threshold = 0.2;  // above 0, at most 1
  double floor = 0.0;               // a ping whose strongest bin is not above it has no return
  std::vector<float> floor_by_bin;  // [n_range], what a bin must exceed as well; empty: nothing
  // The pulse's length in bins, as its energy over its strongest bin's; 1: one of no length.
  double pulse_bins = 1.0;

  double range_step_m() const { return (range_max_m - range_min_m) / n_range; }
};
// kBadInput that names the option.
Status validate(const EchoTraceOptions& options);

// Ranges are slant ranges from the sonar, NaN where there is no return.
struct EchoPing {
  double time_s = 0.0, sonar_depth_m = 0.0;
  double first_m = 0.0;      // where the first return begins
  double strongest_m = 0.0;  // where the return that has the strongest bin begins

  // Depth of the bottom below the surface, m, for a sonar that looks straight down.
  double first_depth_m() const { return sonar_depth_m + first_m; }
  double strongest_depth_m() const { return sonar_depth_m + strongest_m; }
};

// A straight line through (x, y) by least squares; pairs with a NaN take no part.
struct LineFit {
  double slope = 0.0, at_zero = 0.0, rms = 0.0;  // rms of what the line leaves
  std::size_t count = 0;
};
// Nothing where fewer than two different x remain.
std::optional<LineFit> fit_line(std::span<const double> x, std::span<const double> y);

class EchoTrace {
 public:
  // Options must be valid (CHECKed).
  explicit EchoTrace(const EchoTraceOptions& options);

  // One ping's intensity [n_range] (CHECKed), at a time and depth (-y) of the sonar. Values that
  // are negative or not finite count as silence.
  void append(std::span<const float> intensity, double time_s, double sonar_depth_m);

  const EchoTraceOptions& options() const { return options_; }
  const std::vector<EchoPing>& pings() const { return pings_; }
  std::span<const float> intensity() const { return intensity_; }  // [pings][n_range]
  // Line through the first return's range over time: slope in m/s, negative if the sonar descends.
  std::optional<LineFit> first_return_slope() const;

 private:
  EchoTraceOptions options_;
  std::vector<EchoPing> pings_;
  std::vector<float> intensity_;
};

// Where a return of a profile begins, in bins from the first bin's beginning: the first that
// reaches the threshold, or the one that has the strongest bin; nothing where there is none. A
// pulse draws a return's edge out to either side alike, and a bin's edge fills the first bin in
// part: so what lies on the flank before the return's peak, over the peak's value, is how much of
// the flank the return fills, and it begins so far before the peak's bin. A return no longer than
// the pulse (half as much again) is a point's and lies at its peak, between bins.
std::optional<double> first_return_bins(std::span<const float> intensity, double relative_threshold,
                                        double floor, double pulse_bins = 1.0);
std::optional<double> strongest_return_bins(std::span<const float> intensity, double floor,
                                            double pulse_bins = 1.0);

struct EchoPictureOptions {
  std::string title = "ECHO SOUNDER";
  std::uint32_t height_px = 900, width_px = 1300;
  double span_db = 50.0;  // shown below the strongest echo
};
// Range-time: time to the right, range down, colours in decibels below the trace's strongest (10
// log10 of intensity), the first return as a line. RGB.
ImageU8 draw_echo_trace(const EchoTrace& trace, const EchoPictureOptions& options = {});

// echo_trace.npy float32 [pings, n_range], echo_trace.csv (a row a ping), echo_trace.png and, last,
// echo_trace.json.
Status write_echo_trace(const std::filesystem::path& folder, const EchoTrace& trace,
                        const nlohmann::json& facts, const EchoPictureOptions& picture = {});

}  // namespace neritic::sonar
