#include "diver/breath_rhythm.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numeric>

#include "diver/breath_halves.hpp"
#include "diver/breath_rate.hpp"
#include "engine/core/math.hpp"

namespace neritic::diver {
namespace {

// Two to five serve alike on recordings of paced breathing, with either sensor.
constexpr std::size_t kMostComponents = 3;
// A component that has less of all power is rounding.
constexpr double kLeastShare = 1e-9;
// 0 finds a breath with two equal halves twice, 1 finds it half as often; 0.5 lies between.
constexpr double kShareOfDouble = 0.5;
// Bursts alternate, or may, above these deviates of the standard normal distribution
// (breath_halves.hpp): a few bursts never deviate far, many do so by chance more often. 1300 made
// breaths without alternation reach 3.6, 1 % of them 2.9; in and out that vary by up to 15 % from
// breath to breath reach 5 and more in windows of 60 s.
constexpr double kAlternates = 3.6, kManyAlternate = 4.2, kMayAlternate = 3.2,
                 kFewMayAlternate = 2.5;
constexpr double kFewBursts = 9.0, kManyBursts = 20.0;
// And above which the two halves of a breath differ, so that it is not two breaths.
constexpr double kHalvesDiffer = 2.0;
// Where so few bursts tell nothing, a line at half of the frequency tells that exceeds the median
// of all by this factor: on the recordings none does; chance alone reaches 5.5.
constexpr double kHalfLine = 6.0;
// Every burst sounds alike if at most this share of their power goes against the loudness: nine in
// ten made bursts that are alike have up to 0.04, a regulator's hiss and bubbles 0.06 and more.
constexpr double kOtherSounds = 0.07;
constexpr double kNarrow = 0.36, kNarrowANeper = 0.15;
// Fewer turns are no rhythm that is sure.
constexpr double kLeastTurns = 1.9;
// A line whose double exceeds it by this factor in power is one by that double alone: of a breath
// if bursts of the double alternate, else of bursts that are faster than any breath that is
// measured.
constexpr double kDoubleAlone = 4.0;
// Half of a rate may be measured somewhat below the slowest breath.
constexpr double kNearlySlowest = 0.9;
// Lines are searched in steps of the window's resolution divided by this number.
constexpr double kLinesAResolution = 8.0;
constexpr int kMostSweeps = 30;

using Matrix = std::vector<std::vector<double>>;

// Eigenvectors in columns of `vectors`, eigenvalues on the diagonal of `m`: Jacobi's rotations
// (Golub and Van Loan, "Matrix Computations", 4th ed., 8.5). m is symmetric and small.
void diagonalize(Matrix& m, Matrix& vectors) {
  const std::size_t n = m.size();
  vectors.assign(n, std::vector<double>(n, 0.0));
  for (std::size_t i = 0; i < n; ++i) vectors[i][i] = 1.0;
  for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
    double rest = 0.0, all = 0.0;
    for (std::size_t i = 0; i < n; ++i)
      for (std::size_t j = 0; j < n; ++j) (i == j ? all : rest) += m[i][j] * m[i][j];
    if (rest <= 1e-24 * all) return;
    for (std::size_t p = 0; p + 1 < n; ++p)
      for (std::size_t q = p + 1; q < n; ++q) {
        if (m[p][q] == 0.0) continue;
        const double theta = 0.5 * (m[q][q] - m[p][p]) / m[p][q];
        const double t = std::copysign(1.0, theta) / (std::abs(theta) + std::hypot(theta, 1.0));
        const double c = 1.0 / std::hypot(t, 1.0), s = t * c;
        const auto turn = [&](double& a, double& b) {
          const double old = a;
          a = c * old - s * b;
          b = s * old + c * b;
        };
        for (std::size_t k = 0; k < n; ++k) turn(m[k][p], m[k][q]);
        for (std::size_t k = 0; k < n; ++k) turn(m[p][k], m[q][k]);
        for (std::size_t k = 0; k < n; ++k) turn(vectors[k][p], vectors[k][q]);
      }
  }
}

// The largest principal components of the bands, each with as much power as the others.
std::vector<Levels> components_of(const std::vector<Levels>& bands) {
  const std::size_t n = bands.size(), frames = bands[0].size();
  Matrix covariance(n, std::vector<double>(n, 0.0)), vectors;
  double all = 0.0;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      covariance[i][j] =
          std::inner_product(bands[i].begin(), bands[i].end(), bands[j].begin(), 0.0) /
          static_cast<double>(frames);
      if (i == j) all += covariance[i][j];
    }
  diagonalize(covariance, vectors);
  std::vector<std::size_t> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::ranges::sort(order, std::greater{}, [&](std::size_t i) { return covariance[i][i]; });
  std::vector<Levels> out;
  for (std::size_t rank = 0; rank < std::min(n, kMostComponents); ++rank) {
    const std::size_t i = order[rank];
    if (!(covariance[i][i] > kLeastShare * all)) break;
    Levels& component = out.emplace_back(frames, 0.0);
    for (std::size_t band = 0; band < n; ++band)
      for (std::size_t f = 0; f < frames; ++f)
        component[f] += vectors[band][i] / std::sqrt(covariance[i][i]) * bands[band][f];
  }
  return out;
}

// How strong the best line of sounds without rhythm is (its share of all power times the window's
// seconds): an extreme value's distribution, by location and scale. Measured on the paced
// recordings cut into pieces of 0.3 to 3 s in random order, windows of 10 to 60 s: both sensors'
// locations are within 0.2 of it, scales 0.4 to 0.57.
double share_of_arrhythmic_below(double share, double window_s) {
  const double location = 2.85 + 0.75 * std::log(window_s / 20.0);
  constexpr double kScale = 0.5;
  return std::exp(-std::exp(-(share * window_s - location) / kScale));
}

// Bands by the burst that they have in each turn: the loudness is their sum, each by its share of
// what most have in common. `others`: the share of all power in bands that are louder when the
// loudness is softer, or that turn at right angles to it: the sounds of a turn differ in colour.
struct Bursts {
  Levels loudness;
  double others = 0.0;
};
Bursts bursts_of(const std::vector<Levels>& bands, const Levels& turns) {
  std::vector<std::complex<double>> lines;
  std::complex<double> most = 0.0;
  double all = 0.0, alike = 0.0;
  for (const Levels& band : bands) {
    std::complex<double> line = 0.0;
    for (std::size_t i = 0; i < band.size(); ++i)
      line += std::polar(band[i], -2.0 * kPi * turns[i]);
    lines.push_back(line);
    most += line * std::abs(line);
    all += std::norm(line);
  }
  Bursts out{Levels(turns.size(), 0.0)};
  if (!(std::abs(most) > 0.0)) return out;
  for (std::size_t band = 0; band < bands.size(); ++band) {
    const double with = (lines[band] * std::conj(most)).real() / std::abs(most);
    alike += std::pow(std::max(with, 0.0), 2.0);
    for (std::size_t i = 0; i < turns.size(); ++i) out.loudness[i] += with * bands[band][i];
  }
  out.others = 1.0 - alike / all;
  return out;
}

// The share of the second harmonic that has its top where the first one has; negative: its trough.
double double_at_top(const Levels& loudness, const Levels& turns) {
  std::complex<double> first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < loudness.size(); ++i) {
    first += std::polar(loudness[i], -2.0 * kPi * turns[i]);
    second += std::polar(loudness[i], -4.0 * kPi * turns[i]);
  }
  const std::complex<double> turned = second * std::conj(first * first);
  return turned.real() / std::max(std::pow(std::abs(first), 3.0), 1e-300);
}

// One sound that comes once a turn, so wide that it may as well be half of a breath. A hump has its
// double at its top if it is narrow, its double's trough if it is wide. A sin^2 hump that fills
// 0.62 of its period has the share kNarrow - kNarrowANeper times the deviation of the level, which
// noise makes small as it hides the flanks; halves of a breath fill 0.7 to 0.9 of theirs.
bool bursts_are_alike(const std::vector<Levels>& bands, double deviation, const Levels& turns) {
  const Bursts bursts = bursts_of(bands, turns);
  return bursts.others < kOtherSounds &&
         double_at_top(bursts.loudness, turns) < kNarrow - kNarrowANeper * deviation;
}

// How far the halves of turns differ; infinity: too few turns to say.
double halves_differ(const std::vector<Levels>& bands, const Levels& turns) {
  Levels halves = turns;
  for (double& turn : halves) turn *= 2.0;
  return halves.back() > kLeastBursts ? alternation(bands, halves)
                                      : std::numeric_limits<double>::infinity();
}

// The power of each line; a window must hold one breath at least to show its line.
bool has_half_line(const std::vector<double>& lines, std::size_t best, std::size_t slowest,
                   std::size_t slowest_half) {
  constexpr auto kReach = static_cast<std::ptrdiff_t>(kLinesAResolution / 4.0);
  if (best / 2 < slowest_half) return false;
  const auto half = lines.begin() + static_cast<std::ptrdiff_t>(best / 2);
  std::vector<double> sorted(lines.begin() + static_cast<std::ptrdiff_t>(slowest), lines.end());
  const auto median = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::ranges::nth_element(sorted, median);
  return *std::max_element(half - kReach, half + kReach + 1) > kHalfLine * *median;
}

}  // namespace

double parabola_top(double before, double here, double after) {
  const double bend = before - 2.0 * here + after;
  return bend < 0.0 ? std::clamp(0.5 * (before - after) / bend, -0.5, 0.5) : 0.0;
}

std::vector<double> line_powers(const Levels& x, double step_hz, std::size_t count) {
  // Each frame's angle, turned on by one step a line.
  std::vector<std::complex<double>> turned(x.begin(), x.end()), turns;
  for (std::size_t i = 0; i < x.size(); ++i)
    turns.push_back(
        std::polar(1.0, -2.0 * kPi * static_cast<double>(i) * step_hz / kBreathFrames_hz));
  std::vector<double> power;
  for (std::size_t line = 0; line < count; ++line) {
    std::complex<double> sum = 0.0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      sum += turned[i];
      const auto [re, im] = std::pair(turned[i].real(), turned[i].imag());
      turned[i] = {re * turns[i].real() - im * turns[i].imag(),
                   re * turns[i].imag() + im * turns[i].real()};
    }
    power.push_back(std::norm(sum));
  }
  return power;
}

Rhythm common_rhythm(const std::vector<Levels>& bands, double deviation) {
  const std::vector<Levels> components = components_of(bands);
  if (components.empty()) return {};
  const auto frames = static_cast<double>(bands[0].size());
  const double window_s = frames / kBreathFrames_hz;
  const double step_hz = 1.0 / window_s / kLinesAResolution;
  const auto line_of = [&](double hz) {
    return static_cast<std::size_t>(std::ceil(hz / step_hz - 1e-9));
  };
  const std::size_t slowest = line_of(slowest_breath_hz(window_s));
  const auto fastest = static_cast<std::size_t>(std::floor(kFastestBreath_hz / step_hz));
  std::vector<double> together(2 * (fastest + 1) + 1, 0.0);
  for (const Levels& component : components) {
    const std::vector<double> powers = line_powers(component, step_hz, together.size());
    // A pure line has half of the square of its frames.
    for (std::size_t i = 0; i < together.size(); ++i)
      together[i] += powers[i] * 2.0 / (frames * frames) / static_cast<double>(components.size());
  }
  const auto at = [&](std::size_t i) { return together[i] + kShareOfDouble * together[2 * i]; };
  std::size_t best = 0;
  for (std::size_t i = slowest; i <= fastest; ++i)
    if (at(i) >= at(i - 1) && at(i) > at(i + 1) && (best == 0 || at(i) > at(best))) best = i;
  if (best == 0) return {};
  const double confidence = share_of_arrhythmic_below(at(best), window_s);
  const double top = parabola_top(at(best - 1), at(best), at(best + 1));
  const double line_hz = step_hz * (static_cast<double>(best) + top);
  if (2.0 * line_hz > kFastestBreath_hz && together[2 * best] > kDoubleAlone * together[best] &&
      alternation(bands, turns_of(components, 2.0 * line_hz)) < kAlternates)
    return {};
  const Levels turns = turns_of(components, line_hz);
  const double hz =
      turns.back() < kFewBursts ? line_hz : turns.back() * kBreathFrames_hz / (frames - 1.0);
  const double differ =
      hz >= 2.0 * kNearlySlowest * kSlowestBreath_hz ? alternation(bands, turns) : 0.0;
  if (differ > (turns.back() < kManyBursts ? kAlternates : kManyAlternate)) {
    if (0.5 * hz < kNearlySlowest * slowest_breath_hz(window_s)) return {.slower = true};
    return {.rate_hz = 0.5 * hz, .confidence = confidence};
  }
  const bool may_alternate =
      differ > (turns.back() < kFewBursts ? kFewMayAlternate : kMayAlternate);
  Rhythm out{.rate_hz = hz, .confidence = confidence};
  out.unsure = may_alternate || bursts_are_alike(bands, deviation, turns);
  out.weak = halves_differ(bands, turns) < kHalvesDiffer;
  if (out.unsure) out.confidence = std::min(confidence, kUnsureConfidence);
  const std::size_t slowest_half = line_of(std::max(kSlowestBreath_hz, 1.0 / window_s));
  out.doubtful =
      turns.back() < kLeastTurns ||
      (turns.back() < kLeastBursts && has_half_line(together, best, slowest, slowest_half));
  return out;
}

}  // namespace neritic::diver
