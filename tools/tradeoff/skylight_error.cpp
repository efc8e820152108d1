#include "tools/tradeoff/skylight_error.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/clock.hpp"
#include "engine/render/skylight.hpp"
#include "shared/phase.h"

namespace neritic::tools {
namespace {

using render::WorldTriangle;

// A level or upright rectangle from a corner along two sides.
void add_wall(std::vector<WorldTriangle>& out, const Vec3& corner, const Vec3& a, const Vec3& b) {
  out.push_back({corner, corner + a, corner + a + b});
  out.push_back({corner, corner + a + b, corner + b});
}

// x -3 to 3, y -20 to -17, z -4 to 4; a door of 1.6 x 2.2 m in the wall at z = 4, a hatch of
// 1.2 x 1.2 m in the deck.
std::vector<WorldTriangle> hold() {
  std::vector<WorldTriangle> out;
  const Vec3 x(1, 0, 0), y(0, 1, 0), z(0, 0, 1);
  add_wall(out, {-3, -20, -4}, 6.0 * x, 8.0 * z);
  add_wall(out, {-3, -20, -4}, 3.0 * y, 8.0 * z);
  add_wall(out, {3, -20, -4}, 3.0 * y, 8.0 * z);
  add_wall(out, {-3, -20, -4}, 6.0 * x, 3.0 * y);
  add_wall(out, {-3, -20, 4}, 2.2 * x, 3.0 * y);
  add_wall(out, {0.8, -20, 4}, 2.2 * x, 3.0 * y);
  add_wall(out, {-0.8, -17.8, 4}, 1.6 * x, 0.8 * y);
  add_wall(out, {-3, -17, -4}, 6.0 * x, 2.0 * z);
  add_wall(out, {-3, -17, -0.8}, 6.0 * x, 4.8 * z);
  add_wall(out, {-3, -17, -2}, 2.4 * x, 1.2 * z);
  add_wall(out, {0.6, -17, -2}, 2.4 * x, 1.2 * z);
  return out;
}

// The share at a place by rays against each triangle, rays_a_side squared of them (Moeller and
// Trumbore 1997).
double by_rays(std::span<const WorldTriangle> triangles, const Vec3& place_m, int rays_a_side) {
  double seen = 0.0, all = 0.0;
  for (int i = 0; i < rays_a_side; ++i)
    for (int k = 0; k < rays_a_side; ++k) {
      const double cosine = (i + 0.5) / rays_a_side, turn = 2.0 * kPi * (k + 0.5) / rays_a_side;
      const double sine = std::sqrt(1.0 - cosine * cosine);
      const Vec3 d(sine * std::cos(turn), cosine, sine * std::sin(turn));
      const bool hit = std::ranges::any_of(triangles, [&](const WorldTriangle& t) {
        const Vec3 e1 = t[1] - t[0], e2 = t[2] - t[0], p = glm::cross(d, e2), s = place_m - t[0];
        const double det = glm::dot(e1, p);
        if (det == 0.0) return false;
        const Vec3 q = glm::cross(s, e1);
        const double u = glm::dot(s, p) / det, v = glm::dot(d, q) / det;
        return u >= 0.0 && v >= 0.0 && u + v <= 1.0 && glm::dot(e2, q) / det > 0.0;
      });
      const double weight =
          shared::henyey_greenstein(static_cast<float>(cosine), shared::kDiffuseG);
      all += weight;
      if (!hit) seen += weight;
    }
  return seen / all;
}

}  // namespace

OpticsPoint skylight_point(std::uint32_t cell_cm, bool quick) {
  const std::vector<WorldTriangle> walls = hold();
  const scene::Skylight box{
      .low_m = {-6, -21, -7}, .high_m = {6, -14, 7}, .cell_m = cell_cm / 100.0};
  OpticsPoint point{"skylight", cell_cm, 0.0, 1e300};
  render::SkylightGrid grid;
  for (int i = 0; i < (quick ? 1 : 3); ++i) {
    const auto begun_ns = now_ns();
    grid = render::skylight_grid(box, walls);
    point.ms = std::min(point.ms, static_cast<double>(now_ns() - begun_ns) * 1e-6);
  }
  const double step_m = quick ? 1.0 : 0.5;
  double sum = 0.0;
  int count = 0;
  for (double y = -19.5; y <= -15.5; y += step_m)
    for (double z = -5.5; z <= 5.5; z += step_m)
      for (double x = -4.5; x <= 4.5; x += step_m) {
        const auto near = [](double at, double wall) { return std::abs(at - wall) < 0.5; };
        if (near(std::abs(x), 3.0) || near(std::abs(z), 4.0) || near(y, -17.0) || near(y, -20.0))
          continue;
        const Vec3 place(x, y, z);
        const double error = grid.at(place) - by_rays(walls, place, quick ? 24 : 64);
        sum += error * error;
        ++count;
      }
  point.error = std::sqrt(sum / count);
  return point;
}

}  // namespace neritic::tools
