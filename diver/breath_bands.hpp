// Sound into what breathing shows in: the power in octave bands and the envelope, twenty times a
// second. Any sampling rate. Bounded memory; one owner, one thread.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::diver {

inline constexpr double kBreathFrames_hz = 20.0;
// Octaves from 9.4 Hz: what moves with the chest below 75 Hz (some stethoscopes tell breaths apart
// only there), chest and throat above, a regulator's hiss above 1 kHz. Those that do not fit under
// half the sampling rate are left out.
inline constexpr int kMostBreathBands = 9;
inline constexpr double kLowestBreathBand_hz = 9.375;
inline constexpr double kLeastSoundRate_hz = 500.0, kMostSoundRate_hz = 1e6;
Status check_sound_rate(double rate_hz);

struct BreathFrame {
  std::array<double, kMostBreathBands> power{};  // mean squares
  double envelope = 0.0;                         // mean size in the band of 100 to 2000 Hz
};

// Butterworth's low or high pass of second order, by the bilinear transform.
class SecondOrderFilter {
 public:
  static SecondOrderFilter low_pass(double cut_hz, double rate_hz);
  static SecondOrderFilter high_pass(double cut_hz, double rate_hz);
  double step(double x);

 private:
  double b0_ = 1, b1_ = 0, b2_ = 0, a1_ = 0, a2_ = 0, s1_ = 0, s2_ = 0;
};

class BreathBands {
 public:
  // Precondition: check_sound_rate(rate_hz).
  explicit BreathBands(double rate_hz);

  // The frame that this sample completes is added to `out`. A value that is not finite (or larger
  // than a million) is refused and counted, and the last good value held.
  void push(double sample, std::vector<BreathFrame>& out);

  int bands() const { return static_cast<int>(filters_.size()); }
  double width_hz(int band) const { return widths_hz_[static_cast<std::size_t>(band)]; }
  std::uint64_t refused() const { return refused_; }

 private:
  struct BandPass {
    SecondOrderFilter high, low;
    double step(double x) { return low.step(high.step(x)); }
  };
  void take(double value, std::vector<BreathFrame>& out);

  int decimation_ = 1;
  double rate_hz_ = 0.0;  // after it
  std::vector<BandPass> filters_;
  std::vector<double> widths_hz_;
  BandPass whole_;
  BreathFrame sum_;
  std::uint64_t samples_ = 0, frames_ = 0, refused_ = 0;
  int in_frame_ = 0, block_count_ = 0;
  double block_sum_ = 0.0, held_ = 0.0;
};

}  // namespace neritic::diver
