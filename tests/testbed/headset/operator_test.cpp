// `neritic dive --operator`: a window beside a worn headset, driven by keys on a virtual X server.
#include <gmock/gmock.h>

#include "engine/scene/image_file.hpp"
#include "tests/testbed/headset/headset_process.hpp"

namespace neritic::testbed {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

constexpr const char* kHeadset =
    "size 160 150\nfov -54 46 50 -52\nperiod 0.05\nreal_time yes\nout {0}\nout_frames 30\n";

class OperatorWindow : public HeadsetProcess {
 protected:
  void SetUp() override {
    HeadsetProcess::SetUp();
    if (IsSkipped()) return;
    if (std::system("command -v xvfb-run > /dev/null && command -v python3 > /dev/null") != 0)
      GTEST_SKIP() << "no xvfb-run or python3";
  }
  // The dive in the scratch folder while press_keys.py takes the steps. server: more arguments of
  // the X server. Its exit status; 99: a step did not come.
  int watch(const std::string& steps, const std::string& more = "",
            const std::string& server = "") {
    std::ofstream(path("run.sh")) << fmt::format(
        "cd '{}'\nexport XDG_STATE_HOME=$PWD/state\n{} &\nexport DIVE=$!\n"
        "python3 '{}/tests/testbed/view/press_keys.py' Neritic {} 2> driver || {{ kill $DIVE; cat "
        "driver >> said; exit 99; }}\nwait $DIVE\n",
        scratch_.path().string(),
        command("dive '" + scene() + "' --operator --validate --size 480x300 " + more, "said"),
        test::source_dir().string(), steps);
    const int status = std::system(
        fmt::format("xvfb-run -a -s '-screen 0 640x480x24 {}' bash '{}'", server, path("run.sh"))
            .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  // The picture of the X server as the driver wrote it, a .ppm.
  ImageU8 seen(const char* name) const {
    std::ifstream file(scratch_ / name, std::ios::binary);
    std::string magic;
    std::uint32_t width = 0, height = 0, most = 0;
    file >> magic >> width >> height >> most;
    file.get();
    ImageU8 image(std::max(width, 1u), std::max(height, 1u), 3);
    file.read(reinterpret_cast<char*>(image.data.data()),
              static_cast<std::streamsize>(image.data.size()));
    EXPECT_TRUE(file) << name;
    return image;
  }
};

double mean_of(const ImageU8& image, double left, double top, double right, double bottom, int c) {
  double sum = 0.0;
  int count = 0;
  for (auto y = static_cast<std::uint32_t>(top * image.height); y < bottom * image.height; ++y)
    for (auto x = static_cast<std::uint32_t>(left * image.width); x < right * image.width; ++x) {
      sum += image.at(x, y, static_cast<std::uint32_t>(c));
      ++count;
    }
  return sum / count;
}

TEST_F(OperatorWindow, WatchesTheWearerAndWorksTheRun) {
  script(fmt::format(kHeadset, scratch_.path().string()));
  // Panels off, so that nothing lies over the picture.
  ASSERT_EQ(
      watch("'file frame_0030_view_0.png' 'key F2' 'wait 1' 'seen a.ppm' 'key F2' 'wait 1' "
            "'seen b.ppm' 'key F5' 'file over_sand.state' 'key Return' 'wait 1' 'key F12' 'file "
            "neritic_0001.png' 'key Escape'"),
      0)
      << said();
  EXPECT_EQ(text("report"), "") << "OpenXR's rules";
  EXPECT_THAT(said(), HasSubstr("frames in"));
  EXPECT_THAT(said(), Not(HasSubstr("Validation Error")));
  // The middle of the wearer's left eye: tangents -1.38 to 1.04 and 1.19 to -1.28, of which a
  // window of 480 x 300 shows 1.04 and 0.65.
  const ImageU8 eye = scene::read_image8(scratch_ / "frame_0030_view_0.png", 3).value();
  const ImageU8 bare = seen("a.ppm");
  ASSERT_EQ(bare.width, 480u);
  for (const double top : {0.05, 0.4, 0.7}) {
    const double from = (1.19 - 0.65 * (1.0 - 2.0 * top)) / 2.47;
    const double to = from + 0.2 * 1.3 / 2.47;
    for (int c = 0; c < 3; ++c)
      EXPECT_NEAR(mean_of(bare, 0.2, top, 0.8, top + 0.2, c),
                  mean_of(eye, (1.38 - 0.62) / 2.42, from, (1.38 + 0.62) / 2.42, to, c), 14.0)
          << top << ", channel " << c;
  }
  // The panels darken the window's corner.
  const ImageU8 panels = seen("b.ppm");
  EXPECT_LT(mean_of(panels, 0.05, 0.1, 0.3, 0.3, 2), mean_of(bare, 0.05, 0.1, 0.3, 0.3, 2) - 30.0);
}

TEST_F(OperatorWindow, IsTheDisplayWhileNobodyWearsTheHeadset) {
  script(fmt::format(kHeadset, scratch_.path().string()) + "frame 3 synchronized\n");
  ASSERT_EQ(
      watch("'key F12' 'file neritic_0001.png' 'wait 2' 'seen a.ppm' 'size 320 200' 'wait 2' "
            "'seen b.ppm' minimise 'wait 1' restore 'wait 1' 'key F12' 'file neritic_0002.png' "
            "'key Escape'"),
      0)
      << said();
  EXPECT_EQ(text("report"), "");
  EXPECT_EQ(seen("b.ppm").width, 320u);
  EXPECT_GT(mean_of(seen("a.ppm"), 0.4, 0.4, 0.6, 0.6, 2), 40.0) << "the sea";
}

TEST_F(OperatorWindow, NeedsNoMemoryThatIsSharedWithTheServer) {
  script(fmt::format(kHeadset, scratch_.path().string()));
  ASSERT_EQ(watch("'file frame_0030_view_0.png' 'wait 1' 'seen a.ppm' 'size 320 200' 'wait 2' "
                  "'seen b.ppm' 'key Escape'",
                  "", "-extension MIT-SHM"),
            0)
      << said();
  EXPECT_EQ(text("report"), "");
  EXPECT_EQ(seen("b.ppm").width, 320u);
  EXPECT_GT(mean_of(seen("b.ppm"), 0.4, 0.4, 0.6, 0.6, 2), 40.0);
}

TEST_F(OperatorWindow, IsRefusedWhereThereIsNone) {
  script("size 64 60\n");
  EXPECT_EQ(run("dive '" + scene() + "' --operator --headless"), 2);
  EXPECT_THAT(said(), HasSubstr("--operator: found --headless beside it"));
  EXPECT_EQ(run("dive '" + scene() + "' --operator --display window"), 2);
  unsetenv("DISPLAY");
  EXPECT_EQ(run("dive '" + scene() + "' --operator"), 2);
  EXPECT_THAT(said(), HasSubstr("--operator: found"));
  EXPECT_THAT(said(), HasSubstr("no --operator"));
}

}  // namespace
}  // namespace neritic::testbed
