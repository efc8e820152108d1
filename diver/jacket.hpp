// The buoyancy jacket: gas in a bladder behind the trunk, where it lies there, and what its valves
// let in and out by difference of pressure. Axes of the thorax: forward (to the head), starboard,
// down (to the chest). Pure functions; any thread.
#pragma once

#include <cstdint>

#include "diver/tanks.hpp"

namespace neritic::diver {

// Buttons that are pressed: bits. Dump is the cord of the higher one of two valves, at the shoulder
// and low on the back (where the relief valve is): a diver pulls the one that the gas lies at.
inline constexpr std::uint64_t kInflate = 1, kDeflate = 2, kDump = 4;
inline constexpr std::uint64_t kAllButtons = kInflate | kDeflate | kDump;

// How the thorax is in the water.
struct ThoraxPlace {
  Vec3 up{0.0, 0.0, -1.0};  // unit, thorax axes
  double depth_m = 0.0;     // of the thorax's origin
};

// The gas: a cap of the bladder's ellipsoid cut level, at its highest place.
struct JacketGas {
  double volume_m3 = 0.0;
  double pressure_pa = 0.0;  // over ambient only where the bladder is full
  double ambient_pa = 0.0;   // of the water at the gas's lower side
  Vec3 centre_m{0.0};        // of its lift
  double bottom_m = 0.0;     // its lower side above the thorax's origin
};
JacketGas jacket_gas(const Body& body, double moles, const ThoraxPlace& place);

// Whether there is gas that a dump would let out.
bool gas_at_dump(const Body& body, double moles, const ThoraxPlace& place);

// The gas changes by the flow of the pressed buttons and of the relief valve. The gas that comes
// in is taken from the first tank; dump wins over inflate.
void step_jacket(const Body& body, double& moles, TankState& tanks, std::uint64_t buttons,
                 const ThoraxPlace& place, double dt_s);

// Moles of gas that fill this volume of the bladder there; volume up to its capacity.
double jacket_moles(const Body& body, double volume_m3, const ThoraxPlace& place);

}  // namespace neritic::diver
