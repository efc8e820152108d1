// A vehicle's knowledge of its motion (physics_world.hpp): by its own sensors, or its true state.
#include "testbed/simulation/physics_world.hpp"

namespace neritic::testbed {

Result<std::optional<rov::NavigationModel>> choose_navigation(const scene::Scene& scene,
                                                              const scene::Object& object,
                                                              const rov::SensorSet& sensors) {
  using Navigation = scene::Dynamics::Navigation;
  const Navigation wanted = object.dynamics->navigation;
  const std::string missing = rov::missing_for_navigation(sensors);
  if (wanted == Navigation::kMeasured && !missing.empty())
    return bad_input(
        "{}: {}: navigation: found \"measured\"; accepted: \"truth\", or {} added to {}",
        scene.path, object.name, missing, object.dynamics->file.string());
  std::optional<rov::NavigationModel> out;
  if (wanted != Navigation::kTruth && missing.empty()) out = rov::navigation_model(sensors);
  return out;
}

void PhysicsWorld::start_navigation(std::size_t index, PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (!vehicle.navigation) return;
  state.navigation()[vehicle.navigation->place] =
      rov::start_navigation(vehicle.navigation->model, *readings(state, index),
                            rov::surveyed_launch(vehicle.start.position_ned_m, seed_, index), 0.0);
}

void PhysicsWorld::navigate(std::size_t index, double time_s, PhysicsState& state) const {
  const PhysicsVehicle& vehicle = vehicles_[index];
  if (vehicle.navigation)
    rov::update_navigation(vehicle.navigation->model, *readings(state, index), time_s,
                           state.navigation()[vehicle.navigation->place]);
}

const rov::NavigationState* PhysicsWorld::navigation(const PhysicsState& state,
                                                     std::size_t vehicle) const {
  const auto& at = vehicles_[vehicle].navigation;
  return at ? &state.navigation()[at->place] : nullptr;
}

std::optional<rov::NavigationEstimate> PhysicsWorld::estimate(const PhysicsState& state,
                                                              std::size_t vehicle) const {
  const rov::NavigationState* found = navigation(state, vehicle);
  if (!found) return std::nullopt;
  return rov::estimate_of(vehicles_[vehicle].navigation->model, *found);
}

rov::State PhysicsWorld::known_state(const PhysicsState& state, std::size_t vehicle,
                                     double time_s) const {
  const rov::State& body = state.vehicles()[vehicle].body;
  const rov::NavigationState* found = navigation(state, vehicle);
  if (!found) return body;
  return rov::estimated_state(vehicles_[vehicle].navigation->model, *found, time_s, body);
}

}  // namespace neritic::testbed
