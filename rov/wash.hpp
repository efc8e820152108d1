// The wash of a thruster: a round turbulent jet against its thrust. Pure functions; any thread.
// North, east, down, or any other axes.
//
// Model. A jet of diameter D leaves with the momentum flux of the thrust T, at u_0 = sqrt(4 T / (pi
// rho D^2)). Its speed on the axis is u_0 up to 6.2 D and 6.2 u_0 D / x beyond (Rajaratnam 1976,
// "Turbulent Jets", ch. 2: 6.2 to 6.3), its profile u_c exp(-ln 2 (r / b)^2). The half width b
// follows from the momentum, which stays T:
//   b = sqrt(2 ln 2 T / (pi rho u_c^2)),  far off 0.0950 x: measured 0.094 to 0.096 (Hussein, Capp
//   and
// George 1994, J. Fluid Mech. 258, 31).
// Not modelled: swirl, the inflow ahead of the thruster, bending by a current, a wall in the way.
#pragma once

#include "engine/core/math.hpp"

namespace neritic::rov {

struct WashJet {
  Vec3 from_m{0.0};
  Vec3 along{1.0, 0.0, 0.0};  // unit: where the water goes
  double thrust_n = 0.0;      // against along; not negative
  double diameter_m = 0.076;
};
inline constexpr double kJetDecay = 6.2;

double jet_exit_m_s(const WashJet& jet, double water_kg_m3);
// On the axis, x from the thruster; 0 ahead of it.
double jet_axis_m_s(const WashJet& jet, double x_m, double water_kg_m3);
double jet_half_width_m(const WashJet& jet, double x_m, double water_kg_m3);
// The velocity of the water at a point, by this jet alone.
Vec3 jet_velocity_m_s(const WashJet& jet, const Vec3& point_m, double water_kg_m3);

// How much more thrust a jet towards a wall gives at a distance z of its disc of radius D / 2: 1 /
// (1
// - (D / 8 z)^2) (Cheeseman and Bennett 1955, ARC R&M 3021, of rotors above ground), z at least D /
// 2: at most 1.067.
double ground_effect(double diameter_m, double distance_m);

}  // namespace neritic::rov
