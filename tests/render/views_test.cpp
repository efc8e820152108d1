#include "engine/render/views.hpp"

#include <gtest/gtest.h>

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

TEST(Math, LookAtFacesItsTargetForAnyDirection) {
  for (const Vec3& target : {Vec3(1, 2, 3), Vec3(0, 5, 0), Vec3(0, -5, 0), Vec3(-4, 0, 0)}) {
    const Pose pose = look_at(Vec3(0.0), target);
    EXPECT_LT(glm::length(pose.rotation * Vec3(0, 0, -1) - glm::normalize(target)), 1e-9);
  }
}

}  // namespace
}  // namespace neritic::render
