// Signals made for tests: an ECG of given intervals.
#pragma once

#include <cmath>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/random.hpp"

namespace neritic::test {

// Waves of an ECG around a beat at 0, millivolts: P, Q, R, S, T as Gaussian bumps (McSharry 2003,
// IEEE Trans. Biomed. Eng. 50, 289, of about those places and sizes).
inline double ecg_wave(double t_s) {
  constexpr double kWaves[][3] = {{-0.17, 0.15, 0.025},
                                  {-0.025, -0.12, 0.010},
                                  {0.0, 1.1, 0.011},
                                  {0.028, -0.22, 0.010},
                                  {0.27, 0.3, 0.045}};
  double sum = 0.0;
  for (const auto& [at_s, height, width_s] : kWaves)
    sum += height * std::exp(-0.5 * std::pow((t_s - at_s) / width_s, 2.0));
  return sum;
}

inline std::vector<double> ecg_of(const std::vector<double>& beats_s, double rate_hz,
                                  double seconds) {
  std::vector<double> out(static_cast<std::size_t>(seconds * rate_hz), 0.0);
  for (const double beat_s : beats_s) {
    const auto from = static_cast<std::int64_t>((beat_s - 0.5) * rate_hz);
    const auto to = static_cast<std::int64_t>((beat_s + 0.6) * rate_hz);
    for (std::int64_t i = std::max<std::int64_t>(from, 0);
         i <= to && i < static_cast<std::int64_t>(out.size()); ++i)
      out[static_cast<std::size_t>(i)] += ecg_wave(static_cast<double>(i) / rate_hz - beat_s);
  }
  return out;
}

inline std::vector<double> even_beats(double interval_s, double seconds) {
  std::vector<double> out;
  for (double t = 0.4; t < seconds - 0.3; t += interval_s) out.push_back(t);
  return out;
}

// Normal deviates, by Box and Muller 1958.
inline double gauss(const RandomKey& key, std::uint64_t i) {
  const double u = 1.0 - random_uniform(key, 2 * i), v = random_uniform(key, 2 * i + 1);
  return std::sqrt(-2.0 * std::log(u)) * std::cos(2.0 * kPi * v);
}

}  // namespace neritic::test
