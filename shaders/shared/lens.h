// Lenses between the plane at distance 1 (x to the right, y down) and the picture in focal lengths.
// Brown (1971) and Conrady (1919) with OpenCV's coefficients; Kannala and Brandt (2006) as OpenCV's
// fisheye. Inverses by Newton's method: below 1e-6 after 8 steps where the lens folds nothing
// (engine/scene/camera_lens.cpp checks that).
#ifndef NERITIC_SHARED_LENS_H
#define NERITIC_SHARED_LENS_H
#include "shared/types.h"

NERITIC_SHARED_BEGIN

#ifdef __cplusplus
using glm::asin;
using glm::atan;
using glm::clamp;
using glm::dot;
using glm::length;
using glm::sqrt;
using glm::tan;
#endif

NERITIC_CONST uint kLensNone = 0;
NERITIC_CONST uint kLensBrown = 1;
NERITIC_CONST uint kLensFisheye = 2;
// Beyond 85 degrees off the axis there is no plane.
NERITIC_CONST float kWidestLens_rad = 1.4835f;

NERITIC_CONST uint kPortNone = 0;
NERITIC_CONST uint kPortFlat = 1;
NERITIC_CONST uint kPortDome = 2;

// A point of the plane in air, behind a housing's port, to the plane in the water before it.
// offset: of the pupil before a dome's centre, over its radius (engine/scene/camera_lens.cpp).
NERITIC_INLINE vec2 through_port(uint port, float offset, vec2 air) {
  float r = length(air);
  if (port == kPortNone || !(r > 1e-7f)) return air;
  float sine = r / sqrt(1.0f + r * r), angle = atan(r);
  if (port == kPortFlat)
    angle = asin(sine / 1.333f);
  else
    angle = angle - asin(offset * sine) + asin(offset * sine / 1.333f);
  return air * (tan(angle) / r);
}

NERITIC_INLINE vec2 brown_distort(vec2 t, vec4 k, vec2 p) {
  float r2 = dot(t, t);
  float radial = 1.0f + r2 * (k.x + r2 * (k.y + r2 * k.z));
  return vec2(t.x * radial + 2.0f * p.x * t.x * t.y + p.y * (r2 + 2.0f * t.x * t.x),
              t.y * radial + p.x * (r2 + 2.0f * t.y * t.y) + 2.0f * p.y * t.x * t.y);
}

NERITIC_INLINE float fisheye_radius(float angle, vec4 k) {
  float a2 = angle * angle;
  return angle * (1.0f + a2 * (k.x + a2 * (k.y + a2 * (k.z + a2 * k.w))));
}

NERITIC_INLINE vec2 lens_distort(uint model, vec2 t, vec4 k, vec2 p) {
  if (model == kLensBrown) return brown_distort(t, k, p);
  float r = length(t);
  return r > 1e-7f ? t * (fisheye_radius(atan(r), k) / r) : t;
}

NERITIC_INLINE vec2 lens_undistort(uint model, vec2 d, vec4 k, vec2 p) {
  if (model == kLensBrown) {
    vec2 t = d;
    for (int i = 0; i < 8; ++i) {
      float r2 = dot(t, t);
      float radial = 1.0f + r2 * (k.x + r2 * (k.y + r2 * k.z));
      float slope = 2.0f * (k.x + r2 * (2.0f * k.y + r2 * 3.0f * k.z));  // of radial, over r
      float xx = radial + t.x * t.x * slope + 2.0f * p.x * t.y + 6.0f * p.y * t.x;
      float yy = radial + t.y * t.y * slope + 6.0f * p.x * t.y + 2.0f * p.y * t.x;
      float xy = t.x * t.y * slope + 2.0f * (p.x * t.x + p.y * t.y);
      vec2 off = brown_distort(t, k, p) - d;
      float det = xx * yy - xy * xy;
      if (!(abs(det) > 1e-12f)) break;
      t = t - vec2(yy * off.x - xy * off.y, xx * off.y - xy * off.x) / det;
    }
    return t;
  }
  float r = length(d);
  if (!(r > 1e-7f)) return d;
  float angle = min(r, kWidestLens_rad);
  for (int i = 0; i < 8; ++i) {
    float a2 = angle * angle;
    float slope =
        1.0f + a2 * (3.0f * k.x + a2 * (5.0f * k.y + a2 * (7.0f * k.z + a2 * 9.0f * k.w)));
    if (!(slope > 1e-6f)) break;
    angle = clamp(angle - (fisheye_radius(angle, k) - r) / slope, 0.0f, kWidestLens_rad);
  }
  return d * (tan(angle) / r);
}

NERITIC_SHARED_END
#endif
