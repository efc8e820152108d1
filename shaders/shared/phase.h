// How water scatters light: phase functions of the cosine of the scattering angle, 1/sr, integral 1
// over the sphere.
#ifndef NERITIC_SHARED_PHASE_H
#define NERITIC_SHARED_PHASE_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// Mean cosine of particle scattering (Petzold's phase function has about 0.924).
NERITIC_CONST float kParticleG = 0.924f;
// Light that was scattered before arrives from a broad cone about the zenith; scattered once more
// by particles it is spread as by this g (a fit, no measurement: the path radiance near the horizon
// is a few percent of the downwelling irradiance, Jerlov 1976 fig. 36).
NERITIC_CONST float kDiffuseG = 0.6f;

// Henyey and Greenstein 1941; g: the mean cosine.
NERITIC_INLINE float henyey_greenstein(float cosine, float g) {
  float d = 1.0f + g * g - 2.0f * g * cosine;
  return (1.0f - g * g) / (4.0f * 3.14159265f * d * sqrt(d));
}

// Pure sea water, Morel 1974.
NERITIC_INLINE float sea_water_phase(float cosine) {
  return 0.06225f * (1.0f + 0.835f * cosine * cosine);
}

NERITIC_SHARED_END
#endif
