// Flights that touch something in a current (physics_flights.hpp), by a controller in the loop.
#include <cmath>

#include "testbed/simulation/physics_world.hpp"
#include "testbed/simulation/static_scene.hpp"
#include "tools/tradeoff/flight_parts.hpp"

namespace neritic::tools {
using namespace testbed;
namespace {

// Down onto the bed, along it and turning there, up, and down again.
rov::Setpoint down_and_down_again(const rov::State&, double t_s) {
  rov::Setpoint s;
  s.attitude = rov::heading_attitude(t_s >= 6.0 && t_s < 11.0 ? 0.5 : 0.0);
  if (t_s < 6.0)
    s.position_ned_m = {0.3, 0.1, 0.2};
  else if (t_s < 11.0)
    s.position_ned_m = {1.2, 0.6, 0.05};
  else if (t_s < 13.5)
    s.position_ned_m = {1.0, 0.0, -1.0};
  else
    s.position_ned_m = {0.5, -0.5, 0.2};
  return s;
}

// Against the side of the wreck, along it, up its side and onto its deck.
rov::Setpoint along_the_wreck(const rov::State&, double t_s) {
  rov::Setpoint s;
  s.attitude = rov::heading_attitude(0.0);
  if (t_s < 4.0)
    s.position_ned_m = {6.0, 2.5, 15.5};
  else if (t_s < 9.0)
    s.position_ned_m = {8.0, 2.5, 15.3};
  else if (t_s < 11.0)
    s.position_ned_m = {7.5, 3.5, 14.0};
  else if (t_s < 14.0)
    s.position_ned_m = {7.5, 1.0, 12.7};
  else
    s.position_ned_m = {7.3, 1.0, 13.9};
  return s;
}

// Waves of sand in triangles of half a metre, up to 5 cm high and as steep as 1 in 5.
std::unique_ptr<const sim::StaticWorld> uneven_sand() {
  constexpr std::uint32_t kSide = 41;
  std::vector<float> heights_m;
  for (std::uint32_t i = 0; i < kSide * kSide; ++i)
    heights_m.push_back(static_cast<float>(0.03 * std::sin(12.9898 * i) +
                                           0.02 * std::cos(4.7 * (i % kSide)) - 0.05));
  sim::StaticWorldBuilder builder;
  builder.place(builder.add_heights(kSide, kSide, 0.5, heights_m, "sand").value(), {},
                {.friction = 0.5});
  return std::make_unique<const sim::StaticWorld>(builder.build());
}

}  // namespace

Flight landing_flight(bool uneven, double seconds) {
  Flight flight = vehicle_among_things(uneven ? "uneven sand, current" : "landing, current", true);
  if (uneven) flight.solid = uneven_sand();
  flight.inputs.assign(holds_of(seconds), {});
  flight.loop = loop_of(flight.vehicle, down_and_down_again);
  flight.current = turning_current();
  halved_truth(flight);
  return flight;
}

Result<Flight> wreck_flight(const std::filesystem::path& scene_file, double seconds) {
  NERITIC_TRY(const scene::Scene scene, scene::load_scene(scene_file));
  NERITIC_TRY(const auto world, PhysicsWorld::create(scene));
  const PhysicsVehicle& vehicle = world->vehicles().front();
  Flight flight{.name = "wreck, current", .vehicle = vehicle.vehicle, .body = vehicle.kind.solid};
  NERITIC_TRY(sim::StaticWorld solid, static_world_of(scene));
  flight.solid = std::make_unique<const sim::StaticWorld>(std::move(solid));
  rov::teleport(flight.start, {6.0, 3.3, 15.5}, glm::angleAxis(0.15, Vec3(0.6, 0.8, 0.0)));
  flight.inputs.assign(holds_of(seconds), {});
  flight.loop = loop_of(flight.vehicle, along_the_wreck);
  flight.current = turning_current();
  halved_truth(flight);
  return flight;
}

}  // namespace neritic::tools
