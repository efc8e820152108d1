// Inertia of a rigid thing, the water that moves along with it included: momentum P = A v + B w and
// moment of momentum L = B^T v + C w about the origin of the axes it is given in. Plain values,
// pure functions; any thread.
#pragma once

#include "engine/core/math.hpp"

namespace neritic::diver {

struct SpatialMass {
  Mat3 a{0.0}, b{0.0}, c{0.0};
};

inline SpatialMass& operator+=(SpatialMass& m, const SpatialMass& other) {
  m.a += other.a;
  m.b += other.b;
  m.c += other.c;
  return m;
}

// The spatial mass of mass_kg at centre_m with an inertia about that centre.
inline SpatialMass rigid_mass(double mass_kg, const Vec3& centre_m, const Mat3& inertia_kg_m2) {
  const Mat3 s = cross_matrix(centre_m);
  return {mass_kg * Mat3(1.0), -mass_kg * s, inertia_kg_m2 - mass_kg * s * s};
}
inline SpatialMass point_mass(double mass_kg, const Vec3& centre_m) {
  return rigid_mass(mass_kg, centre_m, Mat3(0.0));
}

// In the axes that rotation leads to (outer_from_inner), about the same origin.
inline SpatialMass rotated(const SpatialMass& m, const Mat3& rotation) {
  const Mat3 back = glm::transpose(rotation);
  return {rotation * m.a * back, rotation * m.b * back, rotation * m.c * back};
}
// m S(p) and S(p) m, S(p) being cross_matrix(p), without the products by its zeros.
inline Mat3 times_cross(const Mat3& m, const Vec3& p) {
  return {p.z * m[1] - p.y * m[2], p.x * m[2] - p.z * m[0], p.y * m[0] - p.x * m[1]};
}
inline Mat3 cross_times(const Vec3& p, const Mat3& m) {
  return {glm::cross(p, m[0]), glm::cross(p, m[1]), glm::cross(p, m[2])};
}
// About the point from which the mass's own origin lies at p.
inline SpatialMass shifted(const SpatialMass& m, const Vec3& p) {
  const Mat3 as = times_cross(m.a, p);
  return {m.a, m.b - as, m.c - times_cross(glm::transpose(m.b), p) + cross_times(p, m.b - as)};
}

}  // namespace neritic::diver
