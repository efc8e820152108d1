// The scenes in assets/scenes: each loads, and holds what its page and the benchmarks promise.
#include <gtest/gtest.h>

#include "engine/core/files.hpp"
#include "engine/scene/animation.hpp"
#include "engine/scene/flock_motion.hpp"
#include "engine/scene/scene.hpp"
#include "engine/scene/scene_keys.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/support.hpp"

namespace neritic::scene {
namespace {

Scene load(const std::string& name) {
  auto scene = load_scene(test::source_dir() / "assets/scenes" / name);
  if (scene.ok()) return std::move(scene).value();
  ADD_FAILURE() << scene.error().message;
  return {};
}

const Object* find_object(const Scene& scene, std::string_view name) {
  for (const Object& object : scene.objects)
    if (object.name == name) return &object;
  return nullptr;
}

std::size_t drawn_triangles(const Scene& scene) {
  std::size_t count = 0;
  for (const Object& object : scene.objects)
    count += object.instance_count() * triangle_count(*scene.models.at(object.model));
  return count;
}

TEST(SceneAssets, EverySceneLoads) {
  int count = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "assets/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    ++count;
    const auto scene = load_scene(entry.path());
    EXPECT_TRUE(scene.ok()) << (scene.ok() ? "" : scene.error().message);
  }
  EXPECT_GE(count, 5);
}

TEST(SceneAssets, TheWreckHasTheRovFacingTheDiverAtTwoToFourMetres) {
  const Scene scene = load("wreck.toml");
  for (const char* name : {"seabed", "submarine", "diver", "rov", "shark"})
    EXPECT_NE(find_object(scene, name), nullptr) << name;
  ASSERT_TRUE(scene.sun && scene.water);
  EXPECT_TRUE(scene.water->scattering);
  EXPECT_EQ(scene.lamps.size(), 2u);
  ASSERT_EQ(scene.sonars.size(), 1u);
  ASSERT_GE(scene.cameras.size(), 2u);
  EXPECT_EQ(scene.cameras[0].name, "overview");
  const Object* diver = find_object(scene, "diver");
  ASSERT_NE(diver, nullptr);
  const Pose sonar_from_world = inverse(scene.world_from(scene.sonars[0].mount));
  const Vec3 p = sonar_from_world * scene.world_from(diver->mount).position_m;
  const double range_m = glm::length(p);
  EXPECT_GT(range_m, 2.0);
  EXPECT_LT(range_m, 4.0);
  EXPECT_LT(std::abs(std::atan2(p.x, -p.z)), radians(10.0));
  EXPECT_LT(std::abs(std::asin(p.y / range_m)), radians(5.0));
  const Vec3 diver_depth = scene.world_from(diver->mount).position_m;
  EXPECT_LT(diver_depth.y, -10.0);
  EXPECT_GT(diver_depth.y, -18.0);
}

// Whatever swims by a clip goes through the water: a metre in five seconds, at any time of the
// dive; fish of a school, which may turn, half a metre on average.
TEST(SceneAssets, NothingSwimsOnTheSpot) {
  int swimmers = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(test::source_dir() / "assets/scenes")) {
    if (entry.path().extension() != ".toml") continue;
    const Scene scene = load(entry.path().filename().string().c_str());
    for (const Object& object : scene.objects) {
      if (object.model < 0 || object.clip < 0 || object.human) continue;
      const std::string& clip = scene.models[object.model]->clips[object.clip].name;
      if (clip != "swim" && clip != "cruise" && clip != "frog") continue;
      ++swimmers;
      if (object.flock) {
        const auto index = static_cast<std::size_t>(&object - scene.objects.data());
        for (const double time_s : {0.0, 100.0, 1000.0}) {
          const auto now = flock_copies(MotionSource(scene), index, time_s),
                     then = flock_copies(MotionSource(scene), index, time_s + 5.0);
          double mean_m = 0.0;
          for (std::size_t i = 0; i < now.size(); ++i)
            mean_m += glm::distance(now[i][3], then[i][3]) / static_cast<double>(now.size());
          EXPECT_GT(mean_m, 0.5) << entry.path() << " " << object.name << " " << time_s;
        }
        continue;
      }
      for (const double time_s : {0.0, 100.0, 1000.0})
        EXPECT_GT(glm::distance(scene.world_from(object.mount, time_s).position_m,
                                scene.world_from(object.mount, time_s + 5.0).position_m),
                  1.0)
            << entry.path() << " " << object.name << " " << time_s;
    }
  }
  EXPECT_GE(swimmers, 8);
}

TEST(SceneAssets, TheBenchmarkSceneHasItsSizeAndNothingElse) {
  const Scene scene = load("benchmark_23k.toml");
  EXPECT_NEAR(static_cast<double>(drawn_triangles(scene)), 23000.0, 500.0);
  EXPECT_FALSE(scene.sun || scene.water);
  EXPECT_TRUE(scene.cameras.empty() && scene.lamps.empty());
  ASSERT_EQ(scene.sonars.size(), 1u);
  EXPECT_EQ(scene.sonars[0].bins_azimuth, 512u);
  EXPECT_EQ(scene.sonars[0].bins_range, 500u);
  EXPECT_DOUBLE_EQ(scene.sonars[0].azimuth_rad, radians(90.0));
  EXPECT_DOUBLE_EQ(scene.sonars[0].elevation_rad, radians(28.0));
  const double sonar_y = scene.world_from(scene.sonars[0].mount).position_m.y;
  const Object* floor = find_object(scene, "floor");
  ASSERT_NE(floor, nullptr);
  EXPECT_NEAR(sonar_y - floor->mount.pose.position_m.y, 1.5, 1e-9);
}

TEST(SceneAssets, TheInstancesAreAHundredOfTwentyThousandTriangles) {
  const Scene scene = load("instances.toml");
  std::size_t hundred = 0;
  for (const Object& object : scene.objects)
    if (object.instance_count() == 100) {
      ++hundred;
      EXPECT_NEAR(static_cast<double>(triangle_count(*scene.models.at(object.model))), 20000.0,
                  600.0);
    }
  EXPECT_EQ(hundred, 1u);
}

// A held thing lies between the jaws of the gripper's model. No part of the gripper is in the
// sonar's sight or in the upper 60 % of the camera's.
TEST(SceneAssets, TheVehiclesGripperIsWhereItHolds) {
  const auto scene = load_scene(test::source_dir() / "assets/experiments/team/tool.toml");
  ASSERT_TRUE(scene.ok()) << scene.error().message;
  const Object *rov = find_object(*scene, "rov"), *gripper = find_object(*scene, "gripper");
  ASSERT_TRUE(rov && rov->dynamics && rov->dynamics->gripper && gripper);
  const Vec3 held = rov->dynamics->gripper->position_m;
  const Model& model = *scene->models.at(gripper->model);
  const auto& sonar = scene->sonars.at(0);
  const auto& camera = scene->cameras.at(0);
  const Vec3 sonar_m = sonar.mount.pose.position_m, camera_m = camera.mount.pose.position_m;
  const double lowest = -0.2 * std::tan(0.5 * camera.vertical_fov_rad);
  const auto corners_of = [&](std::string_view name) {
    const auto found = std::ranges::find(model.nodes, name, &Node::name);
    std::vector<Vec3> out;
    if (found == model.nodes.end() || found->mesh < 0) return out;
    const Mat4 placed =
        evaluate_node(model, static_cast<int>(found - model.nodes.begin()), -1, 0.0);
    for (const Primitive& primitive : model.meshes[found->mesh].primitives)
      for (const Vec3f& corner : primitive.positions)
        out.push_back(gripper->mount.pose.position_m + Vec3(placed * Vec4(Vec3(corner), 1.0)));
    return out;
  };
  for (const char* name : {"body", "jaw_port", "jaw_starboard"}) {
    const auto corners = corners_of(name);
    ASSERT_FALSE(corners.empty()) << name;
    double nearest_m = 1e9;
    for (const Vec3& corner : corners) {
      nearest_m = std::min(nearest_m, glm::distance(corner, held));
      const Vec3 heard = corner - sonar_m, seen = corner - camera_m;
      if (heard.z < 0.0) {
        EXPECT_GT(std::atan2(heard.y, -heard.z), 0.5 * sonar.elevation_rad) << name;
      }
      if (seen.z < 0.0) {
        EXPECT_LT(seen.y / -seen.z, lowest) << name;
      }
    }
    // The jaws are 62 mm apart.
    EXPECT_GT(nearest_m, 0.028) << name;
    if (std::string_view(name) != "body") {
      EXPECT_LT(nearest_m, 0.034) << name;
    }
  }
  const auto mean_x = [&](const char* name) {
    double sum = 0.0;
    const auto corners = corners_of(name);
    for (const Vec3& corner : corners) sum += corner.x;
    return sum / static_cast<double>(corners.size());
  };
  EXPECT_LT(mean_x("jaw_port"), held.x);
  EXPECT_GT(mean_x("jaw_starboard"), held.x);
}

TEST(SceneAssets, TheSeabedIsATerrainOfAFile) {
  const Scene scene = load("seabed.toml");
  const Object* ridge = find_object(scene, "ridge");
  ASSERT_NE(ridge, nullptr);
  EXPECT_EQ(triangle_count(*scene.models.at(ridge->model)), 2u * 256u * 256u);
}

// Away from its ridge the bed lies as a survey measured it, at each of the survey's cells within a
// ripple's height.
TEST(SceneAssets, TheSeabedLiesOnASurveysRelief) {
  const std::filesystem::path folder = test::source_dir() / "assets/terrain";
  const auto survey = read_heightfield(folder / "jd211_crop.asc", {});
  const auto bed = read_heightfield(folder / "seabed.npy", {.cell_m = 0.5});
  ASSERT_TRUE(survey.ok() && bed.ok());
  // The corner in the east and south, 25 x 25 m: cells of 2 m, the survey one cell larger on each
  // side.
  double least_m = 1e9, most_m = -1e9, highest_m = -1e9, lowest_m = 1e9;
  for (std::uint32_t row = 52; row <= 64; ++row)
    for (std::uint32_t column = 52; column <= 64; ++column) {
      const double measured = survey->heights_m[(row + 1) * survey->columns + column + 1];
      const double off = bed->heights_m[4 * row * bed->columns + 4 * column] - measured;
      least_m = std::min(least_m, off), most_m = std::max(most_m, off);
      lowest_m = std::min(lowest_m, measured), highest_m = std::max(highest_m, measured);
    }
  EXPECT_LT(most_m - least_m, 0.16);
  EXPECT_GT(highest_m - lowest_m, 0.18);
}

// The format's page names every key that the reader knows.
TEST(SceneAssets, TheFormatsPageHasEveryKey) {
  const auto page = read_text(test::source_dir() / "assets/scenes/README.md");
  ASSERT_TRUE(page.ok());
  for (const KeyList keys : {KeyList(kSceneKeys),
                             KeyList(kSunKeys),
                             KeyList(kSunShadowKeys),
                             KeyList(kCausticsKeys),
                             KeyList(kShaftKeys),
                             KeyList(kAmbientKeys),
                             KeyList(kSkylightKeys),
                             KeyList(kLabKeys),
                             KeyList(kLensKeys),
                             KeyList(kPortKeys),
                             KeyList(kFocusKeys),
                             KeyList(kShutterKeys),
                             KeyList(kImageSensorKeys),
                             KeyList(kSpectrumKeys),
                             KeyList(kFlockKeys),
                             KeyList(kTetherKeys),
                             KeyList(kWinchKeys),
                             KeyList(kWaterKeys),
                             KeyList(kForwardScatterKeys),
                             KeyList(kSnowKeys),
                             KeyList(kWavesKeys),
                             KeyList(kMurkKeys),
                             KeyList(kBubbleKeys),
                             KeyList(kSiltKeys),
                             KeyList(kLayerKeys),
                             KeyList(kObjectKeys),
                             KeyList(kScatterKeys),
                             KeyList(kPhysicsKeys),
                             KeyList(kCurrentKeys),
                             KeyList(kMissionKeys),
                             KeyList(kMissionWaypointKeys),
                             KeyList(kOrbitKeys),
                             KeyList(kFollowKeys),
                             KeyList(kStandBetweenKeys),
                             KeyList(kDiverInputKeys),
                             KeyList(kVehicleInputKeys),
                             KeyList(kObjectInputKeys),
                             KeyList(kInputChoiceKeys),
                             KeyList(kSourceKeys),
                             KeyList(kModemKeys),
                             KeyList(kModemUsblKeys),
                             KeyList(kAcousticsKeys),
                             KeyList(kTrackKeys),
                             KeyList(kLawnMowerKeys),
                             KeyList(kCameraKeys),
                             KeyList(kDetailKeys),
                             KeyList(kSonarKeys),
                             KeyList(kSonarWaterKeys),
                             KeyList(kSonarLevelKeys),
                             KeyList(kSonarBeamKeys),
                             KeyList(kSonarRangeSpreadKeys),
                             KeyList(kSonarSpeckleKeys),
                             KeyList(kSonarNoiseKeys),
                             KeyList(kSonarGhostKeys),
                             KeyList(kSonarSoundSpeedKeys),
                             KeyList(kSonarMotionKeys),
                             KeyList(kSonarLabelKeys),
                             KeyList(kSonarOutputKeys),
                             KeyList(kSonarDetectionKeys),
                             KeyList(kLampKeys)})
    for (const Key key : keys)
      EXPECT_NE(page->find("`" + std::string(key) + "`"), std::string::npos) << key;
}

}  // namespace
}  // namespace neritic::scene
