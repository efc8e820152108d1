// `neritic experiment`: an echo sounder's short descent from scenario to report, the same numbers
// on one worker and on two, resumed after a cut, and refusals in one line.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

struct Answer {
  int status = -1;
  std::string text;
};

// The program of this build, with standard error.
Answer neritic(const std::string& arguments) {
  const fs::path program = fs::read_symlink("/proc/self/exe").parent_path() / "../tools/neritic";
  std::FILE* pipe = ::popen((program.string() + " " + arguments + " 2>&1").c_str(), "r");
  if (!pipe) return {};
  Answer said;
  char piece[4096];
  while (const std::size_t size = std::fread(piece, 1, sizeof piece, pipe))
    said.text.append(piece, size);
  const int raw = ::pclose(pipe);
  said.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  return said;
}

Answer experiment(const std::string& arguments) {
  return neritic("experiment " + arguments);
}

bool no_numpy() {
  return std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0;
}

constexpr const char* kShort = " --runs 1 --set seconds=6 --set height_m=8 --set slope_deg=[0,8] ";

nlohmann::json runs_of(const fs::path& folder) {
  nlohmann::json measures;
  const std::string text = *read_text(folder / "runs.jsonl");
  std::size_t from = text.find('\n') + 1;
  while (from < text.size()) {
    const std::size_t to = text.find('\n', from);
    const auto run = nlohmann::json::parse(text.substr(from, to - from));
    measures[run["condition"].dump()] = run["measures"];
    from = to + 1;
  }
  return measures;
}

TEST(Experiment, SameNumbersByOneWorkerAndByTwoAndAfterACut) {
  if (no_numpy()) GTEST_SKIP() << "no numpy here";
  const test::ScratchFolder folder;
  const std::string one = (folder / "one").string(), two = (folder / "two").string();
  const Answer first = experiment("echo_sounder --workers 1 --out " + one + kShort);
  EXPECT_EQ(first.status, 0) << first.text;
  EXPECT_THAT(first.text, HasSubstr("2 runs, 0 failed"));
  const Answer second = experiment("echo_sounder --workers 2 --out " + two + kShort);
  EXPECT_EQ(second.status, 0) << second.text;
  const nlohmann::json truth = runs_of(one);
  ASSERT_EQ(truth.size(), 2u);
  EXPECT_EQ(runs_of(two), truth);
  for (const char* file : {"report.html", "results.json", "runs.csv"})
    EXPECT_TRUE(fs::exists(fs::path(one) / file)) << file;

  // A kill in the middle of the second line.
  const fs::path log = fs::path(one) / "runs.jsonl";
  const std::string text = *read_text(log);
  ASSERT_TRUE(write_text(log, text.substr(0, text.size() - 40)).ok());
  EXPECT_THAT(experiment("echo_sounder --out " + one + kShort).text,
              HasSubstr("accepted: --resume"));
  const Answer resumed = experiment("echo_sounder --resume --out " + one + kShort);
  EXPECT_EQ(resumed.status, 0) << resumed.text;
  EXPECT_EQ(runs_of(one), truth);
  EXPECT_THAT(experiment("echo_sounder --resume --out " + one + kShort + "--set rate_hz=4").text,
              HasSubstr("results of other settings"));
}

TEST(Experiment, TheRovBlocksASharkInTimeUnlessItStartsTooFar) {
  const fs::path build = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
  if (!fs::exists(build / "python/neritic/__init__.py")) GTEST_SKIP() << "no Python package here";
  const test::ScratchFolder folder;
  const Answer said =
      experiment("shark_far --runs 1 --workers 1 --out " + (folder / "out").string());
  EXPECT_EQ(said.status, 0) << said.text;
  const nlohmann::json runs = runs_of(folder / "out");
  // The reference of the control: 1.48 s from 1 m, 3.56 s from 2.5 m; told 20 times a second.
  EXPECT_NEAR(runs[R"({"offset_m":1.0})"]["time_to_block_s"], 1.48, 0.10);
  EXPECT_NEAR(runs[R"({"offset_m":2.5})"]["time_to_block_s"], 3.56, 0.15);
  EXPECT_EQ(runs[R"({"offset_m":3.0})"]["blocked_in_3_s"], false);
}

TEST(Experiment, ATasksFormulasAreCheckedBeforeItRuns) {
  if (no_numpy()) GTEST_SKIP() << "no numpy here";
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "scene.toml", "").ok());
  ASSERT_TRUE(write_text(folder / "act.py", "class Controller: pass\n").ok());
  const auto refused = [&](const std::string& until, const char* words) {
    const fs::path own = folder / "task.toml";
    ASSERT_TRUE(write_text(own,
                           "[experiment]\nkind = \"task\"\n[task]\nscene = \"scene.toml\"\n"
                           "controller = \"act.py\"\nparticipants = [\"rov\", \"diver\"]\n"
                           "[[stages]]\nname = \"near\"\nuntil = \"" +
                               until + "\"\n")
                    .ok());
    const Answer said = experiment(own.string() + " --out " + (folder / "out").string());
    EXPECT_EQ(said.status, 2) << said.text;
    EXPECT_THAT(said.text, HasSubstr(words));
  };
  refused("distance(rov, shark) < 2", "accepted: 2 of diver, rov");
  refused("__import__('os')", "accepted: distance");
  refused("depth(rov) < deep", "accepted: stage_time, time");
  refused("depth(rov) <", "accepted: a formula");
  refused("[1][0]", "accepted: numbers, comparisons");
}

TEST(Experiment, ATradeOffTakesTheFlagsOfAnExperiment) {
  if (no_numpy()) GTEST_SKIP() << "no numpy here";
  const test::ScratchFolder folder;
  const std::string out = " --out " + (folder / "out").string();
  const auto refused = [&](const std::string& arguments, const std::string& words) {
    const Answer said = neritic("tradeoff " + arguments + out);
    EXPECT_EQ(said.status, 2) << arguments << "\n" << said.text;
    EXPECT_THAT(said.text, HasSubstr(words));
  };
  refused("experiment --runs 2 --seed 3 --workers 1 --resume --quick --set offset=3",
          "--set: found \"offset=3\"; accepted: KEY=VALUE, KEY one of offset_m (the nearest)");
  for (const char* flag :
       {"--runs 3", "--seed 3", "--set a=1", "--workers 2", "--resume", "--json"})
    refused("deco " + std::string(flag), "accepted: that flag of tradeoff experiment alone");
}

// What Python makes of a word's hash, and so the order of a set of words, is else another at each
// start.
TEST(Experiment, AControllerThatGoesThroughASetOfWordsActsTheSameAtEachCall) {
  const fs::path build = fs::read_symlink("/proc/self/exe").parent_path().parent_path();
  if (!fs::exists(build / "python/neritic/__init__.py")) GTEST_SKIP() << "no Python package here";
  const test::ScratchFolder folder;
  ASSERT_TRUE(
      write_text(
          folder / "scene.toml",
          "[physics]\n[[vehicles]]\nname = \"rov\"\nshape = \"box\"\nposition_m = [0, -6, 0]\n"
          "dynamics = \"" +
              (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string() +
              "\"\n")
          .ok());
  const auto acts = [](const char* name, const char* what) {
    return fmt::format(
        "class {}:\n    def __init__(self, *_):\n        pass\n\n"
        "    def act(self, *_):\n        return {}\n",
        name, what);
  };
  ASSERT_TRUE(write_text(folder / "act.py", acts("Controller", "None")).ok());
  ASSERT_TRUE(
      write_text(folder / "play.py", acts("Player", "{'hash': hash('word') % 1000003}")).ok());
  ASSERT_TRUE(write_text(folder / "own.toml",
                         "[experiment]\nkind = \"task\"\nruns = 1\n[task]\n"
                         "scene = \"scene.toml\"\ncontroller = \"act.py\"\n"
                         "player = \"play.py\"\nparticipants = []\ntells = [\"hash\"]\n"
                         "seconds = 0.2\n[[stages]]\nname = \"go\"\nuntil = \"time > 0.1\"\n"
                         "[[measures]]\nname = \"found\"\nof = \"hash\"\nstatistic = \"last\"\n")
                  .ok());
  std::vector<nlohmann::json> found;
  for (const char* out : {"one", "two"}) {
    const Answer said =
        experiment((folder / "own.toml").string() + " --out " + (folder / out).string());
    ASSERT_EQ(said.status, 0) << said.text;
    found.push_back(runs_of(folder / out)["{}"]["found"]);
  }
  EXPECT_TRUE(found[0].is_number()) << found[0];
  EXPECT_EQ(found[0], found[1]);
}

TEST(Experiment, RefusesBadScenariosInOneLine) {
  if (no_numpy()) GTEST_SKIP() << "no numpy here";
  const test::ScratchFolder folder;
  const std::string out = " --out " + (folder / "out").string();
  const auto refused = [&](const std::string& arguments, const char* words) {
    const Answer said = experiment(arguments + out);
    EXPECT_EQ(said.status, 2) << arguments << "\n" << said.text;
    EXPECT_THAT(said.text, HasSubstr(words));
    EXPECT_EQ(std::count(said.text.begin(), said.text.end(), '\n'), 1) << said.text;
    EXPECT_FALSE(fs::exists(folder / "out" / "runs.jsonl"));
  };
  refused("echo_sonder", "echo_sounder (the nearest), ");
  refused("echo_sounder --set slop_deg=3", "slope_deg (the nearest)");
  refused("echo_sounder --set slope_deg=30", "accepted: a number in [0, 12]");
  refused("echo_sounder --set bins=1.5", "a whole number");
  const fs::path own = folder / "own.toml";
  const auto with = [&](const std::string& text, const char* words) {
    ASSERT_TRUE(write_text(own, text).ok());
    refused(own.string(), words);
  };
  with("[experiment", "found no TOML");
  with("[experiment]\nkind = \"sonar\"\n",
       "accepted: imaging, profiling, echo_sounder, shark, task");
  with("[experiment]\nkind = \"echo_sounder\"\nrun = 3\n", "runs (the nearest)");
  with("[experiment]\nkind = \"echo_sounder\"\n[vary]\nslope_deg = [3.0, 1.0]\n",
       "the lower number first");
  with("[experiment]\nkind = \"echo_sounder\"\n[factors]\nslope_deg = []\n",
       "found an empty list; accepted: a list of one level or more");
  with("[experiment]\nkind = \"echo_sounder\"\n[[criteria]]\nmeasure = \"rmse\"\n",
       "criteria[0].measure");
  // Values of a kind that the key does not have.
  with("[experiment]\nkind = [1]\n", "experiment.kind: found a list");
  with("[experiment]\nkind = 1979-05-27\n", "experiment.kind: found \"1979-05-27\"");
  with("[experiment]\nkind = \"echo_sounder\"\n[[criteria]]\nmeasure = { a = 1 }\n",
       "criteria[0].measure: found a table");
  with("criteria = 3\n[experiment]\nkind = \"echo_sounder\"\n", "criteria: found 3");
  const std::string task = "scene = \"own.toml\"\ncontroller = \"own.toml\"\n";
  with("[experiment]\nkind = \"task\"\n[task]\nplaces = 3\n" + task, "task.places: found 3");
  with("[experiment]\nkind = \"task\"\n[task]\n" + task +
           "[task.settings]\na = { default = 1, limits = [1] }\n",
       "task.settings.a.limits: found [1]");
  with("stages = 3\n[experiment]\nkind = \"task\"\n[task]\n" + task, "stages: found 3");
}

}  // namespace
}  // namespace neritic::tools
