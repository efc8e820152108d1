// The ZH-L16 model's numbers: 16 compartments, each with a half-time and with coefficients a and b
// of the pressure that it tolerates, for nitrogen and helium. Plain values; any thread.
//
// Sources: A. A. Buehlmann, Tauchmedizin (4th ed. 1995), table 25: half-times, b, and the columns
// A, B, C of nitrogen's a; helium's and compartment 1b as collected by E. C. Baker, Understanding
// M-values (1998). Compartment 1 exists twice: 4 min, or 1b of 5 min. Programs that name the
// same model differ in that.
#pragma once

#include <array>
#include <cstddef>

namespace neritic::diver {

inline constexpr std::size_t kCompartments = 16;
using Compartments = std::array<double, kCompartments>;

enum class BuehlmannTable { kB, kC };          // B for printed tables, C for computers
enum class FirstCompartment { k4Min, k5Min };  // 1 or 1b

// Coefficients of one inert gas.
struct InertGas {
  Compartments half_time_min, a_bar, b;
  Compartments rate_min;  // ln 2 / half-time
};

struct Buehlmann {
  InertGas n2, he;
  // Water vapour in the lungs, bar: takes the place of that much breathing gas.
  double water_vapour_bar = 0.0627;
  // How much faster than by its half-time a compartment takes up gas, and gives it off. 1.1 and 0.9
  // are what some dive computers add for safety.
  double saturation = 1.0, desaturation = 1.0;
};

Buehlmann buehlmann(BuehlmannTable table, FirstCompartment first, double water_vapour_bar);

}  // namespace neritic::diver
