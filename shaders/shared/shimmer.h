// Layers of water that bend sight: where a sight crosses a transition of the refractive index whose
// waves tilt it, it turns by a small angle. First order in the change of index and in the waves'
// slope (geometrical optics, dr/ds^2 = grad n / n across the sight): the turn is the integral of
// the gradient along the straight sight. Waves shorter than the way within the transition cancel
// out. Flatter than the critical angle sqrt(2 bend) the turn is damped: no mirages. Waves that
// begin within the transition count as if they began outside. Shared by shaders/shimmer.comp and
// tests.
#ifndef NERITIC_SHARED_SHIMMER_H
#define NERITIC_SHARED_SHIMMER_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

NERITIC_CONST uint kShimmerLayers = 4;
NERITIC_CONST uint kShimmerWaves = 10;

struct ShimmerWave {
  vec2 number_m;    // 1/m, along x and z
  float slope;      // amplitude
  float angle_rad;  // at the origin, now
};

struct ShimmerLayer {
  float height_m;  // of the transition's middle over the origin
  float sigma_m;   // deviation of its Gaussian gradient
  float bend;      // change of the refractive index from above to below, over the index
  ShimmerWave waves[kShimmerWaves];
};

struct ShimmerParams {
  ShimmerLayer layers[kShimmerLayers];
};

// How a sight crosses a transition.
struct ShimmerCrossing {
  float way_m;     // to where it crosses
  float strength;  // share of the crossing that is on the sight, over the sine of its grazing angle
  float spread2;   // variance of the way within the transition, m^2 along the sight
  float steep;     // 1 / sine, damped
};

// Share of a normal number below u, within 1e-7: Abramowitz and Stegun 1964, 26.2.17.
NERITIC_INLINE float normal_below(float u) {
  float x = min(abs(u), 12.0f), t = 1.0f / (1.0f + 0.2316419f * x);
  float tail = 0.39894228f * exp(-0.5f * x * x) * t *
               (0.319381530f +
                t * (-0.356563782f + t * (1.781477937f + t * (-1.821255978f + t * 1.330274429f))));
  return u < 0.0f ? tail : 1.0f - tail;
}

// above_m: of the eye over the transition's middle; rise: the sight's y; length_m: of the sight.
NERITIC_INLINE ShimmerCrossing shimmer_crossing(float above_m, float rise, float length_m,
                                                float sigma_m, float bend) {
  ShimmerCrossing out_;
  // A sight that is level, or as good as: it never crosses.
  float sine = abs(rise) < 1e-6f ? 1e-6f : rise;
  float u0 = above_m / sigma_m, u1 = u0 + sine * length_m / sigma_m;
  float share = normal_below(u1) - normal_below(u0);
  float from_ = 0.39894228f * exp(-0.5f * min(u0 * u0, 80.0f)),
        to = 0.39894228f * exp(-0.5f * min(u1 * u1, 80.0f));
  // Mean and variance of a normal number between u0 and u1.
  float some = abs(share) < 1e-6f ? 1e-6f : abs(share);
  float signed_ = share < 0.0f ? -some : some;
  float mean = (from_ - to) / signed_;
  float end = min(max(u1, -12.0f), 12.0f), start = min(max(u0, -12.0f), 12.0f);
  float variance = 1.0f + (start * from_ - end * to) / signed_ - mean * mean;
  float damped = sine / (sine * sine + 2.0f * abs(bend));
  out_.way_m = min(max((mean - u0) * sigma_m / sine, 0.0f), length_m);
  out_.strength = share * damped;
  out_.spread2 = max(variance, 0.0f) * sigma_m * sigma_m * damped * damped;
  out_.steep = damped;
  return out_;
}

// A wave's slope along x, its lift (m) and its slope along z at a place, as far as they do not
// cancel out on the way. level: the sight's x and z.
NERITIC_INLINE vec3 shimmer_wave(ShimmerWave wave, vec2 place_m, vec2 level, float spread2) {
  float along = wave.number_m.x * level.x + wave.number_m.y * level.y;
  float angle = wave.number_m.x * place_m.x + wave.number_m.y * place_m.y + wave.angle_rad;
  float number2 = wave.number_m.x * wave.number_m.x + wave.number_m.y * wave.number_m.y;
  float lift_m = wave.slope * pow(max(number2, 1e-12f), -0.5f) *
                 exp(-0.5f * min(along * along * spread2, 60.0f));
  float slope = lift_m * cos(angle);
  return vec3(wave.number_m.x * slope, lift_m * sin(angle), wave.number_m.y * slope);
}

// Where the sight crosses, once waves have lifted the transition there by lift_m.
NERITIC_INLINE float lifted_way(ShimmerCrossing crossing, float lift_m, float length_m) {
  return min(max(crossing.way_m + lift_m * crossing.steep, 0.0f), length_m);
}

// The turn of the unit sight d at a crossing where the transition has these slopes, times the share
// of the sight behind it: what is seen lies in the direction d + turn.
NERITIC_INLINE vec3 shimmer_turn(ShimmerCrossing crossing, float bend, vec3 d, vec2 slope,
                                 float length_m) {
  float behind = 1.0f - min(crossing.way_m / length_m, 1.0f);
  float tilt = (d.x * slope.x + d.z * slope.y) * crossing.steep;
  vec3 gradient = vec3(-slope.x, 1.0f + tilt, -slope.y);
  float along = gradient.x * d.x + gradient.y * d.y + gradient.z * d.z;
  return (gradient - d * along) * (-bend * crossing.strength * behind);
}

NERITIC_CONST uint kShimmerHdr = 0;
NERITIC_CONST uint kShimmerDepth = 1;
NERITIC_CONST uint kShimmerOut = 2;
NERITIC_CONST uint kShimmerViews = 3;
NERITIC_CONST uint kShimmerData = 4;
// Specialisation constants: layers, and waves of each (0: still water).
NERITIC_CONST uint kSpecShimmerLayers = 0;
NERITIC_CONST uint kSpecShimmerWaves = 1;

NERITIC_SHARED_END
#endif
