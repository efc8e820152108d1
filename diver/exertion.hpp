// The cost to a person of the limbs' work, and how it tires: metabolic power, oxygen, and the
// reserve of work above the critical power. Pure functions; any thread.
#pragma once

#include "diver/limits.hpp"

namespace neritic::diver {

// At rest.
inline constexpr double kRestingOxygen_l_min = 0.32;
// Heat of a litre of oxygen, J (di Prampero 1986, Int. J. Sports Med. 7, 55).
inline constexpr double kJoulePerLitre = 20900.0;

struct Fitness {
  // Most oxygen that the person takes up, l/min; 0: 45 ml a minute for each kg, which commercial
  // divers are asked for (HSE MA1).
  double most_oxygen_l_min = 0.0;
  // The share of it above which work tires: 0.70 to 0.80 of most people (Poole et al. 2016, Med.
  // Sci. Sports Exerc. 48, 2320).
  double critical_share = 0.75;
  // W', mechanical work above the critical power until exhaustion (16.0 kJ: Vanhatalo et al. 2007,
  // Med. Sci. Sports Exerc. 39, 548).
  double reserve_j = 16e3;
  bool tires = true;
};
inline constexpr Bounds kMostOxygenUptake_l_min{1.0, 8.0}, kCriticalShare{0.4, 0.95},
    kWorkReserve_j{1e3, 1e5};

// An error names the first value that is outside.
Status check_fitness(const Fitness& fitness);
double usual_most_oxygen_l_min(double mass_kg);

// Watts above rest that the limbs' work costs. work_w: mechanical, on the water and elsewhere;
// moving_w: to speed limbs up (LimbWork, motion.hpp).
double metabolic_power_w(double work_w, double moving_w);
// The work that costs as much as heat which muscles make by shivering.
double work_of_heat_w(double heat_w);
double oxygen_for_l_min(double metabolic_w);

// Metabolic watts above rest that the person keeps up for long; and at most, the rest of the
// reserve left. The excess over the critical power falls with the reserve (Morton 1996, Ergonomics
// 39, 611).
double critical_power_w(const Fitness& fitness);
double strongest_power_w(const Fitness& fitness, double spent_j);

// The spent part of the reserve, metabolic joule, after dt_s: above the critical power P_c it grows
// by P - P_c, below it falls at the rate (P_c - P) / W' (Skiba et al. 2015, Eur. J. Appl. Physiol.
// 115, 703).
double spent_after(const Fitness& fitness, double spent_j, double metabolic_w, double dt_s);
double reserve_share(const Fitness& fitness, double spent_j);  // 1: rested, 0: exhausted

// Oxygen that such work asks for, l/min, at most most_oxygen_l_min. A tired person takes up more
// for the same work, above the critical power up to the most (the slow component: Poole et al.
// 1988, Ergonomics 31, 1265); below it in proportion to the work.
double oxygen_demand_l_min(const Fitness& fitness, double metabolic_w, double spent_j);

}  // namespace neritic::diver
