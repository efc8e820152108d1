// A person in a scene without divers (tools/neritic/worn_scene.hpp).
#include "tools/neritic/worn_scene.hpp"

#include <gtest/gtest.h>

#include "diver/reach.hpp"
#include "engine/core/files.hpp"
#include "testbed/simulation/physics_world.hpp"
#include "tests/support/support.hpp"
#include "tools/neritic/load_scene.hpp"

namespace neritic::tools {
namespace {

class WornSceneTest : public ::testing::Test {
 protected:
  scene::Scene scene_of(const std::string& text) const {
    const auto path = scratch_ / "own.toml";
    EXPECT_TRUE(write_text(path, text).ok());
    auto scene = load_scene_or_model(path.string(), "");
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
    return std::move(scene).value();
  }
  test::ScratchFolder scratch_;
};

TEST_F(WornSceneTest, TheEyesAreWhereTheFirstCameraLooksFrom) {
  // Looks to starboard and down; another thing has the name; the file ends without a line's end.
  const scene::Scene scene = scene_of(
      "[[cameras]]\nname = \"first\"\nposition_m = [3, -7, 2]\nyaw_deg = -90\npitch_deg = -40\n"
      "[[objects]]\nname = \"wearer\"\nshape = \"sphere\"\nposition_m = [0, -9, 0]");
  ASSERT_FALSE(has_diver(scene));
  const auto worn = with_wearer(scene, "");
  ASSERT_TRUE(worn.ok()) << worn.error().message;
  ASSERT_TRUE(has_diver(worn->scene));
  const scene::Object& diver = worn->scene.objects.back();
  EXPECT_EQ(diver.name, "wearer_2");
  const auto world = testbed::PhysicsWorld::create(worn->scene);
  ASSERT_TRUE(world.ok()) << world.error().message;
  const diver::Body& body = (*world)->humans().front().body;
  const Vec3 eyes =
      diver::body_from_eyes(body, diver::posture_of(body, diver::straight_joints(), {})).position_m;
  const Pose hips = worn->scene.world_from(diver.mount);
  EXPECT_LT(glm::distance(hips * Vec3(eyes.y, eyes.x, -eyes.z), Vec3(3, -7, 2)), 0.03)
      << eyes.x << ' ' << eyes.y << ' ' << eyes.z;
  // The crown points where the camera looks, level.
  EXPECT_LT(glm::distance(hips.rotation * Vec3(0, 1, 0), Vec3(1, 0, 0)), 1e-6);
  // And there the diver's own view looks, too.
  const scene::Camera& own = worn->scene.cameras.back();
  EXPECT_EQ(own.name, "wearer_2_eyes");
  EXPECT_LT(
      glm::distance(worn->scene.world_from(own.mount).rotation * Vec3(0, 0, -1), Vec3(1, 0, 0)),
      1e-6);
}

TEST_F(WornSceneTest, NobodyBeginsInTheAir) {
  const auto worn = with_wearer(
      scene_of("[[cameras]]\nposition_m = [0, 4, 0]\n[physics]\nrate_hz = 100\n[[objects]]\n"
               "name = \"rock\"\nshape = \"sphere\"\nposition_m = [0, -9, 0]\n"),
      "");
  ASSERT_TRUE(worn.ok()) << worn.error().message;
  EXPECT_LE(worn->scene.world_from(worn->scene.objects.back().mount).position_m.y, -0.9);
  EXPECT_EQ(worn->scene.physics->rate_hz, 100.0);  // as its file says
}

TEST_F(WornSceneTest, BubblesAreAddedWhereOthersBreathe) {
  const std::string object =
      "[[objects]]\nname = \"rock\"\nshape = \"sphere\"\nposition_m = [0, -9, 0]\n";
  const auto without = with_wearer(scene_of("[water]\n" + object), "");
  ASSERT_TRUE(without.ok()) << without.error().message;
  EXPECT_TRUE(without->scene.water->bubbles.empty());
  const auto with = with_wearer(
      scene_of("[water]\n[[water.bubbles]]\non = \"rock\"\ndiameter_mm = 3\n" + object), "");
  ASSERT_TRUE(with.ok()) << with.error().message;
  EXPECT_EQ(with->scene.water->bubbles.size(), 2u);
}

TEST_F(WornSceneTest, AModelIsNoSeaToDiveIn) {
  const auto model =
      load_scene_or_model((test::source_dir() / "assets/models/fish.glb").string(), "");
  ASSERT_TRUE(model.ok()) << model.error().message;
  EXPECT_TRUE(is_model(*model));
  const auto worn = with_wearer(*model, "");
  ASSERT_FALSE(worn.ok());
  EXPECT_NE(
      worn.error().message.find("fish.glb: found a model, in which nobody can dive; accepted: a "
                                "scene (.toml)"),
      std::string::npos)
      << worn.error().message;
}

}  // namespace
}  // namespace neritic::tools
