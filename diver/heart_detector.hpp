// Heart beats out of an ECG as it comes, after Pan and Tompkins 1985 (IEEE Trans. Biomed. Eng. 32,
// 230): the band of 5 to 15 Hz, its slope, squared, over a window of 150 ms; two levels that follow
// signal and noise; 200 ms in which no beat can follow another; a look back after 1.66 of the mean
// interval. Memory is bounded: some ten seconds. One owner, one thread.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::diver {

// Below, the band does not fit under half the rate with its slope's five points.
inline constexpr double kLeastEcgRate_hz = 50.0, kMostEcgRate_hz = 1e6;
Status check_ecg_rate(double rate_hz);

struct Beat {
  double time_s = 0.0;     // of the R wave, from the first sample
  double amplitude = 0.0;  // against the mean around it, in the ECG's unit; below 0: upside down
  bool after_gap = false;  // no interval leads to it: the signal was lost in between
  double jitter_s = 0.0;   // standard deviation of time_s by the noise around it
};

struct EcgCounts {
  std::uint64_t samples = 0;    // all, refused ones included
  std::uint64_t refused = 0;    // not finite, or leapt: the last good value was held
  std::uint64_t leaps = 0;      // of these, spikes too steep and short to come from a heart
  std::uint64_t gaps = 0;       // runs of missing samples long enough to count as signal loss
  std::uint64_t relearned = 0;  // times the levels were learnt anew, after seconds without a beat
};

class BeatDetector {
 public:
  // Precondition: check_ecg_rate(rate_hz).
  explicit BeatDetector(double rate_hz);

  // Appends the beats that this sample completes to `out`: at most some 0.5 s after their R wave,
  // those of a look back later.
  void push(double value, std::vector<Beat>& out);
  // No more will come: what the last second held is settled.
  void finish(std::vector<Beat>& out);

  const EcgCounts& counts() const { return counts_; }
  bool learning() const { return !learnt_; }
  // No change for the last two seconds: electrode off, or amplifier at its limit.
  bool flat() const;
  // The ratio of the peak levels of beats and of noise. 0 while learning.
  double signal_over_noise() const;
  // Kurtosis of the band over the last eight seconds, at the newest beat: 3 of noise, 5 and more of
  // a heart up to 200 beats a minute (kSQI of Li, Mark and Clifford 2008, Physiol. Meas. 29, 15). 0
  // before any beat.
  double peakedness() const { return peakedness_; }

 private:
  // The signal's values at one place; all four are aligned.
  struct Place {
    double raw = 0.0, band = 0.0, slope = 0.0, energy = 0.0;
  };
  struct Peak {
    std::int64_t at = 0;
    double energy = 0.0, slope = 0.0;
  };

  void count_step(double step);
  bool leaps(double value);

  Place& place(std::int64_t i) { return ring_[static_cast<std::size_t>(i) & mask_]; }
  const Place& place(std::int64_t i) const { return ring_[static_cast<std::size_t>(i) & mask_]; }
  void take(double value, std::vector<Beat>& out);
  void filter();
  void settle(std::int64_t at, std::vector<Beat>& out);
  void learn(std::int64_t from, std::int64_t to);
  bool is_peak(std::int64_t at) const;
  double band_kurtosis() const;
  void judge(const Peak& peak, std::vector<Beat>& out);
  void look_back(std::int64_t at, std::vector<Beat>& out);
  void accept(const Peak& peak, double share, std::vector<Beat>& out);
  Beat locate(const Peak& peak) const;
  std::int64_t half_top() const;  // places
  struct Vertex {
    double at = 0.0, jitter = 0.0;  // places
  };
  Vertex vertex_near(std::int64_t top, std::int64_t near, std::int64_t reach, double sign) const;
  double noise_around(std::int64_t at) const;
  void lose_signal();
  double threshold() const { return noise_level_ + 0.25 * (signal_level_ - noise_level_); }
  double quietest_since_last_beat(std::int64_t at) const;
  double mean_interval() const;  // in places

  double rate_hz_;
  int decimation_;   // samples a place
  double place_hz_;  // places a second
  std::vector<double> taps_;
  int half_taps_, half_window_, guard_, refractory_;
  std::size_t mask_;
  std::vector<Place> ring_;

  std::int64_t newest_ = -1;   // place of the newest sample
  std::int64_t settled_ = -1;  // last place that was judged
  std::int64_t fresh_ = 0;     // first place after the last loss of signal
  double block_sum_ = 0.0;
  int block_count_ = 0;
  double held_ = 0.0;
  bool has_value_ = false;
  std::uint64_t missing_in_a_row_ = 0;
  std::array<double, 5> largest_steps_{};  // from sample to sample, of this second
  std::array<double, 8> second_steps_{};   // the step of each second before, the newest first
  double usual_step_ = 0.0;                // 0: not known
  double stepped_ = 0.0, leapt_ = 0.0;     // samples of this second; in a leap

  bool learnt_ = false, after_gap_ = true;
  double signal_level_ = 0.0, noise_level_ = 0.0;
  bool noise_heard_ = false;  // a peak since the last beat was noise
  std::optional<Peak> last_beat_;
  std::int64_t last_look_ = 0;  // since when there was no beat: the beat, or when learning ended
  std::array<double, 8> intervals_{};  // the last beats', in places
  int interval_count_ = 0;
  std::array<Peak, 32> passed_{};  // peaks below the threshold since the last beat
  int passed_count_ = 0;
  double peakedness_ = 0.0;
  EcgCounts counts_;
};

// All beats of a recording at once; the same as pushing its samples one by one.
std::vector<Beat> find_beats(double rate_hz, const std::vector<double>& samples,
                             EcgCounts* counts = nullptr);

}  // namespace neritic::diver
