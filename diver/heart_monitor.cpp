#include "diver/heart_monitor.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <type_traits>

#include "engine/core/check.hpp"

namespace neritic::diver {
namespace {

constexpr double kIntervalMemory_s = 300.0;
// At five beats a second there are 1500 in that time.
constexpr std::size_t kMostIntervals = 1600;
constexpr double kSpectrumEvery_s = 10.0;
// After so long without a beat a rate is no rate of now.
constexpr double kStale_s = 5.0;
constexpr double kLeastRr_s = 0.2, kMostRr_s = 3.0;
constexpr double kMostSkip_s = 3600.0;
// More ride over a missed beat, fewer follow an effort sooner (`tradeoff physiology`).
constexpr int kRateOver = 4;
// Energy of beats over that of noise; below, Pan's thresholds lie in the noise.
constexpr double kPoorBelow = 4.0;
// Noise has peaks as well, which Pan's levels part into beats and noise: but it is flat (4.2 at
// most in an hour of white noise), and its peaks keep no time. A heart that is as flat beats so
// fast that the band has no pause, and keeps time.
constexpr double kFlatBelow = 4.5, kLeastNormal = 0.75;
constexpr int kFewestIntervals = 8, kJudgedIntervals = 16;
// Where not even half of the last intervals keep time there is no rate to tell, be it another
// signal than a heart's (breath, gaze) or a heart that flutters; and of a few beats nothing is
// known.
constexpr double kNoTime = 0.5;
constexpr int kTooFewIntervals = 5;
constexpr double kMostOtherWay = 0.25;  // of beats, as extra ones may
// The share among the samples of the last seconds.
constexpr double kMissing_s = 4.0, kMostMissing = 0.25;

static_assert(std::is_trivially_copyable_v<HeartState>);

}  // namespace

const char* name_of(SignalQuality quality) {
  switch (quality) {
    case SignalQuality::kNone:
      return "none";
    case SignalQuality::kLearning:
      return "learning";
    case SignalQuality::kPoor:
      return "poor";
    case SignalQuality::kGood:
      return "good";
  }
  return "";
}

HeartMonitor::HeartMonitor(double rate_hz) : detector_(rate_hz), rate_hz_(rate_hz) {
  intervals_.reserve(kMostIntervals);
}

void HeartMonitor::push(std::span<const double> samples) {
  push_at(samples, 0.0);
}

void HeartMonitor::push(std::span<const double> samples, double lasts_s) {
  if (samples.empty()) return;
  const double longer = lasts_s * rate_hz_ / static_cast<double>(samples.size()) - 1.0;
  NERITIC_CHECK(std::abs(longer) <= kMostStretch, "{} samples in {} s", samples.size(), lasts_s);
  push_at(samples, longer);
}

// longer: by this share of 1 / rate_hz_ each sample lasts longer than that.
void HeartMonitor::push_at(std::span<const double> samples, double longer) {
  NERITIC_CHECK(detector_.has_value(), "a monitor of intervals has no ECG");
  for (const double sample : samples) {
    shift_s_ += longer / rate_hz_;
    found_.clear();
    const std::uint64_t refused = detector_->counts().refused;
    detector_->push(sample, found_);
    const double missed = detector_->counts().refused > refused ? 1.0 : 0.0;
    missing_share_ += (missed - missing_share_) / (kMissing_s * rate_hz_);
    const double now_s = static_cast<double>(detector_->counts().samples) / rate_hz_;
    for (Beat& beat : found_) {
      // It lies some samples back.
      beat.time_s += shift_s_ - longer * (now_s - beat.time_s);
      downward_ = downward_ << 1 | (beat.amplitude < 0.0 ? 1u : 0u);
      Interval interval = judge_.take(beat);
      interval.doubtful = judged() == SignalQuality::kPoor;
      take(interval);
    }
  }
  const EcgCounts& counts = detector_->counts();
  state_.time_s = static_cast<double>(counts.samples) / rate_hz_ + shift_s_;
  state_.refused = counts.refused;
  state_.gaps = counts.gaps;
  state_.quality = judged();
  forget();
}

SignalQuality HeartMonitor::judged() const {
  using enum SignalQuality;
  const EcgCounts& counts = detector_->counts();
  const Timekeeping beats = timekeeping();
  const bool noise =
      detector_->peakedness() < kFlatBelow &&
      (beats.judged < kFewestIntervals || beats.normal < kLeastNormal * beats.judged);
  if (counts.samples == counts.refused || detector_->flat()) return kNone;
  if (detector_->learning()) return kLearning;
  if (detector_->signal_over_noise() < kPoorBelow || missing_share_ > kMostMissing || noise)
    return kPoor;
  if (beats.judged < kTooFewIntervals) return kLearning;
  return beats.normal < kNoTime * beats.judged || both_ways(beats.judged) ? kPoor : kGood;
}

// A heart's beats all point up, or all down; what goes both ways is an eye, a limb, a wave.
bool HeartMonitor::both_ways(int of) const {
  const int down = std::popcount(downward_ & ((std::uint64_t{1} << of) - 1));
  return std::min(down, of - down) > kMostOtherWay * of;
}

HeartMonitor::Timekeeping HeartMonitor::timekeeping() const {
  Timekeeping out;
  for (auto i = intervals_.rbegin(); i != intervals_.rend() && out.judged < kJudgedIntervals; ++i) {
    ++out.judged;
    out.normal += i->kind == IntervalKind::kNormal;
  }
  return out;
}

void HeartMonitor::push_interval(double length_s) {
  NERITIC_CHECK(!detector_.has_value(), "a monitor of an ECG finds intervals itself");
  if (!(length_s >= kLeastRr_s && length_s <= kMostRr_s)) {
    ++state_.refused;
    ++state_.gaps;
    take({state_.time_s, 0.0, IntervalKind::kNone});
    return;
  }
  state_.time_s += length_s;
  take(judge_.take_interval(state_.time_s, length_s));
  state_.quality = SignalQuality::kGood;
  forget();
}

void HeartMonitor::skip(double seconds) {
  if (!(seconds > 0.0 && seconds <= kMostSkip_s)) {
    ++state_.refused;
    return;
  }
  if (detector_) {
    // Lost samples count as samples that are no numbers.
    const double missing[] = {std::nan("")};
    const auto count = static_cast<std::uint64_t>(std::ceil(seconds * rate_hz_));
    for (std::uint64_t i = 0; i < count; ++i) push(missing);
    // The last one lasts as long as is left.
    const double less_s = static_cast<double>(count) / rate_hz_ - seconds;
    shift_s_ -= less_s, state_.time_s -= less_s;
    return;
  }
  ++state_.gaps;
  state_.time_s += seconds;
  take({state_.time_s, 0.0, IntervalKind::kNone});
  state_.quality = SignalQuality::kNone;
  forget();
}

double HeartMonitor::doubtful_share() const {
  return state_.beats > 0 ? static_cast<double>(doubtful_beats_) / static_cast<double>(state_.beats)
                          : 0.0;
}

// Whether the figures of the intervals in memory are denied.
bool HeartMonitor::doubtful() const {
  const auto count = std::ranges::count(intervals_, true, &Interval::doubtful);
  return state_.quality == SignalQuality::kPoor ||
         static_cast<double>(count) > kMostDoubtful * static_cast<double>(intervals_.size());
}

void HeartMonitor::take(const Interval& interval) {
  if (intervals_.size() == kMostIntervals) intervals_.erase(intervals_.begin());
  intervals_.push_back(interval);
  state_.ectopic += static_cast<std::uint64_t>(judge_.settle(intervals_));
  if (interval.kind != IntervalKind::kNone || detector_) {
    ++state_.beats;
    state_.last_beat_s = interval.end_s;
  }
  state_.ectopic += interval.kind == IntervalKind::kEctopic;
  doubtful_beats_ += interval.doubtful;
}

// Drops what is older than five minutes, and works the figures out anew where there is something
// new.
void HeartMonitor::forget() {
  const auto old = std::ranges::find_if(
      intervals_, [&](const Interval& i) { return i.end_s >= state_.time_s - kIntervalMemory_s; });
  intervals_.erase(intervals_.begin(), old);
  if (state_.time_s < spectrum_due_s_) return;
  spectrum_due_s_ = state_.time_s + kSpectrumEvery_s;
  state_.spectrum = heart_spectrum(intervals_);
}

HeartState HeartMonitor::state() const {
  HeartState state = state_;
  const Variability figures = variability(intervals_);
  if (doubtful() || noise_hides(intervals_, figures))
    state.spectrum = {};
  else
    state.over_five_minutes = figures;
  std::vector<double> last_s;
  for (auto i = intervals_.rbegin(); i != intervals_.rend() && last_s.size() < kRateOver; ++i) {
    if (i->kind == IntervalKind::kNone) break;  // what lies before a gap is old
    if (i->kind == IntervalKind::kNormal) last_s.push_back(i->length_s);
  }
  if (last_s.empty() || state.time_s - state.last_beat_s > kStale_s ||
      state.quality == SignalQuality::kPoor) {
    state.rate_bpm = 0.0;
    return state;
  }
  std::ranges::sort(last_s);
  const std::size_t half = last_s.size() / 2;
  const double median_s =
      last_s.size() % 2 == 1 ? last_s[half] : 0.5 * (last_s[half - 1] + last_s[half]);
  state.rate_bpm = 60.0 / median_s;
  return state;
}

}  // namespace neritic::diver
