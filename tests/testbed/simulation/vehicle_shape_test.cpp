// Shapes of vehicles for contacts: their file's outline, the hull of what is drawn, or its box.
#include "testbed/simulation/vehicle_shape.hpp"

#include <gmock/gmock.h>

#include "engine/scene/animation.hpp"
#include "rov/vehicle_file.hpp"
#include "tests/testbed/simulation/dives.hpp"

namespace neritic::testbed {
namespace {

constexpr const char* kBody = "mass_kg = 10\ninertia_kg_m2 = [0.2, 0.2, 0.3]\n";

Result<scene::Scene> scene_with(const test::ScratchFolder& folder, const std::string& outline,
                                const std::string& vehicle) {
  EXPECT_TRUE(write_text(folder / "dynamics.toml", kBody + outline).ok());
  EXPECT_TRUE(write_text(folder / "scene.toml",
                         "[physics]\n[[vehicles]]\nname = \"v\"\n" + vehicle +
                             "\ndynamics = \"dynamics.toml\"\nposition_m = [0, -5, 0]\n")
                  .ok());
  return scene::load_scene(folder / "scene.toml");
}

sim::BodyShape shape_of(const std::string& outline, const std::string& vehicle) {
  const test::ScratchFolder folder;
  const auto scene = scene_with(folder, outline, vehicle);
  EXPECT_TRUE(scene.ok()) << scene.error().message;
  const auto world = PhysicsWorld::create(*scene);
  EXPECT_TRUE(world.ok()) << world.error().message;
  return (*world)->vehicles()[0].kind.solid.shape;
}

// The farthest that the shape reaches along a direction of model axes.
double reach_along(const sim::BodyShape& shape, const Vec3& direction) {
  double most = -1e9;
  for (const sim::ConvexPart& part : shape.parts())
    for (const Vec3& p : part.core_m) most = std::max(most, glm::dot(p, direction) + part.radius_m);
  return most;
}

constexpr const char* kDrawnBox = "shape = \"box\"\nsize_m = [0.6, 0.3, 0.8]";

TEST(VehicleShape, WithoutAnOutlineItIsTheBoxAboutWhatIsDrawn) {
  const sim::BodyShape shape = shape_of("", kDrawnBox);
  ASSERT_EQ(shape.parts().size(), 1u);
  EXPECT_NEAR(reach_along(shape, {1, 0, 0}), 0.3, 1e-6);
  EXPECT_NEAR(reach_along(shape, {0, -1, 0}), 0.15, 1e-6);
  EXPECT_NEAR(reach_along(shape, {0, 0, 1}), 0.4, 1e-6);
}

// Marine axes in the file, model axes in the shape.
TEST(VehicleShape, AnOutlinesPartsAreWhereTheFileSays) {
  const sim::BodyShape shape = shape_of(R"(
[[outline]]
kind = "box"
position_m = [0.1, 0.2, 0.3]
size_m = [0.2, 0.4, 0.6]
[[outline]]
kind = "sphere"
position_m = [1, 0, 0]
radius_m = 0.25
[[outline]]
kind = "capsule"
from_m = [0, -1, 0]
to_m = [0, -2, 0]
radius_m = 0.1
[[outline]]
kind = "hull"
points_m = [[0, 0, -1], [0.2, 0, -1], [0, 0.2, -1], [0, 0, -1.5]]
)",
                                        kDrawnBox);
  ASSERT_EQ(shape.parts().size(), 4u);
  EXPECT_NEAR(reach_along(shape, {0, 0, -1}), 1.25, 1e-9);  // forward: the ball
  EXPECT_NEAR(reach_along(shape, {-1, 0, 0}), 2.1, 1e-9);   // port: the capsule
  EXPECT_NEAR(reach_along(shape, {1, 0, 0}), 0.4, 1e-9);    // starboard, down, aft: the box
  EXPECT_NEAR(reach_along(shape, {0, -1, 0}), 0.6, 1e-9);
  EXPECT_GT(reach_along(shape, {0, 1, 0}), 1.4);  // up: the hull, but for its round corner
  EXPECT_LT(reach_along(shape, {0, 1, 0}), 1.5 + 1e-9);
}

TEST(VehicleShape, BoxesTurnByYawPitchAndRoll) {
  const sim::BodyShape shape =
      shape_of("[[outline]]\nkind = \"box\"\nsize_m = [1, 0.2, 0.1]\nyaw_deg = 90\n", kDrawnBox);
  EXPECT_NEAR(reach_along(shape, {1, 0, 0}), 0.5, 1e-9);
  EXPECT_NEAR(reach_along(shape, {0, 0, 1}), 0.1, 1e-9);
  EXPECT_NEAR(reach_along(shape, {0, 1, 0}), 0.05, 1e-9);
}

// Its hull reaches nearly as far as what is drawn in every direction, and no farther.
TEST(VehicleShape, TheHullOfWhatIsDrawnHoldsIt) {
  const std::string rov = "model = \"" + (test::source_dir() / "assets/models/rov.glb").string() +
                          "\"\ncollision = \"hull\"";
  const sim::BodyShape shape = shape_of("", rov);
  const sim::BodyShape box = shape_of("", rov.substr(0, rov.find('\n')));
  ASSERT_EQ(shape.parts().size(), 1u);
  for (int axis = 0; axis < 3; ++axis)
    for (const double sign : {-1.0, 1.0}) {
      Vec3 direction(0.0);
      direction[axis] = sign;
      EXPECT_LT(reach_along(shape, direction), reach_along(box, direction) + 1e-6);
      EXPECT_GT(reach_along(shape, direction), reach_along(box, direction) - 0.03);
    }
  const Vec3 corner = glm::normalize(Vec3(1.0));
  EXPECT_LT(reach_along(shape, corner), 0.9 * reach_along(box, corner));
}

// The shipped outline is the drawn vehicle's: as long, wide and high but for cables and lamps.
TEST(VehicleShape, TheBlueRovsOutlineIsThatOfItsModel) {
  const TestDive dive = dive_of(mission_scene());
  const sim::BodyShape& shape = dive.world->vehicles()[0].kind.solid.shape;
  ASSERT_EQ(shape.parts().size(), 5u);
  EXPECT_NEAR(reach_along(shape, {1, 0, 0}), 0.2875, 1e-6);
  EXPECT_NEAR(reach_along(shape, {0, 1, 0}), 0.128, 1e-6);
  EXPECT_NEAR(reach_along(shape, {0, -1, 0}), 0.127, 1e-6);
  const scene::Model model =
      *scene::load_scene(test::source_dir() / "assets/scenes/mission.toml")
           ->models[static_cast<std::size_t>(
               std::ranges::find(mission_scene().objects, "rov", &scene::Object::name)->model)];
  const scene::Bounds bounds = scene::model_bounds(model, scene::evaluate_pose(model, -1, 0.0));
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 direction(0.0);
    direction[axis] = 1.0;
    // Aft the tether trails, which is no part of it.
    EXPECT_NEAR(reach_along(shape, direction), bounds.max[axis], axis == 2 ? 0.08 : 0.012) << axis;
    EXPECT_NEAR(reach_along(shape, -direction), -bounds.min[axis], 0.012) << axis;
  }
}

TEST(VehicleShape, FaultsAreOneLine) {
  const test::ScratchFolder folder;
  const auto fault = [&](const std::string& outline, const std::string& vehicle = kDrawnBox) {
    const auto scene = scene_with(folder, outline, vehicle);
    if (!scene.ok()) return scene.error().message;
    const auto world = PhysicsWorld::create(*scene);
    return world.ok() ? std::string() : world.error().message;
  };
  using ::testing::HasSubstr;
  EXPECT_EQ(fault(""), "");
  EXPECT_THAT(fault("[[outline]]\nkind = \"ball\""),
              HasSubstr("outline[0].kind: found \"ball\"; accepted: box, sphere, capsule or hull"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"sphere\""), HasSubstr("radius_m: not found"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"sphere\"\nradius_m = -1"),
              HasSubstr("radius_m: found -1"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"box\"\nsize_m = [1, 0, 1]"), HasSubstr("size_m"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"box\"\nsize_m = [1, 1, 1]\nradius_m = 1"),
              HasSubstr("radius_m: not known"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"hull\"\npoints_m = [[0, 0, 0]]"),
              HasSubstr("accepted: four points or more"));
  EXPECT_THAT(fault("[[outline]]\nkind = \"hull\"\n"
                    "points_m = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]]"),
              HasSubstr("v: outline: found a hull of 4 points without volume"));
  EXPECT_THAT(fault("", std::string(kDrawnBox) + "\ncollision = true"),
              HasSubstr("collision: found true; accepted: \"hull\", beside dynamics"));
}

}  // namespace
}  // namespace neritic::testbed
