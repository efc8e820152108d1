// Small things in the water, drawn as soft spots: marine snow, bubbles, silt. The host places them
// (engine/render/particles.hpp), a triangle each.
#ifndef NERITIC_SHARED_PARTICLES_H
#define NERITIC_SHARED_PARTICLES_H
#include "shared/raster.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kParticleSnow = 0;
NERITIC_CONST uint kParticleBubble = 1;
NERITIC_CONST uint kParticleSilt = 2;
NERITIC_CONST uint kParticleBubbleSpot = 3;  // one of less than kBubbleSpot_px
// A kind's higher bits: 255ths of the light from above that is kept from it.
NERITIC_CONST uint kParticleShadeShift = 8;
NERITIC_CONST uint kParticleKindMask = 255;

// A bubble of a smaller radius in the picture has one light all over.
NERITIC_CONST float kBubbleSpot_px = 0.5f;

struct Particle {
  vec3 position;  // relative to the view set's origin
  float radius_m;
  vec3 moved;     // during the exposure
  float opacity;  // of its middle
  uint kind;
  uint seed;  // of its shape
};

struct ParticlePush {
  vec2 target_size;  // pixels
  float shutter;     // share of the time to the next frame that the exposure lasts
};

// Bindings.
NERITIC_CONST uint kParticleViews = 0;
NERITIC_CONST uint kParticleLighting = 1;
NERITIC_CONST uint kParticleDepth = 2;
NERITIC_CONST uint kParticleStream = 6;  // Particle each
// Where the scene names light shafts, which light particles too.
NERITIC_CONST uint kParticleSun = 3;  // VisibilityParams
NERITIC_CONST uint kParticleCascades = 4;
NERITIC_CONST uint kParticleCaustics = 5;
// Specialisation constants.
NERITIC_CONST uint kSpecParticleKind = 0;
NERITIC_CONST uint kSpecParticleMultiview = 1;  // whether it has many views
NERITIC_CONST uint kSpecParticleCascades = 2;

// A lens of this opening (m), focussed at this distance (m), blurs what is nearer or farther: a
// wide lens of 11 mm at f/2.8.
NERITIC_CONST float kLensOpening_m = 0.0040f;
NERITIC_CONST float kLensFocus_m = 2.0f;

NERITIC_SHARED_END
#endif
