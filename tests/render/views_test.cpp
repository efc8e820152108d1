#include "engine/render/views.hpp"

#include <gtest/gtest.h>

#include "engine/core/intrinsics.hpp"
#include "engine/core/random.hpp"

namespace neritic::render {
namespace {

ViewSet one_view(const Pose& pose) {
  ViewSet set;
  set.width = 200;
  set.height = 100;
  ViewDesc view;
  view.world_from_view = view.next_world_from_view = pose;
  view.tangents = {-1.0, 1.0, -0.5, 0.5};
  view.near_m = 0.1;
  set.views.push_back(view);
  return set;
}

TEST(Views, PointProjectsToItsPixelAndDepth) {
  const Pose pose = look_at({1e5, -10.0, 2e4}, {1e5 + 3.0, -11.0, 2e4 - 8.0});
  const ViewSet set = one_view(pose);
  const shared::View view = gpu_views(set).front();
  const Intrinsics k = intrinsics_of(set.views[0].tangents, set.width, set.height);
  const Vec3 in_view{0.7, -0.3, -4.0};
  const Vec3 from_origin = pose * in_view - set.origin_m();
  const Vec4f clip = view.clip_from_origin * Vec4f(Vec3f(from_origin), 1.0f);
  const double u = (clip.x / clip.w * 0.5 + 0.5) * set.width,
               v = (clip.y / clip.w * 0.5 + 0.5) * set.height;
  EXPECT_NEAR(u, k.cx + k.fx * 0.7 / 4.0, 1e-3);
  EXPECT_NEAR(v, k.cy - k.fy * -0.3 / 4.0, 1e-3);
  EXPECT_NEAR(set.views[0].near_m / (clip.z / clip.w), 4.0, 1e-5);
  // The shading ray through that pixel meets the point at its planar depth.
  const Vec3f ray = view.ray_corner + float(u) * view.ray_dx + float(v) * view.ray_dy;
  EXPECT_LT(glm::length(Vec3(ray) * 4.0 - from_origin), 1e-4);
}

TEST(Views, SphereIsSeenExactlyWhenItReachesTheFrustum) {
  const ViewSet set = one_view({});
  EXPECT_TRUE(any_view_sees(set, {0, 0, -5}, 1.0));
  EXPECT_FALSE(any_view_sees(set, {0, 0, 5}, 1.0));
  EXPECT_TRUE(any_view_sees(set, {0, 0, 0.5}, 1.0));  // around the eye
  // Right plane x = -z: the centre at (6, 0, -5) lies 1 / sqrt(2) outside.
  EXPECT_TRUE(any_view_sees(set, {6, 0, -5}, 0.72));
  EXPECT_FALSE(any_view_sees(set, {6, 0, -5}, 0.69));
  // Top plane y = -z / 2: (0, 3.5, -5) lies 1 / sqrt(1.25) outside.
  EXPECT_TRUE(any_view_sees(set, {0, 3.5, -5}, 0.91));
  EXPECT_FALSE(any_view_sees(set, {0, 3.5, -5}, 0.88));
}

// Sides that lean shift each row of pixels; planes, rays and what is culled go with them.
TEST(Views, LeaningSidesShiftEachRow) {
  ViewSet set = one_view(look_at({5.0, -10.0, 2.0}, {8.0, -11.0, -6.0}));
  ViewDesc& desc = set.views[0];
  desc.lean = 0.4;
  const shared::View view = gpu_views(set).front();
  const Intrinsics k = intrinsics_of(desc.tangents, set.width, set.height);
  const auto pixel_of = [&](const Vec3& in_view) {
    const Vec3 from_origin = desc.world_from_view * in_view - set.origin_m();
    const Vec4f clip = view.clip_from_origin * Vec4f(Vec3f(from_origin), 1.0f);
    return glm::dvec2((clip.x / clip.w * 0.5 + 0.5) * set.width,
                      (clip.y / clip.w * 0.5 + 0.5) * set.height);
  };
  const Vec3 in_view{0.7, -0.3, -4.0};
  const glm::dvec2 at = pixel_of(in_view);
  EXPECT_NEAR(at.x, k.cx + k.fx * (0.7 / 4.0 - 0.4 * -0.3 / 4.0), 1e-3);
  EXPECT_NEAR(at.y, k.cy - k.fy * -0.3 / 4.0, 1e-3);
  const Vec3f ray = view.ray_corner + float(at.x) * view.ray_dx + float(at.y) * view.ray_dy;
  EXPECT_LT(glm::length(Vec3(ray) * 4.0 - (desc.world_from_view * in_view - set.origin_m())), 1e-4);
  // The right side is the plane x - 0.4 y = -z: at the top it lies at tangent 1.2, at the bottom at
  // 0.8.
  const auto sees = [&](const Vec3& center, double radius_m) {
    return any_view_sees(set, desc.world_from_view * center - set.origin_m(), radius_m);
  };
  EXPECT_TRUE(sees({1.15 * 5.0, 2.4, -5.0}, 0.01));
  EXPECT_FALSE(sees({0.9 * 5.0, -2.4, -5.0}, 0.01));
  // (6, 0, -5) lies 1 / sqrt(2.16) beyond it.
  EXPECT_TRUE(sees({6.0, 0.0, -5.0}, 0.69));
  EXPECT_FALSE(sees({6.0, 0.0, -5.0}, 0.67));
}

TEST(Math, LookAtFacesItsTargetForAnyDirection) {
  for (const Vec3& target : {Vec3(1, 2, 3), Vec3(0, 5, 0), Vec3(0, -5, 0), Vec3(-4, 0, 0)}) {
    const Pose pose = look_at(Vec3(0.0), target);
    EXPECT_LT(glm::length(pose.rotation * Vec3(0, 0, -1) - glm::normalize(target)), 1e-9);
  }
}

// Random boxes askew: one of which a point is seen is seen, and more are found to be out of sight
// than by the balls round them.
TEST(SphereCulling, ABoxIsSeenWhereAPointOfItIs) {
  ViewSet set = one_view({Vec3(5.0, -3.0, 2.0), from_yaw_pitch_roll(0.7, -0.4, 0.2)});
  set.within = HalfSpace{Vec3(0.0, -1.0, 0.0), -2.0};
  const SphereCulling culling(set);
  const MixedKey key(RandomKey{4});
  std::uint64_t drawn = 0;
  const auto within = [&](double low, double high) {
    return low + (high - low) * random_uniform(key, drawn++);
  };
  int seen = 0, by_ball = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 center_m(within(-6, 6), within(-6, 6), within(-6, 6));
    const Quat turn = from_yaw_pitch_roll(within(-3, 3), within(-1, 1), within(-3, 3));
    const Vec3 half_m(within(0, 0.3), within(0, 0.3), within(0, 2.0));
    const std::array<Vec3, 3> halves_m{turn * Vec3(half_m.x, 0, 0), turn * Vec3(0, half_m.y, 0),
                                       turn * Vec3(0, 0, half_m.z)};
    const double radius_m = glm::length(half_m);
    const bool box = culling.may_see_box(center_m, radius_m, halves_m, 0.0);
    seen += box;
    by_ball += culling.may_see(center_m, radius_m);
    const Vec3 at_m = center_m + within(-1, 1) * halves_m[0] + within(-1, 1) * halves_m[1] +
                      within(-1, 1) * halves_m[2];
    if (culling.may_see(at_m, 0.0)) {
      EXPECT_TRUE(box);
    }
    EXPECT_TRUE(!box || culling.may_see(center_m, radius_m));
    EXPECT_TRUE(!box || culling.may_see_box(center_m, radius_m + 0.1, halves_m, 0.1));
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(seen, 0.9 * by_ball);
}

// Random spheres: what a part of the planes, a line along x and a way between two places say of
// them is what all planes say of each.
TEST(SphereCulling, ItsShortcutsAgreeWithAllItsPlanes) {
  ViewSet set;
  for (const double x : {-0.032, 0.032}) {
    ViewDesc view;
    view.world_from_view = {Vec3(5.0 + x, -3.0, 2.0), from_yaw_pitch_roll(0.7, -0.4, 0.2)};
    view.tangents = {-1.0, 0.8 + x, -0.9, 1.1};
    set.views.push_back(view);
  }
  set.within = HalfSpace{Vec3(0.0, -1.0, 0.0), -2.0};
  const SphereCulling culling(set);
  const MixedKey key(RandomKey{3});
  std::uint64_t drawn = 0;
  const auto within = [&](double low, double high) {
    return low + (high - low) * random_uniform(key, drawn++);
  };
  const auto place = [&] { return Vec3(within(-6, 6), within(-6, 6), within(-6, 6)); };
  SphereCulling::Part part;
  int seen = 0, swept = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 ball_m = place();
    const double ball_radius_m = within(0.0, 1.0), radius_m = ball_radius_m * within(0.0, 0.5);
    EXPECT_EQ(culling.may_see(ball_m, ball_radius_m, part), culling.may_see(ball_m, ball_radius_m));
    const Vec3 way = place();
    const Vec3 in_it_m =
        ball_m + (ball_radius_m - radius_m) * within(0.0, 1.0) * way / glm::length(way);
    const bool may_see = culling.may_see(in_it_m, radius_m);
    seen += may_see;
    if (culling.may_see(ball_m, ball_radius_m, part)) {
      EXPECT_EQ(part.may_see(in_it_m, radius_m), may_see);
    } else {
      EXPECT_FALSE(may_see);
    }
    double low_m = -6.0, high_m = 6.0;
    const bool some = culling.narrow(ball_m, radius_m, low_m, high_m);
    if (culling.may_see(ball_m, radius_m)) {
      EXPECT_TRUE(some && ball_m.x >= low_m && ball_m.x <= high_m);
    }
    const Vec3 to_m = place();
    const bool may_see_between = culling.may_see_between(ball_m, to_m, radius_m);
    swept += may_see_between;
    if (culling.may_see(glm::mix(ball_m, to_m, within(0.0, 1.0)), radius_m)) {
      EXPECT_TRUE(may_see_between);
    }
  }
  EXPECT_GT(seen, 500);
  EXPECT_LT(swept, 15000);
}

}  // namespace
}  // namespace neritic::render
