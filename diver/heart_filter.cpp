#include "diver/heart_filter.hpp"

#include <cmath>
#include <complex>

#include "engine/core/math.hpp"

namespace neritic::diver {
namespace {

constexpr double kHalfLength_s = 0.2;

// Impulse response of an ideal low pass at t.
double low_pass_tap(double cut_hz, double t_s) {
  const double x = 2.0 * kPi * cut_hz * t_s;
  return std::abs(x) < 1e-12 ? 2.0 * cut_hz : 2.0 * cut_hz * std::sin(x) / x;
}

}  // namespace

std::vector<double> qrs_band_taps(double rate_hz) {
  const int half = static_cast<int>(std::lround(kHalfLength_s * rate_hz));
  std::vector<double> taps, window;
  double sum = 0.0, window_sum = 0.0;
  for (int i = -half; i <= half; ++i) {
    window.push_back(0.54 + 0.46 * std::cos(kPi * i / (half + 1.0)));
    taps.push_back(window.back() * (low_pass_tap(kQrsHigh_hz, i / rate_hz) -
                                    low_pass_tap(kQrsLow_hz, i / rate_hz)));
    sum += taps.back();
    window_sum += window.back();
  }
  // A constant is to vanish, and the band's middle to pass as it is.
  std::complex<double> middle = 0.0;
  const double middle_hz = std::sqrt(kQrsLow_hz * kQrsHigh_hz);
  for (int i = -half; i <= half; ++i) {
    double& tap = taps[static_cast<std::size_t>(i + half)];
    tap -= sum / window_sum * window[static_cast<std::size_t>(i + half)];
    middle += tap * std::polar(1.0, 2.0 * kPi * middle_hz * i / rate_hz);
  }
  for (double& tap : taps) tap /= std::abs(middle);
  return taps;
}

}  // namespace neritic::diver
