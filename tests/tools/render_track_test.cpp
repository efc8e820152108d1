// `neritic render` over several frames: what it accumulates under track/ names the files and the
// settings that the frames were really made with.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

class RenderTrack : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  }

  // A bottom 5 m below the sonars of the scene.
  void render(const std::string& sonars, const std::vector<std::string>& more) {
    ASSERT_TRUE(write_text(folder_ / "scene.toml",
                           "[[objects]]\nname = \"bottom\"\nshape = \"plane\"\nsize_m = [40, 40]\n"
                           "class = \"seabed\"\nposition_m = [0, -15, 0]\n" +
                               sonars)
                    .ok());
    std::vector<std::string> words{"render", (folder_ / "scene.toml").string(), "--out",
                                   (folder_ / "out").string()};
    words.insert(words.end(), more.begin(), more.end());
    const auto line = tools::parse_command_line(words);
    ASSERT_TRUE(line.ok()) << line.error().message;
    const auto done = line->run();
    ASSERT_TRUE(done.ok()) << done.error().message;
  }
  nlohmann::json json_of(const std::string& name) {
    return parse_json(read_text(folder_ / "out" / name).value()).value();
  }
  std::vector<std::string> coco_files(const std::string& sonar) {
    std::vector<std::string> names;
    const nlohmann::json coco = json_of("track/" + sonar + "/coco.json");
    for (const auto& image : coco.at("images")) names.push_back(image["file_name"]);
    return names;
  }
  void expect_all_there(const std::vector<std::string>& names) {
    for (const std::string& name : names) EXPECT_TRUE(fs::exists(folder_ / "out" / name)) << name;
  }
  test::ScratchFolder folder_;
};

constexpr const char* kSideScan =
    "[[sonars]]\nname = \"s\"\nkind = \"sidescan\"\nposition_m = [0, -10, 0]\nrange_m = [1, 20]\n"
    "bins = [100, 1, 64]\nlabels = { energy = true, coco = true }\n";

TEST_F(RenderTrack, BoxesOfASideScanNameBothSidesOfEachFrame) {
  render(kSideScan, {"--frames", "2"});
  const auto names = coco_files("s");
  EXPECT_EQ(names, (std::vector<std::string>{
                       "frame_0000/s/port/sonar.png", "frame_0000/s/starboard/sonar.png",
                       "frame_0001/s/port/sonar.png", "frame_0001/s/starboard/sonar.png"}));
  expect_all_there(names);
}

TEST_F(RenderTrack, BoxesOfASonarAtItsOwnRateNameTheFramesItIsIn) {
  const auto imaging = [](const char* name, int rate_hz) {
    return fmt::format(
        "[[sonars]]\nname = \"{}\"\nposition_m = [0, -10, 0]\npitch_deg = -40\nrange_m = [1, 20]\n"
        "azimuth_deg = 20\nbins = [50, 16, 16]\nlabels = {{ energy = true, coco = true }}\n"
        "rate_hz = {}\n",
        name, rate_hz);
  };
  render(imaging("quick", 10) + imaging("slow", 2), {"--frames", "11", "--own-rates"});
  const auto names = coco_files("slow");
  EXPECT_EQ(names,
            (std::vector<std::string>{"frame_0000/slow/sonar.png", "frame_0005/slow/sonar.png",
                                      "frame_0010/slow/sonar.png"}));
  expect_all_there(names);
  EXPECT_EQ(coco_files("quick").size(), 11u);
  expect_all_there(coco_files("quick"));
}

TEST_F(RenderTrack, AChartTellsTheBinsThatWerePinged) {
  render(
      "[[sonars]]\nname = \"m\"\nkind = \"profiling\"\nposition_m = [0, -10, 0]\npitch_deg = -90\n"
      "range_m = [1, 11]\nazimuth_deg = 40\nelevation_deg = 1\nbins = [100, 16, 8]\n"
      "bandwidth_hz = 3e4\nquality = \"standard\"\n",
      {"--frames", "2"});
  const auto pinged = json_of("frame_0000/m/sonar.json"),
             chart = json_of("track/m/bathymetry.json");
  const double bins = pinged["bins"]["range"];
  ASSERT_GT(bins, 100.0);  // the level takes finer ones than the settings name
  EXPECT_EQ(chart["sensor"]["bins"][0], bins);
  EXPECT_DOUBLE_EQ(chart["error"]["range_bin_m"], 10.0 / bins);
}

}  // namespace
}  // namespace neritic
