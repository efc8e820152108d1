// Whether the tanks hold what the way up takes: a dive computer's view that counts on no gas that
// does not last. Pure functions without allocation; any thread.
#pragma once

#include "diver/deco_live.hpp"
#include "diver/tanks.hpp"

namespace neritic::diver {

struct AscentGas {
  DiveComputerView view;
  // Litres at 1 bar of the tank in use: needed for the ascent, and available.
  double needed_l = 0.0, there_l = 0.0;
  // Bits of tanks: of those that do not hold their share of the way up, or give no full breath.
  std::uint64_t too_small = 0;
  bool enough() const { return needed_l <= there_l; }
};

// The computer's gases are the body's tanks, as diver files make them. Gas for the ascent whose
// tank does not hold its share is left out, and the other gases are breathed longer. The rate is in
// litres a minute at ambient pressure.
AscentGas ascent_gas(const DiveComputer& computer, const DiveComputerState& state, const Body& body,
                     const TankState& tanks, double litres_a_minute);

}  // namespace neritic::diver
