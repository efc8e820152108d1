// The surfaces that a sonar's rays hit: triangles (Embree) or closed forms. Any thread may cast.
#pragma once

#include <memory>
#include <string>

#include "engine/core/result.hpp"
#include "tools/tradeoff/flatten.hpp"

namespace neritic::tools {

struct RayHit {
  double t = 0.0;      // multiple of the direction; 0: nothing
  Vec3f normal{0.0f};  // unit, of the side that is seen
  float reflectivity = 1.0f;
  std::uint16_t label = 0;
  double backscatter = 1.0;  // mu of Lambert's law
};

class RayWorld {
 public:
  virtual ~RayWorld() = default;
  // From the origin of the frame, or another place, along direction (any length).
  RayHit cast(const Vec3& direction) const { return cast_from(Vec3(0.0), direction); }
  virtual RayHit cast_from(const Vec3& origin_m, const Vec3& direction) const = 0;
};

Result<std::unique_ptr<RayWorld>> make_triangle_world(Triangles triangles);
// A seabed plane 0.8 m below and spheres of radius 0.35 and 0.15 m at 3 and 4 m.
std::unique_ptr<RayWorld> make_analytic_world();

}  // namespace neritic::tools
