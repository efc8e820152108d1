// A mirror's ghosts: how strong they are, against the closed form.
#include "sonar/beam_pattern.hpp"
#include "sonar/sound_speed_profile.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarGhost = test::GpuTest;

constexpr double kRange_m = 5.0, kDepth_m = 2.0, kBallRadius_m = 0.05;

// A small sphere dead ahead of a sonar, both at one depth under a surface that mirrors.
scene::Scene sphere_below_surface() {
  scene::Sonar sonar = sonar_of(4.0, 8.0, 400);
  sonar.azimuth_rad = radians(2.0);
  sonar.elevation_rad = radians(90.0);
  sonar.bins_azimuth = 64;
  sonar.bins_elevation = 2048;
  sonar.gbuffer_scale = 2.0;
  sonar.terms.level = plain_level();
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_sphere(kBallRadius_m, 128), {0.0, -kDepth_m, -kRange_m}));
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.position_m = {0.0, -kDepth_m, 0.0};
  return scene;
}

double ghost_over_direct_db(gpu::Device& device, scene::Scene scene, double reflection) {
  const double direct = total(ping(device, scene));
  scene.sonars[0].terms.ghosts =
      scene::SonarGhosts{.surface = true, .surface_reflection = reflection};
  return 10.0 * std::log10(total(ping(device, scene)) / direct - 1.0);
}

// Light of a Lambert sphere towards a direction beta off, relative to straight back: the
// integral of cos(in) cos(out) over what both see.
double lambert_sphere(double beta_rad) {
  return (std::sin(beta_rad) + (kPi - beta_rad) * std::cos(beta_rad)) / kPi;
}

// Both ways round in amplitude (4), the mirror, spreading and absorption of either leg, the
// sphere's share, and what the pattern lets through once along the mirror's leg.
double closed_form_db(double reflection, double pattern_once) {
  const double leg_m = std::hypot(kRange_m, 2.0 * kDepth_m);
  const double angle_rad = std::atan2(2.0 * kDepth_m, kRange_m);
  return 10.0 * std::log10(4.0 * reflection * reflection * lambert_sphere(angle_rad) *
                           pattern_once * kRange_m * kRange_m / (leg_m * leg_m)) -
         0.3 * (leg_m - kRange_m);
}

TEST_F(SonarGhost, ASpheresGhostHasItsClosedFormLevel) {
  EXPECT_NEAR(ghost_over_direct_db(device(), sphere_below_surface(), 0.9), closed_form_db(0.9, 1.0),
              0.3);
}

TEST_F(SonarGhost, EachLegPassesThePatternOnce) {
  scene::Scene scene = sphere_below_surface();
  const auto expect = [&](double width_rad) {
    scene.sonars[0].terms.beam.elevation = scene::SonarPattern{.half_power_rad = width_rad};
    NERITIC_ASSERT_OK(const sonar::BeamPattern pattern,
                      sonar::BeamPattern::of_half_power_width(sonar::BeamShape::kSinc, width_rad));
    const double amplitude = pattern.amplitude(std::atan2(2.0 * kDepth_m, kRange_m));
    EXPECT_NEAR(ghost_over_direct_db(device(), scene, 1.0),
                closed_form_db(1.0, amplitude * amplitude), 0.3)
        << degrees(width_rad);
  };
  expect(radians(20.0));
  expect(radians(35.0));
}

// A plate above the sonar that faces the surface is lit by the mirror and shows the sonar its back.
// Energy over range of what the ghosts add.
double mean_ghost_range_m(gpu::Device& device, scene::Scene scene) {
  const SonarFrame direct = ping(device, scene);
  scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
  const SonarFrame both = ping(device, scene);
  double energy = 0.0, moment = 0.0;
  for (std::size_t i = 0; i < both.image.intensity.size(); ++i) {
    const double more = both.image.intensity[i] - direct.image.intensity[i];
    const auto row = static_cast<std::uint32_t>(i / both.grid.bins.azimuth);
    energy += more;
    moment += more * both.grid.range_m(row);
  }
  return moment / energy;
}

// Each leg is heard by the water that it passes: fast below the sonar, slow above it, where the
// mirror's leg runs.
TEST_F(SonarGhost, EachLegIsHeardByTheSpeedOfItsOwnWater) {
  const scene::SonarTable speeds{{0.0, 1400.0}, {4.0, 1600.0}};
  const auto profile = sonar::SoundSpeedProfile::of_table({{0.0, 1400.0}, {4.0, 1600.0}});
  ASSERT_TRUE(profile.ok());
  scene::Scene scene = sphere_below_surface();
  scene.sonars[0].terms.water.sound_speed_m_s = 1500.0;
  const double still_m = mean_ghost_range_m(device(), scene);
  for (const bool bent : {false, true}) {
    scene.sonars[0].terms.profile = scene::SonarProfile{speeds, bent};
    // Straight legs up to the mirror and down from it; bent ones differ by some millimetres.
    const double half_m = std::hypot(kRange_m / 2.0, kDepth_m);
    const double up_rad = std::atan2(kDepth_m, kRange_m / 2.0);
    const double slower_m =
        1500.0 * 2.0 * profile->straight_time_s(kDepth_m, up_rad, half_m) - 2.0 * half_m;
    EXPECT_NEAR(mean_ghost_range_m(device(), scene) - still_m, slower_m / 2.0, 0.02) << bent;
  }
}

// A ball of a tenth of a metre in cells that are larger: it is drawn larger than it is, and heard
// where it is, on either leg.
TEST_F(SonarGhost, ATargetSmallerThanACellHasItsGhostAtItsPlaceAndLevel) {
  constexpr double kDeep_m = 8.0, kAhead_m = 10.0, kSmall_m = 0.1;
  scene::Sonar sonar = sonar_of(6.0, 18.0, 1200);
  sonar.azimuth_rad = radians(60.0);
  sonar.elevation_rad = radians(120.0);
  sonar.bins_azimuth = 61;
  sonar.bins_elevation = 600;
  sonar.terms.level = plain_level();
  sonar.terms.level->absorption = scene::SonarLevel::Absorption::kNone;
  sonar.mount.pose.position_m = {0.0, -kDeep_m, 0.0};
  scene::Scene scene;
  scene.objects = {object_of(scene, scene::make_sphere(kSmall_m, 128), {0.0, -kDeep_m, -kAhead_m})};
  scene.sonars = {sonar};
  // By the ball's surface: cos(in) cos(out) over both legs squared, there and back the other way.
  const Vec3 ball(0.0, -kDeep_m, -kAhead_m), eye(0.0, -kDeep_m, 0.0), image(0.0, kDeep_m, 0.0);
  double direct = 0.0, ghost = 0.0, ghost_m = 0.0;
  constexpr int kPoints = 20000;
  for (int i = 0; i < kPoints; ++i) {
    const double y = 1.0 - (2.0 * i + 1.0) / kPoints, turn = kPi * (1.0 + std::sqrt(5.0)) * i;
    const double level = std::sqrt(1.0 - y * y);
    const Vec3 n(level * std::cos(turn), y, level * std::sin(turn)), at = ball + kSmall_m * n;
    const double back_m = glm::length(eye - at), there_m = glm::length(image - at);
    const double back = glm::dot(n, eye - at) / back_m, there = glm::dot(n, image - at) / there_m;
    if (back > 0.0) direct += back * back / std::pow(back_m, 4);
    if (back <= 0.0 || there <= 0.0) continue;
    const double power = 4.0 * 0.25 * back * there / std::pow(back_m * there_m, 2);
    ghost += power;
    ghost_m += power * 0.5 * (back_m + there_m);
  }
  const double level_db = 10.0 * std::log10(ghost / direct);
  EXPECT_NEAR(ghost_over_direct_db(device(), scene, 0.5), level_db, 0.5);
  EXPECT_NEAR(mean_ghost_range_m(device(), scene), ghost_m / ghost, 0.03);
  // A pattern lets through what it does where the ball is.
  constexpr double kWide_rad = radians(70.0);
  scene.sonars[0].terms.beam.elevation = scene::SonarPattern{.half_power_rad = kWide_rad};
  NERITIC_ASSERT_OK(const sonar::BeamPattern pattern,
                    sonar::BeamPattern::of_half_power_width(sonar::BeamShape::kSinc, kWide_rad));
  const double once = pattern.amplitude(std::atan2(2.0 * kDeep_m, kAhead_m));
  EXPECT_NEAR(ghost_over_direct_db(device(), scene, 0.5),
              level_db + 20.0 * std::log10(std::abs(once)), 0.6);
}

TEST_F(SonarGhost, WhatTurnsItsBackGivesNone) {
  scene::Scene scene = sphere_below_surface();
  scene.objects = {object_of(scene, scene::make_plane(1.0, 1.0), {0.0, -1.6, -kRange_m})};
  const SonarFrame direct = ping(device(), scene);
  scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
  EXPECT_EQ(ping(device(), scene).image.intensity, direct.image.intensity);
}

// By the mirror the sphere is seen, but the way back is not free; or it is not the way to the
// mirror.
TEST_F(SonarGhost, NoneComesWhereSomethingStandsInEitherLegsWay) {
  const Vec3 halfway(0.0, -kDepth_m, -kRange_m / 2.0);        // on the direct leg
  const Vec3 upwards(0.0, -kDepth_m / 2.0, -kRange_m / 4.0);  // on the way to the mirror
  const auto added = [&](scene::Scene scene) {                // by the ghosts
    const double direct = total(ping(device(), scene));
    scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
    return total(ping(device(), scene)) - direct;
  };
  for (const Vec3& at : {halfway, upwards}) {
    scene::Scene scene = sphere_below_surface();
    const double alone = added(scene);
    scene.objects.push_back(object_of(scene, scene::make_box(Vec3(0.6, 0.3, 0.02)), at));
    EXPECT_EQ(added(scene), 0.0) << at.y;
    // A little aside it hides nothing.
    scene.objects.back().mount.pose.position_m.y -= 0.5;
    EXPECT_NEAR(added(scene) / alone, 1.0, 1e-3) << at.y;
  }
}

// The space on the mirrored sonar's own side is not part of the water.
TEST_F(SonarGhost, WhatStandsBeyondTheMirrorHidesNone) {
  const auto added = [&](scene::Scene scene) {
    const double direct = total(ping(device(), scene));
    scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
    return total(ping(device(), scene)) - direct;
  };
  scene::Scene scene = sphere_below_surface();
  const double alone = added(scene);
  EXPECT_GT(alone, 0.0);
  // The line from the mirror's image of the sonar to the sphere is 1 m above the water here.
  scene.objects.push_back(
      object_of(scene, scene::make_box(Vec3(3.0, 0.3, 0.1)), {0.0, 1.0, -kRange_m / 4.0}));
  EXPECT_DOUBLE_EQ(added(scene), alone);
  // A pile that stands 20 cm deep, and the sound goes 1 m deep here.
  scene.objects.back() =
      object_of(scene, scene::make_box(Vec3(0.6, 1.7, 0.1)), {0.0, 0.65, -kRange_m / 4.0});
  EXPECT_NEAR(added(scene) / alone, 1.0, 1e-3);
}

TEST_F(SonarGhost, WhatIsBuriedUnderTheBottomHidesNone) {
  constexpr double kBottom_m = 10.0;
  const auto added = [&](scene::Scene scene) {
    const double direct = total(ping(device(), scene));
    scene.sonars[0].terms.ghosts = scene::SonarGhosts{.bottom_m = kBottom_m};
    return total(ping(device(), scene)) - direct;
  };
  scene::Scene scene = sphere_below_surface();
  scene.sonars[0].mount.pose.position_m.y = scene.objects[0].mount.pose.position_m.y =
      kDepth_m - kBottom_m;
  const double alone = added(scene);
  EXPECT_GT(alone, 0.0);
  scene.objects.push_back(object_of(scene, scene::make_box(Vec3(3.0, 0.3, 0.1)),
                                    {0.0, -kBottom_m - 1.0, -kRange_m / 4.0}));
  EXPECT_DOUBLE_EQ(added(scene), alone);
}

// A device that cannot clip draws all the rest, camera and sonar, and validation has nothing to
// say.
TEST_F(SonarGhost, ADeviceThatCannotClipLacksThemAlone) {
  gpu::DeviceOptions options;
  options.validation = true;
  options.clip_distance = false;
  NERITIC_ASSERT_OK(const auto other, gpu::Device::create(options));
  scene::Scene scene = sphere_below_surface();
  EXPECT_EQ(total(ping(*other, scene)), total(ping(device(), scene)));
  scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
  NERITIC_ASSERT_OK(const auto session, Session::create(*other, scene));
  FrameRequest request;
  request.sonars = {0};
  const auto result = session->render(request);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.error().code, ErrorCode::kUnsupported);
  EXPECT_NE(result.error().message.find("ghosts: " + other->info().name + " has no shaderClip"),
            std::string::npos)
      << result.error().message;
  EXPECT_TRUE(other->validation_log().messages.empty());
}

}  // namespace
}  // namespace neritic::testbed
