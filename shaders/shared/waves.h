// The waves of the water's surface as the shaders see them: a sum of sines (Airy's linear waves in
// deep water), whose angles are those at the view set's origin at the frame's time, reduced in
// double. The host makes them from a spectrum (engine/core/sea_waves.hpp), so that light, pictures
// and buoyancy share them. Height and slope at a place relative to the origin: add wave_surface of
// all waves.
#ifndef NERITIC_SHARED_WAVES_H
#define NERITIC_SHARED_WAVES_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kMaxWaves = 48;
// Attenuation lengths of the clearest channel after which nothing is left of the surface.
NERITIC_CONST float kSeaFaded = 9.0f;
// Mean square slope of water without wind, both axes (Cox and Munk 1954, clean surface at 0 m/s).
NERITIC_CONST float kCalmSlope2 = 0.003f;

struct Wave {
  vec2 wave_number;  // 1/m, along world x and z: 2 pi over the wavelength
  float amplitude_m;
  float angle_rad;  // at the origin, now
};

struct Waves {
  uint count;
  float height_rms_m;     // of the sum
  float slope2;           // mean square slope of the sum, both axes
  float fine_slope2;      // of the waves shorter than those of the sum, both axes
  float foam_height_m;    // crests above it are whitecaps
  vec2 foam_shift;        // of the whitecaps' pattern at the origin
  float eye_height_m;     // of the surface over the first view's eye, and
  vec2 eye_slope;         // its slopes there, along x and z
  Wave waves[kMaxWaves];  // from long to short
};

// Height above still water (m) and its slopes along x and z.
NERITIC_INLINE vec3 wave_surface(Wave wave, float x_m, float z_m) {
  float angle = wave.wave_number.x * x_m + wave.wave_number.y * z_m + wave.angle_rad;
  float slope = -wave.amplitude_m * sin(angle);
  return vec3(wave.amplitude_m * cos(angle), slope * wave.wave_number.x,
              slope * wave.wave_number.y);
}

NERITIC_SHARED_END
#endif
