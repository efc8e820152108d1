// Whether results can be written, asked before the work: by the check itself, and by every command.
#include "tools/common/outputs.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class Outputs : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(write_text(folder_ / "file", "x").ok());
    fs::create_symlink("nowhere", folder_ / "dangling");
    fs::create_symlink("loop", folder_ / "loop");
    fs::create_symlink("file", folder_ / "link");
  }
  std::string at(const char* name) { return (folder_ / name).string(); }
  std::size_t entries() {
    return static_cast<std::size_t>(
        std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()));
  }
  test::ScratchFolder folder_;
};

TEST_F(Outputs, FoldersThatCanBeMadeAreAcceptedAndNothingIsLeft) {
  const std::size_t before = entries();
  for (const char* name : {"", "out", "a/b/c", "../" /* there */})
    EXPECT_TRUE(check_output_folder("--out", at(name)).ok()) << name;
  EXPECT_TRUE(check_output_folder("--out", "").ok());
  for (const char* name : {"new.csv", "file", "link", "dangling"})
    EXPECT_TRUE(check_output_file("--log", at(name)).ok()) << name;
  EXPECT_TRUE(check_output_file("--log", "/dev/full").ok());
  EXPECT_EQ(entries(), before);
}

TEST_F(Outputs, OthersAreRefusedWithTheFlagAndTheReason) {
  for (const char* name : {"file", "file/below", "loop", "loop/below", "dangling", "dangling/x"}) {
    const Status status = check_output_folder("--out", at(name));
    ASSERT_FALSE(status.ok()) << name;
    EXPECT_EQ(status.error().code, ErrorCode::kIo);
    EXPECT_THAT(status.error().message, HasSubstr("--out: " + at(name) + " (")) << name;
  }
  for (const char* name : {"", "none/a.csv", "file/a.csv", "loop"})
    EXPECT_FALSE(check_output_file("--log", at(name)).ok()) << name;
  // Nobody makes a file there, whatever the rights are.
  EXPECT_FALSE(check_output_folder("--out", "/proc/neritic").ok());
  EXPECT_FALSE(check_output_file("--log", "/proc/neritic.csv").ok());
}

TEST_F(Outputs, TwoFlagsWithOneFileAreRefusedAndDevicesAreNot) {
  ASSERT_TRUE(make_folder(folder_ / "sub").ok());
  const auto checked = [](const std::string& one, const std::string& other) {
    const OutputFile files[] = {{"--log", one}, {"--plot", ""}, {"--save", other}};
    return check_outputs_differ(files);
  };
  EXPECT_TRUE(checked(at("new"), at("file")).ok());
  EXPECT_TRUE(checked("", "").ok());
  EXPECT_TRUE(checked("/dev/null", "/dev/null").ok());
  for (const auto& [one, other] :
       {std::pair("new", "new"), {"new", "sub/../new"}, {"file", "link"}}) {
    const Status status = checked(at(one), at(other));
    ASSERT_FALSE(status.ok()) << one << other;
    EXPECT_EQ(exit_status(status.error().code), 2);
    EXPECT_EQ(status.error().message,
              "--log, --save: found one file, " + at(other) + "; accepted: a file for each flag");
  }
}

// The scene is not there: what is refused is refused before anything is read.
TEST_F(Outputs, NoCommandWritesTwoResultsToOneFile) {
  const std::string file = at("a.png"), data = at("a.plot.json"), out = at("out");
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"dive", "absent.toml", "--log", file, "--save", file},
        {"dive", "absent.toml", "--record", file, "--plot", file},
        {"dive", "absent.toml", "--save", data, "--plot", file},
        {"dive", "absent.toml", "--screenshot", file, "--plot", file},
        {"render", "absent.toml", "--out", out, "--log", file, "--dump-graph", file}}) {
    const Result<std::string> ran = parse_command_line(words).value().run();
    ASSERT_FALSE(ran.ok());
    EXPECT_THAT(ran.error().message, HasSubstr("found one file, ")) << words[0] << words[2];
  }
}

// Each command looks at its outputs before anything else: before its inputs, which are not there.
TEST_F(Outputs, EveryCommandLooksBeforeItWorks) {
  const std::string no = at("file/below"), file = at("none/a.png");
  const std::vector<std::vector<std::string>> commands = {
      {"render", "absent.toml", "--out", no},
      {"render", "absent.toml", "--out", at("out"), "--dump-graph", file},
      {"dive", "absent.toml", "--headless", "--log", file},
      {"dive", "absent.toml", "--headless", "--plot", file},
      {"dive", "absent.toml", "--headless", "--record", file},
      {"dive", "absent.toml", "--headless", "--save", file},
      {"dive", "absent.toml", "--headless", "--screenshot", file},
      {"sonar", "imaging", "--depth", "absent.npy", "--intrinsics", "1,1,1,1", "--out", no},
      {"tradeoff", "physics", "--out", no},
      {"plan", "--depth", "30", "--time", "25", "--out", no},
      {"plan", "--depth", "30", "--time", "25", "--plot", file},
      {"physio", "ecg", "absent.csv", "--out", no},
      {"physio", "ecg", "absent.csv", "--plot", file}};
  for (const std::vector<std::string>& words : commands) {
    const auto line = parse_command_line(words);
    ASSERT_TRUE(line.ok()) << line.error().message;
    const Result<std::string> ran = line->run();
    ASSERT_FALSE(ran.ok());
    EXPECT_THAT(ran.error().message, HasSubstr(": cannot be written")) << words[0] << words.back();
    EXPECT_EQ(exit_status(ran.error().code), 1);
  }
}

}  // namespace
}  // namespace neritic::tools
