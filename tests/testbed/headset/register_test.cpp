// `neritic register --headset`: a headset that is held at marked places finds where the room lies.
#include "engine/scene/scene.hpp"
#include "tests/testbed/headset/headset_process.hpp"

namespace neritic::testbed {
namespace {

using RegisterByHeadset = HeadsetProcess;

// The room's origin lies at (10, -3, 5), its -z points to the scene's +x. The hand trembles by 2
// mm.
TEST_F(RegisterByHeadset, PlacesAtWhichItWasHeldGiveTheLab) {
  const std::vector<Vec3> places{{0.0, 1.0, -1.0}, {1.5, 1.2, -1.0}, {0.2, 0.8, 2.0}};
  const auto scene_of = [](const Vec3& lab) {
    return Vec3(10.0 - lab.z, -3.0 + lab.y, 5.0 + lab.x);
  };
  std::string lines = "size 16 16\nperiod 0.1\n", table = "scene_x_m,scene_y_m,scene_z_m\n";
  double t = 0.0;
  for (const Vec3& at : places) {
    for (int i = 0; i < 24; ++i, t += 0.1)
      lines += fmt::format("head {:.2f} {} {} {} 0 0 0\n", t, at.x + (i % 2 ? 0.001 : -0.001), at.y,
                           at.z);
    t += 1.0;  // on the way to the next
    const Vec3 there = scene_of(at);
    table += fmt::format("{},{},{}\n", there.x, there.y, there.z);
  }
  script(lines);
  std::ofstream(scratch_ / "places.csv") << table;
  ASSERT_EQ(run("register --headset '" + path("places.csv") + "'"), 0) << said();
  EXPECT_EQ(text("report"), "");
  const auto at = said().find("[lab]");
  ASSERT_NE(at, std::string::npos) << said();
  std::ofstream(scratch_ / "scene.toml") << said().substr(at);
  const auto scene = scene::load_scene(scratch_ / "scene.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  ASSERT_TRUE(scene->world_from_lab.has_value());
  for (const Vec3& lab : {Vec3(0.0), Vec3(1.0, 0.0, 0.0), Vec3(0.0, 0.0, -3.0)})
    EXPECT_LT(glm::distance(*scene->world_from_lab * lab, scene_of(lab)), 0.01);
}

}  // namespace
}  // namespace neritic::testbed
