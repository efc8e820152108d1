// Oklab in double (Ottosson 2020, "A perceptual color space for image processing") and the gamut's
// edge of sRGB found by small steps of chroma: the oracle of shaders/shared/gamut.h, with which it
// shares the matrices and no code.
#pragma once

#include <cmath>

#include "engine/core/math.hpp"

namespace neritic::test {

struct Lch {
  double lightness, chroma, hue_rad;
};

// Lightness, chroma and hue of a linear sRGB colour.
inline Lch oklab(const Vec3& c) {
  const double l = std::cbrt(0.4122214708 * c.x + 0.5363325363 * c.y + 0.0514459929 * c.z);
  const double m = std::cbrt(0.2119034982 * c.x + 0.6806995451 * c.y + 0.1073969566 * c.z);
  const double s = std::cbrt(0.0883024619 * c.x + 0.2817188376 * c.y + 0.6299787005 * c.z);
  const double a = 1.9779984951 * l - 2.4285922050 * m + 0.4505937099 * s;
  const double b = 0.0259040371 * l + 0.7827717662 * m - 0.8086757660 * s;
  return {0.2104542553 * l + 0.7936177850 * m - 0.0040720468 * s, std::hypot(a, b),
          std::atan2(b, a)};
}

inline Vec3 linear_srgb(const Lch& colour) {
  const double a = colour.chroma * std::cos(colour.hue_rad),
               b = colour.chroma * std::sin(colour.hue_rad);
  const double l = std::pow(colour.lightness + 0.3963377774 * a + 0.2158037573 * b, 3.0);
  const double m = std::pow(colour.lightness - 0.1055613458 * a - 0.0638541728 * b, 3.0);
  const double s = std::pow(colour.lightness - 0.0894841775 * a - 1.2914855480 * b, 3.0);
  return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
          -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
          -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

inline bool in_srgb(const Vec3& c) {
  return c.x >= 0.0 && c.y >= 0.0 && c.z >= 0.0 && c.x <= 1.0 && c.y <= 1.0 && c.z <= 1.0;
}

// The largest chroma in sRGB of this lightness and hue.
inline double edge_chroma(double lightness, double hue_rad) {
  double chroma = 0.0;
  for (const double step : {0.0005, 0.00002})
    while (in_srgb(linear_srgb({lightness, chroma + step, hue_rad}))) chroma += step;
  return chroma;
}

}  // namespace neritic::test
