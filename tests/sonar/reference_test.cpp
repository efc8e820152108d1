#include "sonar/reference.hpp"

#include <gtest/gtest.h>

#include <random>

#include "sonar/literal_volume.hpp"
#include "tests/sonar/analytic.hpp"

namespace neritic {
namespace {

using sonar::BeamGrid;
using sonar::SonarImage;
using sonar::SonarInput;

BeamGrid default_grid(std::uint32_t bins = 500) {
  return sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {bins, bins, bins});
}

// An independent, naive Algorithm 1: one dense volume in another cell order, written from the page,
// with its own arithmetic for every step.
std::vector<double> naive(const SonarInput& in, double r0, double r1, double az, double el, int nr,
                          int nt, int np) {
  std::vector<double> volume(std::size_t(nr) * nt * np, 0.0);
  const long m = long(in.width) * in.height;
  for (long i = 0; i < m; ++i) {
    const long v = i / in.width, u = i % in.width;
    const double d = in.depth[i];
    if (std::isnan(d) || std::isinf(d) || d <= 0) continue;
    const double n[3] = {in.normals[3 * i], in.normals[3 * i + 1], in.normals[3 * i + 2]};
    const double size = std::hypot(n[0], n[1], n[2]);
    if (!std::isfinite(size) || size == 0) continue;
    const double p[3] = {(u + .5 - in.intrinsics.cx) / in.intrinsics.fx * d,
                         -(v + .5 - in.intrinsics.cy) / in.intrinsics.fy * d, -d};
    const double r = std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]);
    const double theta = std::atan2(p[0], -p[2]), phi = std::asin(p[1] / r);
    if (r < r0 || r >= r1 || theta < -az / 2 || theta >= az / 2 || phi < -el / 2 || phi >= el / 2)
      continue;
    const int ir = int((r - r0) / (r1 - r0) * nr), it = int((theta + az / 2) / az * nt),
              ip = int((phi + el / 2) / el * np);
    const double cosine = -(n[0] * p[0] + n[1] * p[1] + n[2] * p[2]) / (r * size);
    volume[(std::size_t(ip) * nt + it) * nr + ir] = cosine > 0 ? cosine : 0;
  }
  std::vector<double> z(std::size_t(nr) * nt, 0.0);
  for (int ip = np - 1; ip >= 0; --ip)
    for (int it = 0; it < nt; ++it)
      for (int ir = 0; ir < nr; ++ir)
        z[std::size_t(ir) * nt + it] += volume[(std::size_t(ip) * nt + it) * nr + ir] / np;
  return z;
}

SonarInput random_images(std::uint32_t width, std::uint32_t height, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> depth(0.2, 6.0), unit(-1.0, 1.0);
  SonarInput in;
  in.width = width;
  in.height = height;
  in.intrinsics = {width / 1.7, height / 0.6, width / 2.0 + 3.25, height / 2.0 - 1.5};
  for (std::uint32_t i = 0; i < width * height; ++i) {
    const double odd = depth(random);
    in.depth.push_back(odd > 5.9   ? std::numeric_limits<double>::quiet_NaN()
                       : odd > 5.8 ? std::numeric_limits<double>::infinity()
                       : odd > 5.7 ? 0.0
                                   : odd);
    for (int k = 0; k < 3; ++k) in.normals.push_back(3.0 * unit(random));
    if (i % 97 == 0) in.normals[3 * i] = in.normals[3 * i + 1] = in.normals[3 * i + 2] = 0.0;
    if (i % 89 == 0) in.normals[3 * i + 1] = std::numeric_limits<double>::quiet_NaN();
  }
  return in;
}

TEST(SonarReference, IsTheNaivePublishedLoopInEveryCell) {
  const SonarInput in = random_images(400, 300, 7);
  const BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {101, 67, 53});
  const SonarImage image = sonar::reference_image(grid, std::span(&in, 1));
  const auto expected = naive(in, 1.0, 5.0, radians(90.0), radians(28.0), 101, 67, 53);
  ASSERT_EQ(image.intensity.size(), expected.size());
  double energy = 0.0;
  for (std::size_t i = 0; i < expected.size(); ++i) {
    ASSERT_NEAR(image.intensity[i], expected[i], 1e-6) << "cell " << i;
    energy += expected[i];
  }
  EXPECT_GT(energy, 1.0);
}

TEST(SonarReference, TheLastPixelOfACellWins) {
  // Two pixels of one 1 x 1 x 1 cell with different incidence: cos 0 first, then cos 60 degrees.
  SonarInput in;
  in.width = 2;
  in.height = 1;
  in.intrinsics = {1e6, 1e6, 1.0, 0.5};  // both look straight ahead to 1e-6
  in.depth = {2.0, 2.0};
  in.normals = {0, 0, 1, std::sqrt(0.75), 0, 0.5};
  in.labels = {7, 9};
  const BeamGrid grid = sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {1, 1, 1});
  const SonarImage image = sonar::reference_image(grid, std::span(&in, 1));
  EXPECT_NEAR(image.intensity.at(0), 0.5, 1e-5);
  EXPECT_EQ(image.labels.at(0), 9);
}

TEST(SonarReference, ASphereAroundTheSonarIsOneRowOfOnesInEveryColumn) {
  const BeamGrid grid = default_grid();
  // 1.3 pixels a cell leave no cell without a pixel, corners included. 3.004 m is the middle of a
  // bin (on an edge, rounding would spread the pixels of one cell over two bins, and each would
  // count).
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), 3.004), 1.3);
  ASSERT_EQ(inputs.size(), 1u);
  const SonarImage image = sonar::reference_image(grid, inputs);
  for (std::uint32_t r = 0; r < 500; ++r)
    for (std::uint32_t c = 0; c < 500; ++c)
      ASSERT_NEAR(image.intensity[r * 500 + c], r == 250 ? 1.0f : 0.0f, 1e-6f) << r << ',' << c;
}

TEST(SonarReference, ASphereAroundTheSonarFillsAFullTurn) {
  const BeamGrid grid =
      sonar::symmetric_grid(1.0, 5.0, radians(360.0), radians(60.0), {100, 240, 40});
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0.0), 3.01), 1.6);
  ASSERT_EQ(inputs.size(), 4u);
  const SonarImage image = sonar::reference_image(grid, inputs);
  for (std::uint32_t r = 0; r < 100; ++r)
    for (std::uint32_t c = 0; c < 240; ++c)
      ASSERT_NEAR(image.intensity[r * 240 + c], r == 50 ? 1.0f : 0.0f, 1e-6f) << r << ',' << c;
}

TEST(SonarReference, ASmallSphereIsWhereTheClosedFormSays) {
  // Radius 0.25 m at 3 m: nearest point 2.75 m (bin 218.75), seen under +-asin(0.25 / 3) = 9.56
  // degrees of the wedge's 90: 53.1 columns each... of 500 bins a side, 2 * 4.78 / 90 * 500 = 53.1.
  const BeamGrid grid = default_grid();
  const auto inputs = test::sector_images(grid, test::sphere(Vec3(0, 0, -3.0), 0.25), 1.3);
  const SonarImage image = sonar::reference_image(grid, inputs);
  std::uint32_t first_row = 500, columns = 0;
  for (std::uint32_t c = 0; c < 500; ++c) {
    bool seen = false;
    for (std::uint32_t r = 0; r < 500; ++r)
      if (image.intensity[r * 500 + c] > 0.0f) {
        seen = true;
        first_row = std::min(first_row, r);
      }
    columns += seen;
  }
  EXPECT_NEAR(first_row, 218, 1);
  EXPECT_NEAR(columns, 54, 2);
}

TEST(SonarReference, AWallAheadLiesOnTheHyperbolaOfTheClosedForm) {
  // The plane z = -3: in column theta the returns go from 3 / cos(theta) to that over cos(14 deg),
  // and the first of them has incidence cos(theta).
  const BeamGrid grid = default_grid(200);
  const auto inputs = test::sector_images(grid, test::plane(Vec3(0, 0, -1), 3.0), 1.5);
  const auto image = sonar::reference_image(grid, inputs);
  for (std::uint32_t c = 5; c < 200; c += 10) {
    const double theta = grid.azimuth_rad(c);
    const double first = 3.0 / std::cos(theta), last = first / std::cos(radians(14.0));
    double sum = 0.0, lowest = 1e9, highest = 0.0;
    for (std::uint32_t r = 0; r < 200; ++r) {
      const double value = image.intensity[r * 200 + c];
      sum += value;
      if (value > 0.0) {
        lowest = std::min(lowest, grid.range_m(r));
        highest = std::max(highest, grid.range_m(r));
      }
    }
    // A column is 0.45 degrees wide: its edges differ by 3 sin/cos^2 * 0.00785 / 2 in range.
    const double slack =
        0.02 + 3.0 * std::abs(std::sin(theta)) / std::pow(std::cos(theta), 2) * 0.004;
    EXPECT_NEAR(lowest, first, slack) << c;
    EXPECT_NEAR(highest, last, slack) << c;
    // Each of the elevations counts at least once, with cos(theta) cos(phi); a pixel pair that
    // straddles a range bin inside one cell counts twice.
    EXPECT_GT(sum, 0.98 * std::cos(theta)) << c;
  }
}

TEST(SonarReference, TheLiteralVolumeOfTheBenchmarksGivesTheSameImage) {
  const BeamGrid grid = sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {97, 83, 61});
  const auto inputs = test::sector_images(
      grid, test::nearest_of({test::sphere(Vec3(.3, .1, -3), .6), test::plane(Vec3(0, -1, 0), .8)}),
      1.2);
  const SonarImage image = sonar::reference_image(grid, inputs);
  sonar::LiteralVolume volume(grid);
  const auto literal = volume.run(sonar::literal_input(inputs[0]));
  double total = 0.0, difference = 0.0;
  for (std::size_t i = 0; i < image.intensity.size(); ++i) {
    total += image.intensity[i];
    difference += std::abs(image.intensity[i] - literal[i]);
  }
  EXPECT_GT(total, 10.0);
  EXPECT_LT(difference, 1e-3 * total);  // a float may put a pixel in the next bin
}

TEST(SonarReference, UnknownSignsCountByTheirSizeAndBacksOfFacesByNothing) {
  SonarInput in;
  in.width = in.height = 1;
  in.intrinsics = {1.0, 1.0, 0.5, 0.5};
  in.depth = {2.0};
  in.normals = {0, 0, -2.0};  // away from the sensor
  const BeamGrid grid = sonar::symmetric_grid(1.0, 5.0, radians(90.0), radians(28.0), {1, 1, 1});
  EXPECT_EQ(sonar::reference_image(grid, std::span(&in, 1)).intensity[0], 0.0f);
  in.normals_face_sensor = false;
  EXPECT_EQ(sonar::reference_image(grid, std::span(&in, 1)).intensity[0], 1.0f);
  in.normals = {-1, -1, -1};  // a marker of "unknown"
  EXPECT_EQ(sonar::reference_image(grid, std::span(&in, 1)).intensity[0], 0.0f);
}

TEST(SonarReference, RangeAlongTheRayIsTakenAsSuch) {
  const BeamGrid grid = default_grid(100);
  auto planar = test::sector_images(grid, test::plane(Vec3(0, 0, -1), 2.5), 1.0);
  auto ranged = planar;
  for (std::uint32_t v = 0; v < ranged[0].height; ++v)
    for (std::uint32_t u = 0; u < ranged[0].width; ++u) {
      const auto& k = ranged[0].intrinsics;
      ranged[0].depth[v * ranged[0].width + u] *= std::sqrt(
          1.0 + std::pow((u + .5 - k.cx) / k.fx, 2) + std::pow((v + .5 - k.cy) / k.fy, 2));
    }
  ranged[0].depth_is_range = true;
  const auto a = sonar::reference_intensity(grid, planar),
             b = sonar::reference_intensity(grid, ranged);
  double difference = 0.0, total = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    difference += std::abs(a[i] - b[i]);
    total += a[i];
  }
  EXPECT_GT(total, 10.0);
  EXPECT_LT(difference, 1e-3 * total);
}

TEST(SonarReference, ImagesOfNaNAndInfinityAreSilence) {
  for (const double depth : {std::numeric_limits<double>::quiet_NaN(),
                             std::numeric_limits<double>::infinity(), -2.0, 0.0}) {
    auto inputs = test::sector_images(default_grid(50), test::sphere(Vec3(0.0), 3.0), 0.5);
    std::fill(inputs[0].depth.begin(), inputs[0].depth.end(), depth);
    for (const double value : sonar::reference_intensity(default_grid(50), inputs))
      ASSERT_EQ(value, 0.0);
  }
}

TEST(SonarReference, ImagesThatDoNotFitAreRefused) {
  auto inputs = test::sector_images(default_grid(20), test::sphere(Vec3(0.0), 3.0), 0.5);
  SonarInput in = inputs[0];
  EXPECT_TRUE(sonar::validate(in).ok());
  in.normals.pop_back();
  EXPECT_FALSE(sonar::validate(in).ok());
  in = inputs[0];
  in.width = 0;
  EXPECT_FALSE(sonar::validate(in).ok());
  in = inputs[0];
  in.intrinsics.fx = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(sonar::validate(in).ok());
}

}  // namespace
}  // namespace neritic
