// Vehicles that name near_added_mass: heavier near the bottom, lighter under the surface, as in
// open water far from both; without the key as before.
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// Over a level bottom 20 m deep, without thrust: buoyancy alone lifts it.
TestDive rising(double depth_m, const std::string& keys) {
  return dive_of(
      load_text(std::string(kStillWater) +
                "[[objects]]\nname = \"bottom\"\nclass = \"seabed\"\nshape = \"box\"\nsize_m = "
                "[80, 2, 80]\nposition_m = [0, -21, 0]\n" +
                rov_text(fmt::format("position_m = [0, {}, 0]\nfailed_thrusters = [1, 2, 3, 4, 5, "
                                     "6, 7, 8]\n{}",
                                     -depth_m, keys)))
          .value());
}

double lifted_m_s(double depth_m, const std::string& keys) {
  TestDive dive = rising(depth_m, keys);
  dive.run(0.1);
  return dive.speed_m_s();
}

TEST(NearBounds, AVehicleIsAsHeavyAsItsPlaceSays) {
  const std::string near = "near_added_mass = true\n";
  const TestDive dive = rising(10.0, near);
  const PhysicsVehicle& vehicle = dive.world->vehicles()[0];
  const double radius_m = vehicle.near_radius_m;
  EXPECT_NEAR(radius_m, std::cbrt(0.75 / kPi * vehicle.vehicle.displaced_kg / 1025.0), 0.002);
  const double mass_kg = vehicle.vehicle.mass(2, 2),
               added_kg = mass_kg - vehicle.vehicle.rigid_mass(2, 2);
  const double open_m_s = lifted_m_s(10.0, "");
  EXPECT_EQ(lifted_m_s(10.0, near), open_m_s);
  const auto wanted = [&](double away_m, double sign) {
    const double share = sign * 0.375 * std::pow(radius_m / away_m, 3.0);
    return mass_kg / (mass_kg + share * added_kg);
  };
  // The centre of buoyancy lies 0.01 m over the origin.
  EXPECT_NEAR(lifted_m_s(19.75, near) / open_m_s, wanted(0.26, 1.0), 0.003);
  EXPECT_EQ(lifted_m_s(19.75, ""), open_m_s);
  EXPECT_NEAR(lifted_m_s(0.36, near) / lifted_m_s(0.36, ""), wanted(0.35, -1.0), 0.003);
}

TEST(NearBounds, ARestoredRunGoesOnWithTheSameHashes) {
  const std::string near =
      "near_added_mass = true\nmission = { waypoints = [ { position_m = [3, "
      "-19.6, 2] }, { position_m = [0, -0.5, 0] } ] }\n";
  const auto dive_to = [&] {
    return dive_of(
        load_text(std::string(kStillWater) +
                  "[[objects]]\nname = \"bottom\"\nclass = \"seabed\"\nshape = "
                  "\"box\"\nsize_m = [80, 2, 80]\nposition_m = [0, -21, 0]\n" +
                  rov_text("position_m = [0, -19.5, 0]\nnavigation = \"truth\"\n" + near))
            .value());
  };
  TestDive whole = dive_to();
  whole.run(2.0);
  const StateFormat format = whole.world->state_format();
  const SavedState saved = saved_state(*whole.simulation, format);
  whole.run(2.0);
  TestDive again = dive_to();
  restore_state(*again.simulation, saved);
  again.run(2.0);
  EXPECT_EQ(again.simulation->newest().hash, whole.simulation->newest().hash);
}

}  // namespace
}  // namespace neritic::testbed
