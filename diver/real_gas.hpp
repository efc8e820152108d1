// Gas at the pressures of tanks: how far it is from ideal, and how much of it a tank holds. Pure
// functions; any thread.
#pragma once

#include "diver/gas_mix.hpp"

namespace neritic::diver {

inline constexpr double kGasConstant = 8.31446261815324;  // J/(mol K), SI 2019
inline constexpr double kTankTemperature_k = 293.15;
// Up to here the tables reach; higher pressures count as this for compressibility.
inline constexpr double kMostGasPressure_pa = 500e5;

// Z = p V / (n R T): cubics through the tables of the pure gases at 300 K (Perry's Chemical
// Engineers' Handbook, 7th ed., compressibility factors of O2, N2 and He, up to 500 bar), mixed by
// moles. Within 0.4 % of measured air.
double compressibility(const GasMix& mix, double pressure_pa);

// Moles in a volume at a pressure, and back; at the tank's temperature. Both rise with each other.
double moles_in(const GasMix& mix, double volume_m3, double pressure_pa);
double pressure_of(const GasMix& mix, double volume_m3, double moles);

}  // namespace neritic::diver
