// `neritic register`: marks of a pool, measured by a suit with z up, become a scene's [lab] table
// that the scene reads.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/scene.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/commands.hpp"

namespace neritic::tools {
namespace {

using ::testing::HasSubstr;

std::string said_by(const RegisterFlags& flags, Status* status) {
  ::testing::internal::CaptureStdout();
  *status = run_register(flags);
  return ::testing::internal::GetCapturedStdout();
}

TEST(RegisterCommand, MarksOfASuitsFrameBecomeALabThatTheSceneReads) {
  const test::ScratchFolder folder;
  // The lab's x is the scene's south, its z is up, its origin lies at (10, -3, 5).
  const auto scene_of = [](const Vec3& lab) {
    return Vec3(10.0 + lab.y, -3.0 + lab.z, 5.0 + lab.x);
  };
  std::string text = "mark,lab_x_m,lab_y_m,lab_z_m,scene_x_m,scene_y_m,scene_z_m\n";
  for (const Vec3& lab : {Vec3(0, 0, 0), Vec3(2, 0, 0.5), Vec3(2, 3, 0), Vec3(0, 3, 1)}) {
    const Vec3 there = scene_of(lab);
    text += fmt::format("a,{},{},{},{},{},{}\n", lab.x, lab.y, lab.z, there.x, there.y, there.z);
  }
  ASSERT_TRUE(write_text(folder / "marks.csv", text).ok());
  Status status;
  const std::string table =
      said_by({.file = (folder / "marks.csv").string(), .lab_up = "z"}, &status);
  ASSERT_TRUE(status.ok()) << status.error().message;
  EXPECT_THAT(table, HasSubstr("4 pairs, residual 0.0000 m rms"));
  ASSERT_TRUE(write_text(folder / "scene.toml", table).ok());
  const auto scene = scene::load_scene(folder / "scene.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  ASSERT_TRUE(scene->world_from_lab.has_value());
  for (const Vec3& lab : {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1), Vec3(-4, 2, 7)})
    EXPECT_LT(glm::distance(*scene->world_from_lab * lab, scene_of(lab)), 1e-6);
}

TEST(RegisterCommand, LinesThatFailNameWhereAndWhatIsAccepted) {
  const test::ScratchFolder folder;
  const auto error_of = [&](const std::string& rows, bool tilted = false) {
    EXPECT_TRUE(write_text(folder / "m.csv", rows).ok());
    Status status;
    said_by({.file = (folder / "m.csv").string(), .tilted = tilted}, &status);
    return status.ok() ? std::string() : status.error().message;
  };
  const std::string head = "lab_x_m,lab_y_m,lab_z_m,scene_x_m,scene_y_m,scene_z_m\n";
  EXPECT_THAT(error_of("a,b\n1,2\n"), HasSubstr("accepted: lab_x_m, lab_y_m"));
  EXPECT_THAT(error_of(head + "0,0,0,1,2,3\n1,,0,1,2,3\n"), HasSubstr("m.csv:3: lab_y_m"));
  EXPECT_THAT(error_of(head + "0,0,0,1,2,3\n"), HasSubstr("m.csv: found 1 pairs"));
  // x is exchanged with z: a mirrored frame.
  EXPECT_THAT(error_of(head + "0,0,0,0,0,0\n1,0,0,0,0,1\n0,0,2,2,0,0\n0,3,1,1,3,0\n", true),
              HasSubstr("mirrored frame"));
}

// The frame is judged before it is printed.
TEST(RegisterCommand, PairsThatDoNotFitAreRefusedWithTheReasonAndNothingOnStdout) {
  const test::ScratchFolder folder;
  std::string said;
  const auto error_of = [&](const std::string& rows) {
    EXPECT_TRUE(write_text(folder / "m.csv",
                           "lab_x_m,lab_y_m,lab_z_m,scene_x_m,scene_y_m,scene_z_m\n" + rows)
                    .ok());
    Status status;
    ::testing::internal::CaptureStderr();
    EXPECT_EQ(said_by({.file = (folder / "m.csv").string()}, &status), "");
    said = ::testing::internal::GetCapturedStderr();
    EXPECT_FALSE(status.ok()) << rows;
    return status.ok() ? std::string() : status.error().message;
  };
  EXPECT_THAT(error_of("0,0,0,0,0,0\n1000,0,0,1,0,0\n0,0,1000,0,0,1\n"),
              HasSubstr("the lab's columns are in millimetres, accepted are metres"));
  EXPECT_THAT(said, HasSubstr("3 pairs, residual 666"));
  EXPECT_THAT(error_of("0,0,0,0,0,0\n1,0,0,3.2808,0,0\n0,0,1,0,0,3.2808\n"),
              HasSubstr("the scene's columns are in feet"));
  // Upside down: half a turn about x.
  EXPECT_THAT(error_of("0,0,0,0,0,0\n1,0,0,1,0,0\n0,2,0,0,-2,0\n0,0,3,0,0,-3\n"),
              HasSubstr("a frame whose y does not point up"));
  // Left-handed, with y down.
  EXPECT_THAT(error_of("0,0,0,0,0,0\n1,0,0,1,0,0\n0,2,0,0,-2,0\n0,0,3,0,0,3\n"),
              HasSubstr("mirrored"));
  EXPECT_THAT(error_of("0,0,0,0,0,0\n1,0,0,1,0,0\n0,0,1,0,0,1\n2,0,2,5,1,4\n"),
              HasSubstr("the pairs do not fit"));
}

}  // namespace
}  // namespace neritic::tools
