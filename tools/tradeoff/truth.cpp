#include "tools/tradeoff/truth.hpp"

#include <algorithm>
#include <thread>

#include "engine/core/check.hpp"

namespace neritic::tools {
namespace {

struct Return {
  double range_m, strength;
};

// All returns of one thin column of rays.
void trace_column(const RayWorld& world, const sonar::BeamGrid& finest, double azimuth_rad,
                  std::uint32_t rays, std::vector<Return>& out) {
  out.clear();
  const sonar::Limits& l = finest.limits;
  for (std::uint32_t i = 0; i < rays; ++i) {
    const double elevation =
        l.elevation_min_rad + (i + 0.5) / rays * (l.elevation_max_rad - l.elevation_min_rad);
    const Vec3 d = sonar::direction(azimuth_rad, elevation);
    const RayHit hit = world.cast(d);
    const double cosine = -glm::dot(Vec3(hit.normal), d);
    if (hit.t > 0.0 && cosine > 0.0) out.push_back({hit.t, cosine * hit.reflectivity});
  }
}

}  // namespace

std::vector<Truth> trace_truth(const RayWorld& world, const sonar::BeamGrid& finest,
                               const std::vector<sonar::Bins>& wanted, std::uint32_t rays_a_side) {
  std::vector<Truth> truths;
  for (const sonar::Bins& bins : wanted) {
    NERITIC_CHECK(finest.bins.azimuth % bins.azimuth == 0, "{} bins of {}", bins.azimuth,
                  finest.bins.azimuth);
    truths.push_back({bins, std::vector<double>(std::size_t{bins.range} * bins.azimuth)});
  }
  const std::uint32_t rays = finest.bins.elevation * rays_a_side;
  // A thread takes whole columns of every number of bins.
  const auto trace = [&](std::uint32_t first, std::uint32_t end) {
    std::vector<Return> returns;
    for (std::uint32_t column = first; column < end; ++column)
      for (std::uint32_t k = 0; k < rays_a_side; ++k) {
        const double azimuth = finest.limits.azimuth_min_rad +
                               (column + (k + 0.5) / rays_a_side) * finest.azimuth_step_rad();
        trace_column(world, finest, azimuth, rays, returns);
        for (Truth& truth : truths) {
          const std::uint32_t merged = finest.bins.azimuth / truth.bins.azimuth;
          for (const Return& r : returns)
            if (const auto row = sonar::bin_index(r.range_m, finest.limits.range_min_m,
                                                  finest.limits.range_max_m, truth.bins.range))
              truth.intensity[std::size_t{*row} * truth.bins.azimuth + column / merged] +=
                  r.strength / (static_cast<double>(rays) * rays_a_side * merged);
        }
      }
  };
  std::uint32_t half = finest.bins.azimuth / 2;
  for (const Truth& truth : truths) half -= half % (finest.bins.azimuth / truth.bins.azimuth);
  std::thread other([&] { trace(0, half); });
  trace(half, finest.bins.azimuth);
  other.join();
  return truths;
}

}  // namespace neritic::tools
