// Water that moves with a body: coefficients of added mass by potential theory, without the surface
// or other bodies near. Pure functions; any thread.
#pragma once

namespace neritic::diver {

// Coefficients of a prolate spheroid of half axes a > b, as shares of the mass (along, across) and
// of the moment of inertia about a short axis (turning) of the water it displaces. Lamb,
// "Hydrodynamics" (1932), art. 114 and 115. slenderness a/b, over 1; from 1 to 1.0001 it counts
// as 1.0001.
struct SpheroidAddedMass {
  double along = 0.0, across = 0.0, turning = 0.0;
};
SpheroidAddedMass spheroid_added_mass(double slenderness);

// A metre of a long body of elliptic section, kg/m, moving along one axis of the section: its half
// width across that motion counts (Lamb, art. 71; a flat plate is an ellipse without depth).
double section_added_mass(double water_kg_m3, double half_width_m);
// The same turning about its own long axis, kg m (Newman, "Marine Hydrodynamics", 1977, table 4.3).
double section_added_inertia(double water_kg_m3, double half_width_m, double half_depth_m);

}  // namespace neritic::diver
