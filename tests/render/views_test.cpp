#include "engine/render/views.hpp"

#include <gtest/gtest.h>

#include "engine/core/intrinsics.hpp"

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

}  // namespace
}  // namespace neritic::render
