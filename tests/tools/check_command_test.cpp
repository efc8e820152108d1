// `neritic check`: its lines, its JSON, its exit status. The program itself is run.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tests/support/support.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;

struct Said {
  int status = -1;
  std::string out, error;
};

Said checked(const std::string& arguments) {
  const test::ScratchFolder folder;
  const std::string command = NERITIC_BINARY_DIR "/tools/neritic check " + arguments + " > " +
                              (folder / "out").string() + " 2> " + (folder / "error").string();
  Said said;
  const int raw = std::system(command.c_str());
  said.status = WIFEXITED(raw) ? WEXITSTATUS(raw) : -1;
  said.out = read_text(folder / "out").value();
  said.error = read_text(folder / "error").value();
  return said;
}

std::string data(const std::string& name) {
  return (test::source_dir() / "tests/rov/data" / name).string();
}

TEST(CheckCommand, ALineACaseAndStatus0WhereAllHold) {
  const Said rov = checked("rov " + data("trajectories.json"));
  EXPECT_EQ(rov.status, 0) << rov.error;
  EXPECT_EQ(std::ranges::count(rov.out, '\n'), 17);
  EXPECT_THAT(rov.out, HasSubstr("mission_40s            ok      error "));
  EXPECT_EQ(rov.error, "");
  const Said control = checked("control " + data("control.json"));
  EXPECT_EQ(control.status, 0) << control.error;
  EXPECT_EQ(std::ranges::count(control.out, '\n'), 19);
}

TEST(CheckCommand, Status1AndTheCaseWhereOneDoesNotHold) {
  const test::ScratchFolder folder;
  nlohmann::json json = parse_json(read_text(data("trajectories.json")).value()).value();
  json["scenarios"][1]["samples"][4]["p_ned"][0] = 0.5;
  ASSERT_TRUE(write_json(folder / "wrong.json", json).ok());
  const Said said = checked("rov " + (folder / "wrong.json").string());
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.out, HasSubstr("surge_step             not ok  error "));
  EXPECT_THAT(said.error, HasSubstr("wrong.json: 1 of 17 cases do not hold"));

  const Said for_programs = checked("rov --json " + (folder / "wrong.json").string());
  EXPECT_EQ(for_programs.status, 1);
  const auto result = parse_json(for_programs.out);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ((*result)["failed"], 1);
  EXPECT_EQ((*result)["ok"], false);
  EXPECT_EQ((*result)["cases"][1]["id"], "surge_step");
  EXPECT_EQ((*result)["cases"][1]["ok"], false);
  EXPECT_EQ((*result)["cases"][1]["worst"]["what"], "position");
  EXPECT_EQ((*result)["cases"][0]["ok"], true);
}

TEST(CheckCommand, TheLineSaysWhatDoesNotCountAsItStands) {
  const test::ScratchFolder folder;
  nlohmann::json json = parse_json(read_text(data("trajectories.json")).value()).value();
  json["scenarios"][1]["samples"][4]["p_ned"][0] = 0.5;
  json["scenarios"][1]["reference_error_estimate"] = 0.9;
  ASSERT_TRUE(write_json(folder / "claims.json", json).ok());
  const Said said = checked("rov " + (folder / "claims.json").string());
  EXPECT_EQ(said.status, 1);
  EXPECT_THAT(said.out, HasSubstr("; reference_error_estimate 0.9 counts as 1e-05\n"));
  const Said for_programs = checked("rov --json " + (folder / "claims.json").string());
  EXPECT_EQ((*parse_json(for_programs.out))["cases"][1]["note"],
            "reference_error_estimate 0.9 counts as 1e-05");
}

TEST(CheckCommand, Status2AndOneLineWhereThereIsNothingToCheck) {
  const test::ScratchFolder folder;
  ASSERT_TRUE(write_text(folder / "bad.json", "{\"scenarios\": [{\"id\": \"a\"}]}").ok());
  const std::string bad = (folder / "bad.json").string();
  for (const auto& [arguments, error] :
       {std::pair{"rov " + bad, bad + ": case 'a': scenarios[0].params: not found, but needed\n"},
        {std::string("rov nowhere.json"),
         std::string("nowhere.json: found no such file; accepted: a file that can be read\n")},
        {std::string("diver x"),
         std::string("check: found 'diver'; accepted: rov, control or deco\n")},
        {"rov --hz 0 " + bad, std::string("check: --hz: found 0; accepted: 1 to 100000\n")},
        {"rov --integrator euler " + bad,
         std::string("found integrator 'euler'; accepted: semi_euler, rk4 or guarded\n")}}) {
    const Said said = checked(arguments);
    EXPECT_EQ(said.status, 2) << arguments;
    EXPECT_EQ(said.error, "neritic: " + error) << arguments;
    EXPECT_EQ(said.out, "") << arguments;
  }
}

TEST(CheckCommand, TheIntegratorAndTheRateMayBeChosen) {
  for (const char* with : {"--integrator rk4 --hz 60", "--integrator semi_euler", "--hz 1000"})
    EXPECT_EQ(checked("rov " + data("trajectories.json") + " " + with).status, 0) << with;
  EXPECT_EQ(checked("rov " + data("trajectories.json") + " --integrator rk4 --hz 20").status, 1);
}

}  // namespace
}  // namespace neritic::tools
