// A diver's gear: suit, fins, tanks, jacket, lead. Parameters as a person writes them,
// checked by make_body (body.hpp). Plain values; any thread.
#pragma once

#include <optional>
#include <vector>

#include "diver/gas_mix.hpp"
#include "diver/limits.hpp"
#include "engine/core/math.hpp"
#include "engine/core/result.hpp"

namespace neritic::diver {

// So that a state can be copied as bytes.
inline constexpr std::size_t kMaxTanks = 4;

// Foamed neoprene. Its gas follows Boyle's law, so that half of its volume is gone at 10 m.
struct Suit {
  double thickness_m = 0.005;  // as sold; 0: none
};

// One on each foot, flat, in line with the sole but for an angle.
struct Fins {
  double length_m = 0.40;  // of the blade beyond the toes
  double width_m = 0.20;
  double angle_rad = radians(20.0);  // of the blade away from the sole's plane, towards the sole
  double mass_kg = 0.9;              // of each, foot pocket included
  double volume_m3 = 0.8e-3;
};

// The first is worn on the back, with the second if that is of its size and gas (a twin set: right,
// left); the others at the sides: left, right, left. Aluminium of 80 cubic feet (Luxfer S080: 14.2
// kg, 11.1 litres) with valve and regulator.
struct Tank {
  double water_volume_m3 = 0.0111;  // that gas fills
  double empty_mass_kg = 15.8;
  double outer_volume_m3 = 16.6e-3;
  double radius_m = 0.092, length_m = 0.60;
  GasMix mix = kAir;
  double pressure_pa = 200e5;  // at the start
};

// One of that alloy and shape, of another size.
Tank tank_of(double water_volume_m3);

// A bladder behind the trunk, an ellipsoid when full, and its valves. Places in the thorax's axes,
// for a body of 1.78 m.
struct Jacket {
  double capacity_m3 = 0.018;
  Vec3 centre_m{-0.04, 0.0, -0.16};
  Vec3 half_axes_m{0.22, 0.22, 0.0888};  // of 18 litres; scaled to the capacity
  // Two lobes beside the tank, between which gas goes hardly: of the way to the higher side that it
  // would find in an open ellipsoid it takes this share. All of it would turn divers over.
  double sideways = 0.2;
  double mass_kg = 3.5, volume_m3 = 3.0e-3;  // of the cloth, plate and fittings
  // Effective areas: opening times discharge coefficient. The inflator gives 100 litres of 1 bar a
  // minute at the surface, the deflator some 2.5 litres a second at 10 m, the dump valve 5.
  double inflator_m2 = 0.8e-6;
  double deflator_m2 = 0.5e-4;
  double dump_m2 = 1.5e-4;
  double relief_m2 = 3.0e-4;             // wide open
  double relief_pa = 14e3;               // over ambient, where the relief valve begins to open
  Vec3 hose_root_m{0.14, -0.09, -0.20};  // left shoulder
  double hose_m = 0.30;                  // the mouth is lifted so far above its root
  Vec3 dump_m{0.13, 0.09, -0.203};       // right shoulder
  Vec3 relief_at_m{-0.20, 0.14, -0.16};  // low on the back; its cord dumps too
};

struct Gear {
  std::optional<Suit> suit = Suit{};
  std::optional<Fins> fins = Fins{};
  std::vector<Tank> tanks = std::vector<Tank>(1);
  std::optional<Jacket> jacket = Jacket{};
  // Lead; nothing said: as much as makes the diver neutral with an empty jacket, lungs half full of
  // a quiet breath, and 50 bar in the tanks, at 5 m (0 where that floats no one); without a jacket,
  // with the tanks as they are at the start, at the depth where the dive starts; split between
  // belt and shoulders so that the body lies level at 15 m with 120 bar, and to that side which
  // balances tanks that hang at the other.
  std::optional<double> lead_kg;
  std::optional<double> lead_at_shoulders;  // share, 0 to 1
  // Drag of what is worn, m^2 of C_d A along the body; nothing said: as measured with a tank and a
  // jacket, nothing without (body.cpp).
  std::optional<double> drag_area_m2;
};

// How many of its tanks are worn on the back: 0 to 2.
std::size_t tanks_on_back(const Gear& gear);

// Usual gear, SI.
inline constexpr Bounds kSuitThickness_m{0.0, 0.012};
inline constexpr Bounds kFinLength_m{0.01, 1.2}, kFinWidth_m{0.02, 1.0}, kFinAngle_rad{-0.6, 0.6},
    kFinMass_kg{0.01, 10.0}, kFinVolume_m3{0.0, 0.01};
inline constexpr Bounds kTankVolume_m3{1e-4, 0.05}, kTankMass_kg{0.1, 100.0},
    kTankOuterVolume_m3{1e-4, 0.1}, kTankRadius_m{0.01, 0.3}, kTankLength_m{0.05, 1.5},
    kTankPressure_pa{0.0, 350e5};
inline constexpr Bounds kJacketCapacity_m3{1e-3, 0.06}, kJacketMass_kg{0.0, 20.0},
    kJacketVolume_m3{0.0, 0.02}, kValveArea_m2{0.0, 1e-2}, kJacketRelief_pa{0.0, 1e6},
    kJacketHose_m{0.0, 1.0}, kJacketSideways{0.0, 1.0};
inline constexpr Bounds kLead_kg{0.0, 60.0}, kLeadShare{0.0, 1.0}, kGearDragArea_m2{0.0, 5.0};

// Refuses the first value that is out of range: its name, what was found, what is accepted.
Status check_gear(const Gear& gear);

// A swimmer in trunks.
inline Gear no_gear() {
  Gear gear;
  gear.suit.reset();
  gear.fins.reset();
  gear.tanks.clear();
  gear.jacket.reset();
  gear.lead_kg = 0.0;
  return gear;
}

}  // namespace neritic::diver
