#include "rov/navigation_water.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::rov {
namespace {

// Depths at which the scale is compared, as parts of the deepest.
constexpr int kDepths = 16;
// A vehicle of an observation class rises or sinks at up to this speed, for about this time before
// it turns or levels.
constexpr double kVertical_m_s = 0.5, kVertical_s = 5.0;

}  // namespace

double told_depth_m(const PressureSensor& sensor, const SensorWater& water, double depth_m) {
  return (water.pressure_pa(depth_m) - sensor.surface_pa.value_or(water.air_pa)) /
         (sensor.water_kg_m3 * sensor.gravity_m_s2);
}

void allow_for_water(const SensorWater& water, double deepest_m, NavigationModel& model) {
  if (!model.pressure) return;
  const double zero_m = told_depth_m(*model.pressure, water, 0.0);
  const double to_m = std::max(deepest_m, 1.0);
  double scale = 0.0, least = 1e300, most = 0.0, above_m = 0.0;
  for (int i = 1; i <= kDepths; ++i) {
    const double depth_m = to_m * i / kDepths;
    const double told_m = told_depth_m(*model.pressure, water, depth_m) - zero_m;
    scale = std::max(scale, std::abs(told_m / depth_m - 1.0));
    const double local = (told_m - above_m) / (to_m / kDepths);
    least = std::min(least, local);
    most = std::max(most, local);
    above_m = told_m;
  }
  const double drift_m_s = (most - least) * kVertical_m_s;
  model.bias_variance[kPressureBias - kFirstBias] += zero_m * zero_m;
  model.bias_variance[kPressureScale - kFirstBias] += scale * scale;
  model.motion.walk[kPressureBias - kFirstBias] += drift_m_s * drift_m_s * kVertical_s;
}

}  // namespace neritic::rov
