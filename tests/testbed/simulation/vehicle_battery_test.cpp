// Vehicles with a battery in a scene: what it bounds, where it ends, and who reads it.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "testbed/simulation/mission_outlook.hpp"
#include "testbed/simulation/output_samples.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kFar =
    "position_m = [0, -10, 0]\nmission = { waypoints = [ { position_m = [0, -10, -200] } ] }\n";

// A dive of a BlueROV2 Heavy that flies away with such a battery; none: an empty text.
TestDive flight(const std::string& battery, const std::string& table = "") {
  const test::ScratchFolder scratch;
  const std::string folder = vehicles_folder();
  EXPECT_TRUE(write_text(scratch / "v.toml", "include = \"" + folder +
                                                 "/bluerov2_heavy_dynamics.toml\"\n" + table +
                                                 (battery.empty() ? "" : "[battery]\n" + battery))
                  .ok());
  EXPECT_TRUE(write_text(scratch / "dive.toml",
                         std::string(kStillWater) +
                             "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nsize_m = [0.57, 0.26, "
                             "0.46]\ndynamics = \"v.toml\"\n" +
                             kFar)
                  .ok());
  auto scene = scene::load_scene(scratch / "dive.toml");
  if (!scene.ok()) {
    ADD_FAILURE() << scene.error().message;
    std::abort();
  }
  return dive_of(std::move(scene).value());
}

TEST(VehicleBattery, EmptyItFeedsNoThruster) {
  TestDive dive = flight("capacity_wh = 3\n");
  double emptied_s = 0.0, fastest_m_s = 0.0;
  dive.run(40.0, [&] {
    fastest_m_s = std::max(fastest_m_s, dive.speed_m_s());
    const rov::BatteryState& now = *dive.world->battery(dive.state(), 0);
    if (now.empty != 0 && emptied_s == 0.0) emptied_s = dive.time_s();
  });
  EXPECT_GT(emptied_s, 2.0);
  EXPECT_LT(emptied_s, 30.0);
  EXPECT_GT(fastest_m_s, 0.3);
  EXPECT_LT(dive.speed_m_s(), 0.15 * fastest_m_s);
  for (const double command : dive.vehicle().command_n) EXPECT_EQ(command, 0.0);
  EXPECT_EQ(dive.vehicle().mission.arrived, 0u);
}

TEST(VehicleBattery, OneThatCannotLastIsToldBeforeTheDive) {
  const auto told = [](const std::string& battery) {
    std::string out;
    for (const std::string& line : cannot_hold(*flight(battery).world)) out += line;
    return out;
  };
  // 200 m at 0.5 m/s with 20 W: 400 s take 2.22 Wh.
  EXPECT_EQ(told("capacity_wh = 2.3\n"), "");
  EXPECT_EQ(told("capacity_wh = 2.2\n"),
            "rov: its battery's 2.2 Wh are gone before the 400 s of its way are: its electronics "
            "alone draw 20 W");
  EXPECT_THAT(told("charge = 0\n"), testing::HasSubstr("0 Wh are gone"));
  EXPECT_EQ(told(""), "");
}

TEST(VehicleBattery, ItsVoltageBoundsTheThrustOfATable) {
  const std::string table = "thrust_table = \"" + vehicles_folder() + "/t200_thrust.csv\"\n";
  const auto fastest = [&](const std::string& battery) {
    TestDive dive = flight(battery, table);
    dive.run(12.0);
    return dive.speed_m_s();
  };
  const double full = fastest("full_v = 16.8\nempty_v = 10\nresistance_ohm = 0.01\n");
  const double low = fastest("full_v = 16.8\nempty_v = 10\nresistance_ohm = 0.01\ncharge = 0.05\n");
  EXPECT_LT(low, 0.93 * full);
  EXPECT_GT(low, 0.5 * full);
}

TEST(VehicleBattery, IsSampledSavedAndTheSameOnAnyNumberOfThreads) {
  TestDive dive = flight("capacity_wh = 20\n");
  const auto threaded = dive.world->simulation({}, 3);
  threaded->advance(240 * 5);
  OutputSamples outputs(*dive.world, {dive.world->streams().find("rov/battery").value()});
  std::vector<BatteryReading> told;
  dive.run(5.0, [&] {
    for (const Sample& sample : outputs.of(dive.simulation->newest()))
      told.push_back(std::get<BatteryReading>(sample.payload));
  });
  EXPECT_EQ(threaded->newest().hash, dive.simulation->newest().hash);
  ASSERT_GE(told.size(), 5u);
  for (std::size_t i = 1; i < told.size(); ++i) {
    EXPECT_LT(told[i].charge, told[i - 1].charge);
    EXPECT_GT(told[i].left_s, 0.0);
    EXPECT_NEAR(told[i].voltage_v, 12.8 + 4.0 * told[i].charge - 0.05 * told[i].current_a, 1e-3);
  }
  const auto format = dive.world->state_format();
  const auto saved =
      parse_state(format, encode_state(format, saved_state(*dive.simulation, format)), "a");
  ASSERT_TRUE(saved.ok()) << saved.error().message;
  const auto other = dive.world->simulation({});
  restore_state(*other, *saved);
  dive.run(2.0), other->advance(240 * 2);
  EXPECT_EQ(dive.simulation->newest().hash, other->newest().hash);
}

TEST(VehicleBattery, AVehicleWithoutOneHasNoStreamOfItAndNoState) {
  const TestDive dive = flight("");
  EXPECT_FALSE(dive.world->streams().find("rov/battery").has_value());
  EXPECT_EQ(dive.state().batteries().size(), 0u);
  EXPECT_EQ(dive.world->battery(dive.state(), 0), nullptr);
}

}  // namespace
}  // namespace neritic::testbed
