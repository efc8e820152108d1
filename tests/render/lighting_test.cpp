// Only what a scene names is a term of its light: what it does not name is not compiled into the
// shader.
#include "engine/render/lighting.hpp"

#include <gtest/gtest.h>

namespace neritic::render {
namespace {

shared::Lighting light_of(const scene::Scene& scene, bool has_emission = false) {
  FrameState state;
  state.world_from_lamp.resize(scene.lamps.size());
  const auto light = make_lighting(scene, state, Vec3(0.0, -3.0, 0.0), {}, has_emission);
  EXPECT_TRUE(light.ok());
  return light.ok() ? *light : shared::Lighting{};
}

TEST(Lighting, TermsAreExactlyWhatTheSceneNames) {
  for (int bits = 0; bits < 32; ++bits) {
    scene::Scene scene;
    const bool sun = bits & 1, water = bits & 2, scattering = bits & 4, surface = bits & 8,
               emission = bits & 16;
    if (sun) scene.sun = scene::Sun{};
    if (water)
      scene.water = scene::Water{.type = "II", .scattering = scattering, .surface = surface};
    std::uint32_t wanted = sun ? shared::kLightSun : 0;
    if (water) wanted |= shared::kLightWater;
    if (water && scattering) wanted |= shared::kLightScattering;
    if (water && surface) wanted |= shared::kLightSurface;
    if (sun && water && surface) wanted |= shared::kLightSunSeen;
    if (emission) wanted |= shared::kLightEmissive;
    EXPECT_EQ(light_of(scene, emission).terms, wanted) << bits;
    EXPECT_EQ(light_of(scene, emission).lamp_count, 0u) << bits;
  }
}

// The stops that the user names count, whatever the light.
TEST(Lighting, AFixedExposureIsThatOfItsStopsAlone) {
  scene::Scene scene;
  scene.sun = scene::Sun{};
  for (const bool water : {false, true}) {
    if (water) scene.water = scene::Water{.type = "II", .scattering = true};
    const auto light = make_lighting(scene, {}, Vec3(0.0, -8.0, 0.0),
                                     {.compensation_ev = 1.0, .fixed_ev = 12.0}, false);
    ASSERT_TRUE(light.ok());
    EXPECT_EQ(light->exposure, std::exp2(-11.0f));
  }
}

// Over the sea the sky is a light tone that is not burnt out, from overhead to the horizon, and a
// camera that comes up through the surface sees no jump.
TEST(Lighting, AutoExposureOverTheSeaKeepsTheSky) {
  for (const char* type : {"I", "II", "5C"})
    for (const double sun_deg : {15.0, 40.0, 75.0}) {
      scene::Scene scene;
      scene.sun = scene::Sun{.elevation_rad = radians(sun_deg)};
      scene.water = scene::Water{.type = type, .scattering = true, .surface = true};
      const auto at = [&](double height_m) {
        const auto light = make_lighting(scene, {}, Vec3(0.0, height_m, 0.0), {}, false);
        EXPECT_TRUE(light.ok());
        return *light;
      };
      const shared::Lighting over = at(2.0);
      // The light that falls onto a level surface from the sky alone, less what it mirrors, over
      // pi: its mean.
      const double sky = (1.0 - over.direct_share) / (kPi * 0.934) *
                         glm::dot(Vec3(0.2126, 0.7152, 0.0722), Vec3(over.surface_irradiance));
      EXPECT_GT(0.85 * sky * over.exposure, 0.15) << type << " " << sun_deg;
      EXPECT_LT(1.58 * sky * over.exposure, 0.9) << type << " " << sun_deg;
      EXPECT_NEAR(at(-1e-3).exposure / at(1e-3).exposure, 1.0, 0.01) << type << " " << sun_deg;
      EXPECT_EQ(over.exposure, at(20.0).exposure);
    }
}

// Auto exposure is never off the light's scale, by lamps in the dark or in a bright shallow.
TEST(Lighting, AutoExposureShowsGroundByLampsInABlackSeaAsBrightAsWhite) {
  scene::Scene scene;
  scene.sun = scene::Sun{.elevation_rad = radians(-20.0)};
  scene.water = scene::Water{.type = "II", .scattering = true};
  scene.lamps.resize(1);
  scene.lamps[0].intensity_cd = 9000.0;
  FrameState state;
  state.world_from_lamp.resize(1);
  const auto light = make_lighting(scene, state, Vec3(0.0, -3.0, 0.0), {}, false);
  ASSERT_TRUE(light.ok());
  // Half of the lamp's light at 3 m: 500 lx on ground of albedo 0.25.
  const double ground = 0.25 * 500.0 / kPi * light->exposure;
  EXPECT_GT(ground, 0.25);
  EXPECT_LT(ground, 2.5);
}

TEST(Lighting, TermsHaveNamesForTheDump) {
  scene::Scene scene;
  EXPECT_EQ(names_of_terms(light_of(scene)), "");
  scene.water = scene::Water{.type = "II", .scattering = true, .surface = false};
  scene.lamps.resize(2);
  EXPECT_EQ(names_of_terms(light_of(scene)), "water, scattering, glow of lamps, 2 lamps");
  scene.water->scattering = false;
  scene.lamps.resize(1);
  EXPECT_EQ(names_of_terms(light_of(scene)), "water, 1 lamp");
}

TEST(Lighting, LampsAreCountedAndOneTooManyIsBadInput) {
  scene::Scene scene;
  for (std::uint32_t n = 1; n <= shared::kMaxLamps; ++n) {
    scene.lamps.push_back({});
    EXPECT_EQ(light_of(scene).lamp_count, n);
    EXPECT_EQ(light_of(scene).terms, 0u);
  }
  scene.lamps.push_back({});
  const auto light = make_lighting(scene, {}, Vec3(0.0), {}, false);
  ASSERT_FALSE(light.ok());
  EXPECT_EQ(light.error().code, ErrorCode::kBadInput);
}

TEST(Lighting, AStrobeGivesTheShareOfTheExposureInWhichItBurns) {
  scene::Scene scene;
  scene.lamps.resize(1);
  scene.lamps[0].strobe_period_s = 0.1;
  scene.lamps[0].strobe_flash_s = 0.005;
  const auto share = [&](double time_s, double exposed_s) {
    FrameState state;
    state.time_s = time_s;
    state.world_from_lamp.resize(1);
    const auto light = make_lighting(scene, state, Vec3(0.0), {}, false, exposed_s);
    return double(light->lamps[0].intensity_cd.x) / scene.lamps[0].intensity_cd;
  };
  for (const double periods : {0.0, 1.0, 1000.0}) {
    const double t = 0.1 * periods;
    EXPECT_NEAR(share(t + 0.002, 0.0), 1.0, 1e-6);
    EXPECT_NEAR(share(t + 0.008, 0.0), 0.0, 1e-6);
    EXPECT_NEAR(share(t + 0.008, 0.020), 0.25, 1e-6);  // the flash lies within the exposure
    EXPECT_NEAR(share(t + 0.0025, 0.004), 1.0, 1e-6);  // and the exposure within the flash
    EXPECT_NEAR(share(t + 0.005, 0.002), 0.5, 1e-6);   // until its end
    EXPECT_NEAR(share(t, 0.010), 0.5, 1e-6);           // from its beginning
    EXPECT_NEAR(share(t + 0.05, 0.5), 0.05, 1e-6);     // five periods
  }
  EXPECT_NEAR(share(0.05, 10.0), 0.05, 1e-6);
  EXPECT_NEAR(share(1e8, 10.0), 0.05, 1e-3);
  scene.lamps[0].strobe_flash_s = 0.2;  // longer than its period
  EXPECT_NEAR(share(0.03, 0.02), 1.0, 1e-6);
}

}  // namespace
}  // namespace neritic::render
