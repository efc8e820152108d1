// Forward scatter: particles turn light by small angles, and much of it still reaches the camera,
// from nearby. Wells (1973, "Theory of small angle scattering", AGARD LS-61), as Hou, Gray,
// Weidemann and Arnone (2008, Optics Express 16, 9958) use it: over a distance R an object's
// contrast at psi cycles a radian keeps
//   exp(-(c - b f) R),   f = (1 - exp(-x)) / x,   x = 2 pi theta_0 psi,
// for a phase function theta_0 / (2 pi (theta_0^2 + theta^2)^1.5). exp(-c R) of it is the sharp
// picture that shading leaves; the rest is spread by a pyramid of octaves, whose weights follow
// from that curve.
#ifndef NERITIC_SHARED_FORWARD_SCATTER_H
#define NERITIC_SHARED_FORWARD_SCATTER_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// The pyramid's finest level has a quarter of the picture's width: sharper octaves gain next to
// nothing.
NERITIC_CONST uint kScatterFirstLevel = 2;
NERITIC_CONST uint kMaxScatterLevels = 8;
// Cycles a pixel up to which a box of 2^n pixels, drawn linearly, passes light, times 2^n: fitted
// to the curve above over optical lengths of 0.5 to 7 (error below 0.04).
NERITIC_CONST float kScatterCut = 0.21f;

struct ScatterPush {
  vec3 scattering;        // b of particles, 1/m
  float high_cycles_rad;  // upper end of this level's octave; 0: the finest, it has all above
  float low_cycles_rad;   // 0: the coarsest, it has all below
  float angle_rad;        // theta_0
};

// Share of what is scattered forwards over an optical length b R that stays contrast at psi.
NERITIC_INLINE float scatter_contrast(float optical_length, float cycles_rad, float angle_rad) {
  float x = max(6.28318531f * angle_rad * cycles_rad, 1e-4f);
  return exp(-optical_length * (1.0f - (1.0f - exp(-x)) / x));
}

// Bindings: down reads a finer level and writes a coarser; up adds a coarser level to a finer one
// in place; add puts the finest level on the picture.
NERITIC_CONST uint kScatterFrom = 0;
NERITIC_CONST uint kScatterTo = 1;
// Specialisation constant of down: texels a side that become one.
NERITIC_CONST uint kSpecScatterSide = 0;

NERITIC_SHARED_END
#endif
