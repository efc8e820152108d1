// Light shafts: how much of the sun's light, which the water scatters into a sight, arrives there
// through waves and past solids. Bindings of the shafts and shafts blur passes.
#ifndef NERITIC_SHARED_SHAFTS_H
#define NERITIC_SHARED_SHAFTS_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Pixels of the picture to one of the shafts image, a side.
NERITIC_CONST uint kShaftStep = 4;
// A texel of the shafts image (shaft_texel.glsl) holds a ratio up to kShaftMost, and a distance in
// kShaftSteps steps.
NERITIC_CONST float kShaftMost = 8.0;
NERITIC_CONST float kShaftSteps = 1023.0;

struct ShaftParams {
  float reach_m;
};

NERITIC_CONST uint kShaftViews = 0;
NERITIC_CONST uint kShaftLighting = 1;
NERITIC_CONST uint kShaftVisibility = 2;  // VisibilityParams: the sun's maps
NERITIC_CONST uint kShaftData = 3;
NERITIC_CONST uint kShaftDepth = 4;
NERITIC_CONST uint kShaftCascades = 5;
NERITIC_CONST uint kShaftCaustics = 6;
NERITIC_CONST uint kShaftOut = 7;  // r32f: shared/shaft_texel.glsl
// Specialisation constants: the terms of light, the sun's maps (0: none), samples along a sight.
NERITIC_CONST uint kSpecShaftTerms = 0;
NERITIC_CONST uint kSpecShaftCascades = 1;
NERITIC_CONST uint kSpecShaftSamples = 2;

NERITIC_CONST uint kShaftBlurIn = 0;
NERITIC_CONST uint kShaftBlurOut = 1;

NERITIC_SHARED_END
#endif
