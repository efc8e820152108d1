// The share of the sky's light that what stands still lets through, on a grid of cells: caves,
// holds of wrecks, the shade under a quay. Plain data made on the CPU; any thread.
//
// Light comes from above, spread as water spreads it (kDiffuseG). For each of some directions it
// goes through the grid cell by cell, and the triangles in a cell take the share of it that they
// cover there. Sources: discrete ordinates with upwind steps (Chandrasekhar 1960, "Radiative
// Transfer", ch. 2).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/frame_state.hpp"
#include "engine/scene/scene.hpp"

namespace neritic::render {

// A triangle of the world, metres.
using WorldTriangle = std::array<Vec3, 3>;

struct SkylightGrid {
  Vec3 low_m{0.0};  // corner of the first cell
  double cell_m = 1.0;
  std::uint32_t nx = 0, ny = 0, nz = 0;
  std::vector<float> open;  // 0 to 1, [y][z][x], at the cells' middles

  std::size_t cell_of(std::size_t x, std::size_t y, std::size_t z) const {
    return (y * nz + z) * nx + x;
  }
  // Between the eight nearest cells; 1 outside, and over the outermost half cell on the way there.
  double at(const Vec3& place_m) const;
};

// The grid of a box of water, whose effect fades out towards its sides and top. Triangles with a
// corner beyond 1e7 m, or none that is a number, count for nothing.
SkylightGrid skylight_grid(const scene::Skylight& box, std::span<const WorldTriangle> triangles);

// The opaque triangles near the box of the objects whose flag is set, where they are in the state.
std::vector<WorldTriangle> skylight_triangles(const scene::Scene& scene, const FrameState& state,
                                              std::span<const std::uint8_t> objects,
                                              const scene::Skylight& box);

}  // namespace neritic::render
