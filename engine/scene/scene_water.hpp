// Terms that a scene may name of its water beside the type: each is absent until named, and then
// neither computed nor allocated nor declared. Plain data; any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/core/math.hpp"
#include "engine/core/sea_waves.hpp"
#include "engine/core/water_column.hpp"

namespace neritic::scene {

// Light that particles turn by small angles and that still reaches the camera: Wells's point
// spread.
struct ForwardScatter {
  double angle_rad = 0.03;   // theta_0, the phase function's (Hou et al. 2008)
  std::uint32_t levels = 7;  // octaves of blur
};

// Marine snow: particles that rest in the water, or drift with it.
struct Snow {
  double density_m3 = 400.0;
  double diameter_m = 1.5e-3, spread = 0.6;  // median, and the deviation of its logarithm
  double range_m = 3.0;                      // those farther off are part of the haze
  Vec3 drift_m_s{0.0, -0.0006, 0.0};
  double shutter_s = 0.0;  // streaks of this exposure
};

// Gas that rises from a place of an object.
struct BubbleSource {
  int object = -1;        // index into Scene::objects
  std::string on, place;  // its name, and where the file names it
  int joint = -1;         // node of its model; -1: the object's origin
  std::string joint_name, place_joint;
  Vec3 position_m{0.0};       // in the object's frame, or the joint's
  double breath_s = 4.5;      // 0: a leak, without pauses
  double flow_m3_s = 2.5e-4;  // at the source's depth, mean (15 litres a minute)
  double median_radius_m = 5e-3;
  double height_m = 8.0;  // seen so far above the source
};

// Sediment that a fin or a thruster lifts where it passes close over the bed.
struct SiltSource {
  int object = -1;
  std::string on, place;
  int joint = -1;
  std::string joint_name, place_joint;
  Vec3 position_m{0.0};
  double bed_depth_m = 0.0;
  double reach_m = 1.0;  // of the wash, above the bed
  double hang_s = 40.0;  // until most has settled
};

// More particles near the bed: scattering and absorption times 1 + (factor - 1) exp(-height /
// thickness).
struct Murk {
  double bed_depth_m = 0.0, thickness_m = 1.5, factor = 4.0;
};

}  // namespace neritic::scene
