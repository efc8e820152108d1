#include <gtest/gtest.h>

#include <limits>

#include "engine/core/random.hpp"
#include "engine/sim/height_grid.hpp"
#include "tests/sim/bodies.hpp"

namespace neritic::sim {
namespace {

using test::box_mesh, test::Mesh, test::sheet_mesh, test::world_of;

// Where a ray enters the box [-half, half], by slabs; negative where it misses.
double box_distance(const Vec3& origin, const Vec3& direction, const Vec3& half) {
  double from = 0.0, to = 1e30;
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (-half[axis] - origin[axis]) / direction[axis];
    const double b = (half[axis] - origin[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return from <= to ? from : -1.0;
}

Vec3 random_direction(std::uint64_t stream, std::uint64_t i) {
  for (std::uint64_t k = 0;; ++k) {
    const auto uniform = [&](std::uint64_t n) {
      return 2.0 * random_uniform({stream, n, k}, i) - 1.0;
    };
    const Vec3 v(uniform(0), uniform(1), uniform(2));
    const double length = glm::length(v);
    if (length > 0.1 && length < 1.0) return v / length;
  }
}

TEST(Ray, MeetsABoxWhereTheSlabsSay) {
  const Vec3 half(1.0, 0.5, 2.0);
  for (const int cuts : {1, 9}) {
    const StaticWorld world = world_of(box_mesh(half, cuts), {}, {.label = 3});
    int hits = 0;
    for (std::uint64_t i = 0; i < 5000; ++i) {
      const Vec3 origin = 6.0 * random_direction(1, i);
      const Vec3 direction = glm::normalize(2.0 * random_direction(2, i) - origin);
      const double expected = box_distance(origin, direction, half);
      const auto hit = world.cast(origin, direction, 100.0);
      ASSERT_EQ(hit.has_value(), expected >= 0.0) << i;
      if (!hit) continue;
      ++hits;
      ASSERT_NEAR(hit->distance_m, expected, 1e-6);
      EXPECT_EQ(hit->label, 3u);
      EXPECT_LT(glm::dot(hit->normal, direction), 0.0);
      EXPECT_NEAR(glm::length(hit->normal), 1.0, 1e-12);
    }
    EXPECT_GT(hits, 500);
  }
}

TEST(Ray, NoneSlipsThroughTheSeams) {
  // From within a closed mesh every ray hits, through edges and corners too.
  const Mesh box = box_mesh(Vec3(1.0), 5);
  const StaticWorld world = world_of(box);
  for (std::uint64_t i = 0; i < 3000; ++i)
    ASSERT_TRUE(world.cast(Vec3(0.0), random_direction(3, i), 10.0).has_value()) << i;
  for (const Vec3f& corner : box.vertices_m) {
    const auto hit = world.cast(Vec3(0.0), glm::normalize(Vec3(corner)), 10.0);
    ASSERT_TRUE(hit.has_value());
    EXPECT_NEAR(hit->distance_m, glm::length(Vec3(corner)), 1e-9);
  }
}

TEST(Ray, ASeabedOfHeightsIsItsOwnMesh) {
  constexpr std::uint32_t kSide = 33;
  Mesh mesh = sheet_mesh(8.0, 8.0, kSide - 1);
  std::vector<float> heights;
  for (std::size_t i = 0; i < mesh.vertices_m.size(); ++i) {
    mesh.vertices_m[i].y = static_cast<float>(random_uniform({4, 0, 0}, i));
    heights.push_back(mesh.vertices_m[i].y);
  }
  StaticWorldBuilder builder;
  const auto field = builder.add_heights(kSide, kSide, 0.5, heights, "seabed");
  ASSERT_TRUE(field.ok());
  builder.place(*field, {}, {});
  const StaticWorld grid = builder.build(), triangles = world_of(mesh);
  int hits = 0;
  for (std::uint64_t i = 0; i < 5000; ++i) {
    const Vec3 origin = 12.0 * random_direction(5, i);
    const Vec3 direction = random_direction(6, i);
    const auto a = grid.cast(origin, direction, 60.0), b = triangles.cast(origin, direction, 60.0);
    ASSERT_EQ(a.has_value(), b.has_value()) << i;
    if (!a) continue;
    ++hits;
    ASSERT_NEAR(a->distance_m, b->distance_m, 1e-9) << i;
    ASSERT_LT(glm::length(a->normal - b->normal), 1e-9);
  }
  EXPECT_GT(hits, 300);
}

TEST(Ray, StraightDownMeetsTheHeightAndFallsThroughHoles) {
  constexpr float kNone = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> heights{0, 1, 2, 3, 0, kNone, 2, 3, 0, 1, 2, 3};
  const auto grid = HeightGrid::build(4, 3, 1.0, heights, "seabed");
  ASSERT_TRUE(grid.ok());
  // Heights rise by one a metre along x; columns are at -1.5 to 1.5.
  EXPECT_NEAR(*grid->height(1.25, 0.3), 2.75, 1e-12);
  EXPECT_FALSE(grid->height(-0.5, 0.0).has_value());   // the missing sample
  EXPECT_FALSE(grid->height(-0.6, 0.05).has_value());  // in a triangle that needs it
  EXPECT_FALSE(grid->height(1.6, 0.0).has_value());
  EXPECT_TRUE(grid->height(1.5, 1.0).has_value() || grid->height(1.4999, 0.9999).has_value());
}

TEST(Ray, LengthIsALimitAndTheNearestWins) {
  StaticWorldBuilder builder;
  const Mesh sheet = sheet_mesh(5.0, 5.0, 2);
  const auto shape = builder.add_mesh(sheet.vertices_m, sheet.indices, "sheet");
  ASSERT_TRUE(shape.ok());
  for (std::uint32_t i = 0; i < 10; ++i)
    builder.place(*shape, {{Vec3(0.0, -1.0 - i, 0.0), Quat(1.0, 0.0, 0.0, 0.0)}}, {.label = i});
  const StaticWorld world = builder.build();
  const auto hit = world.cast(Vec3(0.3, -3.5, 0.2), Vec3(0.0, -1.0, 0.0), 100.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_EQ(hit->label, 3u);
  EXPECT_NEAR(hit->distance_m, 0.5, 1e-12);
  EXPECT_FALSE(world.cast(Vec3(0.3, -3.5, 0.2), Vec3(0.0, -1.0, 0.0), 0.49).has_value());
}

TEST(Ray, AHundredKilometresOutIsAsPrecise) {
  const Vec3 far_m(1e5, -40.0, -7e4);
  const StaticWorld world = world_of(box_mesh(Vec3(1.0)), {{far_m, Quat(1.0, 0.0, 0.0, 0.0)}, 3.0});
  const auto hit = world.cast(far_m + Vec3(0.1, 10.0, 0.2), Vec3(0.0, -1.0, 0.0), 50.0);
  ASSERT_TRUE(hit.has_value());
  EXPECT_NEAR(hit->distance_m, 7.0, 1e-9);
}

}  // namespace
}  // namespace neritic::sim
