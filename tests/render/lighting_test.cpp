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

// A dark sea with lamps side by side at the origin that look ahead, of so many cd together.
Result<shared::Lighting> light_by_lamps(double sun_deg, double sum_cd, std::size_t count = 1,
                                        double depth_m = 3.0,
                                        std::optional<scene::LampProfile> profile = {}) {
  scene::Scene scene;
  scene.sun = scene::Sun{.elevation_rad = radians(sun_deg)};
  scene.water = scene::Water{.type = "II", .scattering = true};
  scene.lamps.resize(count);
  for (scene::Lamp& lamp : scene.lamps) {
    lamp.intensity_cd = sum_cd / double(count);
    lamp.profile = profile;
    if (profile) lamp.outer_cone_rad = profile->edge_rad;
  }
  FrameState state;
  state.world_from_lamp.resize(count);
  for (Pose& pose : state.world_from_lamp) pose.position_m.y = -depth_m;
  return make_lighting(scene, state, Vec3(0.0, -depth_m, 0.0), {}, false);
}

// The sea is black then: its share of the picture does not count.
TEST(Lighting, AutoExposureByLampsAloneBurnsNothingOut) {
  for (const std::size_t count : {1, 2, 4}) {
    const auto light = light_by_lamps(-30.0, 9000.0, count);
    ASSERT_TRUE(light.ok());
    // White 3 m ahead, by 1000 lx less what 3 m of water take on the way there and back, is 2: 243
    // of 255 in a picture, ground of a quarter of that 201.
    double white = 0.0;
    for (int i = 0; i < 3; ++i)
      white += Vec3(0.2126, 0.7152, 0.0722)[i] * std::exp(-6.0 * light->beam_attenuation[i]);
    EXPECT_NEAR(1000.0 * white / kPi * light->exposure, 2.0, 2e-3) << count;
  }
}

TEST(Lighting, AutoExposureByARingOfLightIsThatOfAnEvenBeam) {
  const auto even = light_by_lamps(-30.0, 9000.0);
  const auto ring = light_by_lamps(
      -30.0, 9000.0, 1, 3.0,
      scene::table_profile({{0.0, 0.0}, {radians(30.0), 1.0}, {radians(60.0), 0.0}}));
  ASSERT_TRUE(even.ok() && ring.ok());
  EXPECT_NEAR(ring->exposure / even->exposure, 1.0, 0.1);
}

TEST(Lighting, LampsAreNothingToAutoExposureInDaylight) {
  const auto without = light_by_lamps(40.0, 0.0), with = light_by_lamps(40.0, 9000.0);
  ASSERT_TRUE(without.ok() && with.ok());
  EXPECT_EQ(without->exposure, with->exposure);
}

// As the sun sets, lamps change the exposure by no jump and only for darker, until they count
// alone.
TEST(Lighting, AutoExposureByLampsFollowsTheSunDown) {
  double before = 0.0, before_without = 0.0;
  for (double sun_deg = 20.0; sun_deg > -20.0; sun_deg -= 0.1) {
    const auto with = light_by_lamps(sun_deg, 9000.0, 1, 20.0);
    const auto without = light_by_lamps(sun_deg, 0.0, 1, 20.0);
    ASSERT_TRUE(with.ok() && without.ok());
    EXPECT_LE(with->exposure, without->exposure) << sun_deg;
    if (before > 0.0) {
      const double by_sun = std::abs(std::log2(without->exposure / before_without));
      EXPECT_LT(std::abs(std::log2(with->exposure / before)), 4.0 * by_sun + 1e-3) << sun_deg;
    }
    before = with->exposure;
    before_without = without->exposure;
  }
  EXPECT_EQ(float(before), light_by_lamps(-30.0, 9000.0, 1, 20.0)->exposure);
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
  FrameState at_start;
  at_start.world_from_lamp.resize(1);
  const auto always = make_lighting(scene, at_start, Vec3(0.0), {}, false);
  ASSERT_TRUE(always.ok());
  scene.lamps[0].strobe_period_s = 0.1;
  scene.lamps[0].strobe_flash_s = 0.005;
  const auto share = [&](double time_s, double exposed_s) {
    FrameState state;
    state.time_s = time_s;
    state.world_from_lamp.resize(1);
    const auto light = make_lighting(scene, state, Vec3(0.0), {}, false, exposed_s);
    EXPECT_EQ(light->exposure, always->exposure);  // the camera knows what the strobe will give
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
