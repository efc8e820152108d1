// `neritic dive` as a user starts it: a window under a virtual X server, no window, no display.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "engine/scene/image_file.hpp"
#include "tests/support/device_gate.hpp"
#include "tests/support/support.hpp"

namespace neritic {
namespace {

namespace fs = std::filesystem;

struct Outcome {
  int status = -1;
  std::string out, err;
};

std::string text_of(const fs::path& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

Outcome neritic(const test::ScratchFolder& scratch, const std::string& before,
                const std::string& arguments) {
  const std::string command =
      fmt::format("{} '{}/tools/neritic' {} > '{}' 2> '{}'", before, NERITIC_BINARY_DIR, arguments,
                  (scratch / "out").string(), (scratch / "err").string());
  const int status = std::system(command.c_str());
  return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, text_of(scratch / "out"),
          text_of(scratch / "err")};
}

Outcome dive(const test::ScratchFolder& scratch, const std::string& before,
             const std::string& arguments) {
  return neritic(scratch, before, "dive " + arguments);
}

std::string pool() {
  return (test::source_dir() / "assets/scenes/pool.toml").string();
}
bool has_program(const char* name) {
  return std::system(fmt::format("command -v {} > /dev/null", name).c_str()) == 0;
}

// Pixels of the picture that are not its corner's colour: more than a blank one has.
std::size_t drawn_pixels(const ImageU8& image) {
  std::size_t count = 0;
  for (std::uint32_t y = 0; y < image.height; ++y)
    for (std::uint32_t x = 0; x < image.width; ++x)
      count += image.at(x, y, 1) != image.at(0, image.height - 1, 1);
  return count;
}

TEST(Dive, WindowShowsFramesWithPanelsAndValidationSilent) {
  if (!has_program("xvfb-run")) GTEST_SKIP() << "no xvfb-run (Debian package xvfb)";
  const test::ScratchFolder scratch;
  const Outcome outcome =
      dive(scratch, "xvfb-run -a -s '-screen 0 640x480x24'",
           fmt::format("'{}' --display window --size 480x270 --frames 6 --validate "
                       "--screenshot '{}'",
                       pool(), (scratch / "last.png").string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_EQ(outcome.out.rfind("6 frames in ", 0), 0u) << outcome.out;
  const auto image = scene::read_image8(scratch / "last.png", 3);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_EQ(image->width, 480u);
  EXPECT_EQ(image->height, 270u);
  EXPECT_GT(drawn_pixels(*image), 480u * 270u / 10);
}

// Each frame's phases follow one another, and frames do too.
void expect_timeline(const fs::path& data, std::size_t frames) {
  const auto timeline = nlohmann::json::parse(text_of(data), nullptr, false);
  ASSERT_TRUE(timeline.is_object());
  EXPECT_EQ(timeline["interval_ms"].size(), frames - 1);
  EXPECT_EQ(timeline["view_scale"], std::vector<double>(frames - 1, 1.0));
  double at_ms = -1e-3;
  for (const auto& frame : timeline["frames"]) {
    EXPECT_GE(frame["passes"].size(), 4u);
    for (const char* phase : {"wait", "simulate, declare", "record", "submit", "show"}) {
      const auto found =
          std::ranges::find_if(frame["host"], [&](const auto& p) { return p[0] == phase; });
      ASSERT_NE(found, frame["host"].end()) << phase;
      EXPECT_GE((*found)[1].get<double>(), at_ms - 1e-2) << phase;
      EXPECT_GE((*found)[2].get<double>(), 0.0) << phase;
      at_ms = (*found)[1].get<double>() + (*found)[2].get<double>();
    }
  }
}

TEST(Dive, HeadlessDrawsThatManyFramesAndSaysWhatTheyTook) {
  const test::ScratchFolder scratch;
  const Outcome outcome =
      dive(scratch, "env -u DISPLAY -u WAYLAND_DISPLAY",
           fmt::format("'{}' --headless --fast --panels --size 160x90 --frames 7 --validate "
                       "--screenshot '{}' --timeline '{}'",
                       pool(), (scratch / "last.png").string(), (scratch / "t.png").string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("7 frames in"), std::string::npos) << outcome.out;
  for (const char* pass : {"camera gbuffer", "camera tonemap", "sonar gather", "overlay"})
    EXPECT_NE(outcome.out.find(pass), std::string::npos) << pass << "\n" << outcome.out;
  EXPECT_TRUE(fs::exists(scratch / "last.png"));
  // Every frame's passes are counted, those still in flight at the end included.
  const std::size_t line = outcome.out.find("camera gbuffer");
  EXPECT_EQ(outcome.out.substr(outcome.out.find('\n', line) - 2, 2), " 7") << outcome.out;
  expect_timeline(scratch / "t.plot.json", 7);
}

// Frames a tenth of a second apart, whatever one takes to draw.
TEST(Dive, SecondsAreThoseOfTheScene) {
  const test::ScratchFolder scratch;
  std::ofstream(scratch / "ball.toml")
      << "[sun]\nelevation_deg = 60\n[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n"
         "radius_m = 0.5\nposition_m = [3, -4, 5]\n[[cameras]]\nname = \"eye\"\nwidth = 64\n"
         "height = 48\nrate_hz = 10\nposition_m = [3, -4, 8]\n";
  const Outcome outcome =
      dive(scratch, "",
           fmt::format("'{}' --headless --fast --seconds 2", (scratch / "ball.toml").string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("21 frames in"), std::string::npos) << outcome.out;
}

// Bodies that bend, without the motion image that `render` always asks for.
TEST(Dive, AnimatedSceneLeavesValidationSilent) {
  const test::ScratchFolder scratch;
  const fs::path wreck = test::source_dir() / "assets/scenes/wreck.toml";
  const Outcome outcome = dive(
      scratch, "",
      fmt::format("'{}' --headless --fast --size 160x90 --frames 4 --validate", wreck.string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("deform"), std::string::npos) << outcome.out;
}

TEST(Dive, SceneWithoutCameraOrSonarIsSeenAndPaysForNoSonar) {
  const test::ScratchFolder scratch;
  std::ofstream(scratch / "ball.toml") << "title = \"Ball\"\n[sun]\nelevation_deg = 60\n"
                                          "[[objects]]\nname = \"ball\"\nshape = \"sphere\"\n"
                                          "radius_m = 0.5\nposition_m = [3, -4, 5]\n";
  const Outcome outcome =
      dive(scratch, "",
           fmt::format("'{}' --headless --fast --size 160x90 --frames 3 "
                       "--screenshot '{}'",
                       (scratch / "ball.toml").string(), (scratch / "last.png").string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(outcome.out.find("sonar"), std::string::npos) << outcome.out;
  const auto image = scene::read_image8(scratch / "last.png", 3);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_GT(drawn_pixels(*image), 200u);  // the ball
}

// A scene made for sonars alone is seen from its first sonar, by a sun that the view adds.
TEST(Dive, ASceneOfSonarsAloneIsLit) {
  const test::ScratchFolder scratch;
  std::ofstream(scratch / "box.toml")
      << "[[objects]]\nname = \"box\"\nshape = \"box\"\nposition_m = [0, -4, -4]\n[[sonars]]\n"
         "name = \"sonar\"\nbins = [32, 32, 32]\nposition_m = [0, -4, 0]\n";
  const Outcome outcome =
      dive(scratch, "",
           fmt::format("'{}' --headless --fast --size 64x48 --frames 1 --screenshot '{}'",
                       (scratch / "box.toml").string(), (scratch / "last.png").string()));
  if (test::may_skip_without_device()) GTEST_SKIP() << outcome.err;
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NE(outcome.err.find("the view adds a sun"), std::string::npos) << outcome.err;
  const auto image = scene::read_image8(scratch / "last.png", 3);
  ASSERT_TRUE(image.ok()) << image.error().message;
  EXPECT_GT(image->at(32, 26, 1), 40);  // the box, ahead of the sonar
}

// A vehicle with a camera and a sonar of four pings a second, in the scratch folder.
std::string write_flight(const test::ScratchFolder& scratch) {
  const std::string dynamics =
      (test::source_dir() / "assets/vehicles/bluerov2_heavy_dynamics.toml").string();
  std::ofstream(scratch / "flight.toml")
      << "title = \"flight\"\n[physics]\n[sun]\n[[objects]]\n"
         "name = \"sand\"\nclass = \"seabed\"\nshape = \"plane\"\n"
         "size_m = [20, 20]\nposition_m = [0, -8, 0]\n"
         "[[vehicles]]\nname = \"rov\"\nshape = \"box\"\n"
         "dynamics = \""
      << dynamics
      << "\"\nposition_m = [0, -6, 0]\n"
         "mission = { waypoints = [ { position_m = [0, -6, -2] } ] }\n"
         "[[vehicles.cameras]]\nname = \"eye\"\nwidth = 32\n"
         "height = 18\nrate_hz = 16\n"
         "[[vehicles.sonars]]\nname = \"sonar\"\nrate_hz = 4\n"
         "range_m = [0.5, 8]\nazimuth_deg = 40\n"
         "elevation_deg = 10\nbins = [50, 16, 8]\n";
  return (scratch / "flight.toml").string();
}

// With and without pictures, and by `render`: the same flight of a second, to the same step, which
// no frame falls on.
TEST(Dive, LogRecordingAndStateDoNotDependOnWhoLooks) {
  const test::ScratchFolder scratch;
  const std::string scene = write_flight(scratch), at = scratch.path().string();
  const auto ask = [&](const std::string& name) {
    return fmt::format("--log {0}/{1}.csv --record {0}/{1}.mcap --save {0}/{1}.state --json", at,
                       name);
  };
  const Outcome alone =
      dive(scratch, "", fmt::format("'{}' --headless --seconds 1.01 {}", scene, ask("a")));
  ASSERT_EQ(alone.status, 0) << alone.err;
  const Outcome shown =
      dive(scratch, "", fmt::format("'{}' --headless --fast --seconds 1.01 {}", scene, ask("b")));
  if (test::may_skip_without_device()) GTEST_SKIP() << shown.err;
  ASSERT_EQ(shown.status, 0) << shown.err;
  const Outcome rendered =
      neritic(scratch, "",
              fmt::format("render '{}' --sensor rov_sonar --frames 5 --out {}/r --log {}/c.csv",
                          scene, at, at));
  ASSERT_EQ(rendered.status, 0) << rendered.err;
  const std::string csv = text_of(scratch / "a.csv");
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 52);
  EXPECT_EQ(text_of(scratch / "b.csv"), csv);
  EXPECT_EQ(text_of(scratch / "c.csv"), csv);
  const Outcome same =
      dive(scratch, "", fmt::format("'{}' --headless --replay {}/b.mcap", scene, at));
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_EQ(text_of(scratch / "b.state"), text_of(scratch / "a.state"));
  const auto hash_in = [](const std::string& out) { return out.substr(out.find("\"hash\""), 28); };
  EXPECT_EQ(hash_in(shown.out), hash_in(alone.out));
  // Both go on from there alike.
  const Outcome on =
      dive(scratch, "",
           fmt::format("'{}' --headless --seconds 1 --restore {}/a.state --json", scene, at));
  const Outcome on_shown = dive(
      scratch, "",
      fmt::format("'{}' --headless --fast --frames 17 --restore {}/b.state --json", scene, at));
  ASSERT_EQ(on_shown.status, 0) << on_shown.err;
  EXPECT_EQ(hash_in(on_shown.out), hash_in(on.out));
  EXPECT_NE(hash_in(on.out), hash_in(alone.out));
  const Outcome replay = dive(
      scratch, "", fmt::format("'{}' --headless --fast --panels --replay {}/a.mcap", scene, at));
  EXPECT_EQ(replay.status, 0) << replay.err;
  EXPECT_NE(replay.out.find("a.mcap: 243 of 243 steps, each with the hash that was recorded"),
            std::string::npos)
      << replay.out;
}

// A recording made without pictures gives later those that the run would have given, bit for bit;
// and those of sensors and scenes that it never had.
TEST(Dive, ARecordingIsRenderedLaterAlsoByOtherSensorsAndElsewhere) {
  const test::ScratchFolder scratch;
  const std::string scene = write_flight(scratch), at = scratch.path().string();
  const Outcome run = dive(
      scratch, "", fmt::format("'{}' --headless --seconds 1.01 --record {}/a.mcap", scene, at));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto render = [&](const std::string& what, const std::string& out) {
    return neritic(scratch, "", fmt::format("render {} --out {}/{}", what, at, out));
  };
  const Outcome then = render("'" + scene + "' --frames 5", "then");
  if (test::may_skip_without_device()) GTEST_SKIP() << then.err;
  ASSERT_EQ(then.status, 0) << then.err;
  const std::string replay = fmt::format("--replay {}/a.mcap ", at);
  const Outcome later = render(replay + "--frames 5", "later");
  ASSERT_EQ(later.status, 0) << later.err;
  const std::string first = text_of(scratch / "then/frame_0000/rov_eye/depth.npy");
  for (const char* file : {"frame_0004/rov_eye/depth.npy", "frame_0004/rov_sonar/sonar.npy"}) {
    const std::string pixels = text_of(scratch / "then" / file);
    EXPECT_GT(pixels.size(), 1000u) << file;
    EXPECT_NE(pixels, first) << file;  // it moved
    EXPECT_EQ(text_of(scratch / "later" / file), pixels) << file;
  }
  // Another sonar, which the scene never had, and no more frames than were recorded.
  ASSERT_TRUE(write_text(scratch / "more.toml",
                         "[[sonars]]\nname = \"second\"\non = \"rov\"\nposition_m = [0, 0, -0.4]\n"
                         "range_m = [0.5, 8]\nazimuth_deg = 40\nelevation_deg = 10\n"
                         "bins = [40, 8, 8]\nrate_hz = 4\n")
                  .ok());
  const Outcome other =
      render(replay + fmt::format("--add {}/more.toml --sensor second", at), "other");
  ASSERT_EQ(other.status, 0) << other.err;
  EXPECT_FALSE(text_of(scratch / "other/frame_0004/second/sonar.npy").empty());
  EXPECT_FALSE(std::filesystem::exists(scratch / "other/frame_0005"));
  const Outcome longer = render(replay + "--sensor rov_sonar --frames 500", "longer");
  EXPECT_EQ(longer.status, 2);
  EXPECT_NE(longer.err.find("--frames: found 500; accepted: up to "), std::string::npos)
      << longer.err;
}

// Its simulation has a thread of its own, and ends with the same step as one without a window.
TEST(Dive, AWindowKeepsTheLogOfThatManySecondsAndItsRecordingReplays) {
  if (!has_program("xvfb-run")) GTEST_SKIP() << "no xvfb-run (Debian package xvfb)";
  const test::ScratchFolder scratch;
  const std::string scene = write_flight(scratch), at = scratch.path().string();
  const Outcome window =
      dive(scratch, "xvfb-run -a -s '-screen 0 640x480x24'",
           fmt::format("'{}' --seconds 1 --log {}/w.csv --record {}/w.mcap --json", scene, at, at));
  if (test::may_skip_without_device()) GTEST_SKIP() << window.err;
  ASSERT_EQ(window.status, 0) << window.err;
  EXPECT_NE(window.out.find("\"hash\""), std::string::npos) << window.out;
  const Outcome alone =
      dive(scratch, "", fmt::format("'{}' --headless --seconds 1 --log {}/a.csv", scene, at));
  ASSERT_EQ(alone.status, 0) << alone.err;
  EXPECT_NE(alone.out.find("1 s in 240 steps"), std::string::npos) << alone.out;
  EXPECT_EQ(text_of(scratch / "w.csv"), text_of(scratch / "a.csv"));
  EXPECT_NE(window.out.find("\"steps\": 240"), std::string::npos) << window.out;
  const Outcome replay =
      dive(scratch, "", fmt::format("'{}' --headless --replay {}/w.mcap", scene, at));
  EXPECT_EQ(replay.status, 0) << replay.err;
}

TEST(Dive, WithoutADisplaySaysSoInOneLineAndNamesTheWaysRound) {
  const test::ScratchFolder scratch;
  const Outcome outcome =
      dive(scratch, "env -u DISPLAY -u WAYLAND_DISPLAY", fmt::format("'{}' --frames 1", pool()));
  EXPECT_EQ(outcome.status, 1);
  EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1) << outcome.err;
  EXPECT_NE(outcome.err.find("--headless"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("neritic render"), std::string::npos) << outcome.err;
}

TEST(Dive, UnknownSensorIsRefusedWithTheKnownOnes) {
  const test::ScratchFolder scratch;
  const Outcome outcome =
      dive(scratch, "", fmt::format("'{}' --headless --frames 1 --sensor nose", pool()));
  EXPECT_EQ(outcome.status, 2);
  EXPECT_NE(outcome.err.find("nose"), std::string::npos) << outcome.err;
  EXPECT_NE(outcome.err.find("accepted: camera, sonar"), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace neritic
