// The first frames of a headset on a machine that never compiled a shader: the runtime gets them in
// time, since the pipelines were made before the session began.
#include <cstdlib>

#include "tests/testbed/headset/headset_run.hpp"

namespace neritic::testbed {
namespace {

// Mesa keeps no compiled shaders while this lives. The program's own cache is off in these dives.
class ColdShaders {
 public:
  ColdShaders() { setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); }
  ~ColdShaders() { unsetenv("MESA_SHADER_CACHE_DISABLE"); }
  ColdShaders(const ColdShaders&) = delete;
  ColdShaders& operator=(const ColdShaders&) = delete;
};

class HeadsetFirstFrame : public HeadsetRun {
 protected:
  // Between two frames of the fake's log, in real time, from the first of the session.
  static std::vector<double> gaps_s(const std::string& log) {
    std::vector<double> times_s, gaps;
    std::istringstream lines(log);
    for (std::string line; std::getline(lines, line);) {
      const auto at = line.find("display ");
      if (at != std::string::npos) times_s.push_back(1e-9 * std::stod(line.substr(at + 8)));
    }
    for (std::size_t i = 1; i < times_s.size(); ++i) gaps.push_back(times_s[i] - times_s[i - 1]);
    return gaps;
  }
};

// A frame that makes pipelines is a gap of seconds.
TEST_F(HeadsetFirstFrame, NoGapBetweenFramesIsLongOnceTheSessionRuns) {
  const ColdShaders cold;
  fakes::FakeHeadset fake("size 94 94\nreal_time yes\nperiod 0.05\n");
  without_validation();  // compiles each shader once more
  govern();
  const scene::Scene scene =
      scene::load_scene(test::source_dir() / "assets/scenes/boat.toml").value();
  NERITIC_ASSERT_OK(const auto physics, LivePhysics::create(scene, LivePhysics::Pace::kPicture));
  with(*physics);
  with(DiveHudOptions{.layouts = {hud::LayoutKind::kWrist}});
  NERITIC_ASSERT_STATUS(dive(scene, 40));
  const std::vector<double> gaps = gaps_s(fake.log());
  ASSERT_GE(gaps.size(), 39u);
  const double longest_s = *std::ranges::max_element(gaps);
  RecordProperty("longest_gap_s", fmt::format("{:.3f}", longest_s));
  EXPECT_LT(longest_s, 1.0) << "between frames " << std::ranges::max_element(gaps) - gaps.begin()
                            << " and the next";
}

}  // namespace
}  // namespace neritic::testbed
