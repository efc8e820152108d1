// `neritic hud`: the instruments of a recorded dive over another program, in a process of its own.
#include <sys/wait.h>

#include <fstream>
#include <sstream>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

class OverlayProcess : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
    ASSERT_EQ(run("dive '" + scene() + "' --headless --seconds 6 --record '" + path("dive.mcap") +
                  "' -q"),
              0)
        << said();
  }
  static std::string scene() { return (test::source_dir() / "assets/scenes/ascent.toml").string(); }
  std::string path(const char* name) const { return (scratch_ / name).string(); }
  int run(const std::string& arguments) const {
    const int status = std::system(fmt::format("XR_RUNTIME_JSON='{}' NERITIC_FAKE_XR='{}' "
                                               "'{}/tools/neritic' {} > '{}' 2>&1",
                                               fake_.manifest(), path("script"), NERITIC_BINARY_DIR,
                                               arguments, path("said"))
                                       .c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int run_hud(const std::string& script) const {
    std::ofstream(scratch_ / "script") << script << "report " << path("report") << '\n';
    return run("hud --replay '" + path("dive.mcap") + "' --hud mask,console --frames 6 --validate");
  }
  std::string text(const char* name) const {
    std::ifstream file(scratch_ / name);
    std::ostringstream all;
    all << file.rdbuf();
    return all.str();
  }
  std::string said() const { return text("said"); }

  test::ScratchFolder scratch_;
  fakes::FakeHeadset fake_;  // for its manifest
};

TEST_F(OverlayProcess, LaysItsPanelsOverTheOtherProgramAndDrawsNoView) {
  ASSERT_EQ(run_hud(fmt::format("size 400 400\nperiod 0.05\nreal_time yes\nbackground 0 0.2 0\n"
                                "out {}\nout_frames 4\n",
                                path(""))),
            0)
      << said();
  EXPECT_EQ(text("report"), "");
  const ImageU8 seen = scene::read_image8(scratch_ / "overlay_frame_0004_view_0.png").value();
  std::size_t ink = 0, other = 0;
  for (std::uint32_t y = 0; y < seen.height; ++y)
    for (std::uint32_t x = 0; x < seen.width; ++x) {
      const auto* p = &seen.at(x, y);
      ink += p[0] > 150 && p[1] > 150 && p[2] > 150;
      other += p[0] == 0 && p[2] == 0 && p[1] > 100;  // the other program's, untouched
    }
  EXPECT_GT(ink, 500u);
  EXPECT_GT(other, 20000u);
}

TEST_F(OverlayProcess, ARuntimeWithoutOverlaysIsNamedInOneLine) {
  EXPECT_EQ(run_hud("without XR_EXTX_overlay\n"), 1);
  EXPECT_EQ(said(),
            "neritic: the OpenXR runtime has no XR_EXTX_overlay: it shows nothing over another "
            "program\n");
}

}  // namespace
}  // namespace neritic::testbed
