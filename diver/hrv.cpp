#include "diver/hrv.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::diver {
namespace {

constexpr double kNn50_ms = 50.0;
// So many odd intervals in a row are no extra beats: the rhythm has changed.
constexpr int kNewRhythm = 5;
// The least intervals that have a median worth the name.
constexpr int kKnown = 3;
constexpr double kPiece_s = 300.0, kLeastPiece_s = 120.0;
constexpr double kVlf_hz = 0.0033, kLf_hz = 0.04, kHf_hz = 0.15, kEnd_hz = 0.4;
// Frequencies to the resolution 1 / T of a piece.
constexpr double kOversampling = 4.0;

double deviation(const std::vector<double>& values) {
  if (values.size() < 2) return 0.0;
  double mean = 0.0, squares = 0.0;
  for (const double v : values) mean += v / static_cast<double>(values.size());
  for (const double v : values) squares += (v - mean) * (v - mean);
  return std::sqrt(squares / static_cast<double>(values.size() - 1));
}

// Adds the power of one piece. Angles are turned on by one step a frequency, not computed anew.
void add_lomb(std::span<const Interval> normal, HeartSpectrum& sum) {
  const std::size_t n = normal.size();
  const double span_s = normal.back().end_s - normal.front().end_s;
  const double step_hz = 1.0 / (kOversampling * span_s);
  double mean_ms = 0.0;
  for (const Interval& i : normal) mean_ms += 1e3 * i.length_s / static_cast<double>(n);
  struct Turn {
    double value_ms, c, s, step_c, step_s;
  };
  std::vector<Turn> turns;
  for (const Interval& i : normal) {
    const double t = i.end_s - normal.front().end_s;
    const double start = 2.0 * kPi * kVlf_hz * t, step = 2.0 * kPi * step_hz * t;
    turns.push_back({1e3 * i.length_s - mean_ms, std::cos(start), std::sin(start), std::cos(step),
                     std::sin(step)});
  }
  // Unnormalised power times 2 T / N is a density: its integral over a line of amplitude A is
  // A^2/2.
  const double scale = 2.0 * span_s / static_cast<double>(n) * step_hz;
  for (double hz = kVlf_hz; hz < kEnd_hz; hz += step_hz) {
    double yc = 0.0, ys = 0.0, cc = 0.0, cs = 0.0;
    for (Turn& t : turns) {
      yc += t.value_ms * t.c;
      ys += t.value_ms * t.s;
      cc += t.c * t.c;
      cs += t.c * t.s;
      const double c = t.c * t.step_c - t.s * t.step_s;
      t.s = t.s * t.step_c + t.c * t.step_s;
      t.c = c;
    }
    const double ss = static_cast<double>(n) - cc;
    // The delay tau that makes cosines and sines orthogonal (Scargle 1982, eq. 10, appendix B).
    const double angle = 0.5 * std::atan2(2.0 * cs, cc - ss);
    const double c = std::cos(angle), s = std::sin(angle);
    const double along = yc * c + ys * s, across = ys * c - yc * s;
    const double cc_turned = cc * c * c + 2.0 * cs * c * s + ss * s * s;
    const double ss_turned = static_cast<double>(n) - cc_turned;
    double power = 0.0;
    if (cc_turned > 1e-9) power += 0.5 * along * along / cc_turned;
    if (ss_turned > 1e-9) power += 0.5 * across * across / ss_turned;
    (hz < kLf_hz ? sum.vlf_ms2 : hz < kHf_hz ? sum.lf_ms2 : sum.hf_ms2) += scale * power;
  }
}

}  // namespace

IntervalKind IntervalJudge::kind_of(double length_s) {
  const auto remember = [&] {
    if (normal_count_ == static_cast<int>(normal_s_.size()))
      std::ranges::move(normal_s_.begin() + 1, normal_s_.end(), normal_s_.begin());
    else
      ++normal_count_;
    normal_s_[static_cast<std::size_t>(normal_count_ - 1)] = length_s;
    odd_in_a_row_ = 0;
    after_ectopic_ = false;
    return IntervalKind::kNormal;
  };
  settles_ = normal_count_ == kKnown - 1;
  if (normal_count_ < kKnown) return remember();
  auto sorted = normal_s_;
  const auto middle = sorted.begin() + normal_count_ / 2;
  std::nth_element(sorted.begin(), middle, sorted.begin() + normal_count_);
  const double usual_s = *middle;
  if (std::abs(length_s - usual_s) <= kEctopicShare * usual_s) {
    // The interval after an ectopic beat begins with that beat, so it is no NN interval.
    if (after_ectopic_) {
      after_ectopic_ = false;
      odd_in_a_row_ = 0;
      return IntervalKind::kAfter;
    }
    return remember();
  }
  if (++odd_in_a_row_ >= kNewRhythm) {
    normal_count_ = 0;
    return remember();
  }
  if (after_ectopic_ && length_s > usual_s) {
    after_ectopic_ = false;
    return IntervalKind::kAfter;
  }
  after_ectopic_ = length_s < usual_s;
  return IntervalKind::kEctopic;
}

// An R wave less than half as high as usual is noise that was taken for it: the wave itself may be
// anywhere in the detector's window of 150 ms.
double IntervalJudge::jitter_of(const Beat& beat) {
  constexpr double kNoise = 0.5, kAnywhere_s = 0.150 / 3.4641016151377544;  // sqrt(12)
  const double size = std::abs(beat.amplitude);
  auto sorted = sizes_;
  const auto middle = sorted.begin() + size_count_ / 2;
  std::nth_element(sorted.begin(), middle, sorted.begin() + size_count_);
  const bool small = size_count_ == static_cast<int>(sizes_.size()) && size < kNoise * *middle;
  if (size_count_ == static_cast<int>(sizes_.size()))
    std::ranges::move(sizes_.begin() + 1, sizes_.end(), sizes_.begin());
  else
    ++size_count_;
  sizes_[static_cast<std::size_t>(size_count_ - 1)] = size;
  return small ? std::max(kAnywhere_s, beat.jitter_s) : beat.jitter_s;
}

int IntervalJudge::settle(std::span<Interval> intervals) {
  if (!settles_) return 0;
  settles_ = false;
  std::array<Interval*, kKnown> first{};
  int found = 0;
  for (auto i = intervals.rbegin(); i != intervals.rend() && found < kKnown; ++i)
    if (i->kind == IntervalKind::kNormal) first[static_cast<std::size_t>(found++)] = &*i;
  if (found < kKnown) return 0;
  std::ranges::sort(first, {}, [](const Interval* i) { return i->length_s; });
  const double usual_s = first[kKnown / 2]->length_s;
  int changed = 0;
  for (Interval* i : first)
    if (std::abs(i->length_s - usual_s) > kEctopicShare * usual_s) {
      i->kind = IntervalKind::kEctopic;
      ++changed;
    }
  return changed;
}

Interval IntervalJudge::take(const Beat& beat) {
  const double length_s = beat.time_s - last_s_, jitter_s = jitter_of(beat);
  const bool none = !has_last_ || beat.after_gap || !(length_s > 0.0);
  const double both_s = std::hypot(jitter_s, last_jitter_s_);
  last_s_ = beat.time_s;
  last_jitter_s_ = jitter_s;
  has_last_ = true;
  if (!none)
    return {
        .end_s = beat.time_s, .length_s = length_s, .kind = kind_of(length_s), .jitter_s = both_s};
  after_ectopic_ = false;
  return {.end_s = beat.time_s};
}

Interval IntervalJudge::take_interval(double end_s, double length_s) {
  last_s_ = end_s;
  has_last_ = true;
  return {end_s, length_s, kind_of(length_s)};
}

std::vector<Interval> intervals_of(std::span<const Beat> beats) {
  IntervalJudge judge;
  std::vector<Interval> out;
  for (const Beat& beat : beats) {
    out.push_back(judge.take(beat));
    judge.settle(out);
  }
  return out;
}

Variability variability(std::span<const Interval> intervals, bool across_gaps) {
  std::vector<double> lengths, differences, sums;
  const Interval* last = nullptr;
  for (const Interval& i : intervals) {
    if (i.kind != IntervalKind::kNormal) {
      if (!across_gaps) last = nullptr;
      continue;
    }
    lengths.push_back(1e3 * i.length_s);
    if (last) {
      differences.push_back(1e3 * (i.length_s - last->length_s));
      sums.push_back(1e3 * (i.length_s + last->length_s));
    }
    last = &i;
  }
  Variability out;
  out.intervals = std::ssize(lengths);
  out.pairs = std::ssize(differences);
  if (lengths.empty()) return out;
  for (const double l : lengths) out.mean_rr_ms += l / static_cast<double>(lengths.size());
  out.mean_rate_bpm = 60e3 / out.mean_rr_ms;
  out.sdnn_ms = deviation(lengths);
  if (differences.empty()) return out;
  double squares = 0.0;
  for (const double d : differences) {
    squares += d * d;
    // Times come in nanoseconds at best: a difference of 50 ms but for rounding is 50 ms.
    out.nn50 += std::abs(d) > kNn50_ms + 1e-6;
  }
  out.rmssd_ms = std::sqrt(squares / out.pairs);
  out.pnn50_percent = 100.0 * out.nn50 / out.pairs;
  out.sd1_ms = deviation(differences) / std::sqrt(2.0);
  out.sd2_ms = deviation(sums) / std::sqrt(2.0);
  return out;
}

double beat_jitter_s(std::span<const Interval> intervals) {
  double squares = 0.0;
  int count = 0;
  for (const Interval& i : intervals) {
    if (i.kind != IntervalKind::kNormal) continue;
    squares += i.jitter_s * i.jitter_s;
    ++count;
  }
  return count > 0 ? std::sqrt(0.5 * squares / count) : 0.0;
}

bool noise_hides(std::span<const Interval> intervals, const Variability& figures) {
  const double jitter_ms = 1e3 * beat_jitter_s(intervals), square = jitter_ms * jitter_ms;
  return 2.0 * square > kMostNoiseShare * figures.sdnn_ms * figures.sdnn_ms ||
         (figures.pairs > 0 &&
          6.0 * square > kMostNoiseShare * figures.rmssd_ms * figures.rmssd_ms);
}

HeartSpectrum heart_spectrum(std::span<const Interval> intervals) {
  std::vector<Interval> normal;
  for (const Interval& i : intervals)
    if (i.kind == IntervalKind::kNormal) normal.push_back(i);
  HeartSpectrum sum;
  if (normal.size() < 2) return sum;
  const double first_s = normal.front().end_s, last_s = normal.back().end_s;
  int pieces = 0;
  for (double from_s = first_s; pieces == 0 || from_s + kPiece_s <= last_s;
       from_s += 0.5 * kPiece_s) {
    const auto before = [](const Interval& i, double t) { return i.end_s < t; };
    const auto begin = std::lower_bound(normal.begin(), normal.end(), from_s, before);
    const auto end = std::lower_bound(begin, normal.end(), from_s + kPiece_s, before);
    const std::span<const Interval> piece(begin, end);
    double covered_s = 0.0;
    for (const Interval& i : piece) covered_s += i.length_s;
    const double wanted_s = std::min(kPiece_s, last_s - from_s);
    if (wanted_s < kLeastPiece_s && pieces == 0) return sum;
    if (covered_s < 0.5 * wanted_s) {
      if (from_s + 0.5 * kPiece_s + kPiece_s > last_s) break;
      continue;
    }
    add_lomb(piece, sum);
    ++pieces;
  }
  if (pieces == 0) return {};
  for (double* power : {&sum.vlf_ms2, &sum.lf_ms2, &sum.hf_ms2}) *power /= pieces;
  sum.lf_over_hf = sum.hf_ms2 > 0.0 ? sum.lf_ms2 / sum.hf_ms2 : 0.0;
  sum.valid = 1;
  return sum;
}

}  // namespace neritic::diver
