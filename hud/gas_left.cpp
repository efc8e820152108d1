#include "hud/gas_left.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::hud {
namespace {

// No breath takes more at once: a larger step of the gauge is another tank.
constexpr double kOtherTank_pa = 10e5;

double ambient_bar(const DiveData& d) {
  return d.surface_bar + d.bar_per_m * d.depth_m;
}

// Whether the data says how quickly the tank's pressure falls.
bool says_rate(const DiveData& d) {
  return d.gas_min > 0.0 && d.tank_pa > kReserve_pa && ambient_bar(d) > 0.0;
}

}  // namespace

void GasLeft::add(const DiveData& d) {
  if (!says_rate(d)) return;
  const double now = (d.tank_pa - kReserve_pa) / (d.gas_min * ambient_bar(d));
  const bool anew = mean_s == 0.0 || d.time_s < time_s ||
                    std::abs(d.tank_pa - tank_pa) > kOtherTank_pa || !(d.gas == gas);
  const double since_s = anew ? 0.0 : d.time_s - time_s;
  time_s = d.time_s, tank_pa = d.tank_pa, gas = d.gas;
  if (anew) {
    rate = now;
    mean_s = 1e-9;
    return;
  }
  // As long as it is short the plain mean since its start.
  mean_s += since_s;
  rate += std::max(-std::expm1(-since_s / kGasMean_s), since_s / mean_s) * (now - rate);
}

double GasLeft::minutes(const DiveData& d) const {
  if (!says_rate(d) || mean_s == 0.0) return d.gas_min;
  if (!(rate > 0.0)) return std::numeric_limits<double>::infinity();
  return (d.tank_pa - kReserve_pa) / (rate * ambient_bar(d));
}

}  // namespace neritic::hud
