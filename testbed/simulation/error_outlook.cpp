#include "testbed/simulation/error_outlook.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "rov/step_choice.hpp"

namespace neritic::testbed {

namespace {

// Of missions that name no speed: what the shipped vehicles reach.
constexpr double kFast_m_s = 1.0;

}  // namespace

std::string not_promised(const scene::Scene& scene, const PhysicsWorld& world) {
  const double asked_m = scene.physics ? scene.physics->max_error_m : 0.0;
  if (asked_m == 0.0) return {};
  bool pulses = false, navigates = false;
  double leaves_m = 0.0;  // the way of a control period past a waypoint
  for (const PhysicsVehicle& vehicle : world.vehicles()) {
    if (!vehicle.mission) continue;
    pulses = pulses || vehicle.file.curve.has_value();
    navigates = navigates || vehicle.navigation.has_value();
    const double speed_m_s = vehicle.mission->speed_m_s();
    if (vehicle.mission->waypoint_count() > 1)
      leaves_m = std::max(leaves_m,
                          (speed_m_s > 0.0 ? speed_m_s : kFast_m_s) * vehicle.file.gains.period_s);
  }
  const bool controlled = std::ranges::any_of(
      world.vehicles(), [](const PhysicsVehicle& vehicle) { return bool(vehicle.mission); });
  std::vector<std::string> reasons;
  if (pulses && asked_m < rov::kTurnedPulse_m)
    reasons.push_back(fmt::format(
        "a thruster's pulse that is rounded to the other microsecond, up to {:g} m after 20 s",
        rov::kTurnedPulse_m));
  if (asked_m < leaves_m)
    reasons.push_back(fmt::format(
        "a waypoint that is left a control period sooner or later, up to {:.2g} m", leaves_m));
  if (controlled && asked_m < rov::kTouchedUnderControl_m && world.solid().counts().things > 0)
    reasons.push_back(
        fmt::format("contacts under control, up to {:g} m", rov::kTouchedUnderControl_m));
  if (navigates) reasons.emplace_back("a vehicle that flies on what it measures, by any distance");
  if (world.vehicles().size() + world.humans().size() > 1 || world.tethers().any() ||
      !world.things().grips().empty())
    reasons.emplace_back(
        "steps in which participants meet, hold things or pull a tether, since "
        "they are not refined");
  if (reasons.empty()) return {};
  return fmt::format("{}: physics.max_error_m: {:g} m holds for the integration, not for {}",
                     scene.path, asked_m, fmt::join(reasons, "; "));
}

}  // namespace neritic::testbed
