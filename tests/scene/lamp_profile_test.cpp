// Lamps' beams: half the intensity at the named angle, a table between its rows, the flux that a
// data sheet states.
#include "engine/scene/lamp_profile.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

TEST(LampProfile, ABellCurveHasHalfItsIntensityAtTheNamedAngle) {
  for (const double half_deg : {2.0, 10.0, 30.0, 60.0}) {
    const LampProfile profile = gaussian_profile(radians(half_deg));
    EXPECT_FLOAT_EQ(profile.share[0], 1.0f);
    EXPECT_NEAR(profile.at(radians(half_deg)), 0.5, 0.01) << half_deg;
    EXPECT_EQ(profile.at(profile.edge_rad + 0.01), 0.0);
  }
  // Narrow: the plane's integral of 2^-(r / half)^2 is pi half^2 / ln 2, less what is cut off.
  const double half = radians(3.0);
  EXPECT_NEAR(gaussian_profile(half).solid_angle_sr() / (kPi * half * half / std::log(2.0)), 0.99,
              0.012);
}

TEST(LampProfile, AnEvenTableAndAConeHaveTheSolidAngleOfTheCap) {
  const LampProfile even = table_profile({{0.0, 1.0}, {radians(40.0), 1.0}});
  EXPECT_NEAR(even.solid_angle_sr(), 2.0 * kPi * (1.0 - std::cos(radians(40.0))), 1e-5);
  EXPECT_NEAR(cone_solid_angle_sr(radians(39.999), radians(40.001)), even.solid_angle_sr(), 1e-4);
  const LampProfile falls = table_profile({{0.0, 1.0}, {radians(10.0), 0.8}, {radians(60.0), 0.0}});
  EXPECT_NEAR(falls.at(radians(10.0)), 0.8, 0.02);
  EXPECT_NEAR(falls.at(radians(35.0)), 0.4, 0.01);
}

TEST(LampProfile, AScenesLampShinesWithTheNamedFlux) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(write_text(scratch / "s.toml",
                         "[[lamps]]\nname = \"a\"\nhalf_intensity_deg = 25\nflux_lm = 3000\n"
                         "[[lamps]]\nname = \"b\"\ncone_deg = [30, 50]\nflux_lm = 800\n"
                         "[[lamps]]\nname = \"c\"\nprofile = [[0, 1], [20, 0.6], [45, 0]]\n")
                  .ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const Lamp& a = scene->lamps.at(0);
  ASSERT_TRUE(a.profile);
  EXPECT_NEAR(a.intensity_cd * a.profile->solid_angle_sr(), 3000.0, 1e-6);
  EXPECT_NEAR(scene->lamps.at(1).intensity_cd * cone_solid_angle_sr(radians(30), radians(50)),
              800.0, 1e-6);
  EXPECT_NEAR(scene->lamps.at(2).outer_cone_rad, radians(45.0), 1e-9);
}

TEST(LampProfile, RefusesBadBeamsByLine) {
  const test::ScratchFolder scratch;
  for (const char* keys :
       {"profile = [[0, 1]]", "profile = [[5, 1], [10, 0]]", "profile = [[0, 1], [10, 2]]",
        "profile = [[0, 0], [10, 0]]", "half_intensity_deg = 0",
        "half_intensity_deg = 20\ncone_deg = [1, 2]", "flux_lm = 10\nintensity_cd = 5"}) {
    ASSERT_TRUE(write_text(scratch / "s.toml", std::string("[[lamps]]\n") + keys + "\n").ok());
    EXPECT_FALSE(load_scene(scratch / "s.toml").ok()) << keys;
  }
}

}  // namespace
}  // namespace neritic::scene
