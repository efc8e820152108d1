// How much of the light from above gets past what stands still: bindings and parameters of the
// skylight pass. The grid: engine/render/skylight.hpp.
#ifndef NERITIC_SHARED_SKYLIGHT_H
#define NERITIC_SHARED_SKYLIGHT_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Pixels of the picture to one of the skylight image, a side.
NERITIC_CONST uint kSkylightStep = 4;

struct SkylightParams {
  vec3 low;  // corner of the grid's first cell, relative to the view set's origin
  float cell_m;
  uint nx;  // cells
  uint ny;
  uint nz;
};

NERITIC_CONST uint kSkylightViews = 0;
NERITIC_CONST uint kSkylightLighting = 1;
NERITIC_CONST uint kSkylightParams = 2;
NERITIC_CONST uint kSkylightDepth = 3;
NERITIC_CONST uint kSkylightNormal = 4;
NERITIC_CONST uint kSkylightGrid = 5;  // floats, [y][z][x]
NERITIC_CONST uint kSkylightOut =
    6;  // rgba8: along the sight, at its end, 1, half visibility_distance
// Specialisation constants: the terms of light; samples along a sight, since Mesa's CPU driver
// compiles a loop to a number of a uniform block anew in each frame.
NERITIC_CONST uint kSpecSkylightTerms = 0;
NERITIC_CONST uint kSpecSkylightSamples = 1;

NERITIC_SHARED_END
#endif
