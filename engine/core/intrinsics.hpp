// A pinhole in pixels: the one type that cameras, the sonar's G-buffer and depth images from files
// share. Pixel centres lie at +0.5, row 0 is on top. Pure functions; any thread.
#pragma once

#include <cstdint>

#include "engine/core/math.hpp"

namespace neritic {

// Focal lengths and principal point in pixels.
struct Intrinsics {
  double fx = 1.0, fy = 1.0, cx = 0.0, cy = 0.0;
};

// The pinhole of a picture of that size between those edges.
inline Intrinsics intrinsics_of(const FrustumTangents& tangents, std::uint32_t width,
                                std::uint32_t height) {
  const double fx = width / (tangents.right - tangents.left),
               fy = height / (tangents.top - tangents.bottom);
  return {fx, fy, -tangents.left * fx, tangents.top * fy};
}

}  // namespace neritic
