#include "diver/heart_detector.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>

#include "diver/heart_filter.hpp"
#include "engine/core/check.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// More places a second say nothing new about a band of 5 to 15 Hz; faster ECG is averaged down.
constexpr double kMostPlaces_hz = 500.0;
constexpr double kWindow_s = 0.150, kRefractory_s = 0.200, kGuard_s = 0.100, kTWave_s = 0.360;
constexpr double kLearn_s = 2.0, kMemory_s = 8.0, kLookBack = 1.66;
// Between two beats so near (100 a minute) a peak of noise has hardly room: their windows and
// guards take most of it.
constexpr double kNoRoom_s = 0.6;
// Half a second of missing samples is no jitter of a radio any more.
constexpr double kLost_s = 0.5;
// The heart stops for no longer (30 beats a minute are 2 s): the levels are wrong, as after a
// spike.
constexpr double kWithoutBeat_s = 4.0;
// The rounding error of a constant, relative to its size.
constexpr double kRounding = 1e-9;
// No ECG is larger, in any unit; its square stays finite.
constexpr double kMostEcg = 1e12;
constexpr double kLeastInterval_s = 0.2, kMostInterval_s = 2.5;
// The round part of an R wave to either side of its top: its deviation as a Gaussian is 8 to 12 ms.
constexpr double kRoundTop_s = 0.012;
// By where a top lies between places, its time errs by so many places (0.02 to 0.055 measured).
constexpr double kBetweenPlaces = 0.05;
// A step of kLeap times the usual one of a second comes from an electrode or a switch, not from a
// beat (an extra beat is about three times as steep as others), unless it lasts longer than
// kLongestLeap_s, a tenth of a QRS complex.
constexpr double kLeap = 10.0, kLongestLeap_s = 0.008;
// A second's step is the largest but for those of a few samples that leapt in and out, fewer than a
// QRS complex has; what is usual falls by no more a second.
constexpr double kPassedOver_s = 0.016, kFallsTo = 0.8;
// Usual: what three of eight seconds have, so that neither a few leaps nor a slow heart count.
constexpr std::ptrdiff_t kUsualOf = 2;

}  // namespace

Status check_ecg_rate(double rate_hz) {
  if (rate_hz >= kLeastEcgRate_hz && rate_hz <= kMostEcgRate_hz) return {};
  return refusal("ECG", fmt::format("a rate of {:g} Hz", rate_hz),
                 fmt::format("{:g} to {:g}", kLeastEcgRate_hz, kMostEcgRate_hz));
}

BeatDetector::BeatDetector(double rate_hz) : rate_hz_(rate_hz) {
  NERITIC_CHECK(check_ecg_rate(rate_hz).ok(), "{} Hz", rate_hz);
  decimation_ = std::max(1, static_cast<int>(std::ceil(rate_hz / kMostPlaces_hz)));
  place_hz_ = rate_hz / decimation_;
  taps_ = qrs_band_taps(place_hz_);
  const auto places = [&](double s) { return static_cast<int>(std::lround(s * place_hz_)); };
  half_taps_ = static_cast<int>(taps_.size() / 2);
  half_window_ = places(kWindow_s / 2.0);
  guard_ = places(kGuard_s);
  refractory_ = places(kRefractory_s);
  const std::size_t size = std::bit_ceil(static_cast<std::size_t>(places(kMemory_s)));
  mask_ = size - 1;
  ring_.resize(size);
}

// The largest steps of this second, the largest first.
void BeatDetector::count_step(double step) {
  const auto at = std::ranges::find_if(largest_steps_, [&](double s) { return step > s; });
  if (at == largest_steps_.end()) return;
  std::ranges::move_backward(at, largest_steps_.end() - 1, largest_steps_.end());
  *at = step;
}

// Whether a sample is so far from the last good one that no heart can have made it; what stays
// there for longer than a leap is as the signal is now. Beats after a rest begin gently: each step
// that is taken for the signal's makes ten times as much usual.
bool BeatDetector::leaps(double value) {
  if (!has_value_) return false;
  const double step = std::abs(value - held_);
  count_step(step);
  if (++stepped_ >= rate_hz_) {
    std::ranges::move_backward(second_steps_.begin(), second_steps_.end() - 1, second_steps_.end());
    const auto over = static_cast<std::size_t>(kPassedOver_s * rate_hz_);
    second_steps_.front() = largest_steps_[std::min(over, largest_steps_.size() - 1)];
    largest_steps_ = {};
    stepped_ = 0.0;
    auto sorted = second_steps_;
    std::ranges::nth_element(sorted, sorted.begin() + kUsualOf, std::greater());
    const bool known = second_steps_.back() > 0.0;  // all eight seconds
    usual_step_ = known ? std::max(sorted[kUsualOf], kFallsTo * usual_step_) : 0.0;
  }
  const bool far = usual_step_ > 0.0 && step > kLeap * usual_step_;
  leapt_ = far ? leapt_ + 1.0 : 0.0;
  if (far && leapt_ <= std::max(1.0, kLongestLeap_s * rate_hz_)) return true;
  leapt_ = 0.0;
  if (usual_step_ > 0.0) usual_step_ = std::max(usual_step_, step);
  return false;
}

void BeatDetector::push(double value, std::vector<Beat>& out) {
  ++counts_.samples;
  const bool number = std::abs(value) <= kMostEcg, leap = number && leaps(value);
  if (!number || leap) {
    ++counts_.refused;
    counts_.leaps += leap ? 1 : 0;
    ++missing_in_a_row_;
    value = held_;
  } else {
    if (static_cast<double>(missing_in_a_row_) > kLost_s * rate_hz_) lose_signal();
    missing_in_a_row_ = 0;
    // The signal before the first sample, or during a loss, counts as equal to this one: no step.
    if (!has_value_)
      for (Place& p : ring_) p = {value};
    has_value_ = true;
    held_ = value;
  }
  block_sum_ += value;
  if (++block_count_ < decimation_) return;
  const double mean = block_sum_ / decimation_;
  block_sum_ = 0.0;
  block_count_ = 0;
  take(mean, out);
}

void BeatDetector::take(double value, std::vector<Beat>& out) {
  place(++newest_) = {value};
  filter();
  // A place is settled once the largest energy around it is known.
  const std::int64_t known = newest_ - half_taps_ - 2 - half_window_ - guard_;
  while (settled_ < known) settle(++settled_, out);
}

// Band, slope and energy of the newest places that have all they need.
void BeatDetector::filter() {
  const std::int64_t b = newest_ - half_taps_;
  double sum = 0.0;
  for (int i = 0; i < static_cast<int>(taps_.size()); ++i)
    sum += taps_[static_cast<std::size_t>(i)] * place(b - half_taps_ + i).raw;
  place(b).band = sum;
  // Five points: (-x[-2] - 2 x[-1] + 2 x[1] + x[2]) / 8T (Pan and Tompkins 1985, eq. 7).
  const std::int64_t d = b - 2;
  place(d).slope =
      0.125 * place_hz_ *
      (place(d + 2).band + 2.0 * place(d + 1).band - 2.0 * place(d - 1).band - place(d - 2).band);
  const std::int64_t e = d - half_window_;
  double energy = 0.0;
  for (std::int64_t i = e - half_window_; i <= e + half_window_; ++i)
    energy += place(i).slope * place(i).slope;
  place(e).energy = energy / (2 * half_window_ + 1);
}

bool BeatDetector::is_peak(std::int64_t at) const {
  const double here = place(at).energy;
  double largest = 0.0;
  for (std::int64_t i = at - half_window_; i <= at + half_window_; ++i)
    largest = std::max(largest, std::abs(place(i).raw));
  const double rounding = kRounding * largest * place_hz_;
  if (!(here > rounding * rounding)) return false;
  for (std::int64_t i = std::max(at - guard_, fresh_); i <= at + guard_; ++i)
    if (i < at ? place(i).energy >= here : place(i).energy > here) return false;
  return true;
}

void BeatDetector::learn(std::int64_t from, std::int64_t to) {
  double most = 0.0, sum = 0.0;
  for (std::int64_t i = from; i < to; ++i) {
    most = std::max(most, place(i).energy);
    sum += place(i).energy;
  }
  // A third of the largest and half the mean, as is usual for the first two seconds.
  signal_level_ = most / 3.0;
  noise_level_ = 0.5 * sum / static_cast<double>(std::max<std::int64_t>(to - from, 1));
  learnt_ = most > 0.0;
  last_look_ = to;
  passed_count_ = 0;
  noise_heard_ = false;
}

void BeatDetector::settle(std::int64_t at, std::vector<Beat>& out) {
  if (at < fresh_) return;
  if (!learnt_) {
    const auto needed = static_cast<std::int64_t>(kLearn_s * place_hz_);
    if (at - fresh_ + 1 < needed) return;
    const std::int64_t from = at - needed + 1;
    learn(from, at + 1);
    if (!learnt_) return;
    last_look_ = from;
    for (std::int64_t i = from; i < at; ++i)
      if (is_peak(i)) judge({i, place(i).energy, place(i).slope}, out);
  }
  if (is_peak(at)) judge({at, place(at).energy, 0.0}, out);
  look_back(at, out);
  if (static_cast<double>(at - last_look_) > kWithoutBeat_s * place_hz_) {
    ++counts_.relearned;
    after_gap_ = true;
    last_beat_.reset();
    interval_count_ = 0;
    learn(at - static_cast<std::int64_t>(kLearn_s * place_hz_), at);
  }
}

void BeatDetector::judge(const Peak& found, std::vector<Beat>& out) {
  Peak peak = found;
  peak.slope = 0.0;
  for (std::int64_t i = peak.at - half_window_; i <= peak.at + half_window_; ++i)
    peak.slope = std::max(peak.slope, std::abs(place(i).slope));
  const std::int64_t since = last_beat_ ? peak.at - last_beat_->at : refractory_;
  if (since < refractory_) return;
  // A T wave is gentler than the QRS complex before.
  const bool t_wave = last_beat_ && static_cast<double>(since) < kTWave_s * place_hz_ &&
                      peak.slope < 0.5 * last_beat_->slope;
  if (peak.energy > threshold() && !t_wave) return accept(peak, 0.125, out);
  noise_level_ = 0.125 * peak.energy + 0.875 * noise_level_;
  noise_heard_ = true;
  if (t_wave) return;
  if (passed_count_ == static_cast<int>(passed_.size())) {
    std::ranges::move(passed_.begin() + 1, passed_.end(), passed_.begin());
    --passed_count_;
  }
  passed_[static_cast<std::size_t>(passed_count_++)] = peak;
}

void BeatDetector::look_back(std::int64_t at, std::vector<Beat>& out) {
  const double mean = mean_interval();
  if (mean <= 0.0 || !last_beat_ || static_cast<double>(at - last_beat_->at) < kLookBack * mean)
    return;
  const Peak* best = nullptr;
  for (int i = 0; i < passed_count_; ++i) {
    const Peak& p = passed_[static_cast<std::size_t>(i)];
    if (p.energy > 0.5 * threshold() && (!best || p.energy > best->energy)) best = &p;
  }
  if (best) accept(*best, 0.25, out);
}

double BeatDetector::quietest_since_last_beat(std::int64_t at) const {
  double least = place(at).energy;
  for (std::int64_t i = std::max(last_beat_->at, at - static_cast<std::int64_t>(mask_)); i < at;
       ++i)
    least = std::min(least, place(i).energy);
  return least;
}

double BeatDetector::mean_interval() const {
  double sum = 0.0;
  for (int i = 0; i < interval_count_; ++i) sum += intervals_[static_cast<std::size_t>(i)];
  return interval_count_ > 0 ? sum / interval_count_ : 0.0;
}

double BeatDetector::band_kurtosis() const {
  const auto memory = static_cast<std::int64_t>(kMemory_s * place_hz_) - 1;
  const std::int64_t end = newest_ - half_taps_, from = std::max(fresh_, newest_ - memory);
  double sum2 = 0.0, sum4 = 0.0;  // the band has no mean
  for (std::int64_t i = from; i <= end; ++i) {
    const double square = place(i).band * place(i).band;
    sum2 += square;
    sum4 += square * square;
  }
  return sum2 > 0.0 ? sum4 / (sum2 * sum2) * static_cast<double>(end - from + 1) : 0.0;
}

void BeatDetector::accept(const Peak& found, double share, std::vector<Beat>& out) {
  const Peak peak = found;  // which may lie among those that are dropped here
  signal_level_ = share * peak.energy + (1.0 - share) * signal_level_;
  if (last_beat_) {
    // Beats that follow each other closely leave no room for a peak of noise: the noise is then
    // what is left between them.
    if (!noise_heard_ && static_cast<double>(peak.at - last_beat_->at) < kNoRoom_s * place_hz_)
      noise_level_ = 0.125 * quietest_since_last_beat(peak.at) + 0.875 * noise_level_;
    const double interval = static_cast<double>(peak.at - last_beat_->at);
    if (interval > kLeastInterval_s * place_hz_ && interval < kMostInterval_s * place_hz_) {
      if (interval_count_ == static_cast<int>(intervals_.size()))
        std::ranges::move(intervals_.begin() + 1, intervals_.end(), intervals_.begin());
      else
        ++interval_count_;
      intervals_[static_cast<std::size_t>(interval_count_ - 1)] = interval;
    }
  }
  int kept = 0;
  for (int i = 0; i < passed_count_; ++i)
    if (passed_[static_cast<std::size_t>(i)].at - peak.at >= refractory_)
      passed_[static_cast<std::size_t>(kept++)] = passed_[static_cast<std::size_t>(i)];
  passed_count_ = kept;
  last_beat_ = peak;
  noise_heard_ = false;
  last_look_ = peak.at;
  peakedness_ = band_kurtosis();
  out.push_back(locate(peak));
  after_gap_ = false;
}

// The R wave: where the band is largest, then the nearest top of the ECG itself, between samples by
// a parabola.
Beat BeatDetector::locate(const Peak& peak) const {
  const auto largest = [&](std::int64_t from, std::int64_t to, const auto& value) {
    std::int64_t best = from;
    for (std::int64_t i = from; i <= to; ++i)
      if (value(i) > value(best)) best = i;
    return best;
  };
  const std::int64_t low = std::max<std::int64_t>(peak.at - half_window_, 0);
  const std::int64_t near =
      largest(low, peak.at + half_window_, [&](std::int64_t i) { return std::abs(place(i).band); });
  const double sign = place(near).band < 0.0 ? -1.0 : 1.0;
  const auto reach = std::max<std::int64_t>(1, std::lround(0.025 * place_hz_));
  // A single sample of a noisy wave may be the largest far from its top.
  // Below 84 places a second the samples beside it lie outside of its top.
  const auto half = static_cast<std::int64_t>(kRoundTop_s * place_hz_);
  const std::int64_t top = largest(std::max(near - reach, half), near + reach, [&](std::int64_t i) {
    double sum = 0.0;
    for (std::int64_t x = -half; x <= half; ++x) sum += sign * place(i + x).raw;
    return sum;
  });
  const Vertex vertex = vertex_near(top, near, reach, sign);
  double mean = 0.0;
  for (std::int64_t i = top - guard_; i <= top + guard_; ++i) mean += place(i).raw;
  mean /= 2 * guard_ + 1;
  // A place is the mean of its samples: its time is their middle.
  const double samples = vertex.at * decimation_ + 0.5 * (decimation_ - 1);
  const double largest_near =
      sign * place(largest(std::max<std::int64_t>(top - half, 0), top + half, [&](std::int64_t i) {
               return sign * place(i).raw;
             })).raw;
  return {samples / rate_hz_, sign * largest_near - mean, after_gap_, vertex.jitter / place_hz_};
}

std::int64_t BeatDetector::half_top() const {
  return std::max<std::int64_t>(1, std::lround(kRoundTop_s * place_hz_));
}

// The top of the R wave by the parabola of least squares through its middle, which is moved to that
// top until it stays: single samples near a round top tell little of where it is. White noise of
// deviation s moves the top of a x^2 + b x + c by s / (2 |a| sqrt(sum of x^2)).
// No more than the reach, within which the largest sample was looked for.
BeatDetector::Vertex BeatDetector::vertex_near(std::int64_t top, std::int64_t near,
                                               std::int64_t reach, double sign) const {
  constexpr int kMostMoves = 4;
  const std::int64_t half = half_top();
  double squares = 0.0, fourths = 0.0;
  for (std::int64_t x = 1; x <= half; ++x) {
    squares += 2.0 * static_cast<double>(x * x);
    fourths += 2.0 * static_cast<double>(x * x * x * x);
  }
  const auto count = static_cast<double>(2 * half + 1);
  const auto most = static_cast<double>(reach);
  Vertex out{static_cast<double>(top), most};
  const double noise = noise_around(top);
  std::int64_t middle = top;
  for (int moves = 0; moves < kMostMoves; ++moves) {
    double sum = 0.0, slope = 0.0, second = 0.0;
    for (std::int64_t x = -half; x <= half; ++x) {
      const double y = place(std::max<std::int64_t>(middle + x, 0)).raw - place(middle).raw;
      sum += y;
      slope += static_cast<double>(x) * y / squares;
      second += static_cast<double>(x * x) * y;
    }
    const double bend = (second - squares / count * sum) / (fourths - squares * squares / count);
    if (!(bend * sign < 0.0)) return out;
    const double shift = -0.5 * slope / bend;
    out.at = static_cast<double>(middle) + std::clamp(shift, -0.5, 0.5);
    out.jitter = std::min(
        std::hypot(noise / (2.0 * std::abs(bend) * std::sqrt(squares)), kBetweenPlaces), most);
    const std::int64_t next = middle + std::clamp<std::int64_t>(std::lround(shift), -half, half);
    if (std::abs(shift) <= 0.5 || std::abs(next - near) > reach) return out;
    middle = next;
  }
  return out;
}

// The deviation of white noise, by the median of the second difference's size over the second
// before: a heart's waves are slow but for the QRS complex, which lasts a tenth of it.
double BeatDetector::noise_around(std::int64_t at) const {
  constexpr double kMedianOfNormal = 0.6744897501960817;
  std::vector<double> sizes;
  const auto from =
      std::max({fresh_ + 1, at - static_cast<std::int64_t>(place_hz_), std::int64_t{1}});
  for (std::int64_t i = from; i < at; ++i)
    sizes.push_back(std::abs(place(i - 1).raw - 2.0 * place(i).raw + place(i + 1).raw));
  if (sizes.empty()) return 0.0;
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::ranges::nth_element(sizes, middle);
  return *middle / (kMedianOfNormal * std::sqrt(6.0));
}

void BeatDetector::lose_signal() {
  ++counts_.gaps;
  // Settles what is known, then learns everything anew.
  has_value_ = false;
  learnt_ = false;
  after_gap_ = true;
  last_beat_.reset();
  interval_count_ = 0;
  passed_count_ = 0;
  fresh_ = newest_ + 1;
}

void BeatDetector::finish(std::vector<Beat>& out) {
  if (newest_ < 0) return;
  const std::int64_t end = newest_;
  const double last = place(end).raw;
  const int more = half_taps_ + 2 + half_window_ + guard_;
  for (int i = 0; i < more; ++i) take(last, out);
  if (learnt_ || end < fresh_) return;
  // Shorter than it takes to learn: the levels of what there is.
  learn(fresh_, end + 1);
  last_look_ = fresh_;
  for (std::int64_t i = fresh_; learnt_ && i <= end; ++i)
    if (is_peak(i)) judge({i, place(i).energy, 0.0}, out);
}

bool BeatDetector::flat() const {
  const auto span = static_cast<std::int64_t>(kLearn_s * place_hz_);
  if (newest_ < span) return false;
  double low = place(newest_).raw, high = low;
  for (std::int64_t i = newest_ - span + 1; i <= newest_; ++i) {
    low = std::min(low, place(i).raw);
    high = std::max(high, place(i).raw);
  }
  return high - low <= kRounding * std::max(std::abs(low), std::abs(high));
}

double BeatDetector::signal_over_noise() const {
  if (!learnt_ || signal_level_ <= 0.0) return 0.0;
  return noise_level_ > 0.0 ? std::min(signal_level_ / noise_level_, 1e6) : 1e6;
}

std::vector<Beat> find_beats(double rate_hz, const std::vector<double>& samples,
                             EcgCounts* counts) {
  BeatDetector detector(rate_hz);
  std::vector<Beat> beats;
  for (const double sample : samples) detector.push(sample, beats);
  detector.finish(beats);
  if (counts) *counts = detector.counts();
  return beats;
}

}  // namespace neritic::diver
