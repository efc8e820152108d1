// Vehicle sensors as a part of the state: their values against readings taken outside of the step.
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kSurvey = "bluerov2_heavy_survey_dynamics.toml";

// At a rate of which every sensor's samples are states.
TEST(SensorState, TheStepReadsWhatTheSensorsReadOfEachState) {
  TestDive dive = dive_of(
      std::string(kStillWater) + "rate_hz = 200\n" +
      "[[objects]]\nname = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\nsize_m = [40, 40]\n"
      "position_m = [0, -12, 0]\n" +
      rov_text("position_m = [0, -10, 0]\n", "plain") +
      rov_text(
          "position_m = [3, -10, 0]\nmission = { waypoints = [ { position_m = [6, -9, -3] } ] }\n",
          "survey", kSurvey));
  const PhysicsVehicle& survey = dive.world->vehicles()[1];
  rov::SensorReadings expected;
  const auto sense = [&](double from_s, double to_s) {
    rov::update_readings(survey.file.sensors, dive.world->sensor_world(1), survey.vehicle,
                         dive.vehicle(1).body, dive.vehicle(1).contact.acceleration, from_s, to_s,
                         expected);
  };
  sense(-1.0, 0.0);
  const double dt_s = dive.world->step_s();
  for (int i = 0; i < 720; ++i) {
    const rov::SensorReadings* found = dive.world->readings(dive.state(), 1);
    ASSERT_NE(found, nullptr);
    ASSERT_TRUE(sim::same_bits(*found, expected)) << i;
    dive.simulation->advance(1);
    sense(dive.time_s() - dt_s, dive.time_s());
  }
  EXPECT_GT(expected.imu.count, 500u);
  EXPECT_GT(expected.dvl.count, 5u);
}

// A lake of fresh water at 1000 m: the pressure is that of its water under its air, whatever water
// the sensor is set for.
TEST(SensorState, PressureIsThatOfTheScenesWater) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "set_for_the_sea.toml",
                         "include = \"" + vehicles_folder() +
                             "/bluerov2_heavy_dynamics.toml\"\n[pressure]\n")
                  .ok());
  const TestDive dive =
      dive_of(std::string("[physics]\nwater_kg_m3 = 1000\naltitude_m = 1000\n") +
              "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nposition_m = [0, -20, 0]\n"
              "dynamics = \"" +
              (scratch / "set_for_the_sea.toml").string() + "\"\n");
  const rov::PressureReading& read = dive.world->readings(dive.state(), 0)->pressure.value;
  EXPECT_NEAR(read.pressure_pa, 89875.0 + 1000.0 * 9.82 * 20.0, 2.0);  // US Standard Atmosphere
  EXPECT_NEAR(read.depth_m, 20.0 * 1000.0 / 1025.0, 1e-9);
}

TEST(SensorState, AVehicleWithoutSensorsTakesNoSpaceForThem) {
  const TestDive plain = dive_of(kStillWater + rov_text("position_m = [0, -10, 0]\n")),
                 survey =
                     dive_of(kStillWater + rov_text("position_m = [0, -10, 0]\n", "s", kSurvey));
  EXPECT_EQ(plain.state().bytes().size(), sizeof(VehicleState));
  EXPECT_EQ(plain.world->readings(plain.state(), 0), nullptr);
  EXPECT_EQ(survey.state().bytes().size(),
            sizeof(VehicleState) + sizeof(rov::SensorReadings) + sizeof(rov::NavigationState));
}

// One sample a second (diver::kComputerSample_s), counted by the step alone.
TEST(SensorState, TheDiveComputerSamplesByItsOwnClock) {
  TestDive dive =
      dive_of(kStillWater + diver_text(std::string("position_m = [0, -10, 0]\n") + kProne));
  const auto computer = [&] { return dive.state().humans()[0].human.life.computer; };
  auto before = computer();
  int samples = 0;
  for (int i = 1; i <= 720; ++i) {
    dive.simulation->advance(1);
    const bool sampled = !sim::same_bits(before, computer());
    const double periods = dive.time_s() / diver::kComputerSample_s;
    EXPECT_EQ(sampled,
              std::floor(periods + 1e-9) !=
                  std::floor(periods - dive.world->step_s() / diver::kComputerSample_s + 1e-9))
        << i;
    samples += sampled ? 1 : 0;
    before = computer();
  }
  EXPECT_EQ(samples, static_cast<int>(3.0 / diver::kComputerSample_s + 1e-9));
}

}  // namespace
}  // namespace neritic::testbed
