// How much of sun, sky and surroundings a surface sees: bindings and parameters of the visibility
// and visibility blur passes.
#ifndef NERITIC_SHARED_VISIBILITY_H
#define NERITIC_SHARED_VISIBILITY_H
#include "shared/raster.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kMaxCascades = 4;

// A square of the sea as the sun sees it, from so far away that its rays are parallel within 0.3
// degrees.
struct Cascade {
  mat4 clip_from_origin;  // of the camera's view set
  vec3 across;            // unit, along the map's columns, and
  vec3 along;             // along its rows
  float near_m;           // metres from the eye = near_m / depth
  float half_m;           // half of the square's width
};

struct VisibilityParams {
  Cascade cascades[4];
  vec3 to_sun;           // unit, in water where there is water
  float origin_depth_m;  // of the view set's origin
  float spread;          // tangent of the sun's half-angle, with the waves' share under water
  float scattering_m;    // b of particles in the green, 1/m
  float sun_cosine;      // of the refracted sun
  float occlusion_m;     // reach of ambient occlusion
};

NERITIC_CONST uint kVisibilityViews = 0;
NERITIC_CONST uint kVisibilityParams = 1;
NERITIC_CONST uint kVisibilityDepth = 2;
NERITIC_CONST uint kVisibilityNormal = 3;
NERITIC_CONST uint kVisibilityCascades = 4;  // a layer each
NERITIC_CONST uint kVisibilityOut = 5;
// Specialisation constants.
NERITIC_CONST uint kSpecCascades = 0;  // 0: no sun shadows
NERITIC_CONST uint kSpecOcclusionTaps = 1;
NERITIC_CONST uint kSpecVisibilityScale = 2;  // pixels of the picture to one of this, linear
NERITIC_CONST uint kSpecShadowTaps = 3;

NERITIC_CONST uint kVisibilityBlurIn = 0;
NERITIC_CONST uint kVisibilityBlurOut = 1;
NERITIC_CONST int kVisibilityBlurBlock = 2;  // pixels a side to an invocation

// Scattering turns the sun's beam: an event adds this much to the variance of its tangent. Half of
// what particles scatter lies within 5 degrees (Petzold 1972); (0.14 rad)^2 of the core.
NERITIC_CONST float kCoreVariance = 0.02f;
// Share of scattering events that throw light out of the core, beyond some 15 degrees (Petzold
// 1972, 0.2 to 0.25): what a shadow no longer takes away.
NERITIC_CONST float kOutOfCore = 0.2f;
// Tangent of the half-angle of the light that is not in the core.
NERITIC_CONST float kSkySpread = 0.7f;

NERITIC_SHARED_END
#endif
