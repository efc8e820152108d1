#include "diver/breath_rate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "diver/breath_rhythm.hpp"
#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::diver {
namespace {

// Frames of the Hann window that smooths levels: 2 Hz; half of it lasts 0.3 s.
constexpr int kSmoothFrames = 10;
// Its equivalent length, (sum w)^2 / sum w^2 of a Hann window: two thirds.
constexpr double kSmooth_s = kSmoothFrames / kBreathFrames_hz * 2.0 / 3.0;
constexpr double kLeastWindow_s = 4.0, kLeastOverlap_s = 2.0;
// A level that varies at most twice as much as that of steady noise carries no information: the
// variance of the logarithm of noise power over B Hz and T s is 1 / BT.
constexpr double kOverNoise = 4.0;
// Bands that vary by less than half a decibel contain no breath.
constexpr double kLeastDeviation = 0.115;  // nepers of power
constexpr double kSilence = 1e-12;         // full scale squared: -120 dB
// Breaths that were missed: a rate says that none was. Breathing that is paced pauses for half a
// breath at most but once in 87 windows.
constexpr double kMostPause = 1.25;
// The first peak so near the highest: twice a breath is like a breath too. Measured on recordings
// of paced breathing; between 0.8 and 0.9 nothing changes much.
constexpr double kFirstPeak = 0.85;
// How far off the next but one breath is looked for, in periods.
constexpr double kReach = 0.15;
constexpr double kMostDeviations = 1.5;  // of a level, from its mean
// How near the rhythm of all bands a period of the envelope is looked for: breaths are not equally
// long. A half or a double of it lies far beyond.
constexpr double kNearRhythm = 0.2;
// The next but one is as far more like a burst than the next where they are halves of a breath.
constexpr double kMoreAlike = 0.1;
// How near half of a rate another is half of it.
constexpr double kHalves = 0.1;
// The baselines look no lower, as published.
constexpr double kSlowestOfBaselines_hz = 0.1;
constexpr double kDecibelsANeper = 4.342944819032518;  // of power

Levels smoothed(const Levels& in) {
  std::array<double, kSmoothFrames + 1> window{};
  double sum = 0.0;
  for (int i = 0; i <= kSmoothFrames; ++i) {
    window[static_cast<std::size_t>(i)] =
        1.0 - std::cos(2.0 * kPi * (i + 1.0) / (kSmoothFrames + 2.0));
    sum += window[static_cast<std::size_t>(i)];
  }
  Levels out(in.size());
  const auto last = static_cast<int>(in.size()) - 1;
  for (int i = 0; i <= last; ++i)
    for (int k = 0; k <= kSmoothFrames; ++k)
      out[static_cast<std::size_t>(i)] +=
          window[static_cast<std::size_t>(k)] / sum *
          in[static_cast<std::size_t>(std::clamp(i + k - kSmoothFrames / 2, 0, last))];
  return out;
}

// To mean 0; gives the deviation.
double center(Levels& levels) {
  double mean = 0.0, squares = 0.0;
  for (const double l : levels) mean += l / static_cast<double>(levels.size());
  for (double& l : levels) {
    l -= mean;
    squares += l * l;
  }
  return std::sqrt(squares / static_cast<double>(levels.size()));
}

double correlation(const Levels& levels, std::size_t lag) {
  double ab = 0.0, aa = 0.0, bb = 0.0;
  for (std::size_t i = lag; i < levels.size(); ++i) {
    ab += levels[i] * levels[i - lag];
    aa += levels[i] * levels[i];
    bb += levels[i - lag] * levels[i - lag];
  }
  const double size = std::sqrt(aa * bb);
  return size > 0.0 ? ab / size : 0.0;
}

// Fills rate and confidence by the autocorrelation of the envelope, centred, from rates between
// these two.
void by_autocorrelation(const Levels& envelope, double slowest_hz, double fastest_hz,
                        BreathEstimate& out) {
  const auto frames = static_cast<int>(envelope.size());
  const int shortest = static_cast<int>(kBreathFrames_hz / fastest_hz);
  const int last = frames - static_cast<int>(kLeastOverlap_s * kBreathFrames_hz);
  const int longest = std::min(static_cast<int>(std::ceil(kBreathFrames_hz / slowest_hz)), last);
  // Autocorrelation by lag, computed on demand; NaN: not yet.
  std::vector<double> r(static_cast<std::size_t>(last + 2),
                        std::numeric_limits<double>::quiet_NaN());
  const auto at = [&](int lag) {
    double& value = r[static_cast<std::size_t>(lag)];
    if (std::isnan(value)) value = correlation(envelope, static_cast<std::size_t>(lag));
    return value;
  };
  const auto is_top = [&](int lag) {
    return at(lag) > 0.0 && at(lag) >= at(lag - 1) && at(lag) > at(lag + 1);
  };
  const auto exact = [&](int lag) { return lag + parabola_top(at(lag - 1), at(lag), at(lag + 1)); };
  double highest = 0.0;
  for (int lag = shortest; lag <= longest; ++lag)
    if (is_top(lag)) highest = std::max(highest, at(lag));
  out.confidence = highest;
  int first = shortest;
  while (first <= longest && !(is_top(first) && at(first) >= kFirstPeak * highest)) ++first;
  if (first > longest) return;
  // Breaths farther apart say the same with less error, as far as they go on to be alike.
  double period = exact(first);
  for (int count = 2; count * period < 0.75 * frames; ++count) {
    const int expected = static_cast<int>(std::lround(count * period));
    const int reach = std::max(1, static_cast<int>(kReach * period));
    int best = 0;
    for (int lag = expected - reach; lag <= std::min(expected + reach, last); ++lag)
      if (is_top(lag) && (best == 0 || at(lag) > at(best))) best = lag;
    if (best == 0 || at(best) < 0.5 * highest) break;
    period = exact(best) / count;
  }
  out.rate_bpm = 60.0 * kBreathFrames_hz / period;
}

void by_spectrum(const Levels& envelope, BreathEstimate& out) {
  const auto n = static_cast<double>(envelope.size());
  const double step_hz = kBreathFrames_hz / n / 8.0;
  Levels windowed = envelope;
  double all = 0.0;
  for (std::size_t i = 0; i < envelope.size(); ++i) {
    windowed[i] *= 0.5 - 0.5 * std::cos(2.0 * kPi * (static_cast<double>(i) + 0.5) / n);
    all += envelope[i] * envelope[i];
  }
  const auto slowest = static_cast<std::size_t>(std::ceil(kSlowestOfBaselines_hz / step_hz));
  const auto fastest = static_cast<std::size_t>(std::floor(kFastestBreath_hz / step_hz));
  const auto power = line_powers(windowed, step_hz, fastest + 2);
  std::size_t best = slowest;
  for (std::size_t i = slowest; i <= fastest; ++i)
    if (power[i] > power[best]) best = i;
  const double top = parabola_top(power[best - 1], power[best], power[best + 1]);
  out.rate_bpm = 60.0 * step_hz * (static_cast<double>(best) + top);
  // A pure line under a Hann window has n/8 of all squares.
  out.confidence = std::min(1.0, all > 0.0 ? power[best] / (all * n / 8.0) : 0.0);
}

// An estimate, and whether a longer window may tell more: of a breath longer than this one can
// measure, or of bursts that are alike; or whether the rate may be that of halves.
struct WindowEstimate {
  BreathEstimate breath;
  bool asks_for_more = false;
  bool slower = false;  // asks for it since a breath is longer
  bool doubtful = false, weak = false;
};

void by_rhythm(const std::vector<Levels>& bands, WindowEstimate& out) {
  const Rhythm rhythm = common_rhythm(bands, out.breath.depth_db / kDecibelsANeper);
  out.breath.rate_bpm = 60.0 * rhythm.rate_hz;
  out.breath.confidence = rhythm.confidence;
  out.asks_for_more = rhythm.slower || rhythm.unsure || rhythm.weak;
  out.weak = rhythm.weak;
  out.slower = rhythm.slower;
  out.doubtful = rhythm.doubtful;
}

// A rate that may be twice the breath's is none.
BreathEstimate unsure(BreathEstimate breath) {
  breath.breathing = 0;
  breath.rate_bpm = 0.0;
  breath.confidence = std::min(breath.confidence, kUnsureConfidence);
  return breath;
}

Levels log_levels(std::span<const BreathFrame> frames, std::size_t band) {
  Levels levels;
  for (const BreathFrame& f : frames) levels.push_back(f.power[band]);
  levels = smoothed(levels);
  for (double& l : levels) l = std::log(l + kSilence);
  return levels;
}

// Whether it goes up and down by more than noise does.
bool is_lively(double deviation, double width_hz) {
  const double noise = 1.0 / (width_hz * kSmooth_s);
  return deviation * deviation >= kOverNoise * noise && deviation >= kLeastDeviation;
}

// The frames that are louder in any lively band than half way between its softest and its loudest
// twentieth, in decibels; none where nothing stands out by 6 dB.
std::vector<bool> loud_frames(std::span<const BreathFrame> frames, const BreathBands& front) {
  std::vector<bool> loud(frames.size(), false);
  if (frames.empty()) return loud;
  for (int band = 0; band < front.bands(); ++band) {
    Levels levels = log_levels(frames, static_cast<std::size_t>(band));
    if (!is_lively(center(levels), front.width_hz(band))) continue;
    Levels sorted = levels;
    std::ranges::sort(sorted);
    const double low = sorted[sorted.size() / 20],
                 high = sorted[sorted.size() - 1 - sorted.size() / 20];
    if (high - low < 2.0 * std::log(2.0)) continue;
    for (std::size_t i = 0; i < levels.size(); ++i)
      if (levels[i] > 0.5 * (low + high)) loud[i] = true;
  }
  return loud;
}

double longest_pause_s(std::span<const BreathFrame> frames, const BreathBands& front) {
  int longest = 0, now = 0;
  for (const bool loud : loud_frames(frames, front))
    longest = std::max(longest, now = loud ? 0 : now + 1);
  return longest / kBreathFrames_hz;
}

// slowest_hz, fastest_hz: between which the autocorrelation looks.
WindowEstimate estimate_window(std::span<const BreathFrame> frames, const BreathBands& front,
                               BreathEstimator estimator, double least_confidence,
                               double slowest_hz = kSlowestOfBaselines_hz,
                               double fastest_hz = kFastestBreath_hz) {
  WindowEstimate result;
  BreathEstimate& out = result.breath;
  if (static_cast<double>(frames.size()) < kLeastWindow_s * kBreathFrames_hz) return result;
  std::vector<Levels> bands;
  for (int band = 0; band < front.bands(); ++band) {
    Levels levels = log_levels(frames, static_cast<std::size_t>(band));
    const double deviation = center(levels);
    if (deviation <= 0.0) continue;
    if (is_lively(deviation, front.width_hz(band)))
      out.depth_db = std::max(out.depth_db, kDecibelsANeper * deviation);
    // A band counts as much as the next, and a knock no more than a breath.
    for (double& l : levels) l = std::clamp(l / deviation, -kMostDeviations, kMostDeviations);
    center(levels);
    bands.push_back(std::move(levels));
  }
  // No band goes up and down by more than noise does.
  if (out.depth_db <= 0.0) return result;
  Levels envelope;
  for (const BreathFrame& f : frames) envelope.push_back(f.envelope);
  envelope = smoothed(envelope);
  center(envelope);
  if (estimator == BreathEstimator::kSpectrum) by_spectrum(envelope, out);
  if (estimator == BreathEstimator::kAutocorrelation)
    by_autocorrelation(envelope, slowest_hz, fastest_hz, out);
  if (estimator == BreathEstimator::kMultiBand) by_rhythm(bands, result);
  const bool missed = estimator != BreathEstimator::kSpectrum &&
                      longest_pause_s(frames, front) * out.rate_bpm / 60.0 >= kMostPause;
  const bool sure = out.confidence >= least_confidence && !missed;
  out.breathing = out.rate_bpm > 0.0 && sure ? 1 : 0;
  if (!out.breathing) out.rate_bpm = 0.0;
  return result;
}

}  // namespace

const char* name_of(BreathQuality quality) {
  switch (quality) {
    case BreathQuality::kNone:
      return "none";
    case BreathQuality::kPoor:
      return "poor";
    case BreathQuality::kGood:
      return "good";
  }
  return "";
}

BreathQuality quality_of(const BreathEstimate& breath, BreathEstimator estimator) {
  if (breath.depth_db <= 0.0) return BreathQuality::kNone;
  const bool told = breath.breathing != 0 && estimator != BreathEstimator::kSpectrum;
  return told ? BreathQuality::kGood : BreathQuality::kPoor;
}

const char* name_of(BreathEstimator estimator) {
  switch (estimator) {
    case BreathEstimator::kSpectrum:
      return "spectrum";
    case BreathEstimator::kAutocorrelation:
      return "autocorrelation";
    case BreathEstimator::kMultiBand:
      return "multiband";
  }
  return "";
}

double confidence_asked(BreathEstimator estimator) {
  switch (estimator) {
    case BreathEstimator::kSpectrum:
      return 0.0;
    case BreathEstimator::kAutocorrelation:
      return 0.25;
    case BreathEstimator::kMultiBand:
      return 0.9;
  }
  return 0.0;
}

Result<BreathEstimator> breath_estimator_of(const std::string& name) {
  using enum BreathEstimator;
  for (const BreathEstimator e : {kSpectrum, kAutocorrelation, kMultiBand})
    if (name == name_of(e)) return e;
  return refusal("", fmt::format("estimator '{}'", name), "spectrum, autocorrelation or multiband");
}

double slowest_breath_hz(double window_s) {
  return window_s >= 2.0 / kSlowestBreath_hz ? kSlowestBreath_hz : 0.1;
}

BreathEstimate estimate_breath(std::span<const BreathFrame> frames, const BreathBands& front,
                               BreathEstimator estimator, double least_confidence) {
  return estimate_window(frames, front, estimator, least_confidence).breath;
}

BreathEstimate estimate_breath(std::span<const BreathFrame> frames, const BreathBands& front,
                               BreathEstimator estimator) {
  return estimate_breath(frames, front, estimator, confidence_asked(estimator));
}

namespace {

// The envelope alone does not tell a breath from its halves, nor one breath from two: it is asked
// for its period near the rhythm that all bands have, in the window, or where that is too short in
// the whole history.
BreathEstimate newest_by_autocorrelation(std::span<const BreathFrame> history, double window_s,
                                         const BreathBands& front) {
  using enum BreathEstimator;
  BreathEstimate rhythm = estimate_newest_breath(history, window_s, front, kMultiBand);
  rhythm.confidence = std::min(rhythm.confidence, kUnsureConfidence);
  if (rhythm.breathing == 0) return rhythm;
  const double hz = rhythm.rate_bpm / 60.0;
  const auto refused = [&] {
    rhythm.breathing = 0;
    rhythm.rate_bpm = 0.0;
    return rhythm;
  };
  // Until two of the slowest breaths are heard, this may be what a half of one repeats.
  if (hz < 4.0 * kSlowestBreath_hz && history.size() < 2.0 / kSlowestBreath_hz * kBreathFrames_hz)
    return refused();
  const auto window = static_cast<std::size_t>(std::lround(window_s * kBreathFrames_hz));
  const auto heard_near = [&](std::size_t frames, double near_hz) {
    return estimate_window(history.last(frames), front, kAutocorrelation,
                           confidence_asked(kAutocorrelation), near_hz / (1.0 + kNearRhythm),
                           near_hz * (1.0 + kNearRhythm))
        .breath;
  };
  for (const std::size_t frames : {std::min(window, history.size()), history.size()}) {
    const BreathEstimate near = heard_near(frames, hz);
    if (near.breathing == 0) continue;
    // Two breaths on, all is as alike as one breath on, but that breaths are not equally long.
    const bool halves = heard_near(history.size(), 0.5 * hz).confidence >
                        heard_near(history.size(), hz).confidence + kMoreAlike;
    return halves ? refused() : near;
  }
  return refused();
}

}  // namespace

// kMultiBand measures a rate whose half is too slow for the window in the history, too. If the
// history finds that half, it is believed. Until the history lasts 40 s, such a rate is refused if
// anything speaks for its half.
BreathEstimate estimate_newest_breath(std::span<const BreathFrame> history, double window_s,
                                      const BreathBands& front, BreathEstimator estimator) {
  if (estimator == BreathEstimator::kAutocorrelation)
    return newest_by_autocorrelation(history, window_s, front);
  const auto window = static_cast<std::size_t>(std::lround(window_s * kBreathFrames_hz));
  const std::size_t heard = std::min(window, history.size());
  const double heard_s = static_cast<double>(heard) / kBreathFrames_hz;
  const WindowEstimate newest =
      estimate_window(history.last(heard), front, estimator, confidence_asked(estimator));
  // Two breaths of half the rate do not fit into the window: a longer one sees whether they are
  // what repeats.
  const bool may_be_halves = estimator == BreathEstimator::kMultiBand &&
                             newest.breath.breathing != 0 &&
                             newest.breath.rate_bpm / 60.0 < 2.0 * slowest_breath_hz(heard_s);
  const auto enough = static_cast<std::size_t>(2.0 / kSlowestBreath_hz * kBreathFrames_hz);
  if (!newest.asks_for_more && !may_be_halves) return newest.breath;
  if (history.size() <= window) {
    if (newest.weak && history.size() >= enough) return unsure(newest.breath);
    if (may_be_halves && newest.doubtful && history.size() < enough) return unsure(newest.breath);
    return newest.breath;
  }
  const WindowEstimate all =
      estimate_window(history, front, estimator, confidence_asked(estimator));
  if (all.weak) return unsure(all.breath);
  if (newest.asks_for_more)
    return newest.slower && history.size() < enough ? unsure(all.breath) : all.breath;
  const double share = all.breath.rate_bpm / newest.breath.rate_bpm;
  if (all.breath.breathing != 0 && std::abs(share - 0.5) < kHalves) return all.breath;
  const bool doubtful = newest.doubtful || all.doubtful || all.asks_for_more;
  return doubtful && history.size() < enough ? unsure(newest.breath) : newest.breath;
}

double quiet_for(std::span<const BreathFrame> frames, const BreathBands& front) {
  const std::vector<bool> loud = loud_frames(frames, front);
  const auto last = std::find(loud.rbegin(), loud.rend(), true);
  return static_cast<double>(last - loud.rbegin()) / kBreathFrames_hz;
}

}  // namespace neritic::diver
