// The devices of assets/sensors in a scene, end to end: what their beams hear beyond half power.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "sonar/head.hpp"
#include "tests/session/sonar_pings.hpp"
#include "tools/session/survey.hpp"

namespace neritic::tools {
namespace {

using SonarPresets = test::GpuTest;

// A flat bottom at bottom_m and the device at depth 5 m; keys: more of its own.
Result<scene::Scene> over_a_flat_bottom(const std::filesystem::path& folder,
                                        const std::string& device, double bottom_m,
                                        const std::string& keys) {
  const auto file = folder / (device + ".toml");
  NERITIC_TRY_STATUS(write_text(
      file, fmt::format("[[objects]]\nname = \"bottom\"\nshape = \"plane\"\nsize_m = [400, 400]\n"
                        "class = \"seabed\"\nposition_m = [0, {}, 0]\n"
                        "[[sonars]]\nname = \"sonar\"\ninclude = \"{}/assets/sensors/{}.toml\"\n"
                        "position_m = [0, -5, 0]\n{}\n",
                        -bottom_m, test::source_dir().string(), device, keys)));
  return scene::load_scene(file);
}

std::vector<double> altitudes_of(gpu::Device& device, const scene::Scene& scene) {
  auto session = Session::create(device, scene);
  EXPECT_TRUE(session.ok()) << session.error().message;
  Survey survey((*session)->scene());
  FrameRequest request;
  request.sonars = {0};
  request.capture.geometry = false;
  for (request.frame = 0; request.frame < 5; ++request.frame) {
    request.time_s = request.frame * 0.2;
    auto result = (*session)->render(request);
    EXPECT_TRUE(result.ok()) << result.error().message;
    const Status added = survey.add(*result, request.frame, request.time_s);
    EXPECT_TRUE(added.ok()) << (added.ok() ? "" : added.error().message);
  }
  const test::ScratchFolder out;
  EXPECT_TRUE(survey.write(out.path(), {}).ok());
  auto npy = read_npy(out / "track" / "sonar" / "sidescan_altitude.npy");
  EXPECT_TRUE(npy.ok()) << npy.error().message;
  return npy->to_doubles();
}

TEST_F(SonarPresets, ASideScansAltitudeIsTheBottomsHeight) {
  const test::ScratchFolder scratch;
  for (const char* terms :
       {"", "level = { source_level_db = 210 }",
        "level = { source_level_db = 210, tvg = 30, tvg_absorption = true }",
        "level = { source_level_db = 210, tvg = 30, tvg_absorption = true }\nspeckle = {}\n"
        "noise = { level_db = 60 }"}) {
    NERITIC_ASSERT_OK(
        const scene::Scene scene,
        over_a_flat_bottom(scratch.path(), "starfish_450", 15.0,
                           fmt::format("range_m = [1, 40]\nbins = [800, 8, 256]\n{}", terms)));
    const auto altitudes = altitudes_of(device(), scene);
    ASSERT_EQ(altitudes.size(), 5u);
    for (const double altitude : altitudes) EXPECT_NEAR(altitude, 10.0, 0.1) << terms;
  }
}

}  // namespace
}  // namespace neritic::tools
