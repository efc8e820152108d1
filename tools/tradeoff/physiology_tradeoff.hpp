// `neritic tradeoff physiology`: how wrong the rates of heart and breath are, over how far back an
// estimate looks (its latency) and what it costs; by every estimator there is. One thread.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "diver/breath_rate.hpp"
#include "engine/core/result.hpp"

namespace neritic::tools {

struct PhysiologyTradeoffOptions {
  bool quick = false;                  // fewer signals: to see that it works
  std::filesystem::path recordings;    // breath paced by a metronome too; empty: only made signals
  std::function<void()> step = [] {};  // after each of steps(options)
};
std::uint64_t steps(const PhysiologyTradeoffOptions& options);

struct BreathPoint {
  std::string signals;  // "made" or "recorded"; of a sensor: its name
  diver::BreathEstimator estimator = diver::BreathEstimator::kMultiBand;
  double window_s = 0.0;
  int windows = 0;
  double answered = 0.0, right = 0.0, doubled = 0.0;  // shares of all windows; right: within 2
  double median_bpm = 0.0;                            // size of the error, of those answered
  double us = 0.0;                                    // of one core, an estimate
};

// Gain and cost of a higher confidence limit: multiband, windows of BreathSettings::window_s.
struct BreathCoverage {
  std::string signals;
  double least_confidence = 0.0;
  double answered = 0.0, right = 0.0;  // shares of all windows; right: within 2
  double median_bpm = 0.0, worst_bpm = 0.0;
  double without_rhythm = 0.0;  // answered, of the same sounds in pieces in random order
};

enum class RateOver : std::uint8_t { kCount, kMean, kMedian };  // beats in a time, or intervals
const char* name_of(RateOver estimator);
struct HeartPoint {
  RateOver estimator = RateOver::kMedian;
  int intervals = 0;       // that an estimate looks back over
  double latency_s = 0.0;  // the time they take, on the mean
  double rms_bpm = 0.0;    // of the error
};

// The detector over sampling rates, all else the same.
struct DetectorPoint {
  double rate_hz = 0.0;
  int found = 0, extra = 0, missed = 0;
  double timing_ms = 0.0;    // root mean square, of the beats found
  double us_a_second = 0.0;  // of one core, a second of ECG
};

struct PhysiologyTradeoff {
  std::vector<BreathPoint> breath;
  std::vector<BreathCoverage> coverage;  // of recordings, by sensor
  std::vector<HeartPoint> heart;
  std::vector<DetectorPoint> detector;
};
Result<PhysiologyTradeoff> run_physiology_tradeoff(const PhysiologyTradeoffOptions& options);

// The knee of a falling curve: the point farthest below the line between its ends. x rises. Fewer
// than three points: the last.
std::size_t knee_of(const std::vector<double>& x, const std::vector<double>& y);
// The knee of multiband: windows with a wrong answer or none, over the window's length.
const BreathPoint* breath_knee(const PhysiologyTradeoff& tradeoff, const std::string& signals);
// The median over the most intervals whose error is within 10 % of the least: more of them ride
// over a missed beat.
const HeartPoint* heart_choice(const PhysiologyTradeoff& tradeoff);

// Writes physiology.csv, .md, .json and .plot.json into the folder. True: physiology.png was
// drawn too.
Result<bool> write_physiology_tradeoff(const std::filesystem::path& folder,
                                       const PhysiologyTradeoff& tradeoff);

}  // namespace neritic::tools
