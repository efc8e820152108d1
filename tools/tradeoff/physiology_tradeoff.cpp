#include "tools/tradeoff/physiology_tradeoff.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <map>

#include "diver/breath_monitor.hpp"
#include "diver/heart_score.hpp"
#include "tools/tradeoff/physiology_signals.hpp"

namespace neritic::tools {
namespace {

using diver::BreathEstimator;

constexpr BreathEstimator kBreathEstimators[] = {
    BreathEstimator::kSpectrum, BreathEstimator::kAutocorrelation, BreathEstimator::kMultiBand};
constexpr double kBreathWindows_s[] = {5.0, 10.0, 15.0, 20.0, 30.0, 45.0, 60.0};
constexpr RateOver kRateEstimators[] = {RateOver::kCount, RateOver::kMean, RateOver::kMedian};
constexpr int kRateIntervals[] = {1, 2, 4, 8, 16, 32, 64};
constexpr double kDetectorRates_hz[] = {50.0, 100.0, 130.16, 250.0, 360.0, 500.0, 1000.0, 2000.0};
constexpr double kRightWithin_bpm = 2.0, kDoubledAbove = 1.6;
constexpr double kHop_s = 5.0;
constexpr double kConfidences[] = {0.0, 0.5, 0.8, 0.9, 0.95};
constexpr int kPieceRounds = 8;
// More intervals ride over more missed beats: of errors so much alike the most are chosen.
constexpr double kAsGood = 1.1;
constexpr double kHeartSeconds = 300.0, kHeartRate_hz = 360.0, kSnr_db = 6.0;

// Processor time of this thread: others at work do not count.
double cpu_us() {
  return 1e6 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

// The frames of every sound: bands are cut once for all windows and estimators.
struct FramedSound {
  std::string kind;
  double true_bpm = 0.0;
  diver::BreathBands bands;
  std::vector<diver::BreathFrame> frames;
};

std::vector<FramedSound> frames_of(const std::vector<BreathSound>& sounds) {
  std::vector<FramedSound> out;
  for (const BreathSound& s : sounds) {
    out.push_back({s.kind, s.true_bpm, diver::BreathBands(s.sound.rate_hz), {}});
    for (const double sample : s.sound.samples) out.back().bands.push(sample, out.back().frames);
  }
  return out;
}

BreathPoint measure_breath(const std::vector<FramedSound>& sounds, const std::string& signals,
                           BreathEstimator estimator, double window_s) {
  BreathPoint point{signals, estimator, window_s};
  std::vector<double> sizes;
  const auto window = static_cast<std::size_t>(window_s * diver::kBreathFrames_hz);
  const auto hop = static_cast<std::size_t>(kHop_s * diver::kBreathFrames_hz);
  const double start_us = cpu_us();
  for (const FramedSound& s : sounds)
    for (std::size_t from = 0; from + window <= s.frames.size(); from += hop) {
      ++point.windows;
      const auto estimate =
          diver::estimate_breath(std::span(s.frames).subspan(from, window), s.bands, estimator);
      if (!estimate.breathing) continue;
      sizes.push_back(std::abs(estimate.rate_bpm - s.true_bpm));
      point.answered += 1.0;
      point.right += sizes.back() <= kRightWithin_bpm;
      point.doubled += estimate.rate_bpm > kDoubledAbove * s.true_bpm;
    }
  if (point.windows == 0) return point;
  point.us = (cpu_us() - start_us) / point.windows;
  for (double* share : {&point.answered, &point.right, &point.doubled}) *share /= point.windows;
  std::ranges::sort(sizes);
  if (!sizes.empty()) point.median_bpm = sizes[sizes.size() / 2];
  return point;
}

std::size_t frames_in(double seconds) {
  return static_cast<std::size_t>(seconds * diver::kBreathFrames_hz);
}

BreathCoverage measure_coverage(const std::vector<FramedSound>& sounds, const std::string& signals,
                                double least_confidence) {
  BreathCoverage out{signals, least_confidence};
  const std::size_t window = frames_in(diver::BreathSettings{}.window_s);
  std::vector<double> sizes;
  double windows = 0.0, pieces = 0.0;
  for (const FramedSound& s : sounds) {
    const auto estimate = [&](const std::vector<diver::BreathFrame>& frames, std::size_t from) {
      return diver::estimate_breath(std::span(frames).subspan(from, window), s.bands,
                                    BreathEstimator::kMultiBand, least_confidence);
    };
    for (std::size_t from = 0; from + window <= s.frames.size(); from += frames_in(kHop_s)) {
      ++windows;
      const auto heard = estimate(s.frames, from);
      if (heard.breathing) sizes.push_back(std::abs(heard.rate_bpm - s.true_bpm));
    }
    for (int round = 0; round < kPieceRounds; ++round) {
      const auto frames = in_pieces(s.frames, {13, static_cast<std::uint64_t>(round), 0});
      for (std::size_t from = 0; from + window <= frames.size(); from += window, ++pieces)
        out.without_rhythm += static_cast<double>(estimate(frames, from).breathing);
    }
  }
  if (windows == 0.0) return out;
  out.without_rhythm /= pieces;
  out.answered = static_cast<double>(sizes.size()) / windows;
  out.right = static_cast<double>(
                  std::ranges::count_if(sizes, [](double e) { return e <= kRightWithin_bpm; })) /
              windows;
  std::ranges::sort(sizes);
  if (!sizes.empty()) out.median_bpm = sizes[sizes.size() / 2], out.worst_bpm = sizes.back();
  return out;
}

// The rate by the last n intervals before beat i; 0: too few.
double rate_by(RateOver estimator, const std::vector<diver::Interval>& beats, std::size_t i, int n,
               double& latency_s) {
  std::vector<double> lengths_s;
  std::size_t from = i;
  for (; from > 0 && static_cast<int>(lengths_s.size()) < n; --from) {
    const diver::Interval& one = beats[from];
    if (one.kind == diver::IntervalKind::kNone) return 0.0;
    if (estimator == RateOver::kCount || one.kind == diver::IntervalKind::kNormal)
      lengths_s.push_back(one.length_s);
  }
  if (static_cast<int>(lengths_s.size()) < n) return 0.0;
  latency_s = beats[i].end_s - beats[from].end_s;
  if (estimator == RateOver::kMedian) {
    std::ranges::sort(lengths_s);
    const auto half = static_cast<std::size_t>(n / 2);
    return 60.0 / (n % 2 == 1 ? lengths_s[half] : 0.5 * (lengths_s[half - 1] + lengths_s[half]));
  }
  double sum_s = 0.0;
  for (const double length_s : lengths_s) sum_s += length_s;
  return 60.0 * n / sum_s;
}

double true_rate(const MadeHeart& heart, double time_s) {
  const auto at = std::ranges::lower_bound(heart.beats_s, time_s - 0.2);
  const auto i =
      std::min(static_cast<std::size_t>(at - heart.beats_s.begin()), heart.beats_s.size() - 1);
  return heart.rate_bpm[i];
}

struct HeardHeart {
  MadeHeart made;
  std::vector<diver::Interval> beats;
};

// Hearts with extra beats at other times: of a single one a few of them decide the error.
std::vector<HeardHeart> heard_hearts() {
  constexpr std::uint64_t kHearts = 12;
  std::vector<HeardHeart> out;
  for (std::uint64_t i = 0; i < kHearts; ++i) {
    HeardHeart& heart = out.emplace_back(HeardHeart{make_heart(kHeartSeconds, 3 + 10 * i), {}});
    const auto ecg =
        make_ecg(heart.made.beats_s, kHeartRate_hz, kHeartSeconds, kSnr_db, 4 + 10 * i);
    heart.beats = diver::intervals_of(diver::find_beats(kHeartRate_hz, ecg));
  }
  return out;
}

HeartPoint measure_rate(const std::vector<HeardHeart>& hearts, RateOver estimator, int intervals) {
  HeartPoint point{estimator, intervals};
  double squares = 0.0, count = 0.0;
  for (const HeardHeart& heart : hearts)
    for (std::size_t i = 1; i < heart.beats.size(); ++i) {
      double latency_s = 0.0;
      const double rate = rate_by(estimator, heart.beats, i, intervals, latency_s);
      if (rate <= 0.0) continue;
      squares += std::pow(rate - true_rate(heart.made, heart.beats[i].end_s), 2.0);
      point.latency_s += latency_s;
      count += 1.0;
    }
  if (count == 0.0) return point;
  point.rms_bpm = std::sqrt(squares / count);
  point.latency_s /= count;
  return point;
}

DetectorPoint measure_detector(const MadeHeart& heart, double rate_hz) {
  const auto ecg = make_ecg(heart.beats_s, rate_hz, kHeartSeconds, kSnr_db, 5);
  const double start_us = cpu_us();
  const auto beats = diver::find_beats(rate_hz, ecg);
  DetectorPoint point{rate_hz};
  point.us_a_second = (cpu_us() - start_us) / kHeartSeconds;
  std::vector<diver::BeatAnnotation> marks;
  for (const double t : heart.beats_s) marks.push_back({t, 1});
  const auto score = diver::score_beats(marks, diver::intervals_of(beats));
  point.found = score.found;
  point.extra = score.extra;
  point.missed = score.missed;
  double squares = 0.0, count = 0.0;
  for (const diver::Beat& beat : beats) {
    const auto after = std::ranges::lower_bound(heart.beats_s, beat.time_s);
    double nearest_s = 1.0;
    if (after != heart.beats_s.end()) nearest_s = *after - beat.time_s;
    if (after != heart.beats_s.begin()) nearest_s = std::min(nearest_s, beat.time_s - *(after - 1));
    if (nearest_s > diver::kBeatTolerance_s) continue;
    squares += nearest_s * nearest_s;
    count += 1.0;
  }
  point.timing_ms = count > 0.0 ? 1e3 * std::sqrt(squares / count) : 0.0;
  return point;
}

std::vector<double> breath_rates(bool quick) {
  return quick ? std::vector{10.0, 18.0} : std::vector{8.0, 10.0, 12.0, 15.0, 18.0, 22.0, 28.0};
}

}  // namespace

const char* name_of(RateOver estimator) {
  switch (estimator) {
    case RateOver::kCount:
      return "count of beats";
    case RateOver::kMean:
      return "mean of normal intervals";
    case RateOver::kMedian:
      return "median of normal intervals";
  }
  return "";
}

std::uint64_t steps(const PhysiologyTradeoffOptions& options) {
  const std::uint64_t breath = std::size(kBreathEstimators) * std::size(kBreathWindows_s);
  return breath * (options.recordings.empty() ? 1 : 2) + (options.recordings.empty() ? 0 : 1) +
         std::size(kDetectorRates_hz) + 1;
}

Result<PhysiologyTradeoff> run_physiology_tradeoff(const PhysiologyTradeoffOptions& options) {
  PhysiologyTradeoff out;
  const auto measure = [&](const std::vector<FramedSound>& framed, const std::string& signals) {
    for (const BreathEstimator estimator : kBreathEstimators)
      for (const double window_s : kBreathWindows_s) {
        const BreathPoint point = measure_breath(framed, signals, estimator, window_s);
        if (point.windows > 0) out.breath.push_back(point);
        options.step();
      }
  };
  if (!options.recordings.empty()) {
    NERITIC_TRY(const auto sounds, read_breath(options.recordings));
    const auto framed = frames_of(sounds);
    measure(framed, "recorded");
    std::map<std::string, std::vector<FramedSound>> sensors;
    for (const FramedSound& sound : framed) sensors[sound.kind].push_back(sound);
    for (const auto& [sensor, heard] : sensors) {
      for (const BreathEstimator estimator : kBreathEstimators)
        for (const double window_s : kBreathWindows_s)
          out.breath.push_back(measure_breath(heard, sensor, estimator, window_s));
      for (const double confidence : kConfidences)
        out.coverage.push_back(measure_coverage(heard, sensor, confidence));
    }
    options.step();
  }
  measure(frames_of(make_breath(breath_rates(options.quick), options.quick ? 65.0 : 90.0, 11)),
          "made");
  const std::vector<HeardHeart> hearts = heard_hearts();
  for (const RateOver estimator : kRateEstimators)
    for (const int intervals : kRateIntervals)
      out.heart.push_back(measure_rate(hearts, estimator, intervals));
  options.step();
  for (const double rate_hz : kDetectorRates_hz) {
    out.detector.push_back(measure_detector(hearts[0].made, rate_hz));
    options.step();
  }
  return out;
}

std::size_t knee_of(const std::vector<double>& x, const std::vector<double>& y) {
  if (x.size() < 3) return x.empty() ? 0 : x.size() - 1;
  std::size_t best = x.size() - 1;
  double most = 0.0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const double share = (x[i] - x.front()) / (x.back() - x.front());
    const double below = y.front() + share * (y.back() - y.front()) - y[i];
    if (below > most) most = below, best = i;
  }
  return best;
}

const BreathPoint* breath_knee(const PhysiologyTradeoff& tradeoff, const std::string& signals) {
  std::vector<const BreathPoint*> points;
  std::vector<double> x, y;
  for (const BreathPoint& p : tradeoff.breath) {
    if (p.signals != signals || p.estimator != BreathEstimator::kMultiBand) continue;
    points.push_back(&p);
    x.push_back(p.window_s);
    y.push_back(1.0 - p.right);
  }
  return points.empty() ? nullptr : points[knee_of(x, y)];
}

const HeartPoint* heart_choice(const PhysiologyTradeoff& tradeoff) {
  const HeartPoint* least = nullptr;
  for (const HeartPoint& p : tradeoff.heart)
    if (p.estimator == RateOver::kMedian && (!least || p.rms_bpm < least->rms_bpm)) least = &p;
  const HeartPoint* choice = least;
  for (const HeartPoint& p : tradeoff.heart)
    if (p.estimator == RateOver::kMedian && p.intervals > choice->intervals &&
        p.rms_bpm <= kAsGood * least->rms_bpm)
      choice = &p;
  return choice;
}

}  // namespace neritic::tools
