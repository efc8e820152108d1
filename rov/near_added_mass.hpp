// Added mass near what bounds the water: more near a solid, less under a free surface. A sphere's
// by the first image, about the whole vehicle (Lamb 1932, "Hydrodynamics", art. 137; Milne-Thomson
// 1968, section 16.41): at the distance h from a solid plane the added mass along it is larger by
// 3/16 (a/h)^3, across it by 3/8 (a/h)^3; under a free surface that moves fast (no potential there)
// as much smaller. A touching sphere has 0.803 and 0.621 of the displaced mass across and along by
// the whole series, here 0.688 and 0.594, in open water 0.5.
//
// The motion keeps its energy: with T = 1/2 v^T A(h, n) v Lagrange's equations have, beside the
// larger mass, -A' v, the force 1/2 v^T dA/dh v along n, and the moment of what turns with n. So a
// body that moves along a wall is drawn to it. Pure functions; any thread.
#pragma once

#include <span>

#include "rov/dynamics.hpp"

namespace neritic::rov {

// A plane that bounds the water: how far the middle of the displaced water is from it, and the unit
// vector from the plane into the water. m, north, east, down.
struct WaterBound {
  double away_m = 0.0;
  Vec3 normal_ned{0.0, 0.0, -1.0};
  bool free_surface = false;
};

// The radius of the sphere that displaces as much water. water_kg_m3 > 0.
double displaced_radius_m(const Vehicle& vehicle, double water_kg_m3);
// So many radii off, the share is under 0.04 %.
inline constexpr double kNearBounds = 10.0;

// The shares by which added mass is larger along and across a bound, and their change per metre off
// it, which is 0 nearer than a radius: there they stay.
struct AddedShare {
  double along = 0.0, across = 0.0, along_1_m = 0.0, across_1_m = 0.0;
};
AddedShare added_share(double radius_m, const WaterBound& bound);

// Sets the mass and its inverse of `near`, else a copy of `open`, and gives the wrench on it beside
// that mass, body axes, for a motion through the water. Bounds at rest.
Vec6 near_added_mass(const Vehicle& open, double radius_m, std::span<const WaterBound> bounds,
                     const Quat& attitude, const Vec6& through_water, Vehicle& near);

}  // namespace neritic::rov
