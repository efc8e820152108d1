// The published algorithm on the CPU, literally, in double precision: every pixel of depth and
// normal images is projected into the volume I(r, theta, phi), the last pixel of a cell in
// row-major order wins, and the sum over elevation is divided by n_phi. GPU gathers are compared
// with it. Source: UnRealTHASC (2024), section IV.A, eq. 2 to 5 and Algorithm 1. Pure
// functions; any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/core/intrinsics.hpp"
#include "engine/core/result.hpp"
#include "sonar/beam_grid.hpp"

namespace neritic::sonar {

// Depth and normals of one pinhole view, as doubles so that nothing read is lost. Row-major, row 0
// on top, pixel centres at +0.5. View axes: x right, y up, z backwards.
struct SonarInput {
  std::uint32_t width = 0, height = 0;
  Intrinsics intrinsics;
  std::vector<double> depth;    // metres; NaN, infinity and <= 0: nothing is hit
  bool depth_is_range = false;  // else planar, along the view axis
  std::vector<double> normals;  // [pixel][3]; any length; zero or not finite: contributes nothing
  bool normals_face_sensor = true;    // else the sign is unknown and the absolute value counts
  std::vector<std::uint16_t> labels;  // a class a pixel; empty: none
  std::vector<float> reflectivity;    // 0 to 1 a pixel; empty: 1
  double yaw_rad = 0.0;               // azimuth of the view's axis (a wedge of several sectors)
};

// kBadInput where sizes do not match or the intrinsics cannot be.
Status validate(const SonarInput& input);

struct SonarImage {
  std::uint32_t n_range = 0, n_azimuth = 0;
  std::vector<float> intensity;       // [n_range][n_azimuth], row 0 nearest, column 0 full port
  std::vector<std::uint16_t> labels;  // same shape; class of the strongest contribution; 0: nothing
  bool unclassed = false;             // something of no class, 0 in labels too, was heard
};

// max(0, -n . p / |p|) / |n|, or its absolute value where the sign is unknown (eq. 2). Nothing
// where it cannot be computed.
std::optional<double> incidence(const Vec3& normal, const Vec3& point, bool faces_sensor);

// The point that a pixel sees, in view axes; nothing where the depth says so.
std::optional<Vec3> point_of(const SonarInput& input, std::uint32_t column, std::uint32_t row);

// Algorithm 1 and eq. 5. Several inputs are the sectors of one wedge, taken in their order. Memory
// grows with the cells that are hit, not with the volume. Inputs must be valid.
SonarImage reference_image(const BeamGrid& grid, std::span<const SonarInput> inputs);
// The same with its values in double: [n_range][n_azimuth].
std::vector<double> reference_intensity(const BeamGrid& grid, std::span<const SonarInput> inputs);

}  // namespace neritic::sonar
