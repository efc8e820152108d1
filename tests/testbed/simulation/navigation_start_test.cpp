// Vehicles that accelerate from the start: levelled by a force that is not gravity's alone.
#include "tests/rov/navigation_runs.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

// The survey vehicle 15 m deep over 40 m, with keys of its dynamics.
TestDive starting(std::uint64_t seed, const std::string& dynamics_keys) {
  const test::ScratchFolder folder;
  const std::string vehicles = vehicles_folder();
  EXPECT_TRUE(write_text(folder / "survey.toml", "include = \"" + vehicles +
                                                     "/bluerov2_heavy_survey_dynamics.toml\"\n" +
                                                     dynamics_keys)
                  .ok());
  EXPECT_TRUE(write_text(folder / "dive.toml",
                         "seed = " + std::to_string(seed) +
                             "\n[physics]\n[[objects]]\nname = \"floor\"\nshape = \"plane\"\n"
                             "size_m = [400, 400]\nposition_m = [0, -40, 0]\nclass = \"seabed\"\n"
                             "[[vehicles]]\nname = \"rov\"\ninclude = \"" +
                             vehicles + "/rov.toml\"\ndynamics = \"" +
                             (folder / "survey.toml").string() +
                             "\"\nposition_m = [0, -15, 0]\n[vehicles.mission]\nspeed_m_s = 0.5\n"
                             "waypoints = [{position_m = [0, -15, -10]}]\n")
                  .ok());
  auto scene = scene::load_scene(folder / "dive.toml");
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  return dive_of(std::move(scene).value());
}

// 704 N too buoyant, 307 N too heavy: up or down at 3 to 8 m/s^2 from the first step on.
TEST(NavigationStart, TooBuoyantOrTooHeavyItKnowsWhereItIs) {
  for (const char* keys : {"volume_m3 = 0.0829\n", "mass_kg = 45\n"})
    for (std::uint64_t seed = 1; seed <= 12; ++seed) {
      SCOPED_TRACE(keys);
      SCOPED_TRACE(seed);
      TestDive dive = starting(seed, keys);
      double most_m = 0.0, most_tilt_rad = 0.0;
      dive.run(15.0, [&] {
        const auto estimate = dive.world->estimate(dive.state(), 0);
        const rov::State& body = dive.vehicle().body;
        most_m = std::max(most_m, glm::distance(body.position_ned_m, estimate->position_ned_m));
        if (dive.time_s() > 5.0)
          most_tilt_rad =
              std::max(most_tilt_rad, glm::length(rov::rotation_vector(
                                          body.attitude * glm::conjugate(estimate->attitude))));
      });
      EXPECT_LT(most_m, 0.8);
      EXPECT_LT(most_tilt_rad, radians(5.0));
      EXPECT_EQ(dive.state().navigation()[0].begun_anew, 0u);
      EXPECT_GT(dive.vehicle().body.position_ned_m.z, -1.0);
    }
}

// Dropped with 200 kg it hits the bottom at 2.9 m/s, harder than its inertial unit measures: it
// does not go on as if nothing had been.
TEST(NavigationStart, AHitBeyondItsInertialUnitIsNotOverlooked) {
  for (std::uint64_t seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    TestDive dive = starting(seed, "mass_kg = 200\n");
    double most_m = 0.0;
    dive.run(25.0, [&] {
      const auto estimate = dive.world->estimate(dive.state(), 0);
      most_m = std::max(
          most_m, glm::distance(dive.vehicle().body.position_ned_m, estimate->position_ned_m));
    });
    EXPECT_GT(dive.vehicle().contact.touched_steps, 1000u);
    EXPECT_GT(dive.state().navigation()[0].imu_refused, 0u);
    EXPECT_LT(most_m, 4.0);  // what it does not know of its tilt and speed, from fix to fix
    const rov::State& body = dive.vehicle().body;
    const auto estimate = dive.world->estimate(dive.state(), 0);
    EXPECT_LT(rov::normalized_square(dive.state().navigation()[0], rov::kPositionError,
                                     body.position_ned_m - estimate->position_ned_m),
              16.0);
  }
}

}  // namespace
}  // namespace neritic::testbed
