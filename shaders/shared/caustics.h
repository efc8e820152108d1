// Caustics: parameters and bindings of the passes that throw rays from a tile of the surface onto
// levels below.
#ifndef NERITIC_SHARED_CAUSTICS_H
#define NERITIC_SHARED_CAUSTICS_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kMaxCausticWaves = 32;

struct CausticWave {
  vec2 wave_number;  // 1/m, along world x and z; whole waves fit into the tile
  float amplitude_m;
  float angle_rad;  // at the world's x = z = 0, now
};

struct CausticsParams {
  uint count;
  uint texels;  // a side of the tile
  float tile_m;
  float first_m;     // depth of the first level
  float step;        // depth of a level over that of the one before
  uint first_level;  // levels that something lies at: the others are even light
  uint end_level;
  vec3 travel_air;  // unit, the way sunlight travels above the surface
  CausticWave waves[32];
};

// Depths of the levels of pictures, m: kCausticFirst_m kCausticStep^i. Between them the picture is
// blended, beyond them the last stays.
NERITIC_CONST uint kCausticLevels = 15;
// The image's layers: four levels each, of which the last is the next layer's first, so that a
// place between two levels is one sample. Level i is channel i % 3 of layer i / 3.
NERITIC_CONST uint kCausticLayers = 5;
NERITIC_CONST uint kCausticLayerStep = 3;
NERITIC_CONST float kCausticFirst_m = 0.4f;
NERITIC_CONST float kCausticStep = 1.26f;
// A ray's energy, in whole numbers, so that sums do not depend on their order and none is lost: the
// square of kCausticPart.
NERITIC_CONST uint kCausticPart = 64;
// Rows of texels that an invocation of the resolve pass smooths.
NERITIC_CONST uint kCausticRows = 8;
NERITIC_CONST uint kCausticsParams = 0;
NERITIC_CONST uint kCausticsSums = 1;
NERITIC_CONST uint kCausticsOut = 2;  // resolve: rgba16f

NERITIC_SHARED_END
#endif
