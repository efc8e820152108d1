// Display colours into the gamut of sRGB: chroma is reduced at constant lightness and hue of Oklab
// (Ottosson 2020, "A perceptual color space for image processing"; his matrices), where clipping
// each channel would turn the hue. Let r be a colour's chroma over the largest chroma that sRGB has
// at its lightness and hue. Colours with r up to kGamutKnee keep every bit. Above, r becomes
// k + (1 - k) x / (1 + x), x = (r - k) / (1 - k): slope 1 at the knee, always rising, below 1.
// Linear light throughout.
#ifndef NERITIC_SHARED_GAMUT_H
#define NERITIC_SHARED_GAMUT_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

// A colour on the gamut's edge gets 0.85 of its chroma, one of twice that chroma 0.94: photographs
// of blue and green water have medians of 0.5 to 0.98.
NERITIC_CONST float kGamutKnee = 0.7f;
// Halvings of the interval that contains the gamut's edge, before one secant step: the edge's
// chroma is then known to 0.2 %.
NERITIC_CONST int kGamutHalvings = 8;
// Channels of a tone curve's result lie well inside of these bounds.
NERITIC_CONST float kGamutWidest = 4.0f;

// A channel without infinities; not a number becomes 0.
NERITIC_INLINE float finite_channel(float x) {
  if (x >= kGamutWidest) return kGamutWidest;
  if (x <= -kGamutWidest) return -kGamutWidest;
  return x > 0.0f || x < 0.0f ? x : 0.0f;
}

NERITIC_INLINE float signed_cube_root(float x) {
  float root = pow(abs(x), 1.0f / 3.0f);
  return x < 0.0f ? -root : root;
}

// The colour at t times the chroma, as a cubic of t: linear sRGB.
NERITIC_INLINE vec3 colour_at(float t, vec3 grey, vec3 first, vec3 second, vec3 third) {
  return grey + t * (first + t * (second + t * third));
}

// The distance of the channel that is nearest to its bound, 0 or 1; negative outside.
NERITIC_INLINE float inside_gamut(vec3 c) {
  float low = min(c.x, min(c.y, c.z)), high = max(c.x, max(c.y, c.z));
  return min(low, 1.0f - high);
}

NERITIC_INLINE vec3 map_into_gamut(vec3 linear) {
  vec3 c = vec3(finite_channel(linear.x), finite_channel(linear.y), finite_channel(linear.z));
  vec3 cones = mat3(0.4122214708f, 0.2119034982f, 0.0883024619f, 0.5363325363f, 0.6806995451f,
                    0.2817188376f, 0.0514459929f, 0.1073969566f, 0.6299787005f) *
               c;
  cones = vec3(signed_cube_root(cones.x), signed_cube_root(cones.y), signed_cube_root(cones.z));
  float lightness = 0.2104542553f * cones.x + 0.7936177850f * cones.y - 0.0040720468f * cones.z;
  if (!(lightness > 0.0f)) return vec3(0.0f);
  if (lightness >= 1.0f) return vec3(1.0f);
  // Lightness has the coefficient 1 in each of the three roots, so what is left of them is the
  // chroma's part.
  vec3 chroma = cones - vec3(lightness);
  const mat3 to_srgb =
      mat3(4.0767416621f, -1.2684380046f, -0.0041960863f, -3.3077115913f, 2.6097574011f,
           -0.7034186147f, 0.2309699292f, -0.3413193965f, 1.7076147010f);
  vec3 grey = vec3(lightness * lightness * lightness);
  vec3 first = 3.0f * lightness * lightness * (to_srgb * chroma);
  vec3 second = 3.0f * lightness * (to_srgb * (chroma * chroma));
  vec3 third = to_srgb * (chroma * chroma * chroma);
  float high = 1.0f / kGamutKnee;
  float at_high = inside_gamut(colour_at(high, grey, first, second, third));
  if (at_high >= 0.0f) return c;
  float low = 0.0f, at_low = min(grey.x, 1.0f - grey.x);
  for (int i = 0; i < kGamutHalvings; ++i) {
    float middle = 0.5f * (low + high);
    float at_middle = inside_gamut(colour_at(middle, grey, first, second, third));
    if (at_middle < 0.0f) {
      high = middle;
      at_high = at_middle;
    } else {
      low = middle;
      at_low = at_middle;
    }
  }
  float edge = low + (high - low) * at_low / (at_low - at_high);  // 1 / r
  // k + (1 - k) x / (1 + x) of the header, with r = 1 / edge, multiplied out.
  float soft = kGamutKnee + (1.0f - kGamutKnee) * (1.0f - kGamutKnee * edge) /
                                (1.0f + edge - 2.0f * kGamutKnee * edge);
  vec3 mapped = colour_at(edge * soft, grey, first, second, third);
  return min(max(mapped, vec3(0.0f)), vec3(1.0f));
}

NERITIC_SHARED_END
#endif
