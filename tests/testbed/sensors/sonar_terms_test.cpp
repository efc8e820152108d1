// Each term of the sonar against a closed form, end to end: scene, G-buffer, gather, receiver.
#include <gtest/gtest.h>

#include <cmath>

#include "sonar/beam_pattern.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarTerms = test::GpuTest;

TEST_F(SonarTerms, ARigidSphereHasItsTargetStrength) {
  scene::Sonar sonar = sonar_of(9.0, 11.0, 200);
  sonar.azimuth_rad = sonar.elevation_rad = radians(2.0);
  sonar.bins_azimuth = sonar.bins_elevation = 256;
  sonar.gbuffer_scale = 2.0;
  sonar.terms.level = plain_level();
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 256), {0.0, 0.0, -10.0}));
  scene.sonars = {sonar};
  const double level_db = 10.0 * std::log10(total(ping(device(), scene)));
  // SL - (40 log 10 + 2 * 0.3 * 10 = 46.0 dB) + 20 log(a / 2); its near side is a tenth nearer.
  EXPECT_NEAR(level_db, 200.0 - 46.0 - 26.02, 0.15);
}

TEST_F(SonarTerms, ALambertWallSendsBackItsClosedForm) {
  scene::Sonar sonar = sonar_of(8.0, 14.0, 600);
  sonar.terms.level = plain_level();
  scene::Scene scene = wall(10.0, sonar);
  scene.objects[0].backscatter_db = -27.0;
  // mu SL times the integral of cos(i) / r^2 10^(-2 alpha r / 10) over the wedge's solid angle,
  // with cos i = cos theta cos phi and r = 10 / cos i.
  double expected = 0.0;
  constexpr int kSteps = 400;
  const double step = radians(20.0) / kSteps;
  for (int i = 0; i < kSteps; ++i)
    for (int j = 0; j < kSteps; ++j) {
      const double theta = radians(-10.0) + (i + 0.5) * step,
                   phi = radians(-10.0) + (j + 0.5) * step;
      const double cosine = std::cos(theta) * std::cos(phi), r = 10.0 / cosine;
      expected += cosine / (r * r) * std::pow(10.0, -0.06 * r) * std::cos(phi) * step * step;
    }
  expected *= std::pow(10.0, 20.0 - 2.7);
  EXPECT_NEAR(total(ping(device(), scene)) / expected, 1.0, 0.003);
}

TEST_F(SonarTerms, WithNothingButLabelsTheImageIsThePlainCosine) {
  scene::Scene scene = wall(3.0, sonar_of(2.0, 4.0, 100));
  const SonarFrame plain = ping(device(), scene);
  scene.sonars[0].terms.labels.energy = true;
  const SonarFrame terms = ping(device(), scene);
  ASSERT_EQ(plain.image.intensity.size(), terms.image.intensity.size());
  for (std::size_t i = 0; i < plain.image.intensity.size(); ++i)
    ASSERT_NEAR(plain.image.intensity[i], terms.image.intensity[i], 2e-6) << i;
  EXPECT_EQ(plain.image.labels, terms.image.labels);
}

TEST_F(SonarTerms, APulseSpreadsEnergyAndKeepsIt) {
  scene::Scene scene = wall(3.0, sonar_of(2.0, 4.0, 400));
  const SonarFrame sharp = ping(device(), scene);
  scene.sonars[0].terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 30e3};
  const SonarFrame spread = ping(device(), scene);
  EXPECT_NEAR(total(spread) / total(sharp), 1.0, 1e-3);
  EXPECT_NEAR(mean_range_m(spread), mean_range_m(sharp), 1e-3);
}

TEST_F(SonarTerms, AConstantProfileScalesRanges) {
  scene::Sonar sonar = sonar_of(2.0, 4.0, 800);
  sonar.terms.water.sound_speed_m_s = 1500.0;
  scene::Scene scene = wall(3.0, sonar);
  const double before = mean_range_m(ping(device(), scene));
  scene.sonars[0].terms.profile = scene::SonarProfile{{{0.0, 1530.0}, {100.0, 1530.0}}, false};
  EXPECT_NEAR(mean_range_m(ping(device(), scene)) / before, 1500.0 / 1530.0, 2e-4);
  scene.sonars[0].terms.profile->bent = true;
  EXPECT_NEAR(mean_range_m(ping(device(), scene)) / before, 1500.0 / 1530.0, 2e-4);
}

// A plate 80 m off, wider than the sonar hears, its middle so far above it, 100 m deep in water
// whose speed rises by 2.5 m/s a metre and is 1500 m/s there.
constexpr double kPlateOff_m = 80.0;
scene::Scene in_a_gradient(double height_m, double above_m, scene::Sonar sonar, bool bent) {
  sonar.terms.water.sound_speed_m_s = 1500.0;
  sonar.terms.profile = scene::SonarProfile{{{0.0, 1250.0}, {200.0, 1750.0}}, bent};
  sonar.mount.pose.position_m = {0.0, -100.0, 0.0};
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_box(Vec3(20.0, height_m, 0.2)),
                                    {0.0, -100.0 + above_m, -kPlateOff_m - 0.1}));
  scene.sonars = {std::move(sonar)};
  return scene;
}

// Rays are arcs of circles about points at the depth where the speed would be 0: the circle through
// sonar and point says how high its ray leaves.
double leaves_rad(double above_m) {
  const double radius_m = 1500.0 / 2.5;  // of a level ray
  const double centre_m =
      (kPlateOff_m * kPlateOff_m + std::pow(radius_m - above_m, 2) - radius_m * radius_m) /
      (2.0 * kPlateOff_m);
  return -std::atan(centre_m / radius_m);
}

scene::Sonar narrow_sonar(double elevation_rad) {
  scene::Sonar sonar = sonar_of(70.0, 90.0, 100);
  sonar.azimuth_rad = radians(4.0);
  sonar.elevation_rad = elevation_rad;
  sonar.bins_azimuth = 96;
  sonar.bins_elevation = 512;
  sonar.terms.level = plain_level();
  sonar.terms.level->absorption_db_per_m = 0.0;
  return sonar;
}

double heard_db(gpu::Device& device, const scene::Scene& scene) {
  return 10.0 * std::log10(std::max(total(ping(device, scene)), 1e-30));
}

// A beam lets an echo through by where its ray leaves: what is level with the sonar by its flank,
// and whole where the sonar is tilted by as much. Straight rays know nothing of it.
TEST_F(SonarTerms, ABentRaysPatternIsThatOfWhereItLeaves) {
  scene::Sonar sonar = narrow_sonar(radians(10.0));
  const double half_power_rad = radians(7.0), height_m = 4.0, tilt_rad = leaves_rad(0.0);
  EXPECT_NEAR(tilt_rad, -std::atan(kPlateOff_m * 2.5 / 3000.0), 1e-12);
  sonar.terms.beam.elevation = scene::SonarPattern{.half_power_rad = half_power_rad};
  NERITIC_ASSERT_OK(const auto pattern, sonar::BeamPattern::of_half_power_width(
                                            sonar::BeamShape::kSinc, half_power_rad));
  const auto mean_db = [&](bool bent, double axis_rad) {
    double sum = 0.0;
    constexpr int kSteps = 200;
    for (int i = 0; i < kSteps; ++i) {
      const double above_m = ((i + 0.5) / kSteps - 0.5) * height_m;
      const double up_rad = bent ? leaves_rad(above_m) : std::atan(above_m / kPlateOff_m);
      sum += pattern.two_way_power(up_rad - axis_rad);
    }
    return 10.0 * std::log10(sum / kSteps);
  };
  const auto heard = [&](bool bent) {
    return heard_db(device(), in_a_gradient(height_m, 0.0, sonar, bent));
  };
  const double all_db = heard(false) - mean_db(false, 0.0);
  ASSERT_LT(mean_db(true, 0.0), -5.0);
  EXPECT_NEAR(heard(true) - mean_db(true, 0.0), all_db, 0.1);
  sonar.mount.pose.rotation = glm::angleAxis(tilt_rad, Vec3(1, 0, 0));
  EXPECT_NEAR(heard(true) - mean_db(true, tilt_rad), all_db, 0.1);
  EXPECT_NEAR(heard(false) - mean_db(false, tilt_rad), all_db, 0.1);
}

// Without a pattern the aperture is what rays leave within: what is above it is heard by a ray from
// within, and what is within it and would take a ray from below is not.
TEST_F(SonarTerms, ABentRayLeavesWithinTheAperture) {
  const scene::Sonar sonar = narrow_sonar(radians(4.0));
  const double above_m = kPlateOff_m * std::tan(-leaves_rad(0.0));
  const auto heard = [&](double at_m, bool bent) {
    return heard_db(device(), in_a_gradient(2.0, at_m, sonar, bent));
  };
  const double straight_db = heard(0.0, false);
  // At 80.18 m, heard at 80.53 m, obliquely: 0.10 dB less.
  EXPECT_NEAR(heard(above_m, true), straight_db - 0.10, 0.1);
  EXPECT_LT(heard(above_m, false), straight_db - 100.0);
  EXPECT_LT(heard(0.0, true), straight_db - 100.0);
}

// A pattern much narrower than what samples it is averaged, not missed: a beam hears a wall as loud
// however coarsely it is sampled.
TEST_F(SonarTerms, ANarrowPatternIsHeardByCoarseColumnsAndRowsAlike) {
  const auto heard_db = [&](std::uint32_t beams, std::uint32_t rows) {
    scene::Sonar sonar = sonar_of(9.9, 10.3, 4);
    sonar.azimuth_rad = radians(60.0);
    sonar.bins_azimuth = beams;
    sonar.bins_elevation = rows;
    sonar.terms.level = plain_level();
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(0.5)};
    sonar.terms.beam.elevation = scene::SonarPattern{.half_power_rad = radians(0.5)};
    const SonarFrame frame = ping(device(), wall(10.0, sonar));
    const auto& v = frame.image.intensity;
    double most = 0.0;  // of the beams about the axis, at the wall
    for (std::uint32_t row = 0; row < 4; ++row)
      most = std::max<double>(most, v[std::size_t{row} * beams + beams / 2]);
    return 10.0 * std::log10(most);
  };
  const double fine = heard_db(512, 512);
  EXPECT_NEAR(heard_db(512, 8), fine, 0.5);
  EXPECT_NEAR(heard_db(64, 512), fine, 0.5);
  EXPECT_NEAR(heard_db(8, 64), fine, 0.7);
}

TEST_F(SonarTerms, TheSurfaceMirrorsAGhostAtTheMeanOfBothWays) {
  scene::Sonar sonar = sonar_of(4.0, 8.0, 800);
  sonar.elevation_rad = radians(80.0);
  sonar.terms.labels.energy = true;
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 64), {0.0, -2.0, -5.0}));
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.position_m = {0.0, -2.0, 0.0};
  const SonarFrame plain = ping(device(), scene);
  scene.sonars[0].terms.ghosts = scene::SonarGhosts{.surface = true};
  const SonarFrame ghosts = ping(device(), scene);
  const double direct = 5.0 - 0.1, mirrored = std::hypot(5.0, 4.0) - 0.1;
  double energy = 0.0, range = 0.0;
  for (std::uint32_t row = 0; row < 800; ++row)
    for (std::uint32_t c = 0; c < 128; ++c) {
      const std::size_t i = std::size_t{row} * 128 + c;
      const double more = ghosts.image.intensity[i] - plain.image.intensity[i];
      energy += more;
      range += more * ghosts.grid.range_m(row);
    }
  ASSERT_GT(energy, 0.0);
  EXPECT_NEAR(range / energy, (direct + mirrored) / 2.0, 0.06);
}

TEST_F(SonarTerms, AFlatBottomMirrorsToo) {
  scene::Sonar sonar = sonar_of(4.0, 8.0, 800);
  sonar.elevation_rad = radians(80.0);
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 64), {0.0, -8.0, -5.0}));
  scene::Object bottom = object_of(scene, scene::make_plane(60.0, 60.0), {0.0, -10.0, 0.0});
  bottom.class_id = 1;
  scene.objects.push_back(bottom);
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.position_m = {0.0, -8.0, 0.0};
  scene.sonars[0].terms.labels.energy = true;
  const SonarFrame plain = ping(device(), scene);
  scene.sonars[0].terms.ghosts = scene::SonarGhosts{.bottom_m = 10.0};
  const SonarFrame ghosts = ping(device(), scene);
  double energy = 0.0, range = 0.0;
  for (std::uint32_t row = 0; row < 800; ++row)
    for (std::uint32_t c = 0; c < 128; ++c) {
      const std::size_t i = std::size_t{row} * 128 + c;
      const double more = ghosts.image.intensity[i] - plain.image.intensity[i];
      energy += more;
      range += more * ghosts.grid.range_m(row);
    }
  ASSERT_GT(energy, 0.0);
  EXPECT_NEAR(range / energy, (5.0 - 0.1 + std::hypot(5.0, 4.0) - 0.1) / 2.0, 0.06);
}

TEST_F(SonarTerms, AConeHearsAFloorAtItsDepth) {
  scene::Sonar sonar = sonar_of(1.0, 20.0, 950);
  sonar.kind = scene::SonarKind::kEchoSounder;
  sonar.semi_angle_rad = radians(12.5);
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_box(Vec3(60.0, 1.0, 60.0)), {0, -12.5, 0}));
  scene.sonars = {sonar};
  scene.sonars[0].mount.pose.rotation = glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0));
  const SonarFrame frame = ping(device(), scene);
  ASSERT_EQ(frame.image.n_azimuth, 1u);
  std::uint32_t first = 0, last = 0;
  for (std::uint32_t row = 0; row < 950; ++row)
    if (frame.image.intensity[row] > 0.0f) {
      if (!first) first = row;
      last = row;
    }
  EXPECT_NEAR(frame.grid.range_m(first), 12.0, 0.02);
  EXPECT_NEAR(frame.grid.range_m(last), 12.0 / std::cos(radians(12.5)), 0.03);
  // Mean of cos i over the cone: (1 - cos^2 psi) / 2 over (1 - cos psi).
  const double c = std::cos(radians(12.5));
  EXPECT_NEAR(total(frame), (1.0 + c) / 2.0, 0.002);
}

TEST_F(SonarTerms, ASideScanHearsItsTwoSides) {
  scene::Sonar sonar = sonar_of(1.0, 20.0, 400);
  sonar.kind = scene::SonarKind::kSideScan;
  sonar.azimuth_rad = radians(1.0);
  sonar.elevation_rad = radians(60.0);
  sonar.bins_azimuth = 1;
  sonar.bins_elevation = 1024;
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.5, 64), {10.0, -5.0, 0.0}));
  scene.sonars = {sonar};
  FrameRequest request;
  request.sonars = {0};
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  ASSERT_EQ(result.sonars.size(), 2u);
  EXPECT_EQ(result.sonars[0].head, "port");
  EXPECT_EQ(total(result.sonars[0]), 0.0);
  EXPECT_GT(total(result.sonars[1]), 0.0);
  EXPECT_NEAR(mean_range_m(result.sonars[1]), std::hypot(10.0, 5.0) - 0.4, 0.1);
}

TEST_F(SonarTerms, APolesEnergyGoesWithItsArea) {
  const auto energy = [&](double radius_m) {
    scene::Sonar sonar = sonar_of(1.5, 2.5, 100);
    sonar.azimuth_rad = radians(10.0);
    sonar.bins_azimuth = 56;
    sonar.terms.beam.samples = 16;
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(0.6)};
    sonar.terms.range_spread = scene::SonarRangeSpread{};
    sonar.gbuffer_scale = 2.0;
    scene::Scene scene;
    scene.objects.push_back(
        object_of(scene, scene::make_cylinder(radius_m, 4.0, 96), {0.013, 0.0, -2.0}));
    scene.sonars = {sonar};
    return total(ping(device(), scene));
  };
  EXPECT_NEAR(energy(0.010) / energy(0.001), 10.0, 0.5);
}

}  // namespace
}  // namespace neritic::testbed
