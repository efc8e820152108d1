// Hits within a step: one impulse at their own place and time, wherever in the step they fall.
#include <gtest/gtest.h>

#include "tests/sim/bodies.hpp"

namespace neritic::sim {
namespace {

using test::Body, test::make_box_body, test::step;

constexpr double kHitStep_s = 1.0 / 240.0;
const Quat kUpright(1.0, 0.0, 0.0, 0.0);

// A tilted box meets a rough floor edge first, at 1.5 m/s along it and 1 m/s down, nothing else
// acting: its motion afterwards is the same for every height it starts at within a step's way.
TEST(Hit, IsTheSameWhereverInTheStepItFalls) {
  const StaticWorld floor = test::flat_seabed({.friction = 0.3});
  const Quat tilt = glm::angleAxis(0.4, glm::normalize(Vec3(1.0, 0.0, 0.3)));
  Twist first;
  for (int i = 0; i < 20; ++i) {
    Body box = make_box_body({0.23, 0.14, 0.29}, 13.5, {Vec3(0.0), tilt});
    box.force_n = Vec3(0.0);
    double lowest_m = 0.0;
    for (const Vec3& p : box.shape.parts()[0].core_m)
      lowest_m = std::min(lowest_m, (tilt * p).y - box.shape.parts()[0].radius_m);
    // 4.2 mm a step.
    box.motion.world_from_body.position_m.y = -lowest_m + 1e-4 + 2.0e-4 * i;
    const Vec3 velocity_m_s(1.5, -1.0, 0.2);
    box.motion.velocity.linear = glm::conjugate(tilt) * velocity_m_s;
    for (int s = 0; s < 2 && !box.report.touched; ++s) step(box, floor, kHitStep_s);
    ASSERT_TRUE(box.report.touched) << i;
    const Pose& pose = box.motion.world_from_body;
    const Vec3 linear = pose.rotation * box.motion.velocity.linear,
               angular = box.motion.velocity.angular;
    EXPECT_GT(linear.y, -0.9) << i;
    EXPECT_GT(glm::length(angular), 0.5) << i;
    if (i == 0) first = {linear, angular};
    EXPECT_LT(glm::distance(linear, first.linear), 2e-3) << i;
    EXPECT_LT(glm::distance(angular, first.angular), 2e-3) << i;
  }
}

// Heights over time by the closed form, to first order in the step: up and down again takes 2 v /
// g, each time e v.
TEST(Hit, ABallBouncesInTheClosedFormsTime) {
  constexpr double kBounce = 0.6, kFall_m = 1.0, kRadius_m = 0.1;
  const StaticWorld floor = test::flat_seabed({.friction = 0.0, .restitution = kBounce});
  BodyShape shape;
  shape.add_sphere(Vec3(0.0), kRadius_m);
  for (const double step_s : {1.0 / 60.0, 1.0 / 240.0, 1.0 / 960.0}) {
    Body ball = test::make_body(shape, test::mass_of(10.0, Vec3(0.04)),
                                {Vec3(0.2, kRadius_m + kFall_m, 0.3), kUpright});
    ball.force_n = Vec3(0.0, -10.0, 0.0);
    double error_m = 0.0;
    for (int i = 1; i * step_s < 4.0; ++i) {
      step(ball, floor, step_s);
      double since_s = i * step_s - std::sqrt(2.0 * kFall_m), up_m_s = kBounce * std::sqrt(2.0);
      double height_m = kFall_m - 0.5 * i * step_s * i * step_s;
      if (since_s >= 0.0) {
        for (; since_s > 2.0 * up_m_s; up_m_s *= kBounce) since_s -= 2.0 * up_m_s;
        height_m = up_m_s * since_s - 0.5 * since_s * since_s;
      }
      const double now_m = ball.motion.world_from_body.position_m.y - kRadius_m;
      error_m = std::max(error_m, std::abs(now_m - height_m));
    }
    EXPECT_LT(error_m, 2.0 * step_s) << step_s;
  }
}

// So many hits that a step cannot be cut at each: a ball in a slot, at a thousand times its width a
// second.
TEST(Hit, AsManyAsTheyAreStayInTheSlotAndGainNoEnergy) {
  StaticWorldBuilder builder;
  const test::Mesh wall = test::box_mesh({0.2, 1.0, 1.0});
  const auto shape = builder.add_mesh(wall.vertices_m, wall.indices, "wall");
  ASSERT_TRUE(shape.ok());
  for (const double side : {-1.0, 1.0})
    builder.place(*shape, {{Vec3(side * 0.32, 0.0, 0.0), kUpright}}, {.restitution = 1.0});
  const StaticWorld slot = builder.build();
  BodyShape sphere;
  sphere.add_sphere(Vec3(0.0), 0.1);
  Body ball = test::make_body(sphere, test::mass_of(10.0, Vec3(0.04)), {Vec3(0.0), kUpright});
  ball.motion.velocity.linear.x = 40.0;
  for (int i = 0; i < 240; ++i) {
    step(ball, slot, kHitStep_s);
    ASSERT_LT(std::abs(ball.motion.world_from_body.position_m.x), 0.03) << i;
    ASSERT_LE(glm::length(ball.motion.velocity.linear), 40.0 * (1.0 + 1e-9)) << i;
  }
}

}  // namespace
}  // namespace neritic::sim
