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
// If a line at half of the frequency exceeds the median of all by this factor, a whole breath has
// twice the period. On the recordings none does; chance alone reaches 5.5.
constexpr double kHalfLine = 6.0;
// Below 0.1 Hz levels drift: there the line at half of the frequency must be this much stronger
// than the best. Slow regulator breath has 1.3 and more; 2 of 150 windows of faster breath on the
// recordings have more than 1.
constexpr double kSlowHalf = 1.25;
// One sound alone repeats where loudness has this share of its power in the line and not much more
// at its double, and colours have at most this share of the loudness's line: made sounds have up to
// 0.4, seldom 0.7, the recordings, whose halves differ in colour, 0.33 and more. Bands that go
// against the loudness tell sounds from one another.
constexpr double kLeastLoudLine = 0.1, kMostDouble = 1.5, kMostAgainst = 0.1;
constexpr double kLittleColour = 0.4, kSomeColour = 0.7;
// Shorter windows leave more colour to chance.
constexpr double kColourWindow_s = 20.0;
// A hump that is wider than half of its period has its double's trough at its top; a narrower one,
// or two humps of different height, the double's top, with more than this share.
constexpr double kNarrow = 0.1;
// Bursts that differ by chance alone reach 5, whole breaths of the recordings 23.
constexpr double kAlternates = 8.0, kSurelyAlternates = 40.0;
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

// Turns the first component so that louder is up, and says whether it is the loudness: bands that
// go against it tell sounds from one another.
bool turn_to_loudness(const std::vector<Levels>& bands, Levels& component) {
  double with = 0.0, against = 0.0;
  for (const Levels& band : bands) {
    const double along = std::inner_product(band.begin(), band.end(), component.begin(), 0.0);
    (along > 0.0 ? with : against) += std::abs(along);
  }
  if (against > with)
    for (double& level : component) level = -level;
  return std::min(with, against) <= kMostAgainst * std::max(with, against);
}

// The colours' share of the loudness's line; infinite where the line is not of one hump a period.
double colour_at(const std::vector<std::vector<double>>& powers, std::size_t line) {
  const double loud = powers[0][line];
  double colour = 0.0;
  for (std::size_t i = 1; i < powers.size(); ++i) colour += powers[i][line];
  const bool one_hump = loud >= kLeastLoudLine && powers[0][2 * line] <= kMostDouble * loud;
  return one_hump ? colour / loud : std::numeric_limits<double>::infinity();
}

// The share of the second harmonic that has its top where the first one has: negative for its
// trough there.
double double_at_top(const Levels& loudness, double hz) {
  std::complex<double> first = 0.0, second = 0.0;
  for (std::size_t i = 0; i < loudness.size(); ++i) {
    const double turns = static_cast<double>(i) / kBreathFrames_hz * hz;
    first += std::polar(loudness[i], -2.0 * kPi * turns);
    second += std::polar(loudness[i], -4.0 * kPi * turns);
  }
  const std::complex<double> turned = second * std::conj(first * first);
  return turned.real() / std::max(std::pow(std::abs(first), 3.0), 1e-300);
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

Rhythm common_rhythm(const std::vector<Levels>& bands) {
  std::vector<Levels> components = components_of(bands);
  if (components.empty()) return {};
  const auto frames = static_cast<double>(bands[0].size());
  const double step_hz = kBreathFrames_hz / frames / kLinesAResolution;
  const auto line_of = [&](double hz) {
    return static_cast<std::size_t>(std::ceil(hz / step_hz - 1e-9));
  };
  const std::size_t slowest = line_of(slowest_breath_hz(frames / kBreathFrames_hz));
  const auto fastest = static_cast<std::size_t>(std::floor(kFastestBreath_hz / step_hz));
  std::vector<double> together(2 * (fastest + 1) + 1, 0.0);
  std::vector<std::vector<double>> powers;
  for (const Levels& component : components) {
    powers.push_back(line_powers(component, step_hz, together.size()));
    for (std::size_t i = 0; i < together.size(); ++i) {
      powers.back()[i] *=
          2.0 / (frames * frames);  // a pure line has half of the square of its frames
      together[i] += powers.back()[i] / static_cast<double>(components.size());
    }
  }
  const auto at = [&](std::size_t i) { return together[i] + kShareOfDouble * together[2 * i]; };
  std::size_t best = 0;
  for (std::size_t i = slowest; i <= fastest; ++i)
    if (at(i) >= at(i - 1) && at(i) > at(i + 1) && (best == 0 || at(i) > at(best))) best = i;
  if (best == 0) return {};
  const double confidence = share_of_arrhythmic_below(at(best), frames / kBreathFrames_hz);
  double line = static_cast<double>(best) + parabola_top(at(best - 1), at(best), at(best + 1));
  constexpr auto kReach = static_cast<std::size_t>(kLinesAResolution / 4.0);
  bool slower = false, alike = false, doubtful = false;
  // A window must hold one breath at least to show its line.
  const double slowest_half_hz = std::max(kSlowestBreath_hz, kBreathFrames_hz / frames);
  if (best / 2 >= line_of(slowest_half_hz)) {
    const auto half = together.begin() + static_cast<std::ptrdiff_t>(best / 2);
    const double highest = *std::max_element(half - kReach, half + kReach + 1);
    std::vector<double> sorted(together.begin() + static_cast<std::ptrdiff_t>(slowest),
                               together.end());
    std::ranges::nth_element(sorted,
                             sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2));
    const bool stands_out = highest > kHalfLine * sorted[sorted.size() / 2];
    if (stands_out && (best / 2 >= line_of(0.1) || highest > kSlowHalf * at(best))) {
      line *= 0.5;
      slower = best / 2 < slowest;
    } else {
      doubtful = stands_out;
    }
  }
  if (line > 0.75 * static_cast<double>(best) && turn_to_loudness(bands, components[0])) {
    const double window_s = frames / kBreathFrames_hz;
    const double hz = step_hz * line, colour = colour_at(powers, best);
    const bool little = colour <= kLittleColour * std::max(1.0, kColourWindow_s / window_s);
    const double differ = colour <= kSomeColour || little ? alternation(bands, hz) : 0.0;
    const bool alternates = differ > (little ? kAlternates : kSurelyAlternates);
    alike = !alternates && little && double_at_top(components[0], hz) < kNarrow;
    if (alternates) line *= 0.5;
    slower = alternates && line < static_cast<double>(slowest);
  }
  if (slower) return {.slower = true};
  return {.rate_hz = step_hz * line,
          .confidence = alike ? std::min(confidence, kAlikeConfidence) : confidence,
          .alike = alike,
          .doubtful = doubtful && line > 0.75 * static_cast<double>(best)};
}

}  // namespace neritic::diver
