// `neritic dive` with a headset in a scene that names no diver.
#include "tests/testbed/headset/headset_process.hpp"

namespace neritic::testbed {
namespace {

class WearerWithoutADiver : public HeadsetProcess {
 protected:
  void SetUp() override {
    HeadsetProcess::SetUp();
    std::ofstream(scratch_ / "rocks.toml")
        << "[water]\n[[objects]]\nname = \"rock\"\nshape = \"sphere\"\nposition_m = [0, -9, 0]\n"
           "[[cameras]]\nposition_m = [0, -9, 5]\n";
  }
};

// The wearer swims by the trigger; the recording has the scene with the diver in it.
TEST_F(WearerWithoutADiver, IsADiverInTheRecordingToo) {
  script(
      "size 16 16\nreal_time yes\nperiod 0.05\nprofile both oculus/touch_controller\n"
      "input /user/hand/right/input/trigger/value 0 1\n");
  ASSERT_EQ(run("dive '" + path("rocks.toml") + "' --display openxr --frames 60 --record '" +
                path("worn.mcap") + "'"),
            0)
      << said();
  EXPECT_EQ(text("report"), "");
  EXPECT_NE(said().find("wearer: body: live from wearer"), std::string::npos) << said();
  EXPECT_NE(said().find("\nwearer: "), std::string::npos) << said();
  EXPECT_NE(said().find(" of way, up to "), std::string::npos) << said();
  ASSERT_EQ(run("dive --replay '" + path("worn.mcap") + "' --headless"), 0) << said();
  EXPECT_NE(said().find("each with the hash that was recorded"), std::string::npos) << said();
}

}  // namespace
}  // namespace neritic::testbed
