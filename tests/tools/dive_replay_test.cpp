// Files of dives to go on from or to run again: recordings, their live samples, saved states.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "testbed/samples/sample_log.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

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
  ASSERT_TRUE(write_sample_log(scratch_ / "joystick.mcap", log).ok());
  auto text = read_text(scratch_ / "dive.toml").value();
  ASSERT_TRUE(
      write_text(scratch_ / "live.toml",
                 text + "inputs = { wrench = { from = \"joystick\", then = \"nobody\" } }\n")
          .ok());
  const std::string play = "--headless --seconds 2 --play " + file("joystick.mcap");
  const Outcome outcome = dive(play + " --json --log " + file("live.csv"), "live.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const auto json = parse_json(outcome.out).value();
  const auto& inputs = json["vehicles"][0]["inputs"];
  EXPECT_EQ(inputs["wrench"], (nlohmann::json{{"authority", "live from joystick"},
                                              {"phase", "lost"},
                                              {"used", 3},
                                              {"not_used", 0},
                                              {"fell_silent", 1},
                                              {"jumped", 0}}));
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

TEST_F(DivePhysics, ARecordingWithoutLiveSamplesHasNothingToPlay) {
  ASSERT_EQ(dive("--headless --seconds 1 --record " + file("a.mcap")).status, 0);
  const Outcome played = dive("--headless --seconds 1 --play " + file("a.mcap"));
  EXPECT_EQ(played.status, 0);
  EXPECT_NE(played.err.find("nothing to play: no live sample was recorded\n"), std::string::npos)
      << played.err;
  // Into its own place: what is played stays, under another name.
  EXPECT_EQ(dive("--headless --seconds 1 --play " + file("a.mcap") + " --record " + file("a.mcap"))
                .status,
            0);
  EXPECT_EQ(dive("--headless --replay " + file("a.mcap")).status, 0);
  EXPECT_EQ(dive("--headless --replay " + file("a_old1.mcap")).status, 0);
}

TEST_F(DivePhysics, ARunThatIsRefusedMovesNoOlderRecording) {
  const std::string record = "--headless --seconds 0.1 --record " + file("kept.mcap");
  ASSERT_EQ(dive(record).status, 0);
  EXPECT_EQ(dive(record + " --play " + file("none.mcap")).status, 2);
  EXPECT_EQ(dive(record + " --markers 47812").status, 2);
  EXPECT_EQ(dive("--headless --replay " + file("kept.mcap")).status, 0);
  EXPECT_FALSE(std::filesystem::exists(file("kept_old1.mcap")));
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
  // A virtual machine's clock may stand still for so short a run: then there is no speed.
  const double wall_s = summary["wall_s"].get<double>();
  EXPECT_NEAR(summary["speed"].get<double>() * wall_s, wall_s > 0.0 ? 2.0 : 0.0, 1e-6);
  // A recording of the second half has the state that it begins with.
  const std::string log = (scratch_ / "half.mcap").string();
  const Outcome both =
      dive("--headless --seconds 2 --restore '" + file + "' --record '" + log + "'");
  ASSERT_EQ(both.status, 0) << both.err;
  const Outcome again = dive("--headless --replay '" + log + "'");
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_NE(again.out.find("480 of 480 steps, each with the hash"), std::string::npos) << again.out;
  EXPECT_EQ(hash_of(again), whole);
  auto text = read_text(scratch_ / "dive.toml").value();
  text.replace(text.find("[1, -7, -2]"), 11, "[1, -7, -3]");
  ASSERT_TRUE(write_text(scratch_ / "other.toml", text).ok());
  const Outcome other = dive("--headless --restore '" + file + "'", "other.toml");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("a state of another scene"), std::string::npos) << other.err;
  EXPECT_EQ(std::ranges::count(other.err, '\n'), 1) << other.err;
}

TEST_F(DivePhysics, RunsAlikeAndReplaysWhatItRecorded) {
  const Outcome first = dive("--headless --seconds 8 --json --record " + file("a.mcap"));
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
  const Outcome replay = dive("--headless --replay " + file("a.mcap"));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find("1920 steps, each with the hash that was recorded"), std::string::npos)
      << replay.out;
  // Another scene goes another way.
  const std::string text = read_text(scratch_ / "dive.toml").value();
  const std::string current = "[current]\nkind = \"uniform\"\nvelocity_m_s = [0.1, 0, 0]\n";
  ASSERT_TRUE(write_text(scratch_ / "other.toml", text + current).ok());
  const Outcome other = dive("--headless --replay " + file("a.mcap"), "other.toml");
  EXPECT_EQ(other.status, 1);
  EXPECT_NE(other.err.find("another state than recorded from step"), std::string::npos)
      << other.err;
  // There is nothing to sum up: the first step differs.
  EXPECT_EQ(other.out.find(" steps dropped, hash "), std::string::npos) << other.out;
}

// The recorded physics runs, whatever that of the shown scene is: none, or another. Those who are
// not there are named once, and not drawn.
TEST_F(DivePhysics, ShowsARecordingInAnotherScene) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  const std::string assets = (test::source_dir() / "assets").string();
  const std::string diver = "[[objects]]\nname = \"diver\"\nmodel = \"" + assets +
                            "/models/diver.glb\"\nhuman = \"" + assets +
                            "/divers/recreational.toml\"\nposition_m = [3, -6, 0]\n" +
                            "pitch_deg = -90\nswim = { waypoints_m = [[3, -6, -20]] }\n";
  ASSERT_TRUE(
      write_text(scratch_ / "two.toml", read_text(scratch_ / "dive.toml").value() + diver).ok());
  const std::string camera = "[[cameras]]\nname = \"eye\"\nwidth = 64\nheight = 48\n" +
                             std::string("position_m = [0, -6, 3]\n[sun]\n");
  const std::string still = read_text(scratch_ / "still.toml").value() + camera;
  ASSERT_TRUE(write_text(scratch_ / "still.toml", still).ok());
  ASSERT_TRUE(write_text(scratch_ / "other.toml", "[physics]\n" + still + diver +
                                                      "[current]\nkind = \"uniform\"\n" +
                                                      "velocity_m_s = [0.1, 0, 0]\n")
                  .ok());
  ASSERT_EQ(dive("--headless --seconds 1 --record " + file("a.mcap"), "two.toml").status, 0);
  for (const bool physics : {false, true}) {
    const std::string shown =
        "--replay " + file("a.mcap") + " --scene " + file(physics ? "other.toml" : "still.toml");
    const Outcome live = neritic("dive --headless --fast --frames 20 " + shown);
    EXPECT_EQ(live.status, 0) << live.err;
    const std::string missing = physics ? "nothing here is named rov, as in the recording"
                                        : "nothing here is named diver or rov, as in the recording";
    EXPECT_NE(live.err.find(missing), std::string::npos) << live.err;
    const Outcome drawn = neritic("render --time 0.5 --frames 1 --sensor eye --out " +
                                  file(physics ? "o1" : "o0") + " " + shown);
    EXPECT_EQ(drawn.status, 0) << drawn.err;
    EXPECT_NE(drawn.err.find(missing), std::string::npos) << drawn.err;
  }
}

// An object under motion capture: eastwards at 1 m/s for a second, 60 poses a second; then silence.
TEST_F(DivePhysics, ARecordingMovesAnObjectAndItsRunRepeatsAndGoesOn) {
  using namespace testbed;
  ASSERT_TRUE(write_text(scratch_ / "prop.toml", R"([physics]
[[objects]]
name = "prop"
shape = "box"
position_m = [0, -5, 0]
inputs = { pose = { from = "mocap", hold_s = 0.3 } }
)")
                  .ok());
  SampleLog log{1.0 / 240.0,
                0,
                {{"prop/pose", PayloadKind::kObjectPose}},
                {"simulation", "mocap"},
                {},
                std::vector<std::uint64_t>(482)};
  for (std::uint64_t i = 0; i < 60; ++i) {
    const auto now = static_cast<TimeNs>(i * 1'000'000'000 / 60);
    ObjectPose pose;
    pose.world_from_object.position_m = {static_cast<double>(i) / 60.0, -5.0, 0.0};
    log.entries.push_back({4 * i, {{0, 1, i, now, now}, pose}});
  }
  ASSERT_TRUE(write_sample_log(scratch_ / "mocap.mcap", log).ok());
  const std::string play = "--headless --json --play " + file("mocap.mcap");
  const Outcome played =
      dive(play + " --seconds 2 --record " + file("prop.mcap") + " --save " + file("prop.state"),
           "prop.toml");
  ASSERT_EQ(played.status, 0) << played.err;
  const auto json = parse_json(played.out).value();
  const auto& prop = json["objects"][0];
  EXPECT_EQ(prop["inputs"]["pose"]["used"], 60);
  EXPECT_EQ(prop["inputs"]["pose"]["phase"], "lost");
  // It went on for 0.1 s after the last pose.
  EXPECT_NEAR(prop["end"]["position_m"][0].get<double>(), 59.0 / 60.0 + 0.1, 1e-6);
  EXPECT_NE(played.err.find("prop: pose: mocap is silent, nobody acts\n"), std::string::npos)
      << played.err;

  const Outcome replayed = dive("--headless --replay " + file("prop.mcap"), "prop.toml");
  EXPECT_NE(replayed.out.find("480 steps, each with the hash that was recorded"), std::string::npos)
      << replayed.out << replayed.err;
  const Outcome longer = dive(play + " --seconds 3", "prop.toml");
  const Outcome restored =
      dive("--headless --json --seconds 1 --restore " + file("prop.state"), "prop.toml");
  ASSERT_EQ(restored.status, 0) << restored.err;
  EXPECT_EQ(parse_json(restored.out).value()["hash"], parse_json(longer.out).value()["hash"]);
}

}  // namespace
}  // namespace neritic
