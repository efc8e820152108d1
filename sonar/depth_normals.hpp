// Normals from a depth image alone. Neighbouring points give them where depth is clean; where noise
// would tilt them, a plane is fitted to as many pixels as it takes. Pure functions; any thread.
#pragma once

#include <vector>

#include "sonar/reference.hpp"

namespace neritic::sonar {

// Medians over the pixels with a normal.
struct NormalEstimate {
  double noise_m = 0.0;  // standard deviation of the depth
  // The error of normals from neighbouring points, and of these here.
  double error_of_neighbours_rad = 0.0, error_rad = 0.0;
  int width_px = 0;  // of the fitted planes; 0 where neighbours were enough
};

struct DepthNormals {
  std::vector<double> normals;  // [pixel][3]: unit, facing the sensor; zero where none was found
  NormalEstimate estimate;
};

// in.normals is not read.
DepthNormals normals_from_depth(const SonarInput& in);

// The depth itself by the same planes, for a gather that counts a cell once in each range bin that
// its pixels lie in: noise spreads them over more bins, and the energy grows.
struct SmoothedDepth {
  double noise_m = 0.0, left_m = 0.0;  // medians: standard deviation before and after
  int width_px = 0;                    // of the fitted planes; 0: no more noise than is accepted
};
// Smooths in.depth where its noise is above accepted_m, by as many pixels as it takes.
SmoothedDepth smooth_depth(SonarInput& in, double accepted_m);

}  // namespace neritic::sonar
