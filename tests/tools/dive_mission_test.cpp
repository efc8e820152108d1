// How missions end: in a table of seeds, and with status 1 where they cannot.
#include <nlohmann/json.hpp>

#include "engine/core/json.hpp"
#include "tests/tools/dive_physics.hpp"

namespace neritic {
namespace {

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
  for (const auto& run : *runs) EXPECT_EQ(run["truly_arrived"], run["arrived"]);
  // Too short for the way.
  const Outcome short_of = dive("--headless --seconds 0.5 --runs 1", "measured.toml");
  EXPECT_EQ(short_of.status, 1);
  EXPECT_NE(short_of.err.find("1 of 1 missions not done in 0.5 s"), std::string::npos)
      << short_of.err;
  EXPECT_EQ(dive("--headless --runs 2 --log x.csv", "measured.toml").status, 2);
  const Outcome one = dive("--headless --seconds 2 --seed 5", "measured.toml");
  EXPECT_NE(one.out.find("navigation off by up to 0."), std::string::npos) << one.out;
}

// A compass that is off by tens of degrees and no fix beside it: the vehicle believes that it
// arrives, metres away. Such a mission was done before.
TEST_F(DivePhysics, AMissionThatIsDoneInBeliefAloneIsMissedAndEndsWithStatusOne) {
  const std::string vehicles = (test::source_dir() / "assets/vehicles").string();
  ASSERT_TRUE(write_text(scratch_ / "lost_vehicle.toml",
                         "include = \"" + vehicles +
                             "/bluerov2_heavy_dynamics.toml\"\n[imu]\nrate_hz = "
                             "200\n[dvl]\nrate_hz = 8\n[pressure]\nrate_hz = 20\n[compass]\n"
                             "rate_hz = 50\nnoise_deg = { bias = 40 }\n")
                  .ok());
  ASSERT_TRUE(write_text(scratch_ / "lost.toml",
                         "include = \"dive.toml\"\n[[vehicles]]\nname = \"rov\"\ndynamics = "
                         "\"lost_vehicle.toml\"\nnavigation = \"measured\"\n"
                         "[vehicles.mission]\nwaypoints = [ { position_m = [0, -6, -6] } ]\n")
                  .ok());
  const Outcome table = dive("--headless --seconds 60 --seed 5 --runs 3", "lost.toml");
  EXPECT_EQ(table.status, 1);
  EXPECT_NE(table.err.find(" missed though the vehicle believes it arrived"), std::string::npos)
      << table.err;
  EXPECT_NE(table.out.find("  missed\n"), std::string::npos) << table.out;
  EXPECT_NE(
      table.out.find(" missed: done as the vehicle believes, but truly off a waypoint by more "
                     "than its radius and 0.5 m\n"),
      std::string::npos)
      << table.out;
  const Outcome json = dive("--headless --seconds 60 --seed 5 --runs 3 --json", "lost.toml");
  const auto runs = parse_json(json.out);
  ASSERT_TRUE(runs.ok()) << json.out;
  int missed = 0;
  for (const auto& run : *runs) {
    ASSERT_EQ(run["true_misses_m"].size(), run["arrived"].get<std::size_t>());
    int truly = 0;
    for (const auto& miss_m : run["true_misses_m"]) {
      EXPECT_LE(miss_m.get<double>(), run["largest_navigation_error_m"].get<double>() + 0.15);
      truly += miss_m.get<double>() <= 0.65 ? 1 : 0;
    }
    EXPECT_EQ(run["truly_arrived"], truly);
    EXPECT_EQ(run["status"], truly == run["arrived"] ? "done" : "missed");
    missed += truly < run["arrived"].get<int>() ? 1 : 0;
  }
  EXPECT_GT(missed, 0);
}

// Each with a line before the dive that says in numbers what does not hold, and with status 1 and a
// line after it that says what is left.
TEST_F(DivePhysics, AMissionThatCannotSucceedIsToldBeforeAndEndsWithStatusOne) {
  struct Case {
    std::string vehicle, keys, water, told;
  };
  const Case cases[] = {
      {"buoyancy_n = 812.57\n", "", "", "rov: 680 N too buoyant: its thrusters push down with 1"},
      {"", "failed_thrusters = [5, 6, 7, 8]\n", "",
       "rov: its thrusters push 0 N up or down (heave): that axis is not controlled"},
      {"", "", "[current]\nkind = \"uniform\"\nvelocity_m_s = [3, 0, 0]\n",
       "rov: the current of 3 m/s drags it with "}};
  for (const Case& one : cases) {
    ASSERT_TRUE(
        write_text(
            scratch_ / "hard_vehicle.toml",
            "include = \"" +
                (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string() +
                "\"\n" + one.vehicle)
            .ok());
    ASSERT_TRUE(write_text(scratch_ / "hard.toml",
                           "[physics]\n" + one.water +
                               "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = "
                               "\"hard_vehicle.toml\"\nposition_m = [0, -6, 0]\n" +
                               one.keys +
                               "mission = { waypoints = [ { position_m = [0, -9, -2] } ] }\n")
                    .ok());
    const Outcome outcome = dive("--headless --seconds 20", "hard.toml");
    EXPECT_EQ(outcome.status, 1) << one.told;
    EXPECT_NE(outcome.err.find(one.told), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("hard.toml: not finished: rov: 1 of 1 waypoints left after 20 s, "),
              std::string::npos)
        << outcome.err;
    // A part of it on purpose.
    EXPECT_EQ(dive("--headless --seconds 2", "hard.toml").status, 0);
    EXPECT_EQ(dive("--headless --seconds 20 --save " + file("on.state"), "hard.toml").status, 0);
  }
  const Outcome well = dive("--headless --seconds 20");
  EXPECT_EQ(well.status, 0) << well.err;
  EXPECT_EQ(well.err.find("thrusters"), std::string::npos) << well.err;
}

// With status 1 and one line, whether or not the time would have sufficed: one that is stuck at a
// wall half way, one off its station in a current, a diver in a current that is faster than he.
TEST_F(DivePhysics, AMissionThatMakesNoWayOrEndsOffItsPlaceEndsWithStatusOne) {
  const std::string assets = (test::source_dir() / "assets").string();
  const auto write = [&](const std::string& text) {
    ASSERT_TRUE(write_text(scratch_ / "stuck.toml", "[physics]\n" + text).ok());
  };
  const std::string rov =
      "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nsize_m = [0.57, 0.26, "
      "0.46]\ndynamics = \"" +
      assets + "/vehicles/bluerov2_heavy_dynamics.toml\"\nposition_m = [0, -6, 0]\n";
  const std::string diver = "[[objects]]\nname = \"diver\"\nclass = \"diver\"\nmodel = \"" +
                            assets + "/models/diver.glb\"\nhuman = \"" + assets +
                            "/divers/recreational.toml\"\nposition_m = [0, -6, 5]\npitch_deg = "
                            "-90\nswim = { waypoints_m = [[0, -6, -40]] }\n";
  struct Case {
    std::string text, told;
  };
  const Case cases[] = {
      {rov +
           "mission = { speed_m_s = 0.3, waypoints = [ { position_m = [0, -6, -60] } ] }\n"
           "[[objects]]\nname = \"wall\"\nclass = \"rock\"\nshape = \"box\"\nsize_m = [30, 30, 1]\n"
           "position_m = [0, -6, -4]\n",
       "not finished: rov: 1 of 1 waypoints left after 40 s, 5"},
      {rov + "mission = { hold = \"station\" }\n[current]\nkind = \"uniform\"\nvelocity_m_s = "
             "[2.5, 0, 0]\n",
       " m off its station at the end; accepted: up to 2 m"},
      {diver + "[current]\nkind = \"uniform\"\nvelocity_m_s = [0, 0, 0.8]\n",
       "not finished: diver: 1 of 1 waypoints left after 40 s, "}};
  for (const Case& one : cases) {
    write(one.text);
    const Outcome outcome = dive("--headless --seconds 40", "stuck.toml");
    EXPECT_EQ(outcome.status, 1) << one.told;
    EXPECT_NE(outcome.err.find(one.told), std::string::npos) << outcome.err;
    EXPECT_EQ(dive("--headless --seconds 40 --save " + file("on.state"), "stuck.toml").status, 0);
  }
  // Without what holds them up they end well, though they are not there yet.
  write(rov + "mission = { speed_m_s = 0.3, waypoints = [ { position_m = [0, -6, -60] } ] }\n");
  EXPECT_EQ(dive("--headless --seconds 40", "stuck.toml").status, 0);
  write(rov + "mission = { hold = \"station\" }\n");
  EXPECT_EQ(dive("--headless --seconds 40", "stuck.toml").status, 0);
  write(diver);
  EXPECT_EQ(dive("--headless --seconds 40", "stuck.toml").status, 0);
}

// Divers who swim by plan have their rows in the table of seeds, alone and beside vehicles.
TEST_F(DivePhysics, RunsOfDiversEndInTheTableToo) {
  const std::string assets = (test::source_dir() / "assets").string();
  const std::string diver = "[[objects]]\nname = \"diver\"\nclass = \"diver\"\nmodel = \"" +
                            assets + "/models/diver.glb\"\nhuman = \"" + assets +
                            "/divers/recreational.toml\"\nposition_m = [4, -6, 5]\npitch_deg = "
                            "-90\nswim = { waypoints_m = [[4, -6, 0], [4, -6, -4]] }\n";
  ASSERT_TRUE(write_text(scratch_ / "alone.toml", "[physics]\n" + diver).ok());
  const Outcome alone = dive("--headless --seconds 60 --seed 5 --runs 2", "alone.toml");
  EXPECT_EQ(alone.status, 0) << alone.err;
  for (const char* row : {"\n         5  diver          2 of 2       2", "\n         6  diver"})
    EXPECT_NE(alone.out.find(row), std::string::npos) << alone.out;
  EXPECT_NE(alone.out.find("2 of 2 missions done, 0 touched something\n"), std::string::npos)
      << alone.out;
  ASSERT_TRUE(write_text(scratch_ / "both.toml", "include = \"dive.toml\"\n" + diver).ok());
  const Outcome both = dive("--headless --seconds 60 --seed 5 --runs 2 --json", "both.toml");
  EXPECT_EQ(both.status, 0) << both.err;
  const auto runs = parse_json(both.out);
  ASSERT_TRUE(runs.ok()) << both.out;
  ASSERT_EQ(runs->size(), 4u);
  EXPECT_EQ((*runs)[0]["vehicle"], "rov");
  EXPECT_EQ((*runs)[1]["diver"], "diver");
  EXPECT_EQ((*runs)[1]["arrived"], 2);
  EXPECT_EQ((*runs)[1]["true_misses_m"].size(), 2u);
  EXPECT_GT((*runs)[1]["last_arrival_s"], 15.0);
  // Too short for the way.
  const Outcome short_of = dive("--headless --seconds 5 --runs 2", "alone.toml");
  EXPECT_EQ(short_of.status, 1);
  EXPECT_NE(short_of.err.find("2 of 2 missions not done in 5 s"), std::string::npos)
      << short_of.err;
  EXPECT_EQ(dive("--headless --runs 2", "still.toml").status, 2);
}

TEST_F(DivePhysics, ARuntimeThatDoesNotLoadIsNamed) {
  setenv("XR_RUNTIME_JSON", "/not/there.json", 1);
  const Outcome outcome = dive("--display openxr --frames 1", "dive.toml");
  unsetenv("XR_RUNTIME_JSON");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_NE(outcome.err.find("XR_RUNTIME_JSON=/not/there.json does not load"), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace neritic
