#include "diver/lungs.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace neritic::diver {
namespace {

constexpr double kAirHeat = kGasConstant * kTankTemperature_k;
// Uptake follows demand within a minute (Whipp and Wasserman 1972, J. Appl. Physiol. 33, 351).
constexpr double kOxygenLag_s = 35.0;
constexpr double kEquivalent = 25.0;
// Values of a man of 75 kg at the surface, for minutes.
constexpr double kMostVentilation_l_min = 110.0;
// No breath is faster: peak flow through a regulator.
constexpr double kMostFlow_m3_s = 8e-3;
// Overpressure that a full lung bears (Schaefer et al. 1958: 80 mmHg).
constexpr double kMostStretch_pa = 10.7e3;

double gas_density(const GasMix& mix, double ambient_pa) {
  return ambient_pa * molar_mass(mix) / kAirHeat;
}

double size_of(const Body& body) {
  return body.lungs.total_m3 / LungSizes{}.total_m3;
}

void hold_breath(const Body& body, LungState& lungs, double ambient_pa, double dt_s) {
  if (lungs.held_moles == 0.0) lungs.held_moles = lungs.volume_m3 * ambient_pa / kAirHeat;
  // Full, they stretch no further but press; what is over leaves by force.
  const double most = body.lungs.total_m3 * (ambient_pa + kMostStretch_pa) / kAirHeat;
  if (lungs.held_moles > most) {
    lungs.held_moles = most;
    lungs.overstretched_s += dt_s;
  }
  lungs.volume_m3 = std::min(lungs.held_moles * kAirHeat / ambient_pa, body.lungs.total_m3);
}

void count_fed(LungState& lungs, bool fed, double dt_s) {
  lungs.unfed_s = fed ? 0.0 : lungs.unfed_s + dt_s;
  if (!fed) lungs.starved_s += dt_s;
}

}  // namespace

double ventilation_l_min(const Body& body, double oxygen_l_min, const GasMix& mix,
                         double ambient_pa) {
  const double denser = gas_density(mix, ambient_pa) / gas_density(kAir, kSurfacePressure_pa);
  const double most = size_of(body) * kMostVentilation_l_min / std::sqrt(std::max(denser, 0.1));
  return std::min(kEquivalent * oxygen_l_min, most);
}

double tidal_volume(const Body& body, double ventilation_l_min) {
  const double litres = std::clamp(0.8 + 0.06 * (ventilation_l_min - 8.0), 0.5, 2.6);
  return 1e-3 * litres * size_of(body);
}

double middle_of_quiet_breath(const Body& body) {
  return body.lungs.rest_m3 + 0.5 * tidal_volume(body, kEquivalent * kRestingOxygen_l_min);
}

namespace {

// Volumes at the ambient pressure of now.
void breathe(const Body& body, LungState& lungs, TankState& tanks, const BreathInputs& in,
             double ambient_pa, double dt_s, BorrowedTank* borrowed) {
  const GasMix mix = borrowed                    ? borrowed->place.mix
                     : in.tank < body.tank_count ? body.tanks[in.tank].mix
                                                 : kAir;
  const double minute_l = in.ventilation_l_min > 0.0
                              ? in.ventilation_l_min
                              : ventilation_l_min(body, lungs.oxygen_l_min, mix, ambient_pa);
  const double tidal_m3 = tidal_volume(body, minute_l);
  const double turns_s = 1e-3 * minute_l / 60.0 / tidal_m3;
  lungs.phase_rad = std::fmod(lungs.phase_rad + 2.0 * kPi * turns_s * dt_s, 2.0 * kPi);
  // Deeper breaths begin lower, so that the middle stays (Babb et al. 1991, J. Appl. Physiol. 70,
  // 722).
  const double middle = middle_of_quiet_breath(body) + in.bias_m3;
  const double lowest =
      std::clamp(middle - 0.5 * tidal_m3, body.lungs.residual_m3,
                 std::max(body.lungs.residual_m3, body.lungs.total_m3 - tidal_m3));
  const double wanted = lowest + 0.5 * tidal_m3 * (1.0 - std::cos(lungs.phase_rad));
  const double change =
      std::clamp(wanted - lungs.volume_m3, -kMostFlow_m3_s * dt_s, kMostFlow_m3_s * dt_s);
  if (change <= 0.0) {
    lungs.volume_m3 += change;  // breathed out into the water
    if (lungs.unfed_s > 0.0) lungs.unfed_s += dt_s;
    return;
  }
  // Without a tank there is only what is above the water.
  if (body.tank_count == 0 && !borrowed) {
    const bool above = ambient_pa <= body.surface_pa;
    if (above) lungs.volume_m3 += change;
    count_fed(lungs, above, dt_s);
    return;
  }
  const double moles = change * ambient_pa / kAirHeat;
  const double given = borrowed
                           ? breathe_tank(borrowed->place, borrowed->moles, moles, ambient_pa, dt_s)
                           : breathe_from(body, tanks, in.tank, moles, ambient_pa, dt_s);
  if (borrowed) borrowed->taken_moles += given;
  lungs.volume_m3 += given * kAirHeat / ambient_pa;
  lungs.breathed_moles += given;
  count_fed(lungs, given >= 0.5 * moles, dt_s);
}

}  // namespace

void step_lungs(const Body& body, LungState& lungs, TankState& tanks, const BreathInputs& in,
                double ambient_pa, double dt_s, BorrowedTank* borrowed) {
  lungs.oxygen_l_min +=
      (in.oxygen_demand_l_min - lungs.oxygen_l_min) * -std::expm1(-dt_s / kOxygenLag_s);
  if (in.hold) {
    hold_breath(body, lungs, ambient_pa, dt_s);
    return;
  }
  // Gas that is not renewed follows Boyle's law; what the lungs cannot hold leaves by the mouth.
  if (lungs.held_moles > 0.0)
    lungs.volume_m3 = std::min(lungs.held_moles * kAirHeat / ambient_pa, body.lungs.total_m3);
  breathe(body, lungs, tanks, in, ambient_pa, dt_s, borrowed);
  lungs.held_moles = lungs.unfed_s > 0.0 ? lungs.volume_m3 * ambient_pa / kAirHeat : 0.0;
}

double remaining_s(const Body& body, const TankState& tanks, std::size_t tank,
                   double ventilation_l_min, double ambient_pa, double reserve_pa) {
  if (tank >= body.tank_count) return 0.0;
  const TankPlace& place = body.tanks[tank];
  const double floor = moles_in(place.mix, place.water_volume_m3, std::max(reserve_pa, ambient_pa));
  const double moles_s = 1e-3 * ventilation_l_min / 60.0 * ambient_pa / kAirHeat;
  const double left = std::max(0.0, tanks.moles[tank] - floor);
  if (left > 0.0 && !(moles_s > 0.0)) return std::numeric_limits<double>::infinity();
  return left > 0.0 ? left / moles_s : 0.0;
}

}  // namespace neritic::diver
