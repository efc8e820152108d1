#include "diver/tanks.hpp"

#include <algorithm>
#include <cmath>

namespace neritic::diver {
namespace {

constexpr double kGamma = 1.4;
constexpr double kChoked = 0.5282817877;      // (2 / (gamma + 1))^(gamma / (gamma - 1))
constexpr double kChokedFlow = 0.6847314564;  // sqrt(gamma) (2 / (gamma + 1))^3
// A demand valve gives 5 litres of ambient pressure a second (EN 250: peaks of 62.5 l/min of
// ventilation are 3.3), less as the tank comes within kWeakTank_pa of ambient.
constexpr double kDemand_m3_s = 5e-3;

// The gas that can leave before the tank reaches that pressure.
double moles_above(const TankPlace& place, double moles, double pressure_pa) {
  return std::max(0.0, moles - moles_in(place.mix, place.water_volume_m3, pressure_pa));
}

}  // namespace

TankState full_tanks(const Body& body) {
  TankState out;
  for (std::size_t i = 0; i < body.tank_count; ++i)
    out.moles[i] =
        moles_in(body.tanks[i].mix, body.tanks[i].water_volume_m3, body.tanks[i].start_pa);
  return out;
}

double tank_pressure(const Body& body, const TankState& tanks, std::size_t tank) {
  if (tank >= body.tank_count) return 0.0;
  return pressure_of(body.tanks[tank].mix, body.tanks[tank].water_volume_m3, tanks.moles[tank]);
}

double breathe_from(const Body& body, TankState& tanks, std::size_t tank, double wanted_moles,
                    double ambient_pa, double dt_s) {
  if (tank >= body.tank_count) return 0.0;
  return breathe_tank(body.tanks[tank], tanks.moles[tank], wanted_moles, ambient_pa, dt_s);
}

double breathe_tank(const TankPlace& place, double& moles, double wanted_moles, double ambient_pa,
                    double dt_s) {
  if (!(wanted_moles > 0.0)) return 0.0;
  const double over_pa = pressure_of(place.mix, place.water_volume_m3, moles) - ambient_pa;
  const double share = std::clamp(over_pa / kWeakTank_pa, 0.0, 1.0);
  const double most =
      share * kDemand_m3_s * dt_s * ambient_pa / (kGasConstant * kTankTemperature_k);
  const double given = std::min({wanted_moles, most, moles_above(place, moles, ambient_pa)});
  moles -= given;
  return given;
}

double flow_from(const Body& body, TankState& tanks, std::size_t tank, double area_m2,
                 double back_pa, double dt_s) {
  if (tank >= body.tank_count) return 0.0;
  const double from_pa = std::min(tank_pressure(body, tanks, tank), back_pa + kHosePressure_pa);
  const double given =
      std::min(dt_s * orifice_moles_s(body.tanks[tank].mix, area_m2, from_pa, back_pa),
               moles_above(body.tanks[tank], tanks.moles[tank], back_pa));
  tanks.moles[tank] -= given;
  return given;
}

std::uint64_t empty_tanks(const Body& body, const TankState& tanks,
                          std::span<const double> ambient_pa) {
  std::uint64_t out = 0;
  for (std::size_t i = 0; i < std::min(body.tank_count, ambient_pa.size()); ++i)
    if (tank_pressure(body, tanks, i) < ambient_pa[i] + kWeakTank_pa) out |= std::uint64_t{1} << i;
  return out;
}

double orifice_moles_s(const GasMix& mix, double area_m2, double from_pa, double to_pa) {
  if (!(from_pa > to_pa)) return 0.0;
  const double ratio = to_pa / from_pa;
  double flow = kChokedFlow;
  if (ratio > kChoked)
    flow = std::sqrt(
        2.0 * kGamma / (kGamma - 1.0) *
        std::max(0.0, std::pow(ratio, 2.0 / kGamma) - std::pow(ratio, (kGamma + 1.0) / kGamma)));
  return area_m2 * from_pa * flow / std::sqrt(molar_mass(mix) * kGasConstant * kTankTemperature_k);
}

}  // namespace neritic::diver
