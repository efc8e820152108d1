// `neritic dive` where it looks for a headset and finds none that shows anything: the dive is in a
// window, and one line says why.
#include <gmock/gmock.h>

#include "tests/testbed/headset/headset_process.hpp"

namespace neritic::testbed {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class HeadsetFallback : public HeadsetProcess {
 protected:
  void SetUp() override {
    HeadsetProcess::SetUp();
    if (IsSkipped()) return;
    if (std::system("command -v xvfb-run > /dev/null") != 0) GTEST_SKIP() << "no xvfb-run";
  }
  // On a virtual X server; what it says goes to said().
  int dive_on_a_screen(const std::string& more) const {
    const std::string script = path("dive.sh");
    std::ofstream(script) << "export XDG_STATE_HOME='" << path("state") << "'\n"
                          << command("dive '" + scene() + "' --seconds 0.2 " + more, "said")
                          << '\n';
    const int status =
        std::system(fmt::format("xvfb-run -a -s '-screen 0 640x480x24' bash '{}'", script).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }
  int lines_of(const std::string& part) const {
    int count = 0;
    std::istringstream all(said());
    for (std::string line; std::getline(all, line);) count += line.find(part) != std::string::npos;
    return count;
  }
};

TEST_F(HeadsetFallback, FormatsThatNobodyCanDrawLeaveTheDiveToAWindow) {
  script("size 64 60\nformats D16_UNORM\n");
  EXPECT_EQ(dive_on_a_screen("--size 320x240"), 0) << said();
  EXPECT_EQ(lines_of("the Vulkan formats D16_UNORM only"), 1) << said();
  EXPECT_EQ(lines_of(": the dive is in a window"), 1) << said();
  EXPECT_THAT(said(), HasSubstr("frames in"));
  EXPECT_EQ(text("report"), "");
}

TEST_F(HeadsetFallback, WithoutARuntimeTheDiveIsInAWindowAndSaysSo) {
  script("available no\n");
  EXPECT_EQ(dive_on_a_screen("--size 320x240"), 0) << said();
  EXPECT_EQ(lines_of(": the dive is in a window"), 1) << said();
  EXPECT_THAT(said(), HasSubstr("frames in"));
}

TEST_F(HeadsetFallback, AHeadsetThatWasAskedForIsNotReplaced) {
  script("size 64 60\nformats D16_UNORM\n");
  EXPECT_NE(dive_on_a_screen("--display openxr"), 0);
  EXPECT_THAT(said(), HasSubstr("the Vulkan formats D16_UNORM only"));
  EXPECT_THAT(said(), Not(HasSubstr("in a window")));
}

TEST_F(HeadsetFallback, NeitherHeadsetNorWindowIsOneLineThatNamesBoth) {
  script("available no\n");
  const std::string call =
      "unset DISPLAY WAYLAND_DISPLAY; " + command("dive '" + scene() + "' --seconds 0.2", "said");
  EXPECT_NE(std::system(call.c_str()), 0);
  EXPECT_THAT(said(), HasSubstr("no headset: "));
  EXPECT_THAT(said(), HasSubstr("no window: "));
}

}  // namespace
}  // namespace neritic::testbed
