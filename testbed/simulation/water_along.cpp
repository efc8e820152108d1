#include "testbed/simulation/water_along.hpp"

#include <algorithm>

#include "diver/human_step.hpp"
#include "rov/frames.hpp"
#include "rov/step.hpp"

namespace neritic::testbed {
namespace {

// So high over the surface waves no longer reach a body.
constexpr double kFades_m = 0.5;

}  // namespace

diver::WaterFlow water_along(const std::optional<sim::Current>& current,
                             const std::optional<SeaWaves>& waves, const Vec3& position_ned_m,
                             const Vec3& velocity_ned_m_s, double time_s, double dt_s) {
  if (!current && !waves) return {};
  const Vec3 velocity_m_s = rov::world_from_ned(velocity_ned_m_s);
  const Vec3 halfway_m = rov::world_from_ned(position_ned_m) + 0.5 * dt_s * velocity_m_s;
  const double halfway_s = time_s + 0.5 * dt_s;
  sim::CurrentSample water;
  double head_m = 0.0;
  if (current) water = sim::sample(*current, halfway_m, halfway_s);
  const Vec3 steady_m_s = water.velocity_m_s;
  if (waves) {
    const WaveFlow flow = waves->flow(halfway_m, halfway_s);
    const double wet = std::clamp(1.0 - (halfway_m.y - flow.head_m) / kFades_m, 0.0, 1.0);
    water.velocity_m_s += wet * flow.velocity_m_s;
    water.gradient_per_s += wet * flow.gradient_per_s;
    water.rate_m_s2 += wet * flow.rate_m_s2;
    head_m = flow.head_m;
  }
  const auto change_along = [&](const Vec3& way_m_s) {
    static_assert(rov::kMostWaterAcceleration_m_s2 == diver::kMostWaterAcceleration_m_s2);
    constexpr double kMost = rov::kMostWaterAcceleration_m_s2;
    return rov::ned_from_world(
        glm::clamp(water.rate_m_s2 + water.gradient_per_s * way_m_s, Vec3(-kMost), Vec3(kMost)));
  };
  const Vec3 change = change_along(velocity_m_s);
  diver::WaterFlow out{rov::ned_from_world(water.velocity_m_s) - 0.5 * dt_s * change, change,
                       change_along(water.velocity_m_s)};
  out.head_m = head_m;
  if (waves) out.waves_m_s = out.current_m_s - rov::ned_from_world(steady_m_s);
  return out;
}

}  // namespace neritic::testbed
