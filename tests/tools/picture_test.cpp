// Pictures that tools/plot draws from a program's data: without matplotlib the data is there and
// one line says what to install; bad data ends in one line.
#include "tools/common/picture.hpp"

#include <gtest/gtest.h>

#include <cstdlib>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tests/support/support.hpp"
#include "tests/tools/page_words.hpp"
#include "tests/tools/undrawn.hpp"
#include "tools/common/curves.hpp"

namespace neritic::tools {
namespace {

class Picture : public testing::Test {
 protected:
  // The exit status of a command line; what it says on stderr is in said().
  int run(const std::string& command) {
    const int raw = std::system(
        fmt::format("{} > /dev/null 2> '{}'", command, (folder_ / "said").string()).c_str());
    return WEXITSTATUS(raw);
  }
  std::string said() const { return read_text(folder_ / "said").value(); }
  std::string file(const char* name) const { return "'" + (folder_ / name).string() + "'"; }

  test::ScratchFolder folder_;
};

const std::string kModule =
    "/usr/bin/python3 -B '" + (test::source_dir() / "tools/plot").string() + "'";

TEST_F(Picture, WithoutMatplotlibTheDataIsWrittenAndOneLineSaysWhatToInstall) {
  const std::string dive =
      fmt::format("{} '{}/tools/neritic' -q dive '{}' --headless --seconds 1 --plot {}",
                  test::kUndrawn, NERITIC_BINARY_DIR,
                  (test::source_dir() / "assets/scenes/mission.toml").string(), file("a.png"));
  EXPECT_EQ(run(dive), 0) << said();
  EXPECT_FALSE(std::filesystem::exists(folder_ / "a.png"));
  EXPECT_NE(said().find("a.png: not drawn: no python3 here has matplotlib; tools/setup plots "),
            std::string::npos)
      << said();
  EXPECT_NE(said().find("a.plot.json\n"), std::string::npos) << said();
  EXPECT_EQ(std::ranges::count(said(), '\n'), 1) << said();
  // By hand, where matplotlib is.
  EXPECT_EQ(run(kModule + " " + file("a.plot.json")), 0) << said();
  EXPECT_GT(std::filesystem::file_size(folder_ / "a.png"), 20000u);
}

TEST_F(Picture, BadDataEndsInOneLine) {
  ASSERT_TRUE(write_text(folder_ / "other.json", "{\"key\": 1}\n").ok());
  EXPECT_EQ(run(kModule + " " + file("other.json")), 2);
  EXPECT_NE(said().find("other.json: found no key \"picture\""), std::string::npos) << said();
  ASSERT_TRUE(write_text(folder_ / "unknown.json", "{\"picture\": \"sunset\"}\n").ok());
  EXPECT_EQ(run(kModule + " " + file("unknown.json")), 2);
  EXPECT_NE(said().find("found picture \"sunset\"; accepted: dive"), std::string::npos) << said();
  EXPECT_EQ(run(kModule + " " + file("none.json")), 2);
  EXPECT_EQ(std::ranges::count(said(), '\n'), 1) << said();
}

TEST_F(Picture, WhatCannotBeDrawnIsAnErrorInOneLine) {
  const auto drawn = write_picture(folder_ / "a.png", {{"picture", "sunset"}});
  ASSERT_FALSE(drawn.ok());
  EXPECT_NE(drawn.error().message.find("a.png: not drawn: tools/plot: "), std::string::npos)
      << drawn.error().message;
  EXPECT_EQ(drawn.error().message.find('\n'), std::string::npos);
  EXPECT_FALSE(write_picture(folder_ / "none/a.png", {{"picture", "dive"}}).ok());
}

TEST_F(Picture, NoLabelOfADiveOverlapsAnotherOrLeavesThePage) {
  ASSERT_EQ(
      run(fmt::format("'{}/tools/neritic' -q dive '{}' --headless --seconds 3 --plot {}",
                      NERITIC_BINARY_DIR, (test::source_dir() / "assets/scenes/dive.toml").string(),
                      file("a.png"))),
      0)
      << said();
  EXPECT_EQ(run(fmt::format(
                "/usr/bin/python3 -B '{}/tests/tools/plot_labels.py' '{}/tools/plot' {}",
                test::source_dir().string(), test::source_dir().string(), file("a.plot.json"))),
            0)
      << said();
}

TEST_F(Picture, AllPanelsOfADiveAreDrawnOnRequestAlone) {
  ASSERT_EQ(
      run(fmt::format("'{}/tools/neritic' -q dive '{}' --headless --seconds 1 --plot {}",
                      NERITIC_BINARY_DIR,
                      (test::source_dir() / "assets/scenes/mission.toml").string(), file("a.png"))),
      0)
      << said();
  EXPECT_EQ(run(kModule + " " + file("a.plot.json") + " --all --out " + file("all.png")), 0)
      << said();
  const auto height = [&](const char* name) {  // big endian, at byte 20 of a PNG
    const std::string png = read_text(folder_ / name).value();
    return png.size() < 24
               ? 0
               : 256 * static_cast<unsigned char>(png[22]) + static_cast<unsigned char>(png[23]);
  };
  EXPECT_GT(height("all.png"), height("a.png") + 200);
  ASSERT_TRUE(write_text(folder_ / "plan.json", "{\"picture\": \"plan\"}\n").ok());
  EXPECT_EQ(run(kModule + " " + file("plan.json") + " --all"), 2);
  EXPECT_NE(said().find("found --all of picture \"plan\"; accepted: dive"), std::string::npos)
      << said();
}

// One element of each kind, with a zero on a logarithmic axis and a NaN.
Page small_page() {
  Page page{"Title", {"A fact."}, 2};
  page.panels.push_back({"Curves",
                         {"s"},
                         {"m"},
                         {{"one", {1.0, 2.0, 4.0}, {0.5, 0.0, NAN}, {"a", "b", "c"}}},
                         {{1.0, 0.5, "default"}},
                         {{0.0, 0.1, "10 %"}}});
  page.panels.push_back({"Bars", {""}, {"%"}, {}, {}, {}, {{"left", "side", 3.0}}});
  page.lanes = {"ms"};
  page.rows = {{"term", {2.0}, "note"}, {"none", {NAN}, ""}};
  return page;
}

TEST_F(Picture, ThePageOfTheModuleHasEveryKeyOfCurvesAndThePageIsDrawn) {
  const auto drawn = write_picture(folder_ / "c.png", page_data(small_page()));
  ASSERT_TRUE(drawn.ok()) << drawn.error().message;
  EXPECT_TRUE(*drawn);
  EXPECT_GT(std::filesystem::file_size(folder_ / "c.png"), 10000u);
  const auto json = parse_json(read_text(folder_ / "c.plot.json").value());
  ASSERT_TRUE(json.ok());
  EXPECT_TRUE((*json)["panels"][0]["series"][0]["y"][2].is_null());
  Words keys;
  gather_keys(*json, keys);
  const std::string page = read_text(test::source_dir() / "tools/plot/README.md").value();
  EXPECT_EQ(words_of(page, "## The data of `curves`", "\n## ", false), keys);
}

TEST(PictureData, HasSixDigitsAndLiesBesideThePicture) {
  EXPECT_EQ(picture_data_path("out/dive.png"), "out/dive.plot.json");
  EXPECT_EQ(six_digits(1.0 / 3.0), 0.333333);
  EXPECT_EQ(six_digits(-123456789.0), -123457000.0);
  EXPECT_TRUE(std::isinf(six_digits(INFINITY)));
}

}  // namespace
}  // namespace neritic::tools
