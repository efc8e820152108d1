// A colour as it is shown (sRGB-encoded, 0 to 1 a channel), with opacity. A plain value.
#pragma once

namespace neritic::draw2d {

struct Color {
  float r = 0, g = 0, b = 0, alpha = 1;
  constexpr Color with_alpha(float a) const { return {r, g, b, a}; }
};

// a at t = 0, b at t = 1.
constexpr Color mix(const Color& a, const Color& b, float t) {
  return {a.r + (b.r - a.r) * t, a.g + (b.g - a.g) * t, a.b + (b.b - a.b) * t,
          a.alpha + (b.alpha - a.alpha) * t};
}

}  // namespace neritic::draw2d
