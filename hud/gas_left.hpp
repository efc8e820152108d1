// How long the gas lasts, by the breathing of the last minute: a single breath does not change it.
// The mean is of what is breathed at the surface's pressure, so that a change of depth counts at
// once. A plain value without allocation; any thread.
#pragma once

#include "hud/dive_data.hpp"

namespace neritic::hud {

// Time constant of the mean, s: after this time 63 % of a change is in it.
inline constexpr double kGasMean_s = 60.0;

struct GasLeft {
  double rate = 0.0;    // of the tank's pressure, Pa a minute and bar of ambient pressure
  double mean_s = 0.0;  // the time that the mean is of so far
  double time_s = 0.0, tank_pa = 0.0;
  diver::GasMix gas;

  // A time before the last one, another tank or another gas begin anew.
  void add(const DiveData& data);
  // Minutes until the reserve. As in the data where it says 0 or nothing is known.
  double minutes(const DiveData& data) const;
};

}  // namespace neritic::hud
