// How much of its thrust a propeller near the surface has: it draws air down to it, and what of it
// is out of the water pushes nothing. Pure functions; any thread.
//
// Model, of Minsaas, Thon and Kauczynski (1987), "Influence of ocean environment on thruster
// performance", Proc. Int. Symp. on Propeller and Cavitation, Shanghai: with the shaft h deep and
// the radius R the share of the thrust is
//   1 - 0.675 (1 - 0.769 h / R)^1.258,   0 <= h / R <= 1.3,   1 below: 0.325 with the shaft at the
// surface. 0.769 is 1 / 1.3 rounded; here it is 1 / 1.3, so that the share has no jump at 1.3.
// Above, our own continuation: 0.325 times the submerged share of the disc over the half that is
// submerged at h = 0, down to none where the disc is out. A disc stands e = R sqrt(1 - d_z^2) above
// and below its shaft, d_z the shaft's direction along the vertical; a lying one as far as its
// nozzle is long, half a diameter in all (19A: Oosterveld 1970): e is R / 2 at least.
//
// The paper's are heavily loaded propellers; a lightly loaded one draws less air. Not modelled:
// the time that air takes to come and go, a propeller's speed, torque, and its distance to the
// hull.
#pragma once

namespace neritic::rov {

inline constexpr double kVentilatedRadii = 1.3;
inline constexpr double kLargestPropeller_m = 20.0;  // that a vehicle may have

// The share, 0 to 1. depth_m: of the shaft under the surface where it is, negative in air;
// shaft_down: the vertical component of the unit vector along it. A radius of 0 is in the water or
// in the air. Where a number is NaN the share is 1.
double thrust_share(double depth_m, double radius_m, double shaft_down);

}  // namespace neritic::rov
