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
  double rate_bpm = 0.0;  // by the median of the last four normal intervals; 0: none, or stale
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

class HeartMonitor {
 public:
  // The monitor of an ECG. Precondition: check_ecg_rate(rate_hz).
  explicit HeartMonitor(double rate_hz);
  // The monitor of a strap that sends intervals.
  HeartMonitor() = default;

  void push(std::span<const double> samples);
  // An interval in seconds, oldest first; one outside 0.2 to 3 s is refused and counted,
  // and is a gap.
  void push_interval(double length_s);
  // No contact for so long, at most an hour; any other length is refused and counted.
  void skip(double seconds);

  HeartState state() const;

 private:
  void take(const Interval& interval);
  void forget();
  // Figures of the last intervals.
  struct Timekeeping {
    int judged = 0, normal = 0;
  };
  Timekeeping timekeeping() const;
  bool both_ways(int of) const;

  std::optional<BeatDetector> detector_;
  double rate_hz_ = 0.0;
  double missing_share_ = 0.0;  // of the samples of late
  std::uint64_t downward_ = 0;  // bits of the last beats, the newest lowest
  IntervalJudge judge_;
  std::vector<Beat> found_;          // scratch
  std::vector<Interval> intervals_;  // the last five minutes, oldest first
  HeartState state_;
  double spectrum_due_s_ = 0.0;
};

}  // namespace neritic::diver
