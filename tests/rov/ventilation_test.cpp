#include "rov/ventilation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace neritic::rov {
namespace {

// The published formula by itself, 1 - 0.675 (1 - 0.769 h / R)^1.258: a thrust of 0.325 with the
// shaft at the surface, worked out for other depths.
TEST(RovVentilation, AShaftUnderTheSurfaceHasThePublishedShare) {
  const double published[][2] = {
      {0.0, 0.325}, {0.25, 0.4840}, {0.5, 0.6337}, {1.0, 0.8932}, {1.3, 1.0}};
  for (const auto& [radii, share] : published)
    for (const double radius_m : {0.038, 1.0, 3.0})
      EXPECT_NEAR(thrust_share(radii * radius_m, radius_m, 0.0), share, 5e-3) << radii;
  for (double radii = 0.0; radii < 1.3; radii += 0.05)
    EXPECT_NEAR(thrust_share(radii, 1.0, 0.0), 1.0 - 0.675 * std::pow(1.0 - 0.769 * radii, 1.258),
                2e-4)
        << radii;
  EXPECT_EQ(thrust_share(2.0, 1.0, 0.0), 1.0);
}

// Half of the disc is out with the shaft at the surface; with it half a radius above, 0.1955 of the
// disc is still in, which a circle's segment has by its closed form.
TEST(RovVentilation, AboveItTheSubmergedPartOfTheDiscDecides) {
  EXPECT_NEAR(thrust_share(-0.5, 1.0, 0.0), 0.325 * 2.0 * 0.19550, 1e-5);
  EXPECT_EQ(thrust_share(-1.0, 1.0, 0.0), 0.0);
  EXPECT_EQ(thrust_share(-5.0, 1.0, 0.0), 0.0);
  // A lying disc is out sooner, and stays as far in as its nozzle is long.
  EXPECT_EQ(thrust_share(-0.5, 1.0, 1.0), 0.0);
  EXPECT_NEAR(thrust_share(-0.25, 1.0, -1.0), thrust_share(-0.5, 1.0, 0.0), 1e-12);
}

TEST(RovVentilation, ItGrowsWithTheDepthWithoutAJump) {
  for (const double down : {0.0, 0.6, 1.0}) {
    double before = 0.0;
    for (double depth = -1.5; depth < 1.6; depth += 1e-3) {
      const double share = thrust_share(depth, 1.0, down);
      EXPECT_GE(share, before);
      EXPECT_LT(share - before, 3e-3) << depth;
      before = share;
    }
    EXPECT_EQ(before, 1.0);
  }
}

TEST(RovVentilation, ExtremesStayFrom0To1) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (const double depth : {0.0, -0.0, 1e-320, -1e-320, 1e300, -1e300, infinite, -infinite, nan})
    for (const double radius : {0.0, 1e-320, 1e300, -1.0, infinite, nan})
      for (const double down : {0.0, 1.0, -1.0, 1.5, nan}) {
        const double share = thrust_share(depth, radius, down);
        EXPECT_TRUE(share >= 0.0 && share <= 1.0) << depth << ' ' << radius << ' ' << down;
      }
  // Without a radius it is in the water or in the air.
  EXPECT_EQ(thrust_share(0.0, 0.0, 0.0), 1.0);
  EXPECT_EQ(thrust_share(-1e-9, 0.0, 0.0), 0.0);
}

}  // namespace
}  // namespace neritic::rov
