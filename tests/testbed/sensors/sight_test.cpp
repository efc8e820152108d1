// A sensor that shows nothing says why at its first frame, with the way out, once.
#include "testbed/sensors/sight.hpp"

#include "testbed/sensors/sight_check.hpp"
#include "tests/testbed/sensors/sonar_pings.hpp"

namespace neritic::testbed {
namespace {

using Sight = test::GpuTest;
using scene::SonarKind;

constexpr SonarKind kKinds[] = {SonarKind::kImaging, SonarKind::kProfiling, SonarKind::kEchoSounder,
                                SonarKind::kSideScan, SonarKind::kMechanical};

scene::Sonar short_sonar(SonarKind kind) {
  scene::Sonar sonar = sonar_of(0.5, 5.0, 32);
  sonar.kind = kind;
  sonar.bins_azimuth = sonar.bins_elevation = 32;
  sonar.depression_rad = radians(20.0);
  return sonar;
}

// A hull of 0.4 m in the middle of a box of water 6 m away, and one sonar of each kind on the hull.
scene::Scene hull_in_a_room(const Vec3& at, double room_m = 6.0) {
  scene::Scene scene;
  scene::Model hull = scene::make_box(Vec3(0.4));
  hull.materials.emplace_back().double_sided = true;
  hull.meshes[0].primitives[0].material = 0;
  scene.objects.push_back(object_of(scene, std::move(hull), {0.0, -20.0, 0.0}));
  scene.objects[0].name = "rov";
  const std::vector<Vec3> walls{{1, 0, 0},  {-1, 0, 0}, {0, 1, 0},
                                {0, -1, 0}, {0, 0, 1},  {0, 0, -1}};
  for (const Vec3& out : walls) {
    const Vec3 size = glm::mix(Vec3(2.0 * room_m), Vec3(0.1), glm::abs(out));
    scene.objects.push_back(
        object_of(scene, scene::make_box(size), Vec3(0.0, -20.0, 0.0) + room_m * out));
  }
  for (const SonarKind kind : kKinds) {
    scene.sonars.push_back(short_sonar(kind));
    scene.sonars.back().name = scene::name_of(kind);
    scene.sonars.back().mount = {.object = 0, .pose = {at, Quat(1, 0, 0, 0)}};
  }
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 32;
  camera.mount = {.object = 0, .pose = {at, Quat(1, 0, 0, 0)}};
  scene.cameras.push_back(camera);
  return scene;
}

std::vector<std::string> told(gpu::Device& device, scene::Scene scene, const Capture& capture,
                              int frames = 2) {
  std::vector<std::string> lines;
  auto session = Session::create(device, std::move(scene));
  if (!session.ok()) {
    ADD_FAILURE() << session.error().message;
    return lines;
  }
  SightCheck check(**session, nullptr, [&](const std::string& line) { lines.push_back(line); });
  FrameRequest request;
  request.capture = capture;
  for (std::size_t i = 0; i < (*session)->scene().cameras.size(); ++i) request.cameras.push_back(i);
  for (std::size_t i = 0; i < (*session)->scene().sonars.size(); ++i) request.sonars.push_back(i);
  for (int i = 0; i < frames; ++i) {
    const auto frame = (*session)->render(request);
    EXPECT_TRUE(frame.ok()) << frame.error().message;
    if (frame.ok()) {
      EXPECT_TRUE(check.accept(*frame).ok());
    }
  }
  return lines;
}

Capture echoes_and_color() {
  return Capture{.motion = false}.without_geometry();
}

TEST_F(Sight, InsideItsCarrierEverySensorSaysSoOnceAndShowsTheWayOut) {
  for (const Capture& capture : {Capture{}, echoes_and_color()}) {
    const auto lines = told(device(), hull_in_a_room(Vec3(0.0)), capture);
    ASSERT_EQ(lines.size(), 6u) << ::testing::PrintToString(lines);
    for (const std::string& line : lines)
      EXPECT_NE(line.find("sees only its own carrier rov"), std::string::npos) << line;
    EXPECT_EQ(lines[0],
              "camera eye: sees only its own carrier rov, 0.20 to 0.20 m away; position_m = "
              "[0.00, 0.00, -0.22] is before its hull");
  }
}

// Through a hull with gaps: a few per cent of the pixels see the sea.
TEST_F(Sight, ACameraInTheShippedVehicleSeesLittleButIt) {
  NERITIC_ASSERT_OK(scene::Scene scene,
                    scene::load_scene(test::source_dir() / "tests/scenes/over_sand.toml"));
  scene.sonars.clear();
  ASSERT_EQ(scene.cameras.size(), 1u);
  scene.cameras[0].mount.pose.position_m = Vec3(0.0);
  const auto lines = told(device(), scene, Capture{});
  ASSERT_EQ(lines.size(), 1u) << ::testing::PrintToString(lines);
  EXPECT_THAT(lines[0],
              ::testing::AllOf(::testing::HasSubstr("sees little but its own carrier rov"),
                               ::testing::HasSubstr("is before its hull")));
}

TEST_F(Sight, AtThePlaceThatTheLineNamesTheyAllSee) {
  scene::Scene scene = hull_in_a_room({0.0, 0.0, -0.22}, 3.0);
  scene.sonars.erase(scene.sonars.begin() + 3);  // a side-scan's sides lie beside the hull
  EXPECT_THAT(told(device(), scene, echoes_and_color()), ::testing::IsEmpty());
}

TEST_F(Sight, WhatIsOutOfRangeIsToldWithItsDistance) {
  for (const SonarKind kind : kKinds) {
    scene::Scene scene = wall(7.0, short_sonar(kind));
    scene.sonars[0].mount.pose.rotation =
        kind == SonarKind::kSideScan
            ? glm::angleAxis(-kPi / 2.0, Vec3(0, 1, 0)) * glm::angleAxis(0.0, Vec3(1, 0, 0))
            : Quat(1, 0, 0, 0);
    const auto lines = told(device(), scene, echoes_and_color());
    ASSERT_EQ(lines.size(), 1u) << scene::name_of(kind);
    EXPECT_NE(lines[0].find("farther than range_m = [0.5, 5]: from 7"), std::string::npos)
        << lines[0];
  }
  const auto near = told(device(), wall(0.3, short_sonar(SonarKind::kImaging)), echoes_and_color());
  ASSERT_EQ(near.size(), 1u);
  EXPECT_NE(near[0].find("nearer than range_m = [0.5, 5]: 0.3 to 0.3"), std::string::npos)
      << near[0];
}

TEST_F(Sight, EmptyWaterIsToldAlsoBesideNoise) {
  scene::Scene scene = wall(3.0, short_sonar(SonarKind::kImaging));
  scene.sonars[0].mount.pose.rotation = glm::angleAxis(kPi, Vec3(0, 1, 0));
  scene.sonars[0].terms.level = plain_level();
  scene.sonars[0].terms.noise = scene::SonarNoise{.level_db = 60.0};
  const auto lines = told(device(), scene, echoes_and_color());
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("sonar sonar: no return, since nothing is in its beams"),
            std::string::npos)
      << lines[0];
}

// The ping draws a ball of one centimetre larger than its own pixels show it.
TEST_F(Sight, ASonarThatHearsASmallTargetWithoutAClassSaysNothing) {
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.005, 16), {0.01, 0.02, -4.0}));
  scene.objects[0].class_id = 0;
  scene.sonars = {short_sonar(SonarKind::kImaging)};
  EXPECT_GT(total(ping(device(), scene)), 0.0);
  EXPECT_THAT(told(device(), scene, echoes_and_color(), 1), ::testing::IsEmpty());
}

TEST_F(Sight, WhatIsOutOfTheWaterIsNotHeardAndTold) {
  scene::Scene scene;
  scene.objects.push_back(object_of(scene, scene::make_sphere(0.5, 32), {0.0, 1.0, -3.0}));
  scene.sonars = {short_sonar(SonarKind::kImaging)};
  scene.sonars[0].mount.pose = {{0.0, -1.0, 0.0},
                                glm::angleAxis(std::atan2(2.0, 3.0), Vec3(1, 0, 0))};
  EXPECT_GT(total(ping(device(), scene)), 0.0);  // a space without water is all water
  scene.water = scene::Water{};
  for (const char* gather : {"plane", "nearest", "published"}) {
    scene.sonars[0].gather = gather;
    EXPECT_EQ(total(ping(device(), scene)), 0.0) << gather;
  }
  auto lines = told(device(), scene, echoes_and_color(), 1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("all in its beams is out of the water, above y = 0"), std::string::npos)
      << lines[0];
  // The part of a ball that is below the surface is heard.
  scene.objects[0].mount.pose.position_m.y = -0.1;
  scene.sonars[0].mount.pose.rotation = glm::angleAxis(std::atan2(0.9, 3.0), Vec3(1, 0, 0));
  scene.sonars[0].gather = "plane";
  EXPECT_GT(total(ping(device(), scene)), 0.0);
  // A sonar in the air hears neither what is beside it nor what is in the water.
  scene.sonars[0].mount.pose = {{0.0, 1.5, 0.0},
                                glm::angleAxis(-std::atan2(1.6, 3.0), Vec3(1, 0, 0))};
  EXPECT_EQ(total(ping(device(), scene)), 0.0);
  lines = told(device(), scene, echoes_and_color(), 1);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_NE(lines[0].find("out of the water, at y = 1.5 m"), std::string::npos) << lines[0];
}

TEST_F(Sight, ACameraBeforeWhichNothingIsSaysThatItIsBlack) {
  scene::Scene scene = wall(3.0, short_sonar(SonarKind::kImaging));
  scene.sonars.clear();
  scene.cameras.resize(1);
  scene.cameras[0].name = "eye";
  scene.cameras[0].width = scene.cameras[0].height = 8;
  EXPECT_THAT(told(device(), scene, Capture{}), ::testing::IsEmpty());
  scene.cameras[0].mount.pose.rotation = glm::angleAxis(kPi, Vec3(0, 1, 0));
  EXPECT_THAT(told(device(), scene, Capture{}),
              ::testing::ElementsAre("camera eye: black, since no opaque surface is in its view: "
                                     "turn or move it"));
  scene.water = scene::Water{.scattering = true};  // open water is a picture
  EXPECT_THAT(told(device(), scene, Capture{}), ::testing::IsEmpty());
}

TEST_F(Sight, WithoutACarrierACameraIsNeverRenderedTwice) {
  scene::Scene scene = wall(3.0, short_sonar(SonarKind::kImaging));
  scene.cameras.resize(1);
  scene.cameras[0].width = scene.cameras[0].height = 8;
  EXPECT_THAT(told(device(), scene, echoes_and_color()), ::testing::IsEmpty());
}

}  // namespace
}  // namespace neritic::testbed
