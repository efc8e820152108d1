// Thrusters at the surface: they draw air, and above it they push nothing.
#include "testbed/simulation/surface.hpp"

#include <limits>

#include "rov/vehicle_file.hpp"
#include "rov/ventilation.hpp"
#include "tests/testbed/simulation/dives.hpp"
#include "tests/testbed/simulation/senders.hpp"

namespace neritic::testbed {
namespace {

// One thruster that pushes up, 0.2 m above the origin, with a propeller of 0.2 m.
rov::Vehicle riser() {
  rov::VehicleParameters p;
  p.name = "riser";
  p.mass_kg = 10.0;
  p.inertia_kg_m2 = Mat3(1.0);
  p.weight_n = p.buoyancy_n = 98.2;
  p.thrusters.push_back({.position_m = {0.0, 0.0, -0.2},
                         .direction = {0.0, 0.0, -1.0},
                         .min_n = -20.0,
                         .max_n = 20.0,
                         .propeller_m = 0.2});
  return make_vehicle(p).value();
}

double commanded_n(const rov::Vehicle& vehicle, double depth_m, double head_m, double command_n) {
  rov::State state;
  state.position_ned_m.z = depth_m;
  rov::Inputs inputs;
  inputs.thruster_n[0] = command_n;
  apply_surface(vehicle, 0.25, -0.25, state, head_m, inputs);
  return inputs.thruster_n[0];
}

TEST(Surface, AThrusterNearItKeepsTheShareOfItsShaftsDepth) {
  const rov::Vehicle vehicle = riser();
  EXPECT_EQ(commanded_n(vehicle, 5.0, 0.0, 12.0), 12.0);
  EXPECT_EQ(commanded_n(vehicle, 0.2 + 0.131, 0.0, 12.0), 12.0);
  // The shaft at the surface, in a trough and under a crest.
  EXPECT_NEAR(commanded_n(vehicle, 0.2, 0.0, 12.0), 0.325 * 12.0, 1e-9);
  EXPECT_NEAR(commanded_n(vehicle, 0.7, -0.5, -12.0), -0.325 * 12.0, 1e-9);
  EXPECT_EQ(commanded_n(vehicle, 0.2, 0.2, 12.0), 12.0);
  // A command beyond the motor is of a motor at its limit.
  EXPECT_NEAR(commanded_n(vehicle, 0.2, 0.0, 500.0), 0.325 * 20.0, 1e-9);
  EXPECT_EQ(commanded_n(vehicle, 0.1, 0.0, 12.0), 0.0);
}

// Also where the shape that is buoyed up ends below its thruster.
TEST(Surface, AThrusterAboveTheShapeIsInTheAirToo) {
  rov::State state;
  state.position_ned_m.z = 0.1;
  rov::Inputs inputs;
  inputs.thruster_n[0] = 12.0;
  apply_surface(riser(), 0.05, -0.05, state, 0.0, inputs);
  EXPECT_EQ(inputs.thruster_n[0], 0.0);
  EXPECT_EQ(inputs.wrench[2], 0.0);
}

TEST(Surface, ExtremesStayWhole) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  rov::Vehicle vehicle = riser();
  EXPECT_EQ(commanded_n(vehicle, 1.0, nan, 12.0), 12.0);
  EXPECT_EQ(commanded_n(vehicle, 1.0, 1e300, 12.0), 12.0);
  EXPECT_EQ(commanded_n(vehicle, 1.0, -1e300, 12.0), 0.0);
  vehicle.thrusters[0].propeller_m = 0.0;
  EXPECT_EQ(commanded_n(vehicle, 0.2, 0.0, 12.0), 12.0);
  EXPECT_EQ(commanded_n(vehicle, 0.19, 0.0, 12.0), 0.0);
}

// A vehicle that is driven up against the surface: what rises out of the water weighs on it, and
// its vertical thrusters, near the surface, push no more than the share of what they are told.
TEST(Surface, AVehicleThatDrivesUpLosesThrustAsItSurfaces) {
  TestDive dive =
      dive_of(load_text(kStillWater + rov_text("position_m = [0, -1, 0]\n", "rov")).value());
  const rov::Vehicle& vehicle = dive.world->vehicles()[0].vehicle;
  SampleInbox& inbox = dive.simulation->inbox();
  const SourceId source = inbox.open("pilot").value();
  const StreamId stream = dive.world->streams().find("rov/wrench").value();
  const StreamId events = dive.world->streams().find("rov/event").value();
  EXPECT_EQ(inbox.push({{events, source, 0, 0, 0},
                        hand_over(static_cast<std::size_t>(VehicleGroup::kWrench), Authority::kLive,
                                  source)}),
            SampleVerdict::kAccepted);
  bool partly = false;
  double shallowest_m = 1.0;
  for (std::uint64_t i = 0; i < 160; ++i) {
    const auto now = static_cast<TimeNs>(dive.time_s() * 1e9);
    VehicleWrench wrench;
    wrench.wrench[2] = -100.0;
    EXPECT_EQ(inbox.push({{stream, source, i, now, now}, wrench}), SampleVerdict::kAccepted);
    dive.run(0.0625);
    const auto& state = dive.state().vehicles()[0];
    const auto forces_n = rov::thruster_forces(vehicle, state.body, state.body.held);
    shallowest_m = std::min(shallowest_m, state.body.position_ned_m.z);
    for (std::size_t k = 0; k < vehicle.thruster_count; ++k) {
      const rov::Thruster& thruster = vehicle.thrusters[k];
      const Vec3 along = state.body.attitude * thruster.direction;
      if (std::abs(along.z) < 0.9) continue;
      const double deep_m =
          state.body.position_ned_m.z + (state.body.attitude * thruster.position_m).z;
      const double share = rov::thrust_share(deep_m, 0.5 * thruster.propeller_m, along.z);
      partly = partly || (share > 0.0 && share < 1.0);
      // It bobs, and the thrust follows by its lag.
      const double before = rov::thrust_share(deep_m + 0.02, 0.5 * thruster.propeller_m, along.z);
      if (i > 80) {
        EXPECT_LE(std::abs(forces_n[k]), before * std::abs(state.command_n[k]) + 0.5) << i;
      }
    }
  }
  EXPECT_TRUE(partly);
  EXPECT_GT(shallowest_m, -0.1);
}

}  // namespace
}  // namespace neritic::testbed
