#include "diver/gear.hpp"

#include <cmath>

#include "engine/core/refusal.hpp"

namespace neritic::diver {

Tank tank_of(double water_volume_m3) {
  Tank tank;
  const double times = water_volume_m3 / tank.water_volume_m3;
  tank.water_volume_m3 = water_volume_m3;
  tank.empty_mass_kg *= times;
  tank.outer_volume_m3 *= times;
  tank.radius_m *= std::cbrt(times);
  tank.length_m *= std::cbrt(times);
  return tank;
}

std::size_t tanks_on_back(const Gear& gear) {
  const auto& tanks = gear.tanks;
  if (tanks.size() < 2) return tanks.size();
  const bool alike = tanks[0].water_volume_m3 == tanks[1].water_volume_m3 &&
                     tanks[0].mix.oxygen == tanks[1].mix.oxygen &&
                     tanks[0].mix.helium == tanks[1].mix.helium;
  return alike ? 2 : 1;
}

Status check_gear(const Gear& gear) {
  if (gear.suit)
    NERITIC_TRY_STATUS(check_limits({{"suit", gear.suit->thickness_m, kSuitThickness_m}}));
  if (gear.fins)
    NERITIC_TRY_STATUS(check_limits({{"fin length", gear.fins->length_m, kFinLength_m},
                                     {"fin width", gear.fins->width_m, kFinWidth_m},
                                     {"fin angle", gear.fins->angle_rad, kFinAngle_rad},
                                     {"fin mass", gear.fins->mass_kg, kFinMass_kg},
                                     {"fin volume", gear.fins->volume_m3, kFinVolume_m3}}));
  if (gear.tanks.size() > kMaxTanks)
    return refusal("tanks", fmt::format("{}", gear.tanks.size()),
                   fmt::format("up to {}", kMaxTanks));
  for (const Tank& tank : gear.tanks) {
    NERITIC_TRY_STATUS(
        check_limits({{"tank volume", tank.water_volume_m3, kTankVolume_m3},
                      {"tank mass", tank.empty_mass_kg, kTankMass_kg},
                      {"tank outer volume", tank.outer_volume_m3, kTankOuterVolume_m3},
                      {"tank radius", tank.radius_m, kTankRadius_m},
                      {"tank length", tank.length_m, kTankLength_m},
                      {"tank pressure", tank.pressure_pa, kTankPressure_pa}}));
    if (!is_mix(tank.mix))
      return refusal("tank gas",
                     fmt::format("oxygen {} and helium {}", tank.mix.oxygen, tank.mix.helium),
                     "shares of 1");
  }
  if (gear.jacket)
    NERITIC_TRY_STATUS(
        check_limits({{"jacket capacity", gear.jacket->capacity_m3, kJacketCapacity_m3},
                      {"jacket mass", gear.jacket->mass_kg, kJacketMass_kg},
                      {"jacket volume", gear.jacket->volume_m3, kJacketVolume_m3},
                      {"jacket inflator", gear.jacket->inflator_m2, kValveArea_m2},
                      {"jacket deflator", gear.jacket->deflator_m2, kValveArea_m2},
                      {"jacket dump valve", gear.jacket->dump_m2, kValveArea_m2},
                      {"jacket relief valve", gear.jacket->relief_m2, kValveArea_m2},
                      {"jacket relief", gear.jacket->relief_pa, kJacketRelief_pa},
                      {"jacket hose", gear.jacket->hose_m, kJacketHose_m},
                      {"jacket sideways", gear.jacket->sideways, kJacketSideways}}));
  if (gear.lead_kg) NERITIC_TRY_STATUS(check_limits({{"lead", *gear.lead_kg, kLead_kg}}));
  if (gear.lead_at_shoulders)
    NERITIC_TRY_STATUS(
        check_limits({{"lead at the shoulders", *gear.lead_at_shoulders, kLeadShare}}));
  if (gear.drag_area_m2)
    NERITIC_TRY_STATUS(check_limits({{"drag area", *gear.drag_area_m2, kGearDragArea_m2}}));
  return {};
}

}  // namespace neritic::diver
