// Help, version and wrong flags of `neritic`; needs no device.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/neritic/commands.hpp"
#include "tools/neritic/flags.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;
using ::testing::MatchesRegex;

std::string said(const std::vector<std::string>& words) {
  const auto line = parse_command_line(words);
  return line.ok() ? line->help : line.error().message;
}

TEST(CommandLine, HelpOfASubcommandNamesTheProgram) {
  for (const std::string name : {"render", "sonar", "dive", "tradeoff", "check", "doctor"})
    EXPECT_THAT(said({name, "--help"}), HasSubstr("Usage: neritic " + name)) << name;
  EXPECT_THAT(said({"--help"}), HasSubstr("Usage: neritic"));
}

TEST(CommandLine, ACommandThatThereIsNotHasNoHelp) {
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"replay"}, {"replay", "--help"}, {"replay", "a"}})
    EXPECT_THAT(said(words), HasSubstr("found command 'replay'; accepted: render, sonar, dive"));
}

TEST(CommandLine, VersionIsOneLine) {
  EXPECT_THAT(said({"--version"}), MatchesRegex("neritic [0-9]+\\.[0-9]+\\.[0-9]+\n"));
}

TEST(CommandLine, AWrongFlagPointsAtTheSubcommandsHelp) {
  EXPECT_THAT(said({"render", "a.toml", "--out", "o", "--colour"}),
              HasSubstr("(see neritic render --help)"));
  EXPECT_THAT(said({"sonar", "imaging"}), HasSubstr("(see neritic sonar --help)"));
  EXPECT_THAT(said({"--colour"}), HasSubstr("(see neritic --help)"));
}

TEST(CommandLine, AFlagSaysWhatItWantsAndAMisspeltOneTheNearest) {
  EXPECT_EQ(said({"plan", "--depth", "30ft", "--time", "20"}),
            "--depth: found '30ft'; accepted: a number: depth of the bottom, metres (see neritic "
            "plan --help)");
  EXPECT_THAT(said({"plan", "--depth=deep"}),
              HasSubstr("--depth: found 'deep'; accepted: a number"));
  EXPECT_EQ(
      said({"plan", "--dept", "30", "--time", "20"}),
      "--dept: found no such flag; accepted: the flags of --help (nearest: --depth) (see neritic "
      "plan --help)");
  EXPECT_THAT(said({"render", "a.toml", "--out", "o", "--offset", "1", "2"}),
              HasSubstr("--offset: found 2 of 3 values; accepted: moves the whole world by x y z"));
  EXPECT_THAT(said({"dive", "a.toml", "--headles"}), HasSubstr("(nearest: --headless)"));
  EXPECT_THAT(said({"dive", "a.toml", "--verbos"}), HasSubstr("(nearest: --verbose)"));
}

// Whatever the parser finds wrong is told in the form of every other refusal.
TEST(CommandLine, EachRefusalSaysWhatWasFoundAndWhatIsAccepted) {
  const std::vector<std::pair<std::vector<std::string>, const char*>> wrong{
      {{}, "found no command; accepted: render, sonar"},
      {{"serve"}, "scene: found nothing; accepted: scene file"},
      {{"render", "a.toml"}, "--out: found nothing; accepted: "},
      {{"render", "a.toml", "b.toml", "--out", "o"},
       "render: found 'b.toml' besides; accepted: scene"},
      {{"render", "a.toml", "--out", "o", "--seed", "-1"}, "--seed: found '-1'; accepted: a whole"},
      {{"render", "a.toml", "--out", "o", "--frames"}, "--frames: found "},
      {{"render", "a.toml", "--out", "o", "--quality", "best"},
       "--quality: found 'best'; accepted: draft, standard, reference"},
      {{"dive", "a.toml", "--units", "feet"}, "--units: found 'feet'; accepted: metric, imperial"},
      {{"dive", "a.toml", "--headless=soon"}, "--headless: found "},
      {{"dive", "a.toml", "--refresh", "0.5"}, "--refresh: found '0.5'; accepted: 1 to 1000"},
      {{"hud"}, "hud: found none of --replay, --connect; accepted: one of them"},
      {{"hud", "--replay", "a.mcap", "--connect", "tcp://a:1"},
       "hud: found 2 of --replay, --connect; accepted: one"},
      {{"serve", "a.toml", "--lockstep", "--realtime"}, "beside it; accepted: one of them"},
      {{"physio"}, "found nothing; accepted: "},
      {{"plan", "--depth"}, "--depth: found "},
      {{"doctor", "--nosuch"},
       "--nosuch: found no such flag; accepted: the flags of --help (nearest: "},
  };
  for (const auto& [words, line] : wrong) {
    EXPECT_THAT(said(words), HasSubstr(line));
    EXPECT_THAT(said(words),
                MatchesRegex("([^;]+: )?found .+; accepted: .+ \\(see neritic .*--help\\)"));
    for (const char* not_ours : {"required", "not in {", "expected", "excludes", "parser"})
      EXPECT_THAT(said(words), ::testing::Not(HasSubstr(not_ours)));
  }
}

TEST(CommandLine, AnEmptyFolderForTheResultsIsRefused) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"render", "a.toml", "--out", ""},
        std::vector<std::string>{"sonar", "imaging", "--intrinsics", "1,1,1,1", "--out", ""},
        std::vector<std::string>{"tradeoff", "sonar", "--out", ""},
        std::vector<std::string>{"plan", "--out", ""}}) {
    const auto line = parse_command_line(words);
    ASSERT_FALSE(line.ok()) << words[0];
    EXPECT_EQ(exit_status(line.error().code), 2);
    EXPECT_THAT(line.error().message, HasSubstr("--out"));
  }
}

TEST(CommandLine, APictureThatIsNoPngIsRefused) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"dive", "a.toml", "--plot"},
        std::vector<std::string>{"dive", "a.toml", "--screenshot"},
        std::vector<std::string>{"plan", "--depth", "30", "--time", "20", "--plot"},
        std::vector<std::string>{"physio", "ecg", "a.csv", "--plot"}}) {
    const auto with = [&](const char* file) {
      std::vector<std::string> all = words;
      all.push_back(file);
      return parse_command_line(all);
    };
    ASSERT_FALSE(with("p.jpg").ok()) << words[0];
    EXPECT_EQ(exit_status(with("p.jpg").error().code), 2);
    EXPECT_THAT(with("p.jpg").error().message, HasSubstr("found 'p.jpg'; accepted: a .png"));
    EXPECT_FALSE(with("p").ok()) << words[0];
    EXPECT_TRUE(with("p.PNG").ok()) << words[0];
  }
}

TEST(Progress, SaysHowLongTheRestTakes) {
  EXPECT_EQ(progress_line("frame", 0, 100, 5.0), "frame 0 of 100");
  EXPECT_EQ(progress_line("frame", 25, 100, 60.0), "frame 25 of 100, 3:00 left");
  EXPECT_EQ(progress_line("frame", 99, 100, 990.0), "frame 99 of 100, 0:10 left");
  EXPECT_EQ(progress_line("point", 10, 100, 1000.0), "point 10 of 100, 2 h 30 min left");
  EXPECT_EQ(progress_line("frame", 100, 100, 60.0), "frame 100 of 100");
}

// Also while one step lasts, and nothing after the last.
TEST(Progress, SaysHowFarItIsWithoutATerminal) {
  testing::internal::CaptureStderr();
  {
    Progress progress("frame", 4, 0.05);
    progress.step();
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    progress.now("a slow one");
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
  }
  {
    const Progress one("frame", 1, 0.05);
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
  }
  const std::string told = testing::internal::GetCapturedStderr();
  EXPECT_THAT(told, MatchesRegex("(note: frame 1 of 4, 0:0[0-9] left\n)+"
                                 "(note: frame 1 of 4, 0:0[0-9] left: a slow one\n)+"));
  EXPECT_GE(std::ranges::count(told, '\n'), 4);
  EXPECT_LE(std::ranges::count(told, '\n'), 16);
}

TEST(CommandLine, NoFrameIsNoNumberOfFrames) {
  for (const char* command : {"render", "dive"}) {
    EXPECT_THAT(said({command, "a.toml", "--out", "o", "--frames", "0"}),
                HasSubstr("found '0'; accepted: 1 to 1000000"))
        << command;
    EXPECT_FALSE(parse_command_line({command, "a.toml", "--frames", "-1"}).ok());
  }
}

TEST(CommandLine, HelpSaysWhatRenderWritesAndHowAPlanIsAskedFor) {
  EXPECT_THAT(said({"render", "--help"}), HasSubstr("OUT/frame_0000"));
  EXPECT_THAT(said({"plan", "--help"}), HasSubstr("neritic plan --depth 30 --time 25"));
  EXPECT_THAT(said({"plan", "--help"}), HasSubstr("--table c"));
  EXPECT_THAT(said({"check", "--help"}), HasSubstr("tests/diver/data/deco_vectors.json"));
}

TEST(CommandLine, AWrongSubcommandListsThem) {
  EXPECT_THAT(said({"rendre"}),
              HasSubstr("render, sonar, dive, serve, keys, tradeoff, check, plan, physio, "
                        "register, experiment, study, recording, hud, simulate, doctor"));
}

}  // namespace
}  // namespace neritic::tools
