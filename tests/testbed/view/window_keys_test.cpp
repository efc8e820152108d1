// `dive` in a window, driven by keys under a virtual X server.
#include <gtest/gtest.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "engine/core/image.hpp"
#include "engine/scene/image_file.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/testbed/view/window_run.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

class WindowKeys : public testing::Test {
 protected:
  void SetUp() override {
    if (!test::can_drive_windows()) GTEST_SKIP() << "no xvfb-run or python3";
    const std::string dynamics =
        (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
    std::ofstream(scratch_ / "flight.toml")
        << "title = \"flight\"\n[physics]\n[sun]\n[[objects]]\nname = \"sand\"\nclass = "
           "\"seabed\"\nshape = \"plane\"\nsize_m = [20, 20]\nposition_m = [0, -8, 0]\n"
           "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\ndynamics = \""
        << dynamics
        << "\"\nposition_m = [0, -6, 0]\nmission = { waypoints = [ { position_m = [0, -6, -9] } ] "
           "}\n[[vehicles.cameras]]\nname = \"eye\"\nwidth = 32\nheight = 18\n"
           "[[vehicles.sonars]]\nname = \"sonar\"\nrate_hz = 4\nrange_m = [0.5, 8]\n"
           "azimuth_deg = 40\nelevation_deg = 10\nbins = [50, 16, 8]\n";
  }
  test::WindowRun drive(const std::string& arguments, const std::vector<std::string>& steps) {
    return test::drive_window(scratch_.path(), "flight.toml --size 320x240 " + arguments, steps);
  }
  test::WindowRun dive(const std::string& arguments) {
    const std::string command =
        fmt::format("cd '{}' && '{}/tools/neritic' dive flight.toml --headless {} > out 2> err",
                    scratch_.path().string(), NERITIC_BINARY_DIR, arguments);
    const int status = std::system(command.c_str());
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, test::text_of(scratch_ / "out"),
            test::text_of(scratch_ / "err")};
  }
  // The only file of that ending.
  std::string file(const std::string& ending) const {
    std::string found;
    for (const auto& entry : fs::directory_iterator(scratch_.path()))
      if (const std::string name = entry.path().filename().string();
          name.starts_with("flight_") && name.ends_with(ending)) {
        EXPECT_EQ(found, "") << name;
        found = name;
      }
    return found;
  }
  test::ScratchFolder scratch_;
};

// A screenshot is written frames after its key: all keys before it have been taken then.
std::vector<std::string> steps_of(const std::vector<std::string>& keys) {
  std::vector<std::string> out;
  int shots = 0;
  for (const std::string& key : keys) {
    if (key != "shot") {
      out.push_back(key);
      continue;
    }
    out.push_back("key F12");
    out.push_back(fmt::format("file neritic_{:04}.png", ++shots));
  }
  return out;
}

// Paused, so that no step lies between the key and the second save.
TEST_F(WindowKeys, F9GoesBackToTheStateOfF5ToTheLastBit) {
  const test::WindowRun run =
      drive("", steps_of({"shot", "key Return", "shot", "key F5", "take flight.state first.state",
                          "key Return", "shot", "wait 0.5", "key Return", "shot", "key F5",
                          "take flight.state later.state", "take first.state flight.state",
                          "key F9", "shot", "take flight.state first.state", "key F5",
                          "take flight.state back.state", "key Escape"}));
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string first = test::text_of(scratch_ / "first.state");
  EXPECT_GT(first.size(), 500u);
  EXPECT_NE(test::text_of(scratch_ / "later.state"), first);
  EXPECT_EQ(test::text_of(scratch_ / "back.state"), first);
}

// A later dive comes up with its panels hidden, as the one before was left.
TEST_F(WindowKeys, PanelsAreHiddenAndShownAgainAndAWindowWithoutThemGoesOn) {
  const std::vector<std::string> shots = {"key F12", "file neritic_0001.png", "wait 0.5", "key F12",
                                          "file neritic_0002.png"};
  std::vector<std::string> hidden = {"wait 0.3", "key F2", "wait 5.2"};  // past the key's note
  hidden.insert(hidden.end(), shots.begin(), shots.end());
  hidden.push_back("key Escape");
  const test::WindowRun run = drive("", hidden);
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  EXPECT_EQ(run.status, 0) << run.err;
  const test::WindowRun again =
      drive("", {"wait 1", "key F12", "file neritic_0003.png", "key F2", "wait 0.5", "key F12",
                 "file neritic_0004.png", "key Escape"});
  EXPECT_EQ(again.status, 0) << again.err;
}

// A vehicle is taken over while it is recorded: what the keys did is in the recording.
TEST_F(WindowKeys, ARecordingBegunInMidRunReplaysFromTheStateInIt) {
  const test::WindowRun run =
      drive("", steps_of({"shot", "key F4", "file flight_*.mcap.part", "key p", "down w", "shot",
                          "up w", "key F9", "shot", "key F4", "file flight_*.mcap", "key Escape"}));
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string recording = file(".mcap");
  ASSERT_NE(recording, "");
  EXPECT_NE(file(".csv"), "");
  const test::WindowRun replay = dive("--replay " + recording);
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find(" steps, each with the hash that was recorded"), std::string::npos)
      << replay.out;
}

// Nothing is drawn meanwhile, and what is saved shows that time passes.
TEST_F(WindowKeys, AMinimisedWindowDrawsNothingWhileTheDiveGoesOn) {
  const test::WindowRun run =
      drive("--timeline t.png",
            steps_of({"shot", "minimise", "wait 0.5", "key F5", "take flight.state first.state",
                      "wait 2.5", "key F5", "take flight.state later.state", "restore", "shot",
                      "key Escape"}));
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  const std::string first = test::text_of(scratch_ / "first.state");
  EXPECT_GT(first.size(), 500u);
  EXPECT_NE(test::text_of(scratch_ / "later.state"), first);
  // For those 3 s no view is drawn: the device works for single frames, those of the scene's sonar.
  const auto timeline =
      nlohmann::json::parse(test::text_of(scratch_ / "t.plot.json"), nullptr, false);
  ASSERT_TRUE(timeline.is_object());
  double longest_s = 0.0, begun_s = -1.0;
  bool worked_before = true;
  for (std::size_t i = 0; i < timeline["device_ms"].size(); ++i) {
    const double at_s = timeline["time_s"][i];
    const bool works = timeline["device_ms"][i] > 0.0;
    if (works && worked_before)
      begun_s = -1.0;
    else if (begun_s < 0.0)
      begun_s = at_s;
    else
      longest_s = std::max(longest_s, at_s - begun_s);
    worked_before = works;
  }
  EXPECT_GT(longest_s, 2.5);
}

// A part of a picture that has no panels.
ImageU8 middle_of(const ImageU8& image) {
  ImageU8 out(image.width / 4, image.height / 4, 3);
  for (std::uint32_t y = 0; y < out.height; ++y)
    std::copy_n(&image.at(3 * image.width / 8, image.height / 2 + y), std::size_t{3} * out.width,
                &out.at(0, y));
  return out;
}

ImageU8 read_ppm(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string magic;
  std::uint32_t width = 0, height = 0, most = 0;
  file >> magic >> width >> height >> most;
  file.get();
  ImageU8 image(width, height, 3);
  file.read(reinterpret_cast<char*>(image.data.data()),
            static_cast<std::streamsize>(image.data.size()));
  EXPECT_TRUE(file.good() && magic == "P6") << path;
  return image;
}

// The number of bytes that the program had written to files and sockets.
double written_bytes(const fs::path& path) {
  std::istringstream text(test::text_of(path));
  std::string key;
  double value = -1.0;
  while (text >> key >> value)
    if (key == "wchar:") return value;
  return -1.0;
}

// A paused dive, so that a screenshot and what the server shows are of one picture: in the first
// size of the window, then in another, whose width is no multiple of a tile's. Its frames between
// the two looks at what it wrote are of one size.
const std::vector<std::string> kShownSteps = {"wait 0.3",
                                              "key F12",
                                              "file neritic_0001.png",
                                              "key Return",
                                              "wait 0.5",
                                              "key F12",
                                              "file neritic_0002.png",
                                              "wait 0.3",
                                              "seen first.ppm",
                                              "io io_1",
                                              "key F12",
                                              "file neritic_0003.png",
                                              "key F12",
                                              "file neritic_0004.png",
                                              "io io_2",
                                              "size 733 451",
                                              "wait 0.7",
                                              "key F12",
                                              "file neritic_0005.png",
                                              "wait 0.3",
                                              "seen second.ppm",
                                              "key Escape"};

class ShownInWindow : public WindowKeys {
 protected:
  test::WindowRun show(const std::string& server, const std::string& quality = "full") {
    return test::drive_window(scratch_.path(),
                              "flight.toml --size 640x480 --timeline t.png --quality " + quality,
                              kShownSteps, server);
  }
  void expect_equal(const std::string& screenshot, const std::string& seen,
                    double mean_within = 0.0) {
    NERITIC_ASSERT_OK(const ImageU8 image, scene::read_image8(scratch_ / screenshot, 3));
    const ImageU8 shown = read_ppm(scratch_ / seen);
    ASSERT_EQ(image.width, shown.width);
    ASSERT_EQ(image.height, shown.height);
    const ImageU8 a = middle_of(image), b = middle_of(shown);
    double sum = 0.0;
    for (std::size_t i = 0; i < a.data.size(); ++i)
      sum += std::abs(int{a.data[i]} - int{b.data[i]});
    EXPECT_LE(sum / static_cast<double>(a.data.size()), mean_within) << screenshot << ' ' << seen;
  }
  // Whether one of the last frames, which have no screenshot, had the pass.
  bool has_pass(const std::string& name) {
    const auto timeline =
        nlohmann::json::parse(test::text_of(scratch_ / "t.plot.json"), nullptr, false);
    EXPECT_TRUE(timeline.is_object() && !timeline["frames"].empty());
    for (const auto& frame : timeline["frames"])
      for (const auto& pass : frame["passes"])
        if (pass[0] == name) return true;
    return false;
  }
};

TEST_F(ShownInWindow, TheXServerShowsWhatIsDrawnAndGetsNoTexelsThroughItsSocket) {
  const test::WindowRun run = show("");
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  expect_equal("neritic_0002.png", "first.ppm");
  expect_equal("neritic_0005.png", "second.ppm");
  // Two frames at least, of 1.2 MB each; screenshots of them are files of 20 kB.
  const double before = written_bytes(scratch_ / "io_1"), after = written_bytes(scratch_ / "io_2");
  ASSERT_GT(before, 0.0);
  EXPECT_LT(after - before, 2.0 * 640 * 480 * 4);
}

// The resolution may change between the two pictures.
TEST_F(ShownInWindow, TheHostScalesALowPictureAndLaysThePanelsOverInPlaceOfTheDevice) {
  const test::WindowRun run = show("", "auto");
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  expect_equal("neritic_0002.png", "first.ppm", 3.0);
  EXPECT_TRUE(has_pass("display texels 0"));
  EXPECT_TRUE(has_pass("display texels 1"));  // the panels, of which only drawn parts are brought
  EXPECT_FALSE(has_pass("display copy"));
  EXPECT_FALSE(has_pass("display panels"));
}

TEST_F(ShownInWindow, AServerThatSharesNoMemoryShowsTheSamePicture) {
  const test::WindowRun run = show("-extension MIT-SHM");
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  expect_equal("neritic_0002.png", "first.ppm");
  expect_equal("neritic_0005.png", "second.ppm");
  EXPECT_TRUE(has_pass("display copy"));
  EXPECT_GT(written_bytes(scratch_ / "io_2") - written_bytes(scratch_ / "io_1"),
            2.0 * 640 * 480 * 4);
}

// Instruments that do not change keep their images from frame to frame, whoever reads them.
TEST_F(WindowKeys, InstrumentsOverTheViewKeepVulkansRules) {
  const std::string scene = (test::source_dir() / "tests/scenes/over_sand.toml").string();
  for (const char* const server : {"", "-extension MIT-SHM"}) {
    const test::WindowRun run = test::drive_window(
        scratch_.path(), "'" + scene + "' --size 320x200 --frames 12 --validate --hud corner",
        {"wait 0.1"}, server);
    if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
    EXPECT_EQ(run.status, 0) << run.err;
  }
}

// At full quality it took four times as long as the view that the governor had made coarse.
TEST_F(WindowKeys, TheInsetGivesWayWithTheViewWhereFramesAreLate) {
  const std::string scene = (test::source_dir() / "assets/scenes/dive.toml").string();
  const test::WindowRun run = test::drive_window(
      scratch_.path(), "'" + scene + "' --size 640x360 --seconds 7 --timeline t.png",
      {"wait 3", "key n"});
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  ASSERT_EQ(run.status, 0) << run.err;
  const auto data = nlohmann::json::parse(test::text_of(scratch_ / "t.plot.json"), nullptr, false);
  ASSERT_TRUE(data.is_object());
  double inset_ms = 0.0, view_ms = 0.0;
  for (const auto& frame : data["frames"])
    for (const auto& pass : frame["passes"])
      (pass[0].get<std::string>().starts_with("inset ") ? inset_ms : view_ms) +=
          pass[1].get<double>();
  EXPECT_GT(inset_ms, 0.0);
  EXPECT_LT(inset_ms, view_ms);
}

TEST_F(WindowKeys, AReplayIsNeitherSavedNorRecorded) {
  ASSERT_EQ(dive("--seconds 3 --record whole.mcap").status, 0);
  const test::WindowRun run =
      drive("--replay whole.mcap", {"wait 0.5", "key F5", "key F4", "key F9", "wait 0.5", "key F12",
                                    "file neritic_0001.png", "key Escape"});
  if (test::may_skip_without_device()) GTEST_SKIP() << run.err;
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_FALSE(fs::exists(scratch_ / "flight.state"));
  EXPECT_EQ(file(".log") + file(".log.part"), "");
}

}  // namespace
}  // namespace neritic
