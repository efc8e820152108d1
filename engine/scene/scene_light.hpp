// Terms that a scene may name of its light besides sun and lamps: shadows, ambient light, caustics,
// shafts. Each is absent unless it is named. Plain values.
#pragma once

#include <array>
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

// [ambient.skylight]: in this box, what stands still takes away light that comes from above, on
// surfaces and in the water: caves, holds, the shade under a quay.
struct Skylight {
  Vec3 low_m{0.0}, high_m{0.0};  // opposite corners
  double cell_m = 0.4;
  std::uint32_t samples = 8;  // along a sight
};
// Cells along x, y and z, at least one.
std::array<std::uint32_t, 3> cells_of(const Skylight& skylight);
inline constexpr double kMostSkylightCells = 4e6;

// [ambient]: light from around. Upwards comes what the bottom sends back.
struct Ambient {
  Vec3f bottom_color{0.30f, 0.28f, 0.22f};  // linear; light sand
  std::optional<double> bottom_depth_m;     // absent: as near as the surface that is lit
  double occlusion_m = 0.0;                 // reach of ambient occlusion; 0: none
  std::uint32_t occlusion_samples = 8;
  std::optional<Skylight> skylight = {};
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
