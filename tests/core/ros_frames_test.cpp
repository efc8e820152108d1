#include "engine/core/ros_frames.hpp"

#include <gtest/gtest.h>

namespace neritic {
namespace {

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT(glm::length(a - b), 1e-12) << a.x << " " << a.y << " " << a.z;
}

// A point that a body carries is at the same place, whichever axes say where.
TEST(RosFrames, AttitudesAgreeWithVectors) {
  const Quat world_from_model_axes = glm::normalize(Quat(0.3, -0.5, 0.2, 0.7));
  const Vec3 in_model(1.0, 2.0, 3.0);
  const Vec3 in_world = world_from_model_axes * in_model;
  expect_near(ros::enu_from_body(world_from_model_axes) * ros::flu_from_body(in_model),
              ros::enu_from_world(in_world));
  const Quat back = ros::body_from_enu(ros::enu_from_body(world_from_model_axes));
  EXPECT_NEAR(std::abs(glm::dot(back, world_from_model_axes)), 1.0, 1e-12);
  const Vec3 optical(in_model.x, -in_model.y, -in_model.z);
  expect_near(ros::enu_from_optical(world_from_model_axes) * optical,
              ros::enu_from_world(in_world));
}

TEST(RosFrames, NamedDirectionsAreThemselves) {
  expect_near(ros::enu_from_world({0, 0, -1}), {0, 1, 0});  // north
  expect_near(ros::enu_from_world({0, 1, 0}), {0, 0, 1});   // up
  expect_near(ros::enu_from_ned({1, 0, 0}), {0, 1, 0});
  expect_near(ros::flu_from_marine({0, 0, 1}), {0, 0, -1});
  expect_near(ros::flu_from_body({0, 0, -1}), {1, 0, 0});  // forward
  const Vec3 v(0.1, -2.5, 3e-9);
  EXPECT_EQ(ros::world_from_enu(ros::enu_from_world(v)), v);  // every bit
  EXPECT_EQ(ros::body_from_flu(ros::flu_from_body(v)), v);
  // A level body that heads east: no rotation in ROS.
  const Quat east = glm::angleAxis(radians(-90.0), Vec3(0, 1, 0));
  EXPECT_NEAR(std::abs(ros::enu_from_body(east).w), 1.0, 1e-12);
}

}  // namespace
}  // namespace neritic
