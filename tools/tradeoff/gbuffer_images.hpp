// G-buffers made by rays through pixel centres (what a perfect rasterizer gives), and normals
// stored in fewer bits. Pure functions; any thread.
#pragma once

#include <string>

#include "sonar/reference.hpp"
#include "tools/tradeoff/ray_world.hpp"

namespace neritic::tools {

enum class NormalCoding { kFloat, kOctahedral16, kRgb8, kRgb8Gamma };
const char* name_of(NormalCoding coding);

// One sector's images at that size, normals as floats.
sonar::SonarInput cast_gbuffer(const RayWorld& world, const sonar::Sector& sector,
                               std::uint32_t width, std::uint32_t height);
// The same with its normals stored and read back. kRgb8Gamma: eq. 1 with gamma 2.2.
sonar::SonarInput with_normals(const sonar::SonarInput& input, NormalCoding coding);

}  // namespace neritic::tools
