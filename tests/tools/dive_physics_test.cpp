// `neritic dive --headless` of scenes with physics, as its users run it: without a Vulkan device,
// with its table, picture, record and replay, and one line for flags that do not fit.
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <thread>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/image_file.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

// A device name that no driver has.
constexpr const char* kNoDevice = "env VK_ICD_FILENAMES=/nonexistent VK_DRIVER_FILES=/nonexistent";

class DivePhysics : public testing::Test {
 protected:
  struct Outcome {
    int status = -1;
    std::string out, err;
  };

  void SetUp() override {
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
    ASSERT_TRUE(write_text(scratch_ / "dive.toml", R"(title = "box"
[physics]
[[objects]]
name = "sand"
class = "seabed"
shape = "plane"
size_m = [20, 20]
position_m = [0, -8, 0]
[[vehicles]]
name = "rov"
shape = "box"
size_m = [0.57, 0.26, 0.46]
dynamics = ")" + dynamics + R"("
position_m = [0, -6, 0]
mission = { waypoints = [ { position_m = [0, -6, -2] }, { position_m = [1, -7, -2] } ] }
)")
                    .ok());
    ASSERT_TRUE(write_text(scratch_ / "still.toml", "[[objects]]\nshape = \"box\"\n").ok());
  }

  Outcome dive(const std::string& arguments, const std::string& name = "dive.toml",
               const std::string& under = kNoDevice) {
    const int raw =
        std::system(fmt::format("{} '{}/tools/neritic' dive '{}' {} > '{}' 2> '{}'", under,
                                NERITIC_BINARY_DIR, (scratch_ / name).string(), arguments,
                                (scratch_ / "out").string(), (scratch_ / "err").string())
                        .c_str());
    return {WIFEXITED(raw) ? WEXITSTATUS(raw) : -1, read_text(scratch_ / "out").value(),
            read_text(scratch_ / "err").value()};
  }
  std::string file(const std::string& name) const { return "'" + (scratch_ / name).string() + "'"; }

  // Columns by name.
  std::map<std::string, std::vector<std::string>> table(const std::string& name) const {
    std::istringstream text(read_text(scratch_ / name).value());
    std::vector<std::string> names;
    std::map<std::string, std::vector<std::string>> columns;
    for (std::string line; std::getline(text, line);) {
      std::istringstream cells(line);
      std::size_t column = 0;
      for (std::string cell; std::getline(cells, cell, ','); ++column) {
        if (columns.size() < names.size() || names.size() == column)
          names.push_back(cell);
        else
          columns[names[column]].push_back(cell);
      }
      for (const std::string& known : names) columns[known];
    }
    return columns;
  }

  // Whether the process has a handler for the signal: it is past its start then.
  static bool catches(pid_t process, int signal) {
    std::ifstream status(fmt::format("/proc/{}/status", process));
    for (std::string line; std::getline(status, line);)
      if (line.starts_with("SigCgt:"))
        return (std::stoull(line.substr(7), nullptr, 16) >> (signal - 1) & 1) != 0;
    return false;
  }

  test::ScratchFolder scratch_;
};

// A recorded joystick flies while the scene gives it the wrench; sequence 2 of it never came.
// Nobody asked for the fault that a console reports.
TEST_F(DivePhysics, PlaysARecordingAndTellsOfLostSilentAndUnusedSamples) {
  using namespace testbed;
  const auto wrench = [](std::uint64_t step, std::uint64_t sequence) {
    return SampleLog::Entry{step, {{0, 1, sequence, 0, 0}, VehicleWrench{{40.0}}}};
  };
  const SampleLog log{
      1.0 / 240.0,
      0,
      {{"rov/wrench", PayloadKind::kWrench}, {"rov/fault", PayloadKind::kFault}},
      {"simulation", "joystick", "console"},
      {wrench(0, 0), wrench(60, 1), {80, {{1, 2, 0, 0, 0}, ThrusterFault{1}}}, wrench(120, 3)},
      std::vector<std::uint64_t>(122)};
  ASSERT_TRUE(write_sample_log(scratch_ / "joystick.log", log).ok());
  auto text = read_text(scratch_ / "dive.toml").value();
  ASSERT_TRUE(
      write_text(scratch_ / "live.toml",
                 text + "inputs = { wrench = { from = \"joystick\", then = \"nobody\" } }\n")
          .ok());
  const std::string play = "--headless --seconds 2 --play " + file("joystick.log");
  const Outcome outcome = dive(play + " --json --log " + file("live.csv"), "live.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = parse_json(outcome.out).value();
  const auto& inputs = json["vehicles"][0]["inputs"];
  EXPECT_EQ(inputs["wrench"], (nlohmann::json{{"authority", "live from joystick"},
                                              {"phase", "lost"},
                                              {"used", 3},
                                              {"not_used", 0},
                                              {"fell_silent", 1}}));
  EXPECT_EQ(inputs["fault"]["not_used"], 1);
  EXPECT_EQ(json["sources"][0]["name"], "joystick");
  EXPECT_EQ(json["sources"][0]["accepted"], 3);
  EXPECT_EQ(json["sources"][0]["lost"], 1);
  EXPECT_EQ(json["sources"][1]["name"], "console");
  EXPECT_NE(outcome.err.find("rov: wrench: joystick is silent, nobody acts\n"), std::string::npos)
      << outcome.err;
  // The log says when: until the first sample, and from 0.5 s after the last.
  const auto columns = table("live.csv");
  ASSERT_TRUE(columns.contains("silent"));
  const auto silent_at = [&](double time_s) {
    for (std::size_t i = 0; i < columns.at("time_s").size(); ++i)
      if (std::abs(std::stod(columns.at("time_s")[i]) - time_s) < 1e-6)
        return columns.at("silent")[i];
    return std::string("no such row");
  };
  EXPECT_EQ(silent_at(0.9), "0");
  EXPECT_EQ(silent_at(1.5), "1");
  const Outcome words = dive(play, "live.toml");
  EXPECT_NE(words.out.find("source joystick: 3 samples taken, 1 lost\n"), std::string::npos)
      << words.out;
  EXPECT_NE(words.out.find("rov: fault: 1 sample of console not used, autopilot\n"),
            std::string::npos)
      << words.out;
  const Outcome alone = dive("--headless --seconds 2 --json --log " + file("alone.csv"));
  EXPECT_NE(parse_json(alone.out).value()["hash"], json["hash"]);
  EXPECT_FALSE(table("alone.csv").contains("silent"));
}

// Two processes: one saves half way, the other goes on; the same hash as one that never stopped.
TEST_F(DivePhysics, SavedInOneProcessItGoesOnInAnotherWithTheSameHash) {
  const std::string file = (scratch_ / "half.state").string();
  const auto hash_of = [](const Outcome& outcome) {
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return outcome.out.substr(outcome.out.rfind("hash "));
  };
  const std::string whole = hash_of(dive("--headless --seconds 4"));
  const std::string half = hash_of(dive("--headless --seconds 2 --save '" + file + "'"));
  const Outcome on = dive("--headless --seconds 2 --restore '" + file + "'");
  EXPECT_NE(half, whole);
  EXPECT_EQ(hash_of(on), whole);
  EXPECT_NE(on.out.find("4 s in 960 steps (2 s of them restored), "), std::string::npos) << on.out;
  const auto summary =
      parse_json(dive("--headless --json --seconds 2 --restore '" + file + "'").out).value();
  EXPECT_NEAR(summary["speed"].get<double>() * summary["wall_s"].get<double>(), 2.0, 1e-6);
  const Outcome both =
      dive("--headless --restore '" + file + "' --record '" + (scratch_ / "x.log").string() + "'");
  EXPECT_EQ(both.status, 2);
  EXPECT_NE(both.err.find("--record: found --restore beside it; accepted: a run from time 0"),
            std::string::npos)
      << both.err;
  auto text = read_text(scratch_ / "dive.toml").value();
  text.replace(text.find("[1, -7, -2]"), 11, "[1, -7, -3]");
  ASSERT_TRUE(write_text(scratch_ / "other.toml", text).ok());
  const Outcome other = dive("--headless --restore '" + file + "'", "other.toml");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("a state of another scene"), std::string::npos) << other.err;
  EXPECT_EQ(std::ranges::count(other.err, '\n'), 1) << other.err;
}

TEST_F(DivePhysics, QuietlyItPrintsItsJsonAlone) {
  const std::string recording = file("a.log");
  const Outcome quiet = dive("-q --headless --seconds 1 --record " + recording);
  EXPECT_EQ(quiet.status, 0) << quiet.err;
  EXPECT_EQ(quiet.out + quiet.err, "");
  EXPECT_EQ(dive("-q --headless --replay " + recording).out, "");
  EXPECT_TRUE(parse_json(dive("-q --headless --seconds 1 --json").out).ok());
}

TEST_F(DivePhysics, ARecordingWithoutLiveSamplesHasNothingToPlay) {
  ASSERT_EQ(dive("--headless --seconds 1 --record " + file("a.log")).status, 0);
  const Outcome played = dive("--headless --seconds 1 --play " + file("a.log"));
  EXPECT_EQ(played.status, 0);
  EXPECT_NE(played.err.find("nothing to play: no live sample was recorded\n"), std::string::npos)
      << played.err;
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

TEST_F(DivePhysics, RunsAlikeAndReplaysWhatItRecorded) {
  const Outcome first = dive("--headless --seconds 8 --json --record " + file("a.log"));
  const Outcome second = dive("--headless --seconds 8 --json");
  ASSERT_EQ(first.status, 0) << first.err;
  const auto a = parse_json(first.out), b = parse_json(second.out);
  ASSERT_TRUE(a.ok() && b.ok()) << first.out;
  EXPECT_EQ((*a)["hash"], (*b)["hash"]);
  EXPECT_EQ((*a)["steps"], 1920);
  EXPECT_EQ((*a)["vehicles"][0]["name"], "rov");
  EXPECT_EQ((*a)["vehicles"][0]["touched_steps"], 0);
  // How deep it dived, and how deep in something solid it was.
  EXPECT_NEAR((*a)["vehicles"][0]["deepest_m"].get<double>(), 7.0, 0.1);
  EXPECT_NEAR((*a)["vehicles"][0]["shallowest_m"].get<double>(), 6.0, 0.1);
  EXPECT_EQ((*a)["vehicles"][0]["deepest_contact_m"], 0.0);
  const Outcome replay = dive("--headless --replay " + file("a.log"));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find("1920 steps, each with the hash that was recorded"), std::string::npos)
      << replay.out;
  // Another scene goes another way.
  const std::string text = read_text(scratch_ / "dive.toml").value();
  const std::string current = "[current]\nkind = \"uniform\"\nvelocity_m_s = [0.1, 0, 0]\n";
  ASSERT_TRUE(write_text(scratch_ / "other.toml", text + current).ok());
  const Outcome other = dive("--headless --replay " + file("a.log"), "other.toml");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("another state than recorded from step"), std::string::npos)
      << other.err;
  // It prints the steps before the difference, and the usual summary.
  EXPECT_NE(other.out.find(" of 1920 steps, each with the hash that was recorded"),
            std::string::npos)
      << other.out;
  EXPECT_NE(other.out.find(" steps dropped, hash "), std::string::npos) << other.out;
}

TEST_F(DivePhysics, AReplayCanBeInterrupted) {
  ASSERT_EQ(dive("--headless --seconds 60 --record " + file("a.log")).status, 0);
  const pid_t program = ::fork();
  if (program == 0) {
    std::freopen((scratch_ / "out").c_str(), "w", stdout);
    std::freopen((scratch_ / "err").c_str(), "w", stderr);
    ::execl(fmt::format("{}/tools/neritic", NERITIC_BINARY_DIR).c_str(), "neritic", "dive",
            (scratch_ / "dive.toml").c_str(), "--headless", "--replay",
            (scratch_ / "a.log").c_str(), nullptr);
    ::_exit(127);
  }
  while (!catches(program, SIGINT)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  ::kill(program, SIGINT);
  int raw = 0;
  ASSERT_EQ(::waitpid(program, &raw, 0), program);
  const std::string err = read_text(scratch_ / "err").value();
  ASSERT_TRUE(WIFEXITED(raw));
  EXPECT_EQ(WEXITSTATUS(raw), 130) << err;
  EXPECT_EQ(err.rfind("neritic: interrupted after ", 0), 0u) << err;
  EXPECT_NE(err.find(" s of 60\n"), std::string::npos) << err;
}

TEST_F(DivePhysics, KeepsTheClocksPaceWhenToldTo) {
  const Outcome outcome = dive("--headless --seconds 1 --realtime --json");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = parse_json(outcome.out);
  ASSERT_TRUE(json.ok());
  EXPECT_EQ((*json)["steps"], 240);
  EXPECT_GT((*json)["wall_s"].get<double>(), 0.98);
}

// Ctrl-C, and what `kill` sends: what was flown until then is written, and replays.
TEST_F(DivePhysics, InterruptedItWritesWhatItHas) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const pid_t program = ::fork();
    if (program == 0) {
      std::freopen((scratch_ / "out").c_str(), "w", stdout);
      std::freopen((scratch_ / "err").c_str(), "w", stderr);
      ::execl(fmt::format("{}/tools/neritic", NERITIC_BINARY_DIR).c_str(), "neritic", "dive",
              (scratch_ / "dive.toml").c_str(), "--headless", "--realtime", "--seconds", "600",
              "--log", (scratch_ / "a.csv").c_str(), "--record", (scratch_ / "a.log").c_str(),
              "--plot", (scratch_ / "a.png").c_str(), nullptr);
      ::_exit(127);
    }
    while (!catches(program, signal)) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    std::this_thread::sleep_for(std::chrono::milliseconds(700));
    ::kill(program, signal);
    ::kill(program, signal);  // as `timeout` does
    int raw = 0;
    ASSERT_EQ(::waitpid(program, &raw, 0), program);
    const std::string out = read_text(scratch_ / "out").value();
    const std::string err = read_text(scratch_ / "err").value();
    EXPECT_TRUE(WIFEXITED(raw));
    EXPECT_EQ(WEXITSTATUS(raw), 130) << err;
    const std::string before = "neritic: interrupted after ";
    ASSERT_EQ(err.rfind(before, 0), 0u) << err;
    EXPECT_NE(err.find(" s of 600; all until then is written\n"), std::string::npos) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
    EXPECT_NE(out.find("hash "), std::string::npos) << out;
    // Every control period until then has its row.
    const double until_s = std::stod(err.substr(before.size()));
    const auto columns = table("a.csv");
    const auto& times = columns.at("time_s");
    EXPECT_NEAR(std::stod(times.back()), until_s, 0.0205);
    EXPECT_NEAR(static_cast<double>(times.size()), 1.0 + 50.0 * until_s, 1.1);
    EXPECT_TRUE(scene::read_image8(scratch_ / "a.png", 3).ok());
    EXPECT_EQ(dive("--headless --replay " + file("a.log")).status, 0);
  }
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
  const std::string flags =
      "--headless --seconds 60 --log-rate 1 --log " + file("a.csv") + " --plot " + file("a.png");
  const Outcome told = dive(flags, "up.toml"), json = dive(flags + " --json", "up.toml");
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

// The vehicle's file is refused before anything moves.
TEST_F(DivePhysics, AParameterFileThatIsNoVehicleEndsInOneLine) {
  const struct {
    const char *parameters, *message;
  } files[] = {
      {"mass_kg = -13.5\ninertia_kg_m2 = [0.3, 0.2, 0.4]\n", "mass_kg: found -13.5"},
      {"mass_kg = 13.5\ninertia_kg_m2 = [0.3, 0, 0.4]\n",
       "found a mass matrix that is not positive definite"},
      {"mass_kg = 13.5\ninertia_kg_m2 = [0.3, 0.2, 0.4]\nadded_mass = [[-13.5, 0, 0, 0, 0, 0], "
       "[0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], [0, 0, 0, 0, 0, 0], "
       "[0, 0, 0, 0, 0, 0]]\n",
       "added_mass: found a sum with the rigid body's mass matrix that is not"},
      {"mass_kg = nan\ninertia_kg_m2 = [0.3, 0.2, 0.4]\n", "mass_kg: found \"nan\""}};
  for (const auto& file : files) {
    ASSERT_TRUE(write_text(scratch_ / "wrong.toml", file.parameters).ok());
    ASSERT_TRUE(write_text(scratch_ / "wrong_dive.toml",
                           "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\n"
                           "dynamics = \"wrong.toml\"\nposition_m = [0, -6, 0]\n")
                    .ok());
    const Outcome outcome = dive("--headless --seconds 1", "wrong_dive.toml");
    EXPECT_EQ(outcome.status, 2) << file.message;
    EXPECT_EQ(outcome.out, "");
    EXPECT_NE(outcome.err.find("wrong.toml:"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find(file.message), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

TEST_F(DivePhysics, FlagsThatDoNotFitEndInOneLine) {
  const struct {
    std::string arguments, scene, message;
  } cases[] = {
      {"--headless --log x.csv", "still.toml",
       "still.toml, where nothing moves by physics; accepted: a scene where a vehicle has "
       "dynamics"},
      {"--headless --log-rate 0", "still.toml", "--log-rate: found "},
      {"--realtime", "dive.toml",
       "--realtime: found a run with pictures; accepted: with --headless and without flags"},
      {"--headless --replay none.log", "dive.toml", "none.log"},
      {"--headless --replay a.log --log x.csv", "dive.toml",
       "--replay: found --log beside it; accepted: no --seconds, --log, --log-rate, --plot, "},
      {"--headless --replay a.log --seconds 10", "dive.toml",
       "--replay: found --seconds beside it; accepted: no --seconds"},
      {"--headless --seconds 1e7", "dive.toml", "--seconds: found 10000000; accepted: up to 1e+06"},
      {"--headless --play a.log --restore a.state", "dive.toml",
       "--play: found --restore beside it; accepted: a run from time 0"},
      {"--headless --log-rate -1", "dive.toml", "--log-rate: found -1; accepted: 0 to 10000"}};
  for (const auto& wrong : cases) {
    const Outcome outcome = dive(wrong.arguments, wrong.scene);
    EXPECT_EQ(outcome.status, 2) << wrong.message;
    EXPECT_NE(outcome.err.find(wrong.message), std::string::npos) << outcome.err;
    EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  }
}

// Sensors enough to navigate by: another seed is another way, and a table of seeds tells how they
// ended.
TEST_F(DivePhysics, RunsOfSeedsEndInATable) {
  const std::string survey =
      (test::source_dir() / "assets/vehicles/bluerov2_heavy_survey_dynamics.toml").string();
  ASSERT_TRUE(write_text(scratch_ / "measured.toml",
                         "include = \"dive.toml\"\n[[vehicles]]\nname = \"rov\"\ndynamics = \"" +
                             survey + "\"\n[vehicles.mission]\nacceptance_m = 0.3\n")
                  .ok());
  const Outcome table = dive("--headless --seconds 40 --seed 5 --runs 3", "measured.toml");
  EXPECT_EQ(table.status, 0) << table.err;
  for (const char* seed : {"\n         5  rov", "\n         6  rov", "\n         7  rov"})
    EXPECT_NE(table.out.find(seed), std::string::npos) << table.out;
  EXPECT_NE(table.out.find("3 of 3 missions done, 0 touched something"), std::string::npos)
      << table.out;
  const Outcome json = dive("--headless --seconds 40 --seed 5 --runs 2 --json", "measured.toml");
  const auto runs = parse_json(json.out);
  ASSERT_TRUE(runs.ok()) << json.out;
  ASSERT_EQ(runs->size(), 2u);
  EXPECT_NE((*runs)[0]["largest_navigation_error_m"], (*runs)[1]["largest_navigation_error_m"]);
  // Too short for the way.
  const Outcome short_of = dive("--headless --seconds 0.5 --runs 1", "measured.toml");
  EXPECT_EQ(short_of.status, 1);
  EXPECT_NE(short_of.err.find("1 of 1 missions not done in 0.5 s"), std::string::npos)
      << short_of.err;
  EXPECT_EQ(dive("--headless --runs 2 --log x.csv", "measured.toml").status, 2);
  const Outcome one = dive("--headless --seconds 2 --seed 5", "measured.toml");
  EXPECT_NE(one.out.find("navigation off by up to 0."), std::string::npos) << one.out;
}

}  // namespace
}  // namespace neritic
