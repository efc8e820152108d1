// Things that would fall between a sonar's samples are drawn larger, so that they are heard in
// every ping, and echo as much less a sample. Larger across the line of sight alone and as far off
// as they are; normals stay the thing's own. Plain data made on the CPU.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/render/frame_state.hpp"

namespace neritic::render {

// How large a thing has to be to be met by enough samples of a view set's eye, and the angles
// within which samples lie. A thing that reaches beyond these is drawn as it is.
struct LeastDrawn {
  Quat world_from_eye{1, 0, 0, 0};  // x to starboard, y up, z backwards
  double wide_rad = 0.0, high_rad = 0.0;
  double azimuth_min_rad = 0.0, azimuth_max_rad = 0.0;
  double elevation_min_rad = 0.0, elevation_max_rad = 0.0;
};

// One object, or one of its copies, that is drawn larger.
struct DrawnLarger {
  std::uint16_t label = 0;                           // of its instance
  double area = 1.0;                                 // of what is drawn over the thing's own
  Mat4 drawn_from_true{1.0};                         // of positions from the eye, in world axes
  double azimuth_rad = 0.0;                          // of its middle, in the eye's axes
  double half_wide_rad = 0.0;                        // of its own width
  double low_rad = 0.0, high_rad = 0.0;              // elevations of its own ends
  double drawn_low_rad = 0.0, drawn_high_rad = 0.0;  // and of what is drawn
};

// The most things that are drawn larger in a view set, the smallest labels first. Objects with more
// copies keep their size: they echo together, and each, larger, would hide others.
inline constexpr std::size_t kMostDrawnLarger = 512;

// Opaque objects and copies smaller than the least; what bends by the ball round it. Each grows
// upwards from its lower end, since that may stand on the bottom, and no farther than its
// neighbours begin: what hides part of another keeps its size. eye_m: in the world.
std::vector<DrawnLarger> drawn_larger(const scene::Scene& scene, const GpuScene& gpu_scene,
                                      const FrameState& state, const Vec3& eye_m,
                                      const LeastDrawn& least);

// A thing's rectangle in angles, for keep_apart.
struct DrawnPlace {
  double azimuth_rad = 0.0, half_wide_rad = 0.0, own_half_wide_rad = 0.0;
  double low_rad = 0.0, own_low_rad = 0.0, own_high_rad = 0.0, high_rad = 0.0;
};
// Takes back what would overlap of each two.
void keep_apart(std::span<DrawnPlace> places);

}  // namespace neritic::render
