#include "diver/breath_halves.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

#include "diver/breath_rate.hpp"
#include "engine/core/math.hpp"

namespace neritic::diver {
namespace {

using Complex = std::complex<double>;

constexpr std::size_t kQuarters = 4;
// Periods of the Hann window that follows the phase: its spectrum is zero at half of the rate away,
// so that bursts which alternate do not move the phase.
constexpr double kPhasePeriods = 4.0;
constexpr int kSweeps = 30;

// The slow amplitude of each component at hz, in the middle of each whole window.
std::vector<std::vector<Complex>> amplitudes_at(const std::vector<Levels>& components, double hz) {
  const auto window = static_cast<std::size_t>(std::lround(kPhasePeriods * kBreathFrames_hz / hz));
  std::vector<std::vector<Complex>> out;
  for (const Levels& x : components) {
    auto& z = out.emplace_back();
    if (window == 0 || window > x.size()) continue;
    // A Hann window is a sum of three turning arrows: each sum slides on by a frame.
    const auto turn = [&](double each, std::size_t i) {
      return std::polar(1.0, -2.0 * kPi * each * static_cast<double>(i));
    };
    z.assign(x.size() - window + 1, 0.0);
    const double step = hz / kBreathFrames_hz, side = 1.0 / static_cast<double>(window);
    for (const int k : {-1, 0, 1}) {
      const double each = step + k * side, weight = k == 0 ? 0.5 : -0.25;
      Complex sum = 0.0;
      for (std::size_t i = 0; i < window; ++i) sum += x[i] * turn(each, i);
      for (std::size_t from = 0;; ++from) {
        z[from] += weight * sum * std::conj(turn(k * side, from));
        if (from + window >= x.size()) break;
        sum += x[from + window] * turn(each, from + window) - x[from] * turn(each, from);
      }
    }
  }
  return out;
}

// The amplitude of what all components have in common: their largest principal component.
std::vector<Complex> common_amplitude(const std::vector<std::vector<Complex>>& z) {
  std::vector<Complex> weights(z.size(), 1.0), common(z[0].size());
  for (int sweep = 0; sweep < kSweeps; ++sweep) {  // by power iteration
    for (std::size_t i = 0; i < common.size(); ++i) {
      common[i] = 0.0;
      for (std::size_t c = 0; c < z.size(); ++c) common[i] += std::conj(weights[c]) * z[c][i];
    }
    double size = 0.0;
    for (std::size_t c = 0; c < z.size(); ++c) {
      weights[c] = 0.0;
      for (std::size_t i = 0; i < common.size(); ++i) weights[c] += z[c][i] * std::conj(common[i]);
      size += std::norm(weights[c]);
    }
    if (!(size > 0.0)) break;
    for (Complex& w : weights) w /= std::sqrt(size);
  }
  return common;
}

// The level at that fraction of a frame's time, by Catmull and Rom's cubic: levels are smoothed to
// 2 Hz, a tenth of the frames' rate, so that it errs by little.
double level_at(const Levels& levels, double frame) {
  const double before = std::floor(frame), x = frame - before;
  const auto last = static_cast<std::ptrdiff_t>(levels.size()) - 1;
  const auto at = [&](int off) {
    const auto i = std::clamp(static_cast<std::ptrdiff_t>(before) + off, std::ptrdiff_t{0}, last);
    return levels[static_cast<std::size_t>(i)];
  };
  const double a = at(-1), b = at(0), c = at(1), d = at(2);
  return b +
         0.5 * x * (c - a + x * (2.0 * a - 5.0 * b + 4.0 * c - d + x * (3.0 * (b - c) + d - a)));
}

// The frames at which phases 1 / (4 each) apart are met, from half of that on, turn after turn.
std::vector<double> frames_of(const Levels& turns, std::size_t bursts, std::size_t each) {
  std::vector<double> out;
  const auto quarters = static_cast<double>(kQuarters * each);
  std::size_t i = 0;
  for (std::size_t k = 0; k < bursts * kQuarters * each; ++k) {
    const double phase = (static_cast<double>(k) + 0.5) / quarters;
    while (i + 2 < turns.size() && turns[i + 1] < phase) ++i;
    const double step = turns[i + 1] - turns[i];
    const double share = step > 0.0 ? (phase - turns[i]) / step : 0.0;
    out.push_back(static_cast<double>(i) + std::clamp(share, 0.0, 1.0));
  }
  return out;
}

double product(const Levels& a, const Levels& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double remove(const Levels& column, Levels& from) {
  const double share = product(from, column) / product(column, column);
  for (std::size_t i = 0; i < from.size(); ++i) from[i] -= share * column[i];
  return share;
}

// 1, t, t^2 as far as there are bursts for them, and last (-1)^i: each without what the ones before
// explain (Gram and Schmidt).
std::vector<Levels> columns_of(std::size_t bursts) {
  std::vector<Levels> columns;
  const std::size_t drifts = bursts < 6 ? 1 : bursts < 9 ? 2 : 3;
  for (std::size_t c = 0; c <= drifts; ++c) {
    Levels& column = columns.emplace_back();
    for (std::size_t i = 0; i < bursts; ++i) {
      const double t = static_cast<double>(i) - 0.5 * static_cast<double>(bursts - 1);
      column.push_back(c < drifts ? std::pow(t, static_cast<double>(c)) : i % 2 == 0 ? 1.0 : -1.0);
    }
    for (std::size_t before = 0; before < c; ++before) remove(columns[before], column);
  }
  return columns;
}

// The deviate of the standard normal distribution that is as seldom exceeded as this F of that many
// degrees of freedom (Paulson 1942; Kelly's correction; Abramowitz and Stegun 26.6.15). Good from
// three degrees on.
double normal_deviate(double f, double above, double below) {
  const double a = 2.0 / (9.0 * above), b = 2.0 / (9.0 * below), root = std::cbrt(f);
  const double z = ((1.0 - b) * root - (1.0 - a)) / std::sqrt(b * root * root + a);
  return below < 10.0 ? z * (1.0 + 0.08 * std::pow(z, 4.0) / std::pow(below, 3.0)) : z;
}

// F of the last column: the bands' squares that it explains over those that all leave. Bands are
// not independent: together they count as (tr S)^2 / tr S^2 ones (Box 1954, Ann. Math. Stat. 25,
// 290), S their residues' covariance.
double deviate_of(std::vector<Levels> bands, const std::vector<Levels>& columns) {
  double explained = 0.0, rest = 0.0, squares = 0.0;
  for (Levels& y : bands)
    for (std::size_t c = 0; c < columns.size(); ++c) {
      const double share = remove(columns[c], y);
      if (c + 1 == columns.size()) explained += share * share * product(columns[c], columns[c]);
    }
  for (const Levels& y : bands) {
    rest += product(y, y);
    for (const Levels& other : bands) squares += std::pow(product(y, other), 2.0);
  }
  if (!(rest > 0.0)) return 0.0;
  const double count = rest * rest / squares;
  const auto left = static_cast<double>(columns[0].size() - columns.size());
  return normal_deviate(explained / (rest / left), count, count * left);
}

}  // namespace

Levels turns_of(const std::vector<Levels>& components, double hz) {
  const std::size_t frames = components[0].size();
  const std::vector<Complex> common = common_amplitude(amplitudes_at(components, hz));
  Levels turns(frames);
  double ahead = 0.0;  // of hz t, turns; before the first whole window and after the last as there
  const std::size_t half = (frames - std::min(frames, common.size())) / 2;
  for (std::size_t i = 0; i < frames; ++i) {
    if (i > half && i - half < common.size())
      ahead += std::arg(common[i - half] * std::conj(common[i - half - 1])) / (2.0 * kPi);
    turns[i] = static_cast<double>(i) / kBreathFrames_hz * hz + ahead;
    if (i > 0) turns[i] = std::max(turns[i], turns[i - 1]);
  }
  return turns;
}

double alternation(const std::vector<Levels>& bands, const Levels& turns) {
  constexpr double kNearlyWhole = 0.05;  // of the last turn
  const auto bursts = static_cast<std::size_t>(turns.back() + kNearlyWhole);
  if (bursts < kLeastBursts) return 0.0;
  const auto each = static_cast<std::size_t>(
      std::ceil(static_cast<double>(turns.size()) / static_cast<double>(kQuarters * bursts)));
  const std::vector<double> frames = frames_of(turns, bursts, each);
  const std::vector<Levels> columns = columns_of(bursts);
  double most = 0.0;
  std::vector<Levels> together;
  for (std::size_t quarter = 0; quarter < kQuarters; ++quarter) {
    std::vector<Levels> means;
    for (const Levels& band : bands) {
      Levels& mean = means.emplace_back(bursts, 0.0);
      for (std::size_t burst = 0; burst < bursts; ++burst)
        for (std::size_t k = 0; k < each; ++k)
          mean[burst] += level_at(band, frames[(burst * kQuarters + quarter) * each + k]) /
                         static_cast<double>(each);
    }
    together.insert(together.end(), means.begin(), means.end());
    most = std::max(most, deviate_of(std::move(means), columns));
  }
  return std::max(most, deviate_of(std::move(together), columns));
}

}  // namespace neritic::diver
