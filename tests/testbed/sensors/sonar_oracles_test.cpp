// The sonar as it runs against acoustics' textbook: beam patterns, target strengths, gains, counts
// and the ranges of simple shapes, through scene, G-buffer, gather and receiver.
#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/npy.hpp"
#include "testbed/output/output.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using SonarOracles = test::GpuTest;

// A point target at a bearing, heard by beams of 1 degree (half power) every 0.05 degrees.
scene::Scene point_target(double bearing_rad) {
  scene::Sonar sonar = sonar_of(9.0, 11.0, 20);
  sonar.azimuth_rad = radians(40.0);
  sonar.bins_azimuth = 800;
  sonar.elevation_rad = radians(1.0);
  sonar.bins_elevation = 20;
  sonar.gbuffer_scale = 4.0;
  scene::Scene scene;
  scene.objects.push_back(
      object_of(scene, scene::make_sphere(0.015, 64),
                {10.0 * std::sin(bearing_rad), 0.0, -10.0 * std::cos(bearing_rad)}));
  scene.sonars = {sonar};
  return scene;
}

// Energy by beam.
std::vector<double> azimuth_cut(const SonarFrame& frame) {
  std::vector<double> cut(frame.image.n_azimuth, 0.0);
  for (std::size_t i = 0; i < frame.image.intensity.size(); ++i)
    cut[i % cut.size()] += frame.image.intensity[i];
  return cut;
}

// Full width where a cut falls to half its highest, in steps of it.
double half_power_steps(const std::vector<double>& cut) {
  const auto top = std::max_element(cut.begin(), cut.end());
  const double half = *top / 2.0;
  const auto side = [&](std::ptrdiff_t step) {
    std::ptrdiff_t i = top - cut.begin();
    while (cut[i + step] > half) i += step;
    return std::abs(static_cast<double>(i - (top - cut.begin()))) +
           (cut[i] - half) / (cut[i] - cut[i + step]);
  };
  return side(-1) + side(1);
}

TEST_F(SonarOracles, APointTargetsAzimuthCutIsThePattern) {
  scene::Scene scene = point_target(0.0);
  scene.sonars[0].terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
  const SonarFrame heard = ping(device(), scene);
  const auto cut = azimuth_cut(heard);
  // 0.886 lambda / L: the line whose half power that width is.
  EXPECT_NEAR(half_power_steps(cut) * 0.05, 1.0, 0.01);
  const double length = 0.885893 / (2.0 * std::sin(radians(0.5)));
  const double highest = *std::max_element(cut.begin(), cut.end());
  double lobe = 0.0;
  for (std::size_t b = 0; b < cut.size(); ++b) {
    const double u = length * std::sin(std::abs(heard.grid.azimuth_rad(b)));
    if (u > 1.0 && u < 2.0) lobe = std::max(lobe, cut[b]);
  }
  EXPECT_NEAR(10.0 * std::log10(lobe / highest), -13.26, 0.1);
}

TEST_F(SonarOracles, ABeamPatternKeepsTheEnergy) {
  scene::Scene scene = point_target(0.0);
  scene.objects[0] = object_of(scene, scene::make_sphere(0.3, 256), {0.0, 0.0, -10.0});
  scene.sonars[0].elevation_rad = radians(4.0);
  scene.sonars[0].bins_elevation = 80;
  const double plain = total(ping(device(), scene));
  scene.sonars[0].terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
  EXPECT_NEAR(total(ping(device(), scene)) / plain, 1.0, 0.01);
}

TEST_F(SonarOracles, SentAndHeardThroughOneLensSideLobesFallTwice) {
  scene::Scene scene = point_target(0.0);
  scene.sonars[0].terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
  scene.sonars[0].terms.beam.two_way = true;
  const SonarFrame heard = ping(device(), scene);
  const auto cut = azimuth_cut(heard);
  const double length = 0.885893 / (2.0 * std::sin(radians(0.5)));
  double lobe = 0.0;
  for (std::size_t b = 0; b < cut.size(); ++b) {
    const double u = length * std::sin(std::abs(heard.grid.azimuth_rad(b)));
    if (u > 1.0 && u < 2.0) lobe = std::max(lobe, cut[b]);
  }
  EXPECT_NEAR(10.0 * std::log10(lobe / *std::max_element(cut.begin(), cut.end())), -26.52, 0.2);
}

TEST_F(SonarOracles, AFlatArraysBeamsWidenToTheSides) {
  for (const double bearing_deg : {0.0, 50.0}) {
    scene::Scene scene = point_target(radians(bearing_deg));
    scene::Sonar& sonar = scene.sonars[0];
    sonar.azimuth_rad = radians(120.0);
    sonar.bins_azimuth = 2400;
    sonar.gbuffer_scale = 2.0;
    sonar.terms.beam.azimuth = scene::SonarPattern{.half_power_rad = radians(1.0)};
    const double turned = half_power_steps(azimuth_cut(ping(device(), scene))) * 0.05;
    sonar.terms.beam.steering = scene::SonarBeam::Steering::kFlat;
    const double steered = half_power_steps(azimuth_cut(ping(device(), scene))) * 0.05;
    EXPECT_NEAR(turned, 1.0, 0.02) << bearing_deg;
    EXPECT_NEAR(steered * std::cos(radians(bearing_deg)), 1.0, 0.03) << bearing_deg;
  }
}

TEST_F(SonarOracles, GainOf40LogMakesEqualSpheresEqual) {
  for (const double range_m : {4.0, 10.0, 25.0}) {
    scene::Sonar sonar = sonar_of(range_m - 1.0, range_m + 1.0, 200);
    sonar.azimuth_rad = sonar.elevation_rad = radians(40.0 / range_m);
    sonar.bins_azimuth = sonar.bins_elevation = 256;
    sonar.gbuffer_scale = 2.0;
    sonar.terms.level = plain_level();
    sonar.terms.level->tvg_log = 40.0;
    sonar.terms.level->tvg_absorption = true;
    scene::Scene scene;
    scene.objects.push_back(object_of(scene, scene::make_sphere(0.1, 256), {0.0, 0.0, -range_m}));
    scene.sonars = {sonar};
    // The rest is SL + TS, with 20 log(a / 2); seen from nearby, a sphere shows 1.5 a / r less.
    const double nearby_db = 10.0 * std::log10(1.0 - 1.5 * 0.1 / range_m);
    EXPECT_NEAR(10.0 * std::log10(total(ping(device(), scene))), 200.0 - 26.02 + nearby_db, 0.1)
        << range_m;
  }
}

TEST_F(SonarOracles, CountsAreTheLevelsFromTheFloorOn) {
  scene::Sonar sonar = sonar_of(8.0, 14.0, 100);
  sonar.terms.level = plain_level();
  for (const std::uint32_t bits : {8u, 16u}) {
    sonar.terms.output = {bits, 60.0, 70.0};
    scene::Scene scene = wall(10.0, sonar);
    const SonarFrame frame = ping(device(), scene);
    const test::ScratchFolder out;
    NERITIC_ASSERT_STATUS(write_sonar_frame(out / "sonar", frame, FrameFacts{}));
    NERITIC_ASSERT_OK(const NpyArray file, read_npy(out / "sonar" / "sonar_counts.npy"));
    EXPECT_EQ(file.type, bits == 8 ? NpyType::kUint8 : NpyType::kUint16);
    const std::vector<double> counts = file.to_doubles();
    ASSERT_EQ(counts.size(), frame.image.intensity.size());
    const double most = bits == 8 ? 255.0 : 65535.0;
    std::size_t between = 0;
    for (std::size_t i = 0; i < counts.size(); ++i) {
      const double v = frame.image.intensity[i];
      const double part = v > 0.0 ? (10.0 * std::log10(v) - 60.0) / 70.0 : 0.0;
      EXPECT_NEAR(counts[i], std::clamp(part, 0.0, 1.0) * most, 0.51) << i;
      between += counts[i] > 0.0 && counts[i] < most;
    }
    EXPECT_GT(between, 100u);
  }
}

// Mean range of each beam's energy; 0 of a silent one.
std::vector<double> range_by_beam(const SonarFrame& frame) {
  std::vector<double> sum(frame.image.n_azimuth, 0.0), moment(sum);
  for (std::size_t i = 0; i < frame.image.intensity.size(); ++i) {
    const double v = frame.image.intensity[i];
    sum[i % sum.size()] += v;
    moment[i % sum.size()] += v * frame.grid.range_m(static_cast<std::uint32_t>(i / sum.size()));
  }
  for (std::size_t b = 0; b < sum.size(); ++b) moment[b] = sum[b] > 0.0 ? moment[b] / sum[b] : 0.0;
  return moment;
}

scene::Sonar thin_fan(double azimuth_deg) {
  scene::Sonar sonar = sonar_of(6.0, 12.0, 1200);  // 5 mm
  sonar.azimuth_rad = radians(azimuth_deg);
  sonar.elevation_rad = radians(0.5);
  sonar.bins_elevation = 8;
  sonar.gbuffer_scale = 4.0;
  return sonar;
}

TEST_F(SonarOracles, ADihedralsFacesLieAtTheirRanges) {
  scene::Scene scene;
  const Vec3 apex(0.0, 0.0, -10.0);
  for (const double side : {-1.0, 1.0}) {
    const Vec3 along = Vec3(side, 0, 1) / std::sqrt(2.0),
               normal = Vec3(-side, 0, 1) / std::sqrt(2.0);
    scene::Object face =
        object_of(scene, scene::make_box(Vec3(16.0, 20.0, 1.0)), apex - 0.5 * normal + 8.0 * along);
    face.mount.pose.rotation = glm::angleAxis(-side * kPi / 4.0, Vec3(0, 1, 0));
    scene.objects.push_back(face);
  }
  scene.sonars = {thin_fan(40.0)};
  const SonarFrame frame = ping(device(), scene);
  const auto ranges = range_by_beam(frame);
  for (std::uint32_t b = 0; b < ranges.size(); ++b) {
    const double theta = std::abs(frame.grid.azimuth_rad(b));
    EXPECT_NEAR(ranges[b], 10.0 / (std::sin(theta) + std::cos(theta)), 0.005) << b;
  }
}

TEST_F(SonarOracles, ACylinderLiesAtItsRange) {
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_cylinder(0.5, 8.0, 512), {0, 0, -10.0}));
  scene.sonars = {thin_fan(5.0)};
  const SonarFrame frame = ping(device(), scene);
  const auto ranges = range_by_beam(frame);
  for (std::uint32_t b = 0; b < ranges.size(); ++b) {
    const double theta = frame.grid.azimuth_rad(b), s = 10.0 * std::sin(theta);
    const double truth = 10.0 * std::cos(theta) - std::sqrt(0.25 - s * s);
    if (std::abs(theta) < radians(2.3)) {  // of 2.87: beyond, a beam sees the limb in part
      EXPECT_NEAR(ranges[b], truth, 0.006) << b;
    }
  }
}

TEST_F(SonarOracles, NoiseIsTheSeasOverTheBandAndTheReceiversOwn) {
  scene::Sonar sonar = sonar_of(1.0, 5.0, 200);
  sonar.terms.frequency_hz = 100e3;
  sonar.terms.level = plain_level();
  sonar.terms.range_spread = scene::SonarRangeSpread{.bandwidth_hz = 20e3};
  scene::Scene empty;
  const auto mean_db = [&](const scene::SonarNoise& noise) {
    sonar.terms.noise = noise;
    empty.sonars = {sonar};
    const SonarFrame frame = ping(device(), empty);
    return 10.0 * std::log10(total(frame) / static_cast<double>(frame.image.intensity.size()));
  };
  // Coates's terms by hand (tests/sonar/acoustics_test.cpp) and 43.01 dB of band; 25 600 bins tell
  // the mean to 0.03 dB.
  EXPECT_NEAR(mean_db({.wind_m_s = 10.0, .shipping = 0.5}), 77.21, 0.1);
  EXPECT_NEAR(mean_db({.wind_m_s = 10.0, .shipping = 0.5, .self_db = 80.0}), 81.84, 0.1);
  EXPECT_NEAR(mean_db({.level_db = 60.0}), 60.0, 0.1);
}

TEST_F(SonarOracles, ASeabedsMaterialScalesItsBackscatterAboutSands) {
  scene::Sonar sonar = sonar_of(8.0, 14.0, 200);
  sonar.terms.level = plain_level();
  scene::Scene scene = wall(10.0, sonar);
  scene.objects[0].class_id = 1;
  const auto level_db = [&](const char* material) {
    scene.objects[0].material = material;
    return 10.0 * std::log10(total(ping(device(), scene)));
  };
  const double unnamed = level_db("");
  EXPECT_NEAR(level_db("sand"), unnamed, 1e-3);
  EXPECT_LT(level_db("mud"), unnamed - 3.0);
  EXPECT_GT(level_db("rock"), unnamed + 3.0);
  EXPECT_LT(level_db("rock"), unnamed + 8.2);  // all of it reflected is 8.1 dB more than sand does
}

}  // namespace
}  // namespace neritic::testbed
