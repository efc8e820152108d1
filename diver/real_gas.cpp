#include "diver/real_gas.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

// Z - 1 = a p + b p^2 + c p^3, p in bar.
struct Virial {
  double a, b, c;
};
constexpr Virial kOxygen{-7.18090e-4, 2.818511e-6, -1.502886e-9};
constexpr Virial kNitrogen{-2.19269e-4, 2.928516e-6, -2.076252e-9};
constexpr Virial kHelium{4.87295e-4, -8.80840e-8, 5.26362e-11};

double departure(const Virial& v, double bar) {
  return bar * (v.a + bar * (v.b + bar * v.c));
}

}  // namespace

double compressibility(const GasMix& mix, double pressure_pa) {
  const double bar = 1e-5 * std::clamp(pressure_pa, 0.0, kMostGasPressure_pa);
  return 1.0 + mix.oxygen * departure(kOxygen, bar) + mix.nitrogen() * departure(kNitrogen, bar) +
         mix.helium * departure(kHelium, bar);
}

double moles_in(const GasMix& mix, double volume_m3, double pressure_pa) {
  return pressure_pa * volume_m3 /
         (compressibility(mix, pressure_pa) * kGasConstant * kTankTemperature_k);
}

double pressure_of(const GasMix& mix, double volume_m3, double moles) {
  const double ideal_pa = moles * kGasConstant * kTankTemperature_k / volume_m3;
  // Newton's method for p = Z(p) p_ideal by secants of Z; two rounds leave 1e-9 at 300 bar, and the
  // fixed number keeps the bits the same everywhere.
  double low = ideal_pa, at_low = compressibility(mix, low) * ideal_pa - low;
  double p = low + at_low;
  for (int i = 0; i < 6; ++i) {
    const double off = compressibility(mix, p) * ideal_pa - p;
    if (off == at_low || off == 0.0) break;
    const double next = p - off * (p - low) / (off - at_low);
    low = p, at_low = off, p = next;
  }
  return std::max(p, 0.0);
}

}  // namespace neritic::diver
