// How the heart's intervals vary: the figures of the Task Force (1996, Circulation 93, 1043) in
// time and frequency. Pure functions of intervals; any thread.
#pragma once

#include <span>
#include <vector>

#include "diver/heart_detector.hpp"

namespace neritic::diver {

// The class of the interval that a beat ends.
enum class IntervalKind : std::uint8_t {
  kNormal,   // between two beats of the sinus rhythm: NN
  kNone,     // the first beat, or the first after a gap: no interval
  kEctopic,  // the beat came too early (or far too late): an extra beat, or a missed one
  kAfter,    // the pause that follows an ectopic beat
};

struct Interval {
  double end_s = 0.0;     // the time of the beat that ends it
  double length_s = 0.0;  // 0 of kNone
  IntervalKind kind = IntervalKind::kNone;
  bool doubtful = false;  // its beat was found in a poor signal (HeartMonitor)
  double jitter_s = 0.0;  // deviation of length_s by noise in the ECG; 0: measured by a device
};

// An interval that is so far from the median of the normal ones before (share of it) ends in an
// ectopic beat. 20 % is usual (Malik 1989, Eur. Heart J. 10, 1060); atrial beats come as little as
// 15 % early.
inline constexpr double kEctopicShare = 0.15;

// Classifies intervals one by one. Bounded memory. One owner, one thread.
class IntervalJudge {
 public:
  Interval take(const Beat& beat);
  // Until three intervals are known each counts as normal: once they are, those that are far from
  // their median are ectopic after all. For the intervals that the judge gave, the newest last,
  // after each. Returns their number.
  int settle(std::span<Interval> intervals);
  // An interval that a device measured itself (a heart strap's RR).
  Interval take_interval(double end_s, double length_s);

 private:
  IntervalKind kind_of(double length_s);
  std::array<double, 9> normal_s_{};  // the last ones
  int normal_count_ = 0, odd_in_a_row_ = 0;
  bool settles_ = false;  // the newest is the third of a rhythm
  double jitter_of(const Beat& beat);

  std::array<double, 9> sizes_{};  // of the last beats' R waves
  int size_count_ = 0;
  double last_s_ = 0.0, last_jitter_s_ = 0.0;
  bool has_last_ = false, after_ectopic_ = false;
};
std::vector<Interval> intervals_of(std::span<const Beat> beats);

struct Variability {
  std::int64_t intervals = 0;
  double mean_rr_ms = 0.0, mean_rate_bpm = 0.0;
  double sdnn_ms = 0.0;   // sample deviation (n - 1)
  double rmssd_ms = 0.0;  // over pairs of intervals that follow one another
  std::int64_t nn50 = 0, pairs = 0;
  double pnn50_percent = 0.0;         // of pairs; a difference of exactly 50 ms does not count
  double sd1_ms = 0.0, sd2_ms = 0.0;  // Poincare: across and along

  static void fields(auto&& field, auto& self) {
    field("intervals", self.intervals);
    field("mean_rr_ms", self.mean_rr_ms);
    field("mean_rate_bpm", self.mean_rate_bpm);
    field("sdnn_ms", self.sdnn_ms);
    field("rmssd_ms", self.rmssd_ms);
    field("nn50", self.nn50);
    field("pairs", self.pairs);
    field("pnn50_percent", self.pnn50_percent);
    field("sd1_ms", self.sd1_ms);
    field("sd2_ms", self.sd2_ms);
  }
};
// Figures of normal intervals alone. Pairs with something between them count only if across_gaps
// says so. Fewer than two intervals, or pairs: their figures are 0.
Variability variability(std::span<const Interval> intervals, bool across_gaps = false);

// Noise of the ECG moves each beat's time by a deviation s, so that SDNN^2 grows by 2 s^2, and
// RMSSD^2, of differences of intervals that share a beat, by 6 s^2. Where that is more than this
// share of the figures' squares, they tell too much of the noise; below, they are at most 12 % too
// large.
inline constexpr double kMostNoiseShare = 0.2;
// s, of the normal intervals' beats, in seconds; 0 of intervals that a device measured.
double beat_jitter_s(std::span<const Interval> intervals);
bool noise_hides(std::span<const Interval> intervals, const Variability& figures);

// Power by frequency: VLF 0.0033 to 0.04 Hz, LF to 0.15, HF to 0.4 (Task Force 1996).
struct HeartSpectrum {
  double vlf_ms2 = 0.0, lf_ms2 = 0.0, hf_ms2 = 0.0;
  double lf_over_hf = 0.0;  // 0 where HF is 0
  std::uint64_t valid = 0;  // 1: two minutes or more, half of them normal intervals

  static void fields(auto&& field, auto& self) {
    field("vlf_ms2", self.vlf_ms2);
    field("lf_ms2", self.lf_ms2);
    field("hf_ms2", self.hf_ms2);
    field("lf_over_hf", self.lf_over_hf);
    field("valid", self.valid);
  }
};
// By Lomb (1976, Astrophys. Space Sci. 39, 447) and Scargle (1982, Astrophys. J. 263, 835): beats
// are not evenly spaced, and this asks for no resampling, which would take power from HF and invent
// values where ectopic beats were left out. The mean of pieces of 300 s, half overlapping.
HeartSpectrum heart_spectrum(std::span<const Interval> intervals);

}  // namespace neritic::diver
