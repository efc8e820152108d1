#include "engine/sim/current.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/core/random.hpp"
#include "tests/sim/spring.hpp"
#include "tests/support/support.hpp"

namespace neritic::sim {
namespace {

using test::kNan;

// v = a + b x + c y + d z + e t in each component: a grid gives it exactly.
Vec3 linear_flow(const Vec3& p, double t_s) {
  return Vec3(0.5 + 0.25 * p.x - 0.125 * t_s, 0.03125 * p.y, 1.0 - 0.5 * p.z + 0.0625 * p.y);
}

GridCurrent linear_grid() {
  GridCurrent grid;
  grid.axes = {Vec3(-4.0, -8.0, 2.0), Vec3(2.0, 4.0, -1.0), 10.0, 5.0};
  grid.counts = {3, 3, 4, 5};
  for (int t = 0; t < 3; ++t)
    for (int y = 0; y < 3; ++y)
      for (int z = 0; z < 4; ++z)
        for (int x = 0; x < 5; ++x) {
          const Vec3 v = linear_flow(Vec3(-4.0 + 2.0 * x, -8.0 + 4.0 * y, 2.0 - z), 10.0 + 5.0 * t);
          for (int i = 0; i < 3; ++i) grid.velocities_m_s.push_back(static_cast<float>(v[i]));
        }
  return grid;
}

// Gradient and rate against central differences, away from the kinks.
void expect_derivatives(const Current& current, const Vec3& p, double t_s) {
  const CurrentSample at = sample(current, p, t_s);
  constexpr double kStep = 1e-5;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 step(0.0);
    step[axis] = kStep;
    const Vec3 slope = (sample(current, p + step, t_s).velocity_m_s -
                        sample(current, p - step, t_s).velocity_m_s) /
                       (2.0 * kStep);
    EXPECT_LT(glm::length(slope - at.gradient_per_s[axis]), 1e-8) << name_of(current) << axis;
  }
  const Vec3 rate = (sample(current, p, t_s + kStep).velocity_m_s -
                     sample(current, p, t_s - kStep).velocity_m_s) /
                    (2.0 * kStep);
  EXPECT_LT(glm::length(rate - at.rate_m_s2), 1e-8) << name_of(current);
}

TEST(Current, UniformIsTheSameEverywhere) {
  const Current current = UniformCurrent{Vec3(0.3, 0.0, -0.2)};
  for (const Vec3& p : {Vec3(0.0), Vec3(1e5, -40.0, 3.0)})
    EXPECT_EQ(sample(current, p, 100.0).velocity_m_s, Vec3(0.3, 0.0, -0.2));
  EXPECT_EQ(name_of(current), "uniform");
}

TEST(Current, PowerLawHasThePublishedProfile) {
  const Current current = PowerLawCurrent{Vec3(2.0, 0.0, 0.0), 40.0};
  EXPECT_EQ(sample(current, Vec3(0.0, 0.0, 0.0), 0.0).velocity_m_s.x, 2.0);
  EXPECT_EQ(sample(current, Vec3(0.0, 3.0, 0.0), 0.0).velocity_m_s.x, 2.0);
  // Half way down, 0.5^(1/7) = 0.905724.
  EXPECT_NEAR(sample(current, Vec3(9.0, -20.0, 9.0), 0.0).velocity_m_s.x, 2.0 * 0.905724, 2e-6);
  EXPECT_EQ(sample(current, Vec3(0.0, -40.0, 0.0), 0.0).velocity_m_s.x, 0.0);
  EXPECT_EQ(sample(current, Vec3(0.0, -41.0, 0.0), 0.0).velocity_m_s.x, 0.0);
}

TEST(Current, PowerLawsGradientStaysFiniteAtTheBed) {
  const Current current = PowerLawCurrent{Vec3(2.0, 0.0, 0.0), 40.0};
  for (const double height_m : {0.0, 1e-300, 1e-9, 1e-3, 0.1})
    EXPECT_LT(sample(current, Vec3(0.0, height_m - 40.0, 0.0), 0.0).gradient_per_s[1].x, 50.0);
}

TEST(Current, LinearGoesFromTheSurfaceToItsDepthAndStaysBelow) {
  const Current current = LinearCurrent{Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.5), 20.0};
  EXPECT_EQ(sample(current, Vec3(0.0, -5.0, 0.0), 0.0).velocity_m_s, Vec3(0.75, 0.0, 0.125));
  EXPECT_EQ(sample(current, Vec3(0.0, -90.0, 0.0), 0.0).velocity_m_s, Vec3(0.0, 0.0, 0.5));
  EXPECT_EQ(sample(current, Vec3(0.0, 2.0, 0.0), 0.0).velocity_m_s, Vec3(1.0, 0.0, 0.0));
}

TEST(Current, DerivativesAreThoseOfTheVelocity) {
  expect_derivatives(PowerLawCurrent{Vec3(2.0, 0.0, -1.0), 40.0}, Vec3(1.0, -13.0, 2.0), 3.0);
  expect_derivatives(LinearCurrent{Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, 0.5), 20.0},
                     Vec3(1.0, -13.0, 2.0), 3.0);
  GridCurrent grid = linear_grid();
  for (std::size_t i = 0; i < grid.velocities_m_s.size(); ++i)
    grid.velocities_m_s[i] = static_cast<float>(random_uniform({1, 2, 3}, i));
  expect_derivatives(grid, Vec3(0.3, -5.1, 0.4), 12.3);
}

TEST(Current, AGridGivesALinearFlowExactlyInsideAndClampsOutside) {
  const Current current = linear_grid();
  ASSERT_TRUE(check_current(current).ok());
  for (std::uint64_t i = 0; i < 1000; ++i) {
    const auto at = [&](std::uint64_t n) { return random_uniform({7, 0, n}, i) * 1.6 - 0.3; };
    const Vec3 p(-4.0 + 8.0 * at(0), -8.0 + 8.0 * at(1), -1.0 + 3.0 * at(2));
    const double t_s = 10.0 + 10.0 * at(3);
    const Vec3 inside = glm::clamp(p, Vec3(-4.0, -8.0, -1.0), Vec3(4.0, 0.0, 2.0));
    const Vec3 expected = linear_flow(inside, std::clamp(t_s, 10.0, 20.0));
    EXPECT_LT(glm::length(sample(current, p, t_s).velocity_m_s - expected), 1e-12);
  }
  const CurrentSample outside = sample(current, Vec3(99.0), 99.0);
  EXPECT_EQ(outside.rate_m_s2, Vec3(0.0));
  EXPECT_EQ(outside.gradient_per_s, Mat3(0.0));
}

TEST(Current, AGridReadsFromItsFileSteadyOrNot) {
  const neritic::test::ScratchFolder folder;
  const GridCurrent grid = linear_grid();
  ASSERT_TRUE(write_npy(folder / "flow.npy", grid.velocities_m_s, {3, 3, 4, 5, 3}).ok());
  const auto read = read_grid_current(folder / "flow.npy", grid.axes);
  ASSERT_TRUE(read.ok()) << read.error().message;
  EXPECT_EQ(read->velocities_m_s, grid.velocities_m_s);
  EXPECT_EQ(read->counts, grid.counts);
  const std::vector<double> one{0.5, 0.0, -0.25};
  ASSERT_TRUE(write_npy(folder / "flow.npy", one, {1, 1, 1, 3}).ok());
  const auto steady = read_grid_current(folder / "flow.npy", {});
  ASSERT_TRUE(steady.ok()) << steady.error().message;
  EXPECT_EQ(sample(*steady, Vec3(5.0), 9.0).velocity_m_s, Vec3(0.5, 0.0, -0.25));
}

TEST(Current, WhatAGridsFileMayNotHaveIsNamed) {
  const neritic::test::ScratchFolder folder;
  const auto error_of = [&](std::initializer_list<std::size_t> shape, double last,
                            const CurrentGridAxes& axes) {
    std::size_t count = 1;
    for (const std::size_t extent : shape) count *= extent;
    std::vector<double> values(count, 0.5);
    if (count > 0) values.back() = last;
    EXPECT_TRUE(write_npy(folder / "flow.npy", values, shape).ok());
    const auto read = read_grid_current(folder / "flow.npy", axes);
    EXPECT_FALSE(read.ok());
    return read.ok() ? "" : read.error().message;
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != text.npos && text.find('\n') == text.npos;
  };
  EXPECT_TRUE(has(error_of({2, 2, 3}, 0.0, {}), "shape (2, 2, 3); accepted: [time, y, z, x, 3]"));
  EXPECT_TRUE(has(error_of({2, 2, 2, 2}, 0.0, {}), "shape (2, 2, 2, 2)"));
  EXPECT_TRUE(has(error_of({2, 0, 2, 3}, 0.0, {}), "0 samples along axis 1"));
  EXPECT_TRUE(has(error_of({2, 1, 2, 3}, kNan, {}), "sample 3: found nan m/s"));
  EXPECT_TRUE(has(error_of({2, 1, 2, 3}, 1e9, {}), "accepted: up to 100 m/s"));
  EXPECT_TRUE(has(error_of({1, 1, 1, 3}, 0.0, {.spacing_m = Vec3(1.0, 0.0, 1.0)}), "spacing_m"));
  EXPECT_TRUE(has(error_of({1, 1, 1, 3}, 0.0, {.interval_s = -1.0}), "interval_s: found -1"));
}

TEST(Current, ValuesThatCannotBeAreRefused) {
  EXPECT_FALSE(check_current(UniformCurrent{Vec3(kNan, 0.0, 0.0)}).ok());
  EXPECT_FALSE(check_current(UniformCurrent{Vec3(101.0, 0.0, 0.0)}).ok());
  EXPECT_FALSE(check_current(PowerLawCurrent{Vec3(1.0), 0.0}).ok());
  EXPECT_FALSE(check_current(PowerLawCurrent{Vec3(1.0), 10.0, 0.0}).ok());
  EXPECT_FALSE(check_current(LinearCurrent{Vec3(1.0), Vec3(0.0), -1.0}).ok());
  EXPECT_TRUE(check_current(UniformCurrent{Vec3(5.0, 0.0, 0.0)}).ok());
}

}  // namespace
}  // namespace neritic::sim
