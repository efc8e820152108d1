// The words, logs and plots of `neritic dive` for a dive by physics alone.
#include "tests/tools/dive_physics.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"

namespace neritic {
namespace {

TEST_F(DivePhysics, QuietlyItPrintsItsJsonAlone) {
  const std::string recording = file("a.mcap");
  const Outcome quiet = dive("-q --headless --seconds 1 --record " + recording);
  EXPECT_EQ(quiet.status, 0) << quiet.err;
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(dive("-q --headless --replay " + recording).out, "");
  EXPECT_TRUE(parse_json(dive("-q --headless --seconds 1 --json").out).ok());
}

TEST_F(DivePhysics, FliesWithoutADeviceAndSaysWhatCameOfIt) {
  const Outcome outcome = dive("--headless --seconds 20 --log " + file("a.csv"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out.rfind("rov: 2 of 2 waypoints (the last after ", 0), 0u) << outcome.out;
  EXPECT_NE(outcome.out.find("touched nothing\n20 s in 4800 steps, "), std::string::npos)
      << outcome.out;
  const auto columns = table("a.csv");
  const auto& times = columns.at("time_s");
  ASSERT_EQ(times.size(), 1001u);  // 50 a second, and the start
  EXPECT_EQ(times.front(), "0");
  EXPECT_EQ(times.back(), "20");
  EXPECT_NEAR(std::stod(columns.at("x_m").back()), 1.0, 0.05);
  EXPECT_NEAR(std::stod(columns.at("depth_m").back()), 7.0, 0.05);
  EXPECT_EQ(columns.at("arrived").back(), "2");
  EXPECT_EQ(columns.at("thrust_8_n").size(), 1001u);
  // The hash of the last row is the one that is said.
  EXPECT_NE(outcome.out.find("hash " + columns.at("hash").back()), std::string::npos);
}

TEST_F(DivePhysics, ATimeShorterThanAStepIsOneStep) {
  const Outcome outcome = dive("--headless --seconds 5e-324 --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = parse_json(outcome.out);
  ASSERT_TRUE(json.ok());
  EXPECT_EQ((*json)["steps"], 1);
}

TEST_F(DivePhysics, KeepsTheClocksPaceWhenToldTo) {
  const Outcome outcome = dive("--headless --seconds 1 --realtime --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = parse_json(outcome.out);
  ASSERT_TRUE(json.ok());
  EXPECT_EQ((*json)["steps"], 240);
  EXPECT_GT((*json)["wall_s"].get<double>(), 0.98);
}

TEST_F(DivePhysics, WhatCannotBeWrittenIsSaidBeforeItFliesAndTheRestIsWritten) {
  for (const std::string& file : {file("none/a.csv"), "'" + scratch_.path().string() + "'"}) {
    const Outcome early = dive("--headless --realtime --seconds 600 --log " + file);
    EXPECT_EQ(early.status, 1);
    EXPECT_NE(early.err.find(": cannot be written\n"), std::string::npos) << early.err;
    EXPECT_EQ(early.out, "");
  }
  const Outcome full = dive("--headless --seconds 1 --record /dev/full --log " + file("a.csv"));
  EXPECT_EQ(full.status, 1);
  EXPECT_NE(full.err.find("/dev/full: cannot be written whole"), std::string::npos) << full.err;
  EXPECT_EQ(table("a.csv").at("time_s").size(), 51u);
  EXPECT_NE(full.out.find("hash "), std::string::npos) << full.out;
}

TEST_F(DivePhysics, DrawsItsPlotAndKeepsTheRateOfItsRows) {
  const Outcome outcome = dive("--headless --seconds 4 --log-rate 10 --log " + file("a.csv") +
                               " --plot " + file("a.png"));
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(table("a.csv").at("time_s").size(), 41u);
  const auto image = scene::read_image8(scratch_ / "a.png", 3);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width, 1600u);
  EXPECT_GT(image->height, 800u);
  const auto data = parse_json(read_text(scratch_ / "a.plot.json").value());
  ASSERT_TRUE(data.ok()) << data.error().message;
  EXPECT_EQ((*data)["vehicles"][0]["depth_m"].size(), 41u);
}

// From 24 m up to 17 m with nitrox for 21 m: said in words, in --json and in the log.
TEST_F(DivePhysics, AGasSwitchIsToldAndDrawn) {
  const std::string model = (test::source_dir() / "assets/models/diver.glb").string();
  ASSERT_TRUE(
      write_text(scratch_ / "nitrox.toml", "tanks = [ {}, { oxygen = 0.5, volume_l = 7 } ]\n")
          .ok());
  ASSERT_TRUE(write_text(scratch_ / "up.toml", R"(title = "up"
[physics]
[[objects]]
name = "diver"
class = "diver"
human = "nitrox.toml"
position_m = [0, -24, 0]
pitch_deg = -90
swim = { speed_m_s = 0.45, waypoints_m = [[0, -17, -24]] }
model = ")" + model + "\"\n")
                  .ok());
  const std::string flags = "--headless --seconds 60 --log-rate 1 --log " + file("a.csv");
  const Outcome told = dive(flags + " --plot " + file("a.png"), "up.toml"),
                json = dive(flags + " --json", "up.toml");
  ASSERT_EQ(told.status, 0) << told.err;
  EXPECT_NE(told.out.find("\ndiver: changes to tank 2 (EAN50) at "), std::string::npos) << told.out;
  const auto said = parse_json(json.out).value()["humans"][0];
  ASSERT_EQ(said["gas_switches"].size(), 1u);
  const auto& change = said["gas_switches"][0];
  EXPECT_EQ(change["from"], "tank 1 (air)");
  EXPECT_EQ(change["to"], "tank 2 (EAN50)");
  EXPECT_EQ(said["tank"], change["to"]);
  const double at_s = change["at_s"], depth_m = change["depth_m"];
  EXPECT_LT(depth_m, 21.0);
  EXPECT_NEAR(change["po2_bar"].get<double>(), 0.5 * (1.01325 + 0.1008 * depth_m), 5e-3);
  const auto columns = table("a.csv");
  for (std::size_t i = 0; i < columns.at("tank").size(); ++i)
    EXPECT_EQ(columns.at("tank")[i], std::stod(columns.at("time_s")[i]) < at_s ? "0" : "1") << i;
  EXPECT_TRUE(scene::read_image8(scratch_ / "a.png", 3).ok());
}

// The shipped dive: the diver swims, the vehicle keeps beside, and what is said is what was logged.
TEST_F(DivePhysics, ADiverSwimsAndIsLogged) {
  const std::string scene = (test::source_dir() / "assets/scenes/dive.toml").string();
  const int raw = std::system(
      fmt::format("{} '{}/tools/neritic' -q dive '{}' --headless --seconds 20 --json --log {} "
                  "--plot {} > {} 2> {}",
                  kNoDevice, NERITIC_BINARY_DIR, scene, file("d.csv"), file("d.png"), file("out"),
                  file("err"))
          .c_str());
  ASSERT_EQ(WEXITSTATUS(raw), 0) << read_text(scratch_ / "err").value();
  const auto json = parse_json(read_text(scratch_ / "out").value());
  ASSERT_TRUE(json.ok());
  const auto& said = (*json)["humans"][0];
  EXPECT_EQ(said["name"], "diver");
  EXPECT_EQ(said["touched_steps"], 0);
  EXPECT_EQ(said["refused_inputs"], 0);
  EXPECT_GT(said["way_m"].get<double>(), 6.0);
  EXPECT_LT(said["tank_bar"].get<double>(), 199.5);
  auto columns = table("d.csv");
  std::vector<double> depths;
  for (std::size_t i = 0; i < columns["vehicle"].size(); ++i) {
    if (columns["vehicle"][i] != "diver") {
      EXPECT_EQ(columns["tank_bar"][i], "");  // a vehicle has no tank
      continue;
    }
    depths.push_back(std::stod(columns["depth_m"][i]));
    EXPECT_EQ(columns["thrust_1_n"][i], "");  // nor a diver thrusters
  }
  ASSERT_EQ(depths.size(), 201u);  // ten a second, and the start
  EXPECT_NEAR(*std::ranges::max_element(depths), said["deepest_m"].get<double>(), 0.02);
  EXPECT_NEAR(*std::ranges::min_element(depths), said["shallowest_m"].get<double>(), 0.02);
  const auto image = scene::read_image8(scratch_ / "d.png", 3);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_GT(image->height, 1000u);  // with the panels of the diver and of the vehicle
}

}  // namespace
}  // namespace neritic
