#include "sonar/acoustics_pulse.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>

#include "engine/core/math.hpp"
#include "engine/core/refusal.hpp"

namespace neritic::sonar {
namespace {

double sinc(double x) {
  const double a = kPi * x;
  return std::abs(a) < 1e-8 ? 1.0 : std::sin(a) / a;
}

// Sine and cosine integrals of z > 0: Si(z) and Cin(z) = gamma + ln z - Ci(z), both 0 at 0.
// DLMF 6.2 (definitions), 6.6 (series), 6.9.1 (continued fraction of E1, here of E1(iz)).
struct Integrals {
  double si = 0.0, cin = 0.0;
};

Integrals integrals_by_series(double z) {
  Integrals sum;
  double term = 1.0;  // z^n / n!, alternating in pairs
  for (int n = 1; n < 60 && std::abs(term) > 1e-18; ++n) {
    term *= z / n;
    const double sign = (n / 2) % 2 == 0 ? 1.0 : -1.0;
    if (n % 2 == 1)
      sum.si += sign * term / n;
    else
      sum.cin -= sign * term / n;
  }
  return sum;
}

// E1(w) = e^-w / (w + 1 - 1 / (w + 3 - 4 / (w + 5 - ...))), from the tail upwards.
Integrals integrals_by_fraction(double z) {
  const std::complex<double> w(0.0, z);
  constexpr int kTerms = 200;
  std::complex<double> tail = w + (2.0 * kTerms + 1.0);
  for (int n = kTerms; n >= 1; --n) tail = w + (2.0 * n - 1.0) - double(n) * n / tail;
  const std::complex<double> e1 = std::exp(-w) / tail;
  // E1(iz) = -Ci(z) + i (Si(z) - pi/2).
  return {kPi / 2.0 + e1.imag(), std::numbers::egamma + std::log(z) + e1.real()};
}

Integrals integrals(double z) {
  return z < 4.0 ? integrals_by_series(z) : integrals_by_fraction(z);
}

// Integral of sinc^2 from 0 to u; odd.
double sinc2_integral(double u) {
  const double a = std::abs(u);
  if (a < 1e-9) return u;
  const double sine = std::sin(kPi * a);
  const double value = integrals(2.0 * kPi * a).si / kPi - sine * sine / (kPi * kPi * a);
  return std::copysign(value, u);
}

// Integral of sin^2(pi t) / (pi^2 t) from 0 to u; even.
double log_integral(double u) {
  const double a = std::abs(u);
  return a == 0.0 ? 0.0 : integrals(2.0 * kPi * a).cin / (2.0 * kPi * kPi);
}

// The pulse's energy in resolutions: that of a flat one is 1.
double length(PulseShape shape) {
  return shape == PulseShape::kFlat ? 1.0 : 1.5;
}

// Share of the energy between 0 and x resolutions; odd, one half at infinity. The Hann envelope is
// sin(pi x) / pi * (1/x - 1/2 / (x-1) - 1/2 / (x+1)); squared, in partial fractions.
double energy_from_zero(PulseShape shape, double x) {
  if (std::isinf(x)) return std::copysign(0.5, x);
  if (shape == PulseShape::kFlat) return sinc2_integral(x);
  return (sinc2_integral(x) + 0.25 * (sinc2_integral(x - 1.0) + sinc2_integral(x + 1.0)) +
          0.75 * (log_integral(x + 1.0) - log_integral(x - 1.0))) /
         length(shape);
}

// Integral of energy_from_zero from 0 to x, by parts; even. The first moment of the Hann envelope's
// power follows from the same partial fractions.
double energy_integral(PulseShape shape, double x) {
  double moment = log_integral(x);
  if (shape == PulseShape::kHann)
    moment += log_integral(1.0) - 0.5 * (log_integral(x - 1.0) + log_integral(x + 1.0)) +
              0.25 * (sinc2_integral(x - 1.0) - sinc2_integral(x + 1.0)) +
              0.5 * sinc2_integral(1.0);
  return x * energy_from_zero(shape, x) - moment / length(shape);
}

// Share between a point in bin 0 and the far edge of the k-th bin out; bin: in resolutions.
double energy_to_edge(PulseShape shape, PlaceInBin place, double k, double bin) {
  if (place == PlaceInBin::kMiddle) return energy_from_zero(shape, (k + 0.5) * bin);
  return (energy_integral(shape, (k + 1.0) * bin) - energy_integral(shape, k * bin)) / bin;
}

double envelope(PulseShape shape, double x) {
  return shape == PulseShape::kFlat ? sinc(x) : sinc(x) + 0.5 * (sinc(x - 1.0) + sinc(x + 1.0));
}

Status positive(const char* what, double value) {
  if (value > 0.0 && std::isfinite(value)) return {};
  return refusal(fmt::format("range_spread: {}", what), fmt::format("{}", value),
                 "a positive number");
}

}  // namespace

double range_resolution_m(double sound_speed_m_s, double bandwidth_hz) {
  return sound_speed_m_s / (2.0 * bandwidth_hz);
}

double pulse_envelope(PulseShape shape, double offset_m, double resolution_m) {
  return envelope(shape, offset_m / resolution_m);
}

double pulse_length_m(PulseShape shape, double resolution_m) {
  return length(shape) * resolution_m;
}

double pulse_energy_below(PulseShape shape, double offset_m, double resolution_m) {
  return 0.5 + energy_from_zero(shape, offset_m / resolution_m);
}

Result<RangeSpread> range_spread(PulseShape shape, double resolution_m, double bin_m,
                                 double max_truncated, PlaceInBin place) {
  NERITIC_TRY_STATUS(positive("resolution", resolution_m));
  NERITIC_TRY_STATUS(positive("bin", bin_m));
  if (!(max_truncated > 0.0 && max_truncated < 1.0))
    return refusal("range_spread", fmt::format("truncation {}", max_truncated),
                   "a number in (0, 1)");
  const double bin = bin_m / resolution_m;
  // edges[k]: share between the point and the far edge of the k-th bin out.
  std::vector<double> edges;
  do {
    if (edges.size() > kMaxReach)
      return refusal(
          "range_spread",
          fmt::format("a pulse of {:g} m (c / 2B), which spreads over more than {} bins of {:g} m",
                      resolution_m, kMaxReach, bin_m),
          "more bandwidth_hz, or fewer range bins");
    edges.push_back(energy_to_edge(shape, place, static_cast<double>(edges.size()), bin));
  } while (1.0 - 2.0 * edges.back() > max_truncated);

  RangeSpread spread;
  spread.reach = static_cast<std::uint32_t>(edges.size() - 1);
  spread.truncated = std::max(0.0, 1.0 - 2.0 * edges.back());
  spread.pulse_bins = length(shape) / bin;
  spread.energy.resize(2 * std::size_t{spread.reach} + 1);
  spread.amplitude.resize(spread.energy.size());
  for (std::uint32_t k = 0; k <= spread.reach; ++k) {
    const double share = k == 0 ? 2.0 * edges[0] : std::max(0.0, edges[k] - edges[k - 1]);
    const double energy = share / (2.0 * edges.back());
    const double amplitude = std::copysign(std::sqrt(energy), envelope(shape, k * bin));
    spread.energy[spread.reach - k] = spread.energy[spread.reach + k] = energy;
    spread.amplitude[spread.reach - k] = spread.amplitude[spread.reach + k] = amplitude;
  }
  return spread;
}

}  // namespace neritic::sonar
