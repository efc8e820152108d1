// Limbs out of a table: names, times, angles; and what is wrong is said in one line.
#include "diver/limb_recording.hpp"

#include <gtest/gtest.h>

#include "diver/kinematics.hpp"
#include "tests/diver/bodies.hpp"

namespace neritic::diver {
namespace {

TEST(LimbRecording, ColumnsAreFoundByTheirSegmentsNames) {
  const auto r = read_limb_recording(
      "t_s,lower_leg_l_y_deg,note,head_z_deg\n2,-30,1,10\n3,-50,1,20\n5,-10,1,0\n", "k.csv");
  ASSERT_TRUE(r.ok()) << r.error().message;
  EXPECT_EQ(r->time_s, (std::vector<double>{0.0, 1.0, 3.0}));
  const auto deg = [&](double t, bool repeat, Segment segment) {
    const Vec3 rad = angles_of(r->at(t, repeat))[joint_of(segment)];
    return Vec3(degrees(rad.x), degrees(rad.y), degrees(rad.z));
  };
  EXPECT_NEAR(deg(0.0, false, kLeftLowerLeg).y, -30.0, 1e-9);
  EXPECT_NEAR(deg(0.5, false, kLeftLowerLeg).y, -40.0, 1e-9);
  EXPECT_NEAR(deg(2.0, false, kLeftLowerLeg).y, -30.0, 1e-9);
  EXPECT_NEAR(deg(2.0, false, kHead).z, 10.0, 1e-9);
  EXPECT_NEAR(deg(-1.0, false, kHead).z, 10.0, 1e-9);
  EXPECT_NEAR(deg(9.0, false, kHead).z, 0.0, 1e-9);
  EXPECT_NEAR(deg(3.5, true, kLeftLowerLeg).y, -40.0, 1e-9);  // again from the first
  EXPECT_NEAR(glm::length(deg(1.0, false, kRightUpperLeg)), 0.0, 1e-9);
}

TEST(LimbRecording, WhatIsWrongIsSaidInOneLine) {
  const struct {
    const char *text, *message;
  } wrong[] = {
      {"t_s,knee_deg\n0,1\n1,2\n", "angles such as upper_leg_l_y_deg"},
      {"head_y_deg\n1\n2\n", "t_s and angles"},
      {"t_s,pelvis_y_deg\n0,1\n1,2\n", "t_s and angles"},
      {"t_s,head_y_deg\n0,1\n", "found 1 rows; accepted: two or more"},
      {"t_s,head_y_deg\n0,1\n0,2\n", "k.csv:3: found time 0; accepted: times that rise"},
      {"t_s,head_y_deg\n0,1\n1,400\n", "k.csv:3: head_y_deg: found 400; accepted: -360 to 360"},
      {"# a suit\nt_s,head_y_deg\n0,1\n\n# slower\n1,nan\n", "k.csv:6: head_y_deg: found nan"}};
  for (const auto& one : wrong) {
    const auto r = read_limb_recording(one.text, "k.csv");
    ASSERT_FALSE(r.ok()) << one.text;
    EXPECT_NE(r.error().message.find(one.message), std::string::npos) << r.error().message;
    EXPECT_EQ(r.error().message.find('\n'), std::string::npos);
  }
}

}  // namespace
}  // namespace neritic::diver
