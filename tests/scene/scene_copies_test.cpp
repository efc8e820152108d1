// Copies of objects: their places, labels, files and scattering; what an offset moves.
#include <gtest/gtest.h>

#include <glm/gtc/matrix_transform.hpp>

#include "tests/scene/scene_texts.hpp"

namespace neritic::scene {
namespace {

constexpr const char* kWorldOfThree = R"(
[[objects]]
name = "a"
shape = "sphere"
position_m = [1, 2, 3]
copies = [[0, 0, 0], [1, 0, 0, 90], [2, 0, 0, 0, 3]]
scale = 2
[[objects]]
name = "b"
shape = "box"
on = "a"
position_m = [1, 0, 0]
[[cameras]]
position_m = [0.1, 0.2, 0.3]
look_at = "b"
)";

TEST(SceneLoad, CopiesCarryPlaceTurnAndScaleAndEachItsLabel) {
  const test::ScratchFolder scratch;
  const Scene scene = scene_of(scratch, kWorldOfThree);
  const Object& a = scene.objects[0];
  ASSERT_EQ(a.instance_count(), 3u);
  EXPECT_EQ(a.instance, 1);
  EXPECT_EQ(scene.objects[1].instance, 4);
  EXPECT_EQ(a.scale, Vec3(1.0));  // held by the copies
  const auto point = [&](std::size_t copy, const Vec3& p) {
    return Vec3(scene.world_from_copy(a, copy) * Vec4(p, 1.0));
  };
  expect_near(point(0, {0, 0, -1}), {1, 2, 1});
  expect_near(point(1, {0, 0, -1}), {0, 2, 3});
  expect_near(point(2, {0, 0, -1}), {3, 2, -3});
  EXPECT_EQ(scene.world_from_copy(scene.objects[1], 0)[3], Vec4(2, 2, 3, 1));
}

TEST(SceneLoad, AnOffsetMovesWhatIsFixedToTheWorldAndNothingElse) {
  const test::ScratchFolder scratch;
  const Vec3 offset(100000.0, 0.0, -100000.0);
  const Scene here = scene_of(scratch, kWorldOfThree);
  const Scene there = scene_of(scratch, kWorldOfThree, {offset});
  expect_near(there.objects[0].mount.pose.position_m, Vec3(1, 2, 3) + offset);
  EXPECT_EQ(there.objects[1].mount.pose.position_m, here.objects[1].mount.pose.position_m);
  EXPECT_EQ(there.objects[0].copies, here.objects[0].copies);
  EXPECT_EQ(there.cameras[0].mount.pose.rotation, here.cameras[0].mount.pose.rotation);
  expect_near(there.world_from(there.objects[1].mount).position_m, Vec3(2, 2, 3) + offset);
}

TEST(SceneLoad, CopiesComeFromACsvFile) {
  const test::ScratchFolder scratch;
  ASSERT_TRUE(
      write_text(scratch / "c.csv", "x,y,z,yaw\r\n# first\n1, 2,3 , 90\r\n\n4,5,6 # last").ok());
  const Scene scene =
      scene_of(scratch, "[[objects]]\nshape = 'sphere'\ncopies_file = 'c.csv'\nscale = 2");
  ASSERT_EQ(scene.objects[0].copies.size(), 2u);
  expect_near(Vec3(scene.objects[0].copies[0] * Vec4(0, 0, -1, 1)), {-1, 2, 3});
  ASSERT_TRUE(write_text(scratch / "c.csv", "1,2,3\n1,2,x").ok());
  const auto bad = load_scene(scratch / "s.toml");
  ASSERT_FALSE(bad.ok());
  EXPECT_NE(bad.error().message.find("c.csv:2: found 'x'; accepted: a number"), std::string::npos)
      << bad.error().message;
}

TEST(SceneScatter, StandsOnTheSurfaceInsideTheAreaAndOutsideTheKeepOut) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  const Scene scene = scene_of(scratch, kHill);
  ASSERT_EQ(scene.objects.at(1).copies.size(), 200u);
  double smallest = 9.0, largest = 0.0;
  for (const Mat4& copy : scene.objects[1].copies) {
    const Vec3 p(copy[3]);
    const double scale = glm::length(Vec3(copy[0]));
    EXPECT_TRUE(p.x >= 0 && p.x <= 20 && p.z >= -9 && p.z <= 9);
    EXPECT_GE(std::hypot(p.x - 10, p.z), 4.0);
    EXPECT_NEAR(p.y, -20.0 + 0.5 * (p.x - 10.0) - 0.1 * scale, 1e-6);
    smallest = std::min(smallest, scale);
    largest = std::max(largest, scale);
  }
  EXPECT_GE(smallest, 0.5);
  EXPECT_LE(largest, 2.0);
  EXPECT_LT(smallest, 0.6);  // of 200 draws
  EXPECT_GT(largest, 1.9);
  const Vec3 normal = glm::normalize(Vec3(-0.5, 1.0, 0.0));
  for (const Mat4& copy : scene.objects[2].copies) expect_near(Vec3(copy[1]), normal, 1e-6);
}

TEST(SceneScatter, TheSameSeedGivesTheSamePlacesAndAnotherSeedOthers) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  const Scene first = scene_of(scratch, kHill), second = scene_of(scratch, kHill);
  EXPECT_EQ(first.objects.at(1).copies, second.objects.at(1).copies);
  std::string other_seed = kHill;
  other_seed.replace(other_seed.find("seed = 5"), 8, "seed = 6");
  EXPECT_NE(scene_of(scratch, other_seed).objects.at(1).copies, first.objects[1].copies);
  // More copies leave the first ones where they are.
  std::string more = kHill;
  more.replace(more.find("count = 200"), 11, "count = 300");
  const Scene third = scene_of(scratch, more);
  EXPECT_TRUE(std::equal(first.objects[1].copies.begin(), first.objects[1].copies.end(),
                         third.objects.at(1).copies.begin()));
}

TEST(SceneScatter, ASurfaceThatDoesNotCoverTheAreaIsRefused) {
  const test::ScratchFolder scratch;
  write_hill(scratch);
  ASSERT_TRUE(write_text(scratch / "s.toml",
                         "[[objects]]\nname = 'hill'\nterrain = 'hill.npy'\ncell_m = 1\n"
                         "[[objects]]\nshape = 'box'\n"
                         "scatter = {area_m = [50, 50, 60, 60], on = 'hill'}")
                  .ok());
  const auto scene = load_scene(scratch / "s.toml");
  ASSERT_FALSE(scene.ok());
  EXPECT_NE(scene.error().message.find("found no place for copy 0 of 1"), std::string::npos);
}

}  // namespace
}  // namespace neritic::scene
