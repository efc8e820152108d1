#include "testbed/simulation/water_along.hpp"

#include "diver/human_step.hpp"
#include "rov/frames.hpp"
#include "rov/step.hpp"

namespace neritic::testbed {

diver::WaterFlow water_along(const std::optional<sim::Current>& current, const Vec3& position_ned_m,
                             const Vec3& velocity_ned_m_s, double time_s, double dt_s) {
  if (!current) return {};
  const Vec3 velocity_m_s = rov::world_from_ned(velocity_ned_m_s);
  const sim::CurrentSample water =
      sim::sample(*current, rov::world_from_ned(position_ned_m) + 0.5 * dt_s * velocity_m_s,
                  time_s + 0.5 * dt_s);
  const auto change_along = [&](const Vec3& way_m_s) {
    static_assert(rov::kMostWaterAcceleration_m_s2 == diver::kMostWaterAcceleration_m_s2);
    constexpr double kMost = rov::kMostWaterAcceleration_m_s2;
    return rov::ned_from_world(
        glm::clamp(water.rate_m_s2 + water.gradient_per_s * way_m_s, Vec3(-kMost), Vec3(kMost)));
  };
  const Vec3 change = change_along(velocity_m_s);
  return {rov::ned_from_world(water.velocity_m_s) - 0.5 * dt_s * change, change,
          change_along(water.velocity_m_s)};
}

}  // namespace neritic::testbed
