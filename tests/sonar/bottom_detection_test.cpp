#include "sonar/bottom_detection.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::BottomDetection;
using sonar::DetectionMethod;

// A swath across a plane whose foot lies at tilt_rad to starboard of the axis and distance_m away.
// Each beam is an integral over its width (and the fan's) of the cosine of incidence, from the
// plane's equation alone.
std::vector<float> plane_image(const BeamGrid& grid, double distance_m, double tilt_rad) {
  const Vec3 inwards(std::sin(tilt_rad), 0.0, -std::cos(tilt_rad));
  std::vector<double> sum(std::size_t{grid.bins.range} * grid.bins.azimuth);
  constexpr int kAcross = 400, kAlong = 9;
  for (std::uint32_t beam = 0; beam < grid.bins.azimuth; ++beam)
    for (int i = 0; i < kAcross; ++i)
      for (int k = 0; k < kAlong; ++k) {
        const double a =
            grid.azimuth_rad(beam) + ((i + 0.5) / kAcross - 0.5) * grid.azimuth_step_rad();
        const double e = glm::mix(grid.limits.elevation_min_rad, grid.limits.elevation_max_rad,
                                  (k + 0.5) / kAlong);
        const Vec3 d(std::cos(e) * std::sin(a), std::sin(e), -std::cos(e) * std::cos(a));
        const double cosine = glm::dot(d, inwards);
        if (cosine <= 0.0) continue;
        if (const auto row = sonar::bin_index(distance_m / cosine, grid.limits.range_min_m,
                                              grid.limits.range_max_m, grid.bins.range))
          sum[*row * grid.bins.azimuth + beam] += cosine / (kAcross * kAlong);
      }
  return {sum.begin(), sum.end()};
}

// The published profiling sonar: 90 x 0.5 degrees, 500 bins; here with 1 degree beams.
BeamGrid swath(double range_max_m) {
  return sonar::symmetric_grid(1.0, range_max_m, radians(90), radians(0.5), {500, 91, 9});
}

TEST(BottomDetection, ATiltedPlaneIsWithinHalfABinWhereItIsMetStraightOn) {
  for (int tilt_deg = 0; tilt_deg <= 85; tilt_deg += 5)
    for (const double distance_m : {5.0, 5.013, 7.777}) {
      const BeamGrid grid = swath(20.0);
      const double tilt = radians(tilt_deg);
      const auto found = sonar::detect_bottom(grid, plane_image(grid, distance_m, tilt));
      const double bin = grid.range_step_m();
      std::size_t straight = 0, oblique = 0;
      double sum = 0.0;
      for (const BottomDetection& d : found) {
        const double incidence = grid.azimuth_rad(d.beam) - tilt;
        const double truth = distance_m / std::cos(incidence);
        // A beam that sees the plane only in part, since the range ends, has an echo cut short.
        const double end =
            distance_m / std::cos(std::abs(incidence) + grid.azimuth_step_rad() / 2.0);
        if (!(end > 0.0 && end < grid.limits.range_max_m)) continue;
        const double error = d.range_m - truth;
        sum += error;
        ++oblique;
        // The error that the beam's width and the bins allow, from a beam met straight on to 75
        // degrees.
        EXPECT_NEAR(error, 0.0, 0.5 * bin + 0.002 * distance_m)
            << tilt_deg << " deg, beam " << d.beam;
        if (std::abs(incidence) < radians(2.0)) {
          EXPECT_NEAR(error, 0.0, 0.5 * bin) << tilt_deg << " deg";
          ++straight;
        }
      }
      if (tilt_deg <= 45) {
        EXPECT_GE(straight, 2u);
      }
      EXPECT_GT(oblique, 20u) << tilt_deg;
      EXPECT_NEAR(sum / static_cast<double>(oblique), 0.0, 0.15 * bin) << tilt_deg << " biased";
    }
}

TEST(BottomDetection, TheAxisMeetsAPlaneAt85DegreesWithinHalfAPercent) {
  for (const double tilt_deg : {60.0, 70.0, 80.0, 85.0}) {
    const BeamGrid grid =
        sonar::symmetric_grid(0.5, 100.0, radians(1.0), radians(0.5), {2000, 1, 9});
    const auto found = sonar::detect_bottom(grid, plane_image(grid, 2.0, radians(tilt_deg)));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].method,
              tilt_deg > 65.0 ? DetectionMethod::kCentreOfGravity : DetectionMethod::kAmplitude);
    const double truth = 2.0 / std::cos(radians(tilt_deg));
    EXPECT_NEAR(found[0].range_m, truth, 0.5 * grid.range_step_m() + 0.005 * truth) << tilt_deg;
    EXPECT_NEAR(found[0].quality, 1.0, 0.01);
  }
}

TEST(BottomDetection, ShortEchoesAreLocatedByAmplitudeAndLongOnesByTheirCentre) {
  const BeamGrid grid = sonar::symmetric_grid(0.0, 100.0, radians(10), radians(1), {100, 3, 1});
  std::vector<float> image(300, 0.0f);
  image[40 * 3] = 0.75f;  // an echo a bin long whose middle lies a quarter bin behind bin 40's
  image[41 * 3] = 0.25f;
  for (int i = 20; i < 60; ++i) image[i * 3 + 1] = i % 7 == 4 ? 0.05f : 0.5f + 0.001f * (i % 5);
  const auto found = sonar::detect_bottom(grid, image);
  ASSERT_EQ(found.size(), 2u);  // the third beam is silent
  EXPECT_EQ(found[0].beam, 0u);
  EXPECT_EQ(found[0].method, DetectionMethod::kAmplitude);
  EXPECT_NEAR(found[0].range_m, 40.75, 1e-9);
  EXPECT_FLOAT_EQ(found[0].intensity, 0.75f);
  EXPECT_EQ(found[1].beam, 1u);
  EXPECT_EQ(found[1].method, DetectionMethod::kCentreOfGravity);
  EXPECT_EQ(found[1].echo_bins, 40u);  // across the dips
  EXPECT_NEAR(found[1].range_m, 40.0, 0.2);
}

TEST(BottomDetection, AnEchoApartFromTheStrongestIsLeftOut) {
  const BeamGrid grid = sonar::symmetric_grid(0.0, 100.0, radians(10), radians(1), {100, 1, 1});
  std::vector<float> image(100, 0.0f);
  image[30] = 0.4f;  // a fish
  image[70] = 1.0f;
  image[90] = std::numeric_limits<float>::quiet_NaN();
  image[95] = std::numeric_limits<float>::infinity();
  image[96] = -5.0f;
  const auto found = sonar::detect_bottom(grid, image);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].range_m, 70.5, 1e-12);
  EXPECT_NEAR(found[0].quality, 1.0 / 1.4, 1e-6);
  EXPECT_TRUE(sonar::detect_bottom(grid, image, {.floor = 1.5}).empty());
  EXPECT_EQ(sonar::detect_bottom(grid, image, {.floor = 0.5}).size(), 1u);
  EXPECT_TRUE(sonar::detect_bottom(grid, image, {.least_quality = 0.75}).empty());
  EXPECT_EQ(sonar::detect_bottom(grid, image, {.least_quality = 0.7}).size(), 1u);
  EXPECT_FALSE(sonar::validate(sonar::BottomDetectionOptions{.least_quality = 1.5}).ok());
}

TEST(BottomDetection, APeakBetweenBinsIsFoundThere) {
  EXPECT_EQ(sonar::sub_bin_offset(0, 1, 0), 0.0);
  EXPECT_NEAR(sonar::sub_bin_offset(0, 0.5, 0.5), 0.5, 1e-12);
  EXPECT_NEAR(sonar::sub_bin_offset(0.3, 0.7, 0.0), -0.3, 1e-12);
  for (const double at : {-0.45, -0.2, 0.0, 0.1, 0.4}) {  // a parabola, exactly
    const auto value = [&](double x) { return 10.0 - (x - at) * (x - at); };
    EXPECT_NEAR(sonar::sub_bin_offset(value(-1), value(0), value(1)), at, 1e-12);
  }
  EXPECT_EQ(sonar::sub_bin_offset(1, 1, 1), 0.0);
}

TEST(BottomDetection, NadirBeamsAreThoseThatPointDownInTheWorld) {
  const BeamGrid grid = swath(20.0);
  std::vector<BottomDetection> all(91);
  for (std::uint32_t i = 0; i < 91; ++i) all[i].beam = i;
  const Pose down{Vec3(0, -2, 0), from_yaw_pitch_roll(0.3, radians(-90), 0)};
  const auto nadir = sonar::nadir_detections(grid, all, down, radians(1.2));
  ASSERT_EQ(nadir.size(), 3u);
  EXPECT_EQ(nadir[1].beam, 45u);
  EXPECT_TRUE(sonar::nadir_detections(grid, all, Pose{}, radians(1.2)).empty());
}

TEST(BottomDetection, OptionsThatCannotBeAreNamed) {
  EXPECT_TRUE(sonar::validate(sonar::BottomDetectionOptions{}).ok());
  EXPECT_FALSE(sonar::validate(sonar::BottomDetectionOptions{.relative_threshold = 0.0}).ok());
  EXPECT_FALSE(sonar::validate(sonar::BottomDetectionOptions{.relative_threshold = 1.5}).ok());
  EXPECT_FALSE(sonar::validate(sonar::BottomDetectionOptions{.floor = std::nan("")}).ok());
}

}  // namespace
}  // namespace neritic
