#include "diver/gear.hpp"

#include "diver/limits.hpp"

namespace neritic::diver {

Status check_gear(const Gear& gear) {
  if (gear.suit) NERITIC_TRY_STATUS(check_limits({{"suit", gear.suit->thickness_m, 0.0, 0.012}}));
  if (gear.fins)
    NERITIC_TRY_STATUS(check_limits({{"fin length", gear.fins->length_m, 0.01, 1.2},
                                     {"fin width", gear.fins->width_m, 0.02, 1.0},
                                     {"fin angle", gear.fins->angle_rad, -0.6, 0.6},
                                     {"fin mass", gear.fins->mass_kg, 0.01, 10.0},
                                     {"fin volume", gear.fins->volume_m3, 0.0, 0.01}}));
  if (gear.tanks.size() > kMaxTanks)
    return bad_input("tanks: {} found, up to {} are accepted", gear.tanks.size(), kMaxTanks);
  for (const Tank& tank : gear.tanks) {
    NERITIC_TRY_STATUS(check_limits({{"tank volume", tank.water_volume_m3, 1e-4, 0.05},
                                     {"tank mass", tank.empty_mass_kg, 0.1, 100.0},
                                     {"tank outer volume", tank.outer_volume_m3, 1e-4, 0.1},
                                     {"tank radius", tank.radius_m, 0.01, 0.3},
                                     {"tank length", tank.length_m, 0.05, 1.5},
                                     {"tank pressure", tank.pressure_pa, 0.0, 350e5}}));
    if (!is_mix(tank.mix))
      return bad_input("tank gas: oxygen {} and helium {} found, shares of 1 are accepted",
                       tank.mix.oxygen, tank.mix.helium);
  }
  if (gear.jacket)
    NERITIC_TRY_STATUS(check_limits({{"jacket capacity", gear.jacket->capacity_m3, 1e-3, 0.06},
                                     {"jacket mass", gear.jacket->mass_kg, 0.0, 20.0}}));
  if (gear.lead_kg) NERITIC_TRY_STATUS(check_limits({{"lead", *gear.lead_kg, 0.0, 60.0}}));
  if (gear.lead_at_shoulders)
    NERITIC_TRY_STATUS(
        check_limits({{"lead at the shoulders", *gear.lead_at_shoulders, 0.0, 1.0}}));
  if (gear.drag_area_m2)
    NERITIC_TRY_STATUS(check_limits({{"drag area", *gear.drag_area_m2, 0.0, 5.0}}));
  return {};
}

}  // namespace neritic::diver
