// Breathing: how much air moves for what the body does, breath by breath, through a regulator or
// held. Volumes at ambient pressure and the water's temperature. Pure functions; any thread.
#pragma once

#include <cstdint>

#include "diver/exertion.hpp"
#include "diver/tanks.hpp"

namespace neritic::diver {

struct LungState {
  double volume_m3 = 2.5e-3;   // of gas
  double held_moles = 0.0;     // while the breath is held, or nothing comes to breathe
  double phase_rad = 0.0;      // 0: empty of the tidal volume; breathing in to pi, out to 2 pi
  double oxygen_l_min = 0.32;  // uptake, at standard temperature and pressure, dry
  // Seconds in which the lungs were stretched beyond what they bear, a breath held on ascent: a
  // risk of barotrauma, not an injury. And seconds without enough to breathe.
  double overstretched_s = 0.0, starved_s = 0.0;
  double unfed_s = 0.0;         // since nothing came to breathe; 0 while it does
  double breathed_moles = 0.0;  // from tanks, so far

  static void fields(auto&& field, auto& self) {
    field("volume_m3", self.volume_m3);
    field("held_moles", self.held_moles);
    field("phase_rad", self.phase_rad);
    field("oxygen_l_min", self.oxygen_l_min);
    field("overstretched_s", self.overstretched_s);
    field("starved_s", self.starved_s);
    field("unfed_s", self.unfed_s);
    field("breathed_moles", self.breathed_moles);
  }
};

// Respiratory minute volume, litres of ambient pressure a minute: 25 times the oxygen taken up, as
// far as the chest can move gas that dense (maximal voluntary ventilation falls with the root of
// density: Camporesi and Bosco 2003, "Bennett and Elliott's Physiology", 5th ed., ch. 5).
double ventilation_l_min(const Body& body, double oxygen_l_min, const GasMix& mix,
                         double ambient_pa);

// Volume of one breath for that ventilation; breaths are slower and deeper under water.
double tidal_volume(const Body& body, double ventilation_l_min);

// Gas in the lungs half way through a breath at rest, m^3.
double middle_of_quiet_breath(const Body& body);

struct BreathInputs {
  double oxygen_demand_l_min = kRestingOxygen_l_min;
  double ventilation_l_min = 0.0;  // as measured; 0: follows from oxygen
  double bias_m3 = 0.0;            // mean lung volume less that at rest
  bool hold = false;
  std::size_t tank = 0;
};

// borrowed: breathed from instead of tanks, where there is one.
void step_lungs(const Body& body, LungState& lungs, TankState& tanks, const BreathInputs& inputs,
                double ambient_pa, double dt_s, BorrowedTank* borrowed = nullptr);

// Seconds until the tank is down to reserve_pa (or ambient pressure, where that is more) at that
// ventilation and depth; infinite where nothing is breathed.
double remaining_s(const Body& body, const TankState& tanks, std::size_t tank,
                   double ventilation_l_min, double ambient_pa, double reserve_pa);

}  // namespace neritic::diver
