// The light and the shape of a gas bubble in water: what its surface mirrors, what it lets through,
// how flat it is. Pure functions, in GLSL and C++.
#ifndef NERITIC_SHARED_BUBBLE_H
#define NERITIC_SHARED_BUBBLE_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Wobbles of a bubble a second (ellipsoidal ones swing some five times: Clift, Grace and Weber
// 1978, ch. 7).
NERITIC_CONST float kWobble_hz = 5.0f;
// The look of a bubble now (Particle::seed): bits 0 to 7 of its swing, 8 to 15 of its tilt's lead,
// each a 256th of a turn.
NERITIC_CONST float kWobbleTurn_rad = 6.2831853f / 256.0f;

#ifdef __cplusplus
using glm::sqrt;
#endif

// Index of water against the gas (kWaterIndex of lighting.h).
NERITIC_CONST float kBubbleIndex = 1.333f;

// Height over width. Clean bubbles: Wellek, Agrawal and Skelland 1966 (AIChE Journal 12, 854),
// 1 / (1 + 0.163 Eo^0.757) with Eo = g rho d^2 / sigma, sea water of 0.0735 N/m. Wide
// ones become caps, round on top: they count as ellipsoids of 0.42.
NERITIC_INLINE float bubble_aspect(float radius_m) {
  float eotvos = 9.81f * 1026.0f * 4.0f * radius_m * radius_m / 0.0735f;
  return max(1.0f / (1.0f + 0.163f * pow(eotvos + 1e-6f, 0.757f)), 0.42f);
}

// How much of a spherical cap a bubble is: round on top, flat or dented below. Between Eotvos
// numbers of 10 and 40 ellipsoids go over to caps (Clift, Grace and Weber 1978, fig. 2.5).
NERITIC_INLINE float bubble_cap(float radius_m) {
  float eotvos = 9.81f * 1026.0f * 4.0f * radius_m * radius_m / 0.0735f;
  float share = min(max((eotvos - 10.0f) / 30.0f, 0.0f), 1.0f);
  return share * share * (3.0f - 2.0f * share);
}

// Fresnel's reflectance from water into gas, unpolarised; sine: of the angle of incidence. 1 from 1
// / 1.333 on: total reflection.
NERITIC_INLINE float bubble_reflectance(float sine) {
  float sine_gas = kBubbleIndex * sine;
  if (sine_gas >= 1.0f) return 1.0f;
  float c_water = sqrt(1.0f - sine * sine), c_gas = sqrt(1.0f - sine_gas * sine_gas);
  float s = (kBubbleIndex * c_water - c_gas) / (kBubbleIndex * c_water + c_gas);
  float p = (kBubbleIndex * c_gas - c_water) / (kBubbleIndex * c_gas + c_water);
  return 0.5f * (s * s + p * p);
}

// The ways of light that leaves a sphere of gas towards the eye, traced back from it: off its face,
// and in and out again on the far side (turned by twice the difference of the angles, away from the
// middle). All unit vectors; along: from the eye, normal: of the face, towards the eye.
NERITIC_INLINE vec3 bubble_mirrored(vec3 along, vec3 normal) {
  float facing = along.x * normal.x + along.y * normal.y + along.z * normal.z;
  return along - normal * (2.0f * facing);
}
NERITIC_INLINE vec3 bubble_passed(vec3 along, vec3 normal) {
  // Off the axis, as long as the sine of the angle of incidence.
  vec3 out_axis = normal - along * (normal.x * along.x + normal.y * along.y + normal.z * along.z);
  float sine = sqrt(out_axis.x * out_axis.x + out_axis.y * out_axis.y + out_axis.z * out_axis.z);
  if (sine < 1e-4f) return along;
  float sine_gas = min(kBubbleIndex * sine, 1.0f);
  float c_water = sqrt(max(1.0f - sine * sine, 0.0f)), c_gas = sqrt(1.0f - sine_gas * sine_gas);
  // Cosine and sine of the difference of the angles, then of twice that.
  float c = c_gas * c_water + sine_gas * sine, s = sine_gas * c_water - c_gas * sine;
  float cos_turn = c * c - s * s, sin_turn = 2.0f * s * c;
  return along * cos_turn + out_axis * (sin_turn / sine);
}

NERITIC_SHARED_END
#endif
