// The sonar image that infinitely fine beams would give, nearly: many rays a cell, each with its
// own range and incidence, averaged. Knows nothing of G-buffers. Two threads.
#pragma once

#include <vector>

#include "sonar/beam_grid.hpp"
#include "tools/tradeoff/ray_world.hpp"

namespace neritic::tools {

// The image [n_range][n_azimuth] of one number of bins.
struct Truth {
  sonar::Bins bins;
  std::vector<double> intensity;
};

// finest.bins: rays_a_side^2 rays go through each of its (theta, phi) cells. The wanted bins must
// divide the finest in azimuth. The elevation bins do not matter to the truth.
std::vector<Truth> trace_truth(const RayWorld& world, const sonar::BeamGrid& finest,
                               const std::vector<sonar::Bins>& wanted, std::uint32_t rays_a_side);

}  // namespace neritic::tools
