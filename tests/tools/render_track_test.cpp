// `neritic render` over several frames: what it accumulates under track/ names the files and the
// settings that the frames were really made with.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/gpu_fixture.hpp"
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
  // Beside coco.json each picture is as large as it says, so that boxes lie where they belong.
  void expect_pictures(const std::string& sonar) {
    const nlohmann::json coco = json_of("track/" + sonar + "/coco.json");
    for (const auto& image : coco.at("images")) {
      const std::string name = image["file_name"];
      NERITIC_ASSERT_OK(const ImageU8 picture,
                        scene::read_image8(folder_ / "out" / "track" / sonar / name));
      EXPECT_EQ(picture.width, image["width"]) << name;
      EXPECT_EQ(picture.height, image["height"]) << name;
    }
  }
  test::ScratchFolder folder_;
};

constexpr const char* kSideScan =
    "[[sonars]]\nname = \"s\"\nkind = \"sidescan\"\nposition_m = [0, -10, 0]\nrange_m = [1, 20]\n"
    "bins = [100, 1, 64]\nlabels = { energy = true, coco = true }\n";

// A side-scan's pings lie side by side, in the picture as in the labels and the waterfall: nothing
// is a bin wide.
TEST_F(RenderTrack, BoxesOfASideScanLieOverItsWaterfall) {
  render(kSideScan, {"--frames", "3"});
  EXPECT_EQ(coco_files("s"), (std::vector<std::string>{"coco/pings_00000.png"}));
  expect_pictures("s");
  const auto values_of = [&](const std::string& name, std::vector<std::size_t> shape) {
    const auto array = read_npy(folder_ / "out" / name);
    EXPECT_TRUE(array.ok() && array->shape == shape) << name;
    return array.ok() ? array->to_doubles() : std::vector<double>();
  };
  const auto labels = values_of("track/s/sidescan_labels.npy", {3, 200});
  EXPECT_TRUE(fs::exists(folder_ / "out/track/s/sidescan_labels.png"));
  const auto heard = values_of("track/s/sidescan_slant.npy", {3, 200});
  ASSERT_EQ(labels.size(), heard.size());
  for (std::size_t ping = 0; ping < 3; ++ping)
    for (const char* side : {"port", "starboard"}) {
      const auto frame =
          values_of(fmt::format("frame_{:04}/s/{}/sonar_labels.npy", ping, side), {100});
      for (std::size_t i = 0; i < frame.size(); ++i)
        EXPECT_EQ(labels[ping * 200 + (side[0] == 'p' ? 99 - i : 100 + i)], frame[i]);
    }
  NERITIC_ASSERT_OK(const ImageU8 picture,
                    scene::read_image8(folder_ / "out/track/s/coco/pings_00000.png"));
  ASSERT_EQ(picture.width, 200u);
  ASSERT_EQ(picture.height, 3u);
  const auto info = json_of("track/s/coco.json")["info"];
  const double floor_db = info["floor_db"], full_db = info["full_scale_db"];
  for (std::size_t i = 0; i < heard.size(); ++i) {
    const double db = heard[i] > 0.0 ? 10.0 * std::log10(heard[i]) : -1e9;
    EXPECT_NEAR(picture.data[i],
                255.0 * std::clamp((db - floor_db) / (full_db - floor_db), 0.0, 1.0), 0.51);
  }
}

// Boxes, masks and picture of one frame, of which no other track is made: what is heard in a box is
// bright in the picture there, and shadow has a category of its own.
TEST_F(RenderTrack, BoxesOfOneFrameLieOverItsPicture) {
  render(
      "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\nradius_m = 0.5\nclass = \"target\"\n"
      "position_m = [2, -14.5, -6]\n"
      "[[sonars]]\nname = \"s\"\nposition_m = [0, -10, 0]\npitch_deg = -35\nrange_m = [1, 20]\n"
      "azimuth_deg = 60\nelevation_deg = 40\nbins = [200, 64, 64]\n"
      "labels = { energy = true, coco = true }\n"
      "[[sonars]]\nname = \"m\"\nkind = \"profiling\"\nposition_m = [0, -10, 0]\npitch_deg = -90\n"
      "range_m = [1, 11]\nazimuth_deg = 40\nelevation_deg = 1\nbins = [100, 16, 8]\n",
      {});
  expect_pictures("s");
  EXPECT_FALSE(fs::exists(folder_ / "out/track/m"));
  const nlohmann::json coco = json_of("track/s/coco.json");
  NERITIC_ASSERT_OK(const ImageU8 picture,
                    scene::read_image8(folder_ / "out/track/s/coco/frame_0000.png"));
  NERITIC_ASSERT_OK(const NpyArray array, read_npy(folder_ / "out/frame_0000/s/sonar.npy"));
  const std::vector<double> heard = array.to_doubles();
  ASSERT_EQ(heard.size(), picture.data.size());
  const double most = *std::max_element(heard.begin(), heard.end());
  for (std::size_t i = 0; i < heard.size(); ++i) {
    if (heard[i] == 0.0) {
      EXPECT_EQ(picture.data[i], 0) << i;
    }
    if (heard[i] > 0.1 * most) {
      EXPECT_GT(picture.data[i], 50) << i;
    }
  }
  std::set<std::string> found;
  for (const auto& a : coco.at("annotations"))
    for (const auto& category : coco.at("categories"))
      if (category["id"] == a["category_id"]) found.insert(category["name"]);
  EXPECT_TRUE(found.contains("target") && found.contains("shadow") && found.contains("seabed"))
      << coco.at("annotations").size();
  for (const auto& a : coco.at("annotations")) {
    if (a["category_id"] != 12) continue;  // the target, to starboard and above the bottom
    EXPECT_GT(a["bbox"][0], 32);
    std::uint8_t brightest = 0;
    const std::uint32_t x0 = a["bbox"][0], y0 = a["bbox"][1], w = a["bbox"][2], h = a["bbox"][3];
    for (std::uint32_t y = y0; y < y0 + h; ++y)
      for (std::uint32_t x = x0; x < x0 + w; ++x) brightest = std::max(brightest, picture.at(x, y));
    EXPECT_GT(brightest, 100);
  }
}

TEST_F(RenderTrack, BoxesHaveTheirPicturesWithoutFramesToo) {
  render(kSideScan, {"--frames", "2", "--track-only"});
  EXPECT_FALSE(fs::exists(folder_ / "out/frame_0000"));
  EXPECT_EQ(coco_files("s").size(), 1u);
  expect_pictures("s");
}

TEST_F(RenderTrack, BoxesOfASonarAtItsOwnRateNameTheFramesItIsIn) {
  const auto imaging = [](const char* name, int rate_hz) {
    return fmt::format(
        "[[sonars]]\nname = \"{}\"\nposition_m = [0, -10, 0]\npitch_deg = -40\nrange_m = [1, 20]\n"
        "azimuth_deg = 20\nbins = [50, 16, 16]\nlabels = {{ energy = true, coco = true }}\n"
        "rate_hz = {}\n",
        name, rate_hz);
  };
  // Frames follow the quickest, wherever it is named.
  render(imaging("slow", 2) + imaging("quick", 10), {"--frames", "11", "--own-rates"});
  const auto names = coco_files("slow");
  EXPECT_EQ(names, (std::vector<std::string>{"coco/frame_0000.png", "coco/frame_0005.png",
                                             "coco/frame_0010.png"}));
  expect_pictures("slow");
  EXPECT_EQ(coco_files("quick").size(), 11u);
  expect_pictures("quick");
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
