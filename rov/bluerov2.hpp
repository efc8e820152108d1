// The BlueROV2 Heavy's published parameters, for use without a file. Equal to those of
// assets/vehicles/bluerov2_heavy_dynamics.toml and its variants. Any thread.
#pragma once

#include "rov/vehicle.hpp"

namespace neritic::rov {

// From the parameters' source, used with them: von Benzon et al. 2022.
inline constexpr double kGravity = 9.82;                               // m/s^2
inline constexpr double kSeaDensity = 1028.0, kFreshDensity = 1000.0;  // kg/m^3

// von Benzon et al. 2022 (JMSE 10(12):1898), in water of this density. Centres 1 cm apart: surge
// above 15.6 N without pitch compensation overturns it.
VehicleParameters bluerov2_heavy(double water_kg_m3 = kSeaDensity);
// The same with centres 3 cm apart, for flying by hand: righting moment up to 4 N m.
VehicleParameters bluerov2_heavy_manual(double water_kg_m3 = kSeaDensity);
// Wu 2018 (as in OsloMet's BlueRov_m_script.m), without thrusters of its own set: those above.
VehicleParameters bluerov2_wu2018();

// The eight thrusters: four horizontal at 45 degrees, four vertical; 1 to 4 and 5 to 8 are front
// right, front left, rear right, rear left. Forces of a T200 at 16 V.
std::vector<Thruster> heavy_thrusters();
inline constexpr double kT200Min16V = -39.908, kT200Max16V = 51.436;  // N, Blue Robotics 2019

// Polynomial of the thrust of one motor against its normalised input V in [-1, 1], N (von Benzon
// et al. 2022). It is not monotone: it falls beyond |V| = 0.97.
double von_benzon_thrust_n(double input);

}  // namespace neritic::rov
