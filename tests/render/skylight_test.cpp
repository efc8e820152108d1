// The light from above in a grid of cells: open water has all of it, a closed room none, and under
// a roof it falls as rays to the sky say. Broken triangles count for nothing.
#include "engine/render/skylight.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "shared/phase.h"

namespace neritic::render {
namespace {

const scene::Skylight kBox{.low_m = {-6, -12, -6}, .high_m = {6, -4, 6}, .cell_m = 0.4};

void add_wall(std::vector<WorldTriangle>& out, const Vec3& corner, const Vec3& a, const Vec3& b) {
  out.push_back({corner, corner + a, corner + a + b});
  out.push_back({corner, corner + a + b, corner + b});
}

// Of 4 x 3 x 4 m round (0, -9.5, 0), turned about the vertical, so that walls slant through cells.
std::vector<WorldTriangle> room(double turn_rad) {
  std::vector<WorldTriangle> out;
  const Vec3 x(4, 0, 0), y(0, 3, 0), z(0, 0, 4), low(-2, -11, -2);
  add_wall(out, low, x, z);
  add_wall(out, low + y, x, z);
  add_wall(out, low, x, y);
  add_wall(out, low + z, x, y);
  add_wall(out, low, y, z);
  add_wall(out, low + x, y, z);
  const Quat turn = glm::angleAxis(turn_rad, Vec3(0, 1, 0));
  for (WorldTriangle& t : out)
    for (Vec3& corner : t) corner = turn * corner;
  return out;
}

TEST(Skylight, OpenWaterHasAllOfIt) {
  const SkylightGrid grid = skylight_grid(kBox, {});
  EXPECT_EQ(grid.open.size(), 30u * 20 * 30);
  for (const float open : grid.open) ASSERT_NEAR(open, 1.0f, 1e-5f);
  EXPECT_EQ(grid.at({100.0, -5.0, 0.0}), 1.0);
  EXPECT_EQ(grid.at({std::numeric_limits<double>::quiet_NaN(), 0.0, 0.0}), 1.0);
}

TEST(Skylight, ClosedRoomIsDarkHoweverItIsTurned) {
  for (const double turn_rad : {0.05, 0.2, 0.5, 0.785}) {
    const SkylightGrid grid = skylight_grid(kBox, room(turn_rad));
    for (double y = -10.4; y <= -8.6; y += 0.3)
      for (double x = -1.2; x <= 1.2; x += 0.3)
        ASSERT_LT(grid.at({x, y, 0.3}), 0.05) << x << " " << y << " turned " << turn_rad;
    EXPECT_NEAR(grid.at({0.0, -5.0, 0.0}), 1.0, 0.01) << "above the room";
  }
}

// A wide roof at -6 m covers x < 0: at its edge half of the sky is left, and far below it the sky
// beyond the edge. Integrals of the same radiance over the directions that pass the edge.
TEST(Skylight, RoofTakesTheSkyBehindItsEdge) {
  std::vector<WorldTriangle> roof;
  add_wall(roof, {-500, -6, -500}, {500, 0, 0}, {0, 0, 1000});
  // The box's own walls are open water, so the roof must end inside it nowhere else.
  const scene::Skylight wide{.low_m = {-40, -12, -40}, .high_m = {40, -4, 40}, .cell_m = 0.4};
  const SkylightGrid grid = skylight_grid(wide, roof);
  for (const double x : {-3.0, -1.5, 0.0, 1.5, 3.0})
    for (const double depth_m : {1.2, 2.4, 4.4}) {
      double seen = 0.0, all = 0.0;
      for (int i = 0; i < 400; ++i)
        for (int k = 0; k < 400; ++k) {
          const double cosine = (i + 0.5) / 400, turn = 2.0 * kPi * (k + 0.5) / 400;
          const double across_m =
              x + depth_m * std::sqrt(1.0 - cosine * cosine) / cosine * std::cos(turn);
          const double weight =
              shared::henyey_greenstein(static_cast<float>(cosine), shared::kDiffuseG);
          all += weight;
          if (across_m > 0.0) seen += weight;
        }
      EXPECT_NEAR(grid.at({x, -6.0 - depth_m, 0.0}), seen / all, 0.08)
          << x << " m, " << depth_m << " m below";
    }
}

TEST(Skylight, ThinThingsTakeLittle) {
  std::vector<WorldTriangle> rail;
  add_wall(rail, {-5, -8, 0}, {10, 0, 0}, {0, 0.02, 0});
  const SkylightGrid grid = skylight_grid(kBox, rail);
  for (const float open : grid.open) ASSERT_GT(open, 0.8f);
}

TEST(Skylight, BrokenAndHugeTrianglesAreHarmless) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInf = std::numeric_limits<double>::infinity();
  std::vector<WorldTriangle> broken{{Vec3(kNan, 0, 0), Vec3(0, -8, 0), Vec3(1, -8, 0)},
                                    {Vec3(kInf, 0, 0), Vec3(0, -8, 0), Vec3(1, -8, 0)},
                                    {Vec3(0, -8, 0), Vec3(0, -8, 0), Vec3(0, -8, 0)},
                                    {Vec3(1e300), Vec3(-1e300), Vec3(0, 1e300, 0)}};
  const SkylightGrid grid = skylight_grid(kBox, broken);
  for (const float open : grid.open) {
    ASSERT_TRUE(std::isfinite(open));
    ASSERT_GE(open, 0.0f);
    ASSERT_LE(open, 1.0001f);
  }
}

TEST(Skylight, TheSameInputGivesTheSameBits) {
  const auto walls = room(0.3);
  EXPECT_EQ(skylight_grid(kBox, walls).open, skylight_grid(kBox, walls).open);
}

}  // namespace
}  // namespace neritic::render
