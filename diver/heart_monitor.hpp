// A diver's heart as it beats: ECG samples or a strap's intervals in, one plain state out, over the
// last five minutes. Bounded memory. One owner, one thread.
#pragma once

#include <optional>
#include <span>

#include "diver/hrv.hpp"

namespace neritic::diver {

enum class SignalQuality : std::uint64_t {
  kNone,      // nothing yet, or no change: electrode off, saturated
  kLearning,  // too little seen to tell
  kPoor,      // noise is nearly as large, or is all there is, or much is missing, or the beats keep
              // no time or point both ways, as of breath or gaze taken for a heart: may be wrong
  kGood,
};
const char* name_of(SignalQuality quality);

// A snapshot's data about the heart. Always finite.
struct HeartState {
  double time_s = 0.0;  // of the newest sample or interval
  double last_beat_s = 0.0;
  // By the median of the last four normal intervals; 0: none, stale, or of a poor signal.
  double rate_bpm = 0.0;
  // Without intervals, and no valid spectrum, where the signal is poor or was for more than
  // kMostDoubtful of the intervals, and where noise moves the beats by too much (noise_hides).
  Variability over_five_minutes;
  HeartSpectrum spectrum;
  SignalQuality quality = SignalQuality::kNone;
  std::uint64_t beats = 0, ectopic = 0, refused = 0, gaps = 0;

  static void fields(auto&& field, auto& self) {
    field("time_s", self.time_s);
    field("last_beat_s", self.last_beat_s);
    field("rate_bpm", self.rate_bpm);
    field("over_five_minutes", self.over_five_minutes);
    field("spectrum", self.spectrum);
    field("quality", self.quality);
    field("beats", self.beats);
    field("ectopic", self.ectopic);
    field("refused", self.refused);
    field("gaps", self.gaps);
  }
};

// Noise adds beats and shifts others. Where more than this share of them was found in a poor
// signal, figures of their intervals tell more of the noise than of the heart.
inline constexpr double kMostDoubtful = 0.02;

class HeartMonitor {
 public:
  // The monitor of an ECG. Precondition: check_ecg_rate(rate_hz).
  explicit HeartMonitor(double rate_hz);
  // The monitor of a strap that sends intervals.
  HeartMonitor() = default;

  void push(std::span<const double> samples);
  // Samples that last so long by a clock that knows it better than the nominal rate: times and
  // intervals are by that clock. Precondition: within kMostStretch of the nominal length.
  void push(std::span<const double> samples, double lasts_s);
  static constexpr double kMostStretch = 0.1;
  // An interval in seconds, oldest first; one outside 0.2 to 3 s is refused and counted,
  // and is a gap.
  void push_interval(double length_s);
  // No contact for so long, at most an hour; any other length is refused and counted.
  void skip(double seconds);

  HeartState state() const;
  // The share of all beats so far that were found in a poor signal.
  double doubtful_share() const;

 private:
  void push_at(std::span<const double> samples, double longer);
  void take(const Interval& interval);
  SignalQuality judged() const;
  bool doubtful() const;
  void forget();
  // Figures of the last intervals.
  struct Timekeeping {
    int judged = 0, normal = 0;
  };
  Timekeeping timekeeping() const;
  bool both_ways(int of) const;

  std::optional<BeatDetector> detector_;
  double rate_hz_ = 0.0;
  double shift_s_ = 0.0;        // the state's time less that of as many samples at rate_hz_
  double missing_share_ = 0.0;  // of the samples of late
  std::uint64_t downward_ = 0;  // bits of the last beats, the newest lowest
  IntervalJudge judge_;
  std::uint64_t doubtful_beats_ = 0;
  std::vector<Beat> found_;          // scratch
  std::vector<Interval> intervals_;  // the last five minutes, oldest first
  HeartState state_;
  double spectrum_due_s_ = 0.0;
};

}  // namespace neritic::diver
