// Terms that a scene may name of its light besides sun and lamps: shadows, ambient light, caustics,
// shafts. Each is absent unless it is named. Plain values.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/core/math.hpp"

namespace neritic::scene {

// [sun.shadows]: what stands in the sun's way. Squares of the sea round the camera, each three
// times as wide as the one before, are drawn as the sun sees them.
struct SunShadows {
  std::uint32_t size = 1024;   // texels a side of each square
  std::uint32_t cascades = 3;  // squares
  double reach_m = 40.0;       // from the camera, of the widest
  bool full_resolution = false;
};

// [ambient]: light from around. Upwards comes what the bottom sends back.
struct Ambient {
  Vec3f bottom_color{0.30f, 0.28f, 0.22f};  // linear; light sand
  std::optional<double> bottom_depth_m;     // absent: as near as the surface that is lit
  double occlusion_m = 0.0;                 // reach of ambient occlusion; 0: none
  std::uint32_t occlusion_samples = 8;
};

inline constexpr std::size_t kMostCausticWaves = 32;

// [sun.caustics]: the net of light that waves throw on what lies below. A tile of the surface, by
// waves that fit into it.
struct Caustics {
  struct Wave {
    double amplitude_m = 0.0, wavelength_m = 1.0, direction_rad = 0.0;  // as of the wind
  };
  std::vector<Wave> waves;                     // named one by one; empty: by the wind
  double wind_m_s = 3.0, direction_rad = 0.0;  // towards which it blows, from north towards east
  double tile_m = 6.0;
  std::uint32_t texels = 192;  // a side of the tile
};

// [sun.shafts]: beams of light in the water, by the same waves as the caustics and the same solids
// as the shadows.
struct Shafts {
  std::uint32_t samples = 12;  // along a sight
  double reach_m = 20.0;       // farther off the light counts as even
};

}  // namespace neritic::scene
