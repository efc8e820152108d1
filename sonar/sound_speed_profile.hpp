// Sound speed over depth, and rays through it: straight ones, whose travel time is exact, and bent
// ones after Snell. Linear between the table's rows, constant above the first and below the last.
// Depths are metres below the surface, positive; elevations radians above the horizontal; times
// one way. No surface and no bottom: the caller ends rays there. Immutable; any thread.
#pragma once

#include <span>
#include <vector>

#include "sonar/table.hpp"

namespace neritic::sonar {

// Where a ray is after a given time.
struct RayPoint {
  double horizontal_m = 0.0;  // from the launch
  double depth_m = 0.0;
  double arc_m = 0.0;          // length along the ray
  double elevation_rad = 0.0;  // of its direction there
};

class SoundSpeedProfile {
 public:
  // Rows of depth_m in [-100, 12000], rising, and m/s in [100, 10000].
  static Result<SoundSpeedProfile> of_table(SonarTable depth_speed);

  // The profile along a ray that a flat mirror reflects, unfolded: beyond the mirror's depth it is
  // mirrored.
  SoundSpeedProfile beyond_mirror(double mirror_depth_m, bool water_below) const;

  double speed_m_s(double depth_m) const;

  // Straight rays. Integral of ds / c along range_m from launch_depth_m, in closed form a layer.
  // Non-negative; NaN gives NaN.
  double straight_time_s(double launch_depth_m, double elevation_rad, double range_m) const;

  // A bent ray after time_s >= 0: circular arcs in layers of constant gradient g (radius
  // c / (|g| cos(elevation))), turning points included (Jensen et al. 2011, Computational Ocean
  // Acoustics, sec. 3.3). Exact but for rays that the speed's minimum would hold within 1
  // micrometre of one depth: those stay on that depth. Elevation in [-pi/2, pi/2].
  RayPoint bent(double launch_depth_m, double elevation_rad, double time_s) const;

 private:
  friend class RayTracer;
  struct Layer {
    double top_m, bottom_m;  // may be infinite
    double speed_at(double depth_m) const { return speed_m_s + gradient_s * (depth_m - depth_m_); }
    double depth_m_, speed_m_s;  // a depth of the layer and the speed there
    double gradient_s;           // dc/dz, 1/s
  };
  SoundSpeedProfile(SonarTable rows);
  // Index of the layer that holds depth; of two at a boundary the lower one.
  std::size_t layer_at(double depth_m) const;
  SonarTable rows_;
  std::vector<Layer> layers_;  // rows + 1, from the top; the outer two are half-spaces
};

}  // namespace neritic::sonar
