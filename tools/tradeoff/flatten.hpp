// A scene at an instant as one list of triangles, posed, skinned and morphed on the host: what the
// ray caster sees. Independent of the renderer on purpose. Pure function; any thread.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/scene/scene.hpp"

namespace neritic::tools {

struct Triangles {
  std::vector<Vec3f> positions;  // metres, in the frame asked for
  std::vector<Vec3f> normals;    // unit, one a position
  std::vector<std::uint32_t> indices;
  std::vector<std::uint16_t> classes;  // one a triangle
  std::vector<float> reflectivity;     // one a triangle
  std::vector<double> backscatter;     // one a triangle: sonar::backscatter_strength
};

// frame_from_world: the frame to put them in; subtraction in double.
Triangles flatten(const scene::Scene& scene, double time_s, const Pose& frame_from_world);

}  // namespace neritic::tools
