// Normals from noisy depth of planes and spheres, whose own normals are known, beside those of
// plain differences between neighbours.
#include "sonar/depth_normals.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <random>

namespace neritic::sonar {
namespace {

// Distance along a ray (x, y, -1) in units of its length, 0 where it misses; and the normal there.
struct Shape {
  std::function<double(const Vec3& ray)> depth;
  std::function<Vec3(const Vec3& point)> normal;
};

Shape plane(const Vec3& normal, double distance_m) {
  const Vec3 n = glm::normalize(normal);
  return {[=](const Vec3& ray) { return -distance_m / glm::dot(n, ray); },
          [=](const Vec3&) { return n; }};
}

Shape sphere(const Vec3& centre, double radius_m) {
  return {[=](const Vec3& ray) {
            const double a = glm::dot(ray, ray), b = glm::dot(ray, centre);
            const double root = b * b - a * (glm::dot(centre, centre) - radius_m * radius_m);
            return root < 0.0 ? 0.0 : (b - std::sqrt(root)) / a;
          },
          [=](const Vec3& p) { return glm::normalize(p - centre); }};
}

// 160 x 120 pixels of 48 degrees. noise: standard deviation, m.
SonarInput picture_of(const Shape& shape, double noise_m) {
  SonarInput in;
  in.width = 160;
  in.height = 120;
  in.intrinsics = {180.0, 180.0, 80.0, 60.0};
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 1.0);
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const Vec3 ray((u + 0.5 - 80.0) / 180.0, (60.0 - v - 0.5) / 180.0, -1.0);
      const double depth = shape.depth(ray);
      in.depth.push_back(depth > 0.0 ? depth + noise_m * noise(random) : 0.0);
    }
  return in;
}

// Central differences, as anybody would.
std::vector<double> plain_normals(const SonarInput& in) {
  std::vector<double> out(3 * in.depth.size(), 0.0);
  for (std::uint32_t v = 1; v + 1 < in.height; ++v)
    for (std::uint32_t u = 1; u + 1 < in.width; ++u) {
      const auto l = point_of(in, u - 1, v), r = point_of(in, u + 1, v), t = point_of(in, u, v - 1),
                 b = point_of(in, u, v + 1);
      if (!l || !r || !t || !b) continue;
      const Vec3 n = glm::normalize(glm::cross(*r - *l, *t - *b));
      std::copy_n(&n[0], 3, &out[3 * (std::size_t{v} * in.width + u)]);
    }
  return out;
}

// The echo that a sonar would hear of them: the mean cosine of incidence against the true one's, as
// a share of it.
double echo_error(const Shape& shape, const SonarInput& in, std::span<const double> normals) {
  double found = 0.0, wanted = 0.0;
  for (std::uint32_t v = 8; v + 8 < in.height; ++v)
    for (std::uint32_t u = 8; u + 8 < in.width; ++u) {
      const Vec3 ray((u + 0.5 - 80.0) / 180.0, (60.0 - v - 0.5) / 180.0, -1.0);
      const double depth = shape.depth(ray);
      const double* n = &normals[3 * (std::size_t{v} * in.width + u)];
      if (!(depth > 0.0)) continue;
      found += incidence({n[0], n[1], n[2]}, ray, true).value_or(0.0);
      wanted += incidence(shape.normal(ray * depth), ray, true).value_or(0.0);
    }
  return std::abs(found / wanted - 1.0);
}

double median_angle_deg(const Shape& shape, const SonarInput& in, std::span<const double> normals) {
  std::vector<double> angles;
  for (std::uint32_t v = 0; v < in.height; ++v)
    for (std::uint32_t u = 0; u < in.width; ++u) {
      const Vec3 ray((u + 0.5 - 80.0) / 180.0, (60.0 - v - 0.5) / 180.0, -1.0);
      const double* n = &normals[3 * (std::size_t{v} * in.width + u)];
      if (n[0] == 0.0 && n[1] == 0.0 && n[2] == 0.0) continue;
      const Vec3 wanted = shape.normal(ray * shape.depth(ray));
      angles.push_back(
          degrees(std::acos(std::clamp(glm::dot(wanted, Vec3(n[0], n[1], n[2])), -1.0, 1.0))));
    }
  std::nth_element(angles.begin(), angles.begin() + static_cast<long>(angles.size() / 2),
                   angles.end());
  return angles[angles.size() / 2];
}

TEST(DepthNormals, NoisyPlanesAndSpheresKeepTheirNormals) {
  const std::pair<const char*, Shape> shapes[] = {{"wall", plane({0, 0, 1}, 3.0)},
                                                  {"slope", plane({0.1, 1, 0.7}, 2.0)},
                                                  {"ball", sphere({0.1, 0.0, -3.0}, 0.8)}};
  for (const auto& [name, shape] : shapes)
    for (const double noise_m : {0.003, 0.01, 0.03}) {
      SCOPED_TRACE(fmt::format("{}, {} m", name, noise_m));
      const SonarInput in = picture_of(shape, noise_m);
      const DepthNormals found = normals_from_depth(in);
      const double before = echo_error(shape, in, plain_normals(in)),
                   after = echo_error(shape, in, found.normals);
      const double angle = median_angle_deg(shape, in, found.normals);
      EXPECT_LT(after, 0.015);  // of 0.1 to 42 % before
      if (before > 0.02) {
        EXPECT_LT(after, 0.15 * before);
      }
      EXPECT_LT(angle, noise_m < 0.02 ? 4.0 : 7.0);
      EXPECT_NEAR(found.estimate.noise_m / noise_m, 1.0, 0.15);
    }
}

// A floor under a level camera, seen at 60 to 88 degrees: the share of its pixels that have a
// normal, and the median error. Rows farther than some three altitudes had none, as soon as there
// was noise.
std::pair<double, double> floor_of(double noise_m, double step_m) {
  const Shape floor = plane(Vec3(0.0, 1.0, 0.0), 1.2);
  SonarInput in = picture_of(floor, noise_m);
  for (double& d : in.depth) {
    if (!(d > 0.0 && d < 30.0)) d = 0.0;
    if (step_m > 0.0) d = step_m * std::round(d / step_m);
  }
  const DepthNormals got = normals_from_depth(in);
  std::vector<double> off_rad;
  int seen = 0;
  for (std::size_t i = 0; i < in.depth.size(); ++i) {
    if (in.depth[i] == 0.0) continue;
    ++seen;
    const Vec3 n(got.normals[3 * i], got.normals[3 * i + 1], got.normals[3 * i + 2]);
    if (glm::length(n) > 0.5) off_rad.push_back(std::acos(std::clamp(n.y, -1.0, 1.0)));
  }
  const double share = static_cast<double>(off_rad.size()) / seen;
  std::nth_element(off_rad.begin(), off_rad.begin() + off_rad.size() / 2, off_rad.end());
  return {share, degrees(off_rad[off_rad.size() / 2])};
}

TEST(DepthNormals, AFloorSeenAtAGrazeKeepsItsNormals) {
  for (const double noise_m : {0.0, 1e-4, 5e-4, 1e-3, 3e-3}) {
    const auto [share, off_deg] = floor_of(noise_m, 0.0);
    EXPECT_GT(share, 0.97) << noise_m;
    EXPECT_LT(off_deg, 3.0) << noise_m;
  }
}

TEST(DepthNormals, DepthsOfWholeMillimetresAreKnownToBeRounded) {
  for (const double step_m : {1e-3, 4e-3, 20e-3}) {
    const auto [share, off_deg] = floor_of(0.0, step_m);
    EXPECT_GT(share, 0.97) << step_m;
    EXPECT_LT(off_deg, 4.0) << step_m;
    SonarInput in = picture_of(plane(Vec3(0.2, 0.3, 1.0), 3.0), 0.0);
    for (double& d : in.depth) d = step_m * std::round(d / step_m);
    EXPECT_NEAR(normals_from_depth(in).estimate.noise_m, step_m / std::sqrt(12.0), 0.5 * step_m);
  }
}

TEST(DepthNormals, CleanDepthIsLeftAsItIs) {
  for (const Shape& shape : {plane({0.1, 1, 0.7}, 2.0), sphere({0.1, 0.0, -3.0}, 0.8)}) {
    const SonarInput in = picture_of(shape, 0.0);
    const DepthNormals found = normals_from_depth(in);
    EXPECT_EQ(found.estimate.width_px, 0);
    EXPECT_LT(degrees(found.estimate.error_of_neighbours_rad), 0.5);
    EXPECT_LT(median_angle_deg(shape, in, found.normals), 0.2);
  }
}

// The published gather counts a cell once in each range bin that its pixels lie in, so that noise
// makes it louder.
TEST(DepthNormals, NoisyDepthKeepsThePublishedGathersEnergy) {
  const BeamGrid grid = symmetric_grid(1.0, 5.0, radians(44.0), radians(34.0), {400, 40, 30});
  const auto energy = [&](SonarInput in, const Shape& shape) {
    in.normals.clear();
    for (std::uint32_t v = 0; v < in.height; ++v)
      for (std::uint32_t u = 0; u < in.width; ++u) {
        const Vec3 ray((u + 0.5 - 80.0) / 180.0, (60.0 - v - 0.5) / 180.0, -1.0);
        const Vec3 n = shape.normal(ray * shape.depth(ray));
        in.normals.insert(in.normals.end(), {n.x, n.y, n.z});
      }
    double sum = 0.0;
    for (const float cell : reference_image(grid, std::span(&in, 1)).intensity) sum += cell;
    return sum;
  };
  for (const Shape& shape : {plane({0, 0, 1}, 3.0), plane({0.1, 0.5, 1}, 2.5)}) {
    const double clean = energy(picture_of(shape, 0.0), shape);
    SonarInput in = picture_of(shape, 0.02);
    EXPECT_GT(energy(in, shape), 1.3 * clean);
    const SmoothedDepth told = smooth_depth(in, 0.25 * grid.range_step_m());
    EXPECT_NEAR(told.noise_m, 0.02, 0.002);
    EXPECT_GE(told.width_px, 7);
    EXPECT_NEAR(energy(in, shape) / clean, 1.0, 0.05);
    SonarInput untouched = picture_of(shape, 0.0);
    const std::vector<double> before = untouched.depth;
    EXPECT_EQ(smooth_depth(untouched, 0.25 * grid.range_step_m()).width_px, 0);
    EXPECT_EQ(untouched.depth, before);
  }
}

// A crate's face 0.3 m before a wall: noise is smoothed on each, not across the outline.
TEST(DepthNormals, AnOutlineStaysSharp) {
  Shape crate = plane({0, 0, 1}, 3.0);
  crate.depth = [](const Vec3& ray) { return std::abs(ray.x) < 0.15 ? 2.7 : 3.0; };
  const SonarInput in = picture_of(crate, 0.008);
  const DepthNormals found = normals_from_depth(in);
  EXPECT_GT(found.estimate.width_px, 3);
  std::size_t tilted = 0, all = 0;
  for (std::size_t i = 0; i < in.depth.size(); ++i, ++all)
    tilted += found.normals[3 * i + 2] < std::cos(radians(20.0));
  EXPECT_LT(static_cast<double>(tilted) / all, 0.01);
}

}  // namespace
}  // namespace neritic::sonar
