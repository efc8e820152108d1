#include "diver/buehlmann.hpp"

#include <numbers>

namespace neritic::diver {
namespace {

// Compartments 2 to 16; the first is one of two.
using Rest = std::array<double, kCompartments - 1>;
constexpr Rest kN2HalfTime_min{8,   12.5, 18.5, 27,  38.3, 54.3, 77, 109,
                               146, 187,  239,  305, 390,  498,  635};
constexpr Rest kN2A_B{1.0000, 0.8618, 0.7562, 0.6667, 0.5600, 0.4947, 0.4500, 0.4187,
                      0.3798, 0.3497, 0.3223, 0.2850, 0.2737, 0.2523, 0.2327};
constexpr Rest kN2A_C{1.0000, 0.8618, 0.7562, 0.6200, 0.5043, 0.4410, 0.4000, 0.3750,
                      0.3500, 0.3295, 0.3065, 0.2835, 0.2610, 0.2480, 0.2327};
constexpr Rest kN2B{0.6514, 0.7222, 0.7825, 0.8126, 0.8434, 0.8693, 0.8910, 0.9092,
                    0.9222, 0.9319, 0.9403, 0.9477, 0.9544, 0.9602, 0.9653};
constexpr Rest kHeHalfTime_min{3.02,  4.72,  6.99,  10.21,  14.48,  20.53,  29.11, 41.20,
                               55.19, 70.69, 90.34, 115.29, 147.42, 188.24, 240.03};
constexpr Rest kHeA{1.3830, 1.1919, 1.0458, 0.9220, 0.8205, 0.7305, 0.6502, 0.5950,
                    0.5545, 0.5333, 0.5189, 0.5181, 0.5176, 0.5172, 0.5119};
constexpr Rest kHeB{0.5747, 0.6527, 0.7223, 0.7582, 0.7957, 0.8279, 0.8553, 0.8757,
                    0.8903, 0.8997, 0.9073, 0.9122, 0.9171, 0.9217, 0.9267};

Compartments with_first(double first, const Rest& rest) {
  Compartments all{first};
  for (std::size_t i = 0; i < rest.size(); ++i) all[i + 1] = rest[i];
  return all;
}

InertGas inert_gas(double half_time_min, const Rest& half_times_min, double a, const Rest& as,
                   double b, const Rest& bs) {
  InertGas gas{with_first(half_time_min, half_times_min), with_first(a, as), with_first(b, bs), {}};
  for (std::size_t i = 0; i < kCompartments; ++i)
    gas.rate_min[i] = std::numbers::ln2 / gas.half_time_min[i];
  return gas;
}

}  // namespace

Buehlmann buehlmann(BuehlmannTable table, FirstCompartment first, double water_vapour_bar) {
  const bool slow = first == FirstCompartment::k5Min;
  Buehlmann model;
  model.n2 = inert_gas(slow ? 5.0 : 4.0, kN2HalfTime_min, slow ? 1.1696 : 1.2599,
                       table == BuehlmannTable::kB ? kN2A_B : kN2A_C, slow ? 0.5578 : 0.5050, kN2B);
  model.he = inert_gas(slow ? 1.88 : 1.51, kHeHalfTime_min, slow ? 1.6189 : 1.7424, kHeA,
                       slow ? 0.4770 : 0.4245, kHeB);
  model.water_vapour_bar = water_vapour_bar;
  return model;
}

}  // namespace neritic::diver
