// Sonars that move over a bottom, end to end: what a track adds up to, against the terrain.
#include "testbed/output/survey.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "engine/core/files.hpp"
#include "engine/core/npy.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

using SurveyTest = test::GpuTest;

// A carrier without a model, and what it carries: index 0 of the objects.
scene::Scene scene_with_bottom(scene::Model bottom) {
  scene::Scene scene;
  scene.path = "test";
  scene::Object carrier;
  carrier.name = "carrier";
  carrier.instance = 1;
  scene::Object ground;
  ground.name = "bottom";
  ground.model = 0;
  ground.class_id = 1;
  ground.instance = 2;
  scene.models.push_back(std::make_shared<scene::Model>(std::move(bottom)));
  scene.objects = {carrier, ground};
  return scene;
}

nlohmann::json read_json(const std::filesystem::path& path) {
  const auto text = read_text(path);
  return text.ok() ? nlohmann::json::parse(*text) : nlohmann::json();
}

// Real multibeam soundings, 120 x 120 m of them.
Result<scene::Heightfield> real_bottom(const std::filesystem::path& shared) {
  NERITIC_TRY(const scene::Heightfield whole,
              scene::read_heightfield(shared / "data/bathymetry/bathy-jd211/jd211_crop_a.asc", {}));
  constexpr std::uint32_t kSide = 60, kFrom = 150;
  scene::Heightfield crop{kSide, kSide, whole.cell_m, {}};
  for (std::uint32_t row = 0; row < kSide; ++row)
    for (std::uint32_t column = 0; column < kSide; ++column)
      crop.heights_m.push_back(
          whole.heights_m[std::size_t{kFrom + row} * whole.columns + kFrom + column]);
  return crop;
}

// Looks down from the first object, from 5 m on, by 300 range bins.
scene::Sonar multibeam(double range_max_m, std::uint32_t beams, std::uint32_t rows) {
  scene::Sonar sonar;
  sonar.name = "multibeam";
  sonar.kind = scene::SonarKind::kProfiling;
  sonar.range_min_m = 5.0;
  sonar.range_max_m = range_max_m;
  sonar.azimuth_rad = radians(90.0);
  sonar.elevation_rad = radians(0.5);
  sonar.bins_range = 300;
  sonar.bins_azimuth = beams;
  sonar.bins_elevation = rows;
  sonar.mount.object = 0;
  sonar.mount.pose.rotation = glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0));
  return sonar;
}

TEST_F(SurveyTest, ALawnMowerTrackChartsTheRealBottom) {
  NERITIC_REQUIRE_SHARED(shared);
  NERITIC_ASSERT_OK(const scene::Heightfield field, real_bottom(shared));
  scene::Scene scene = scene_with_bottom(scene::make_terrain(field));
  scene.sonars = {multibeam(35.0, 256, 8)};  // bins of 0.1 m
  const scene::LawnMower mower{-40.0, -40.0, 40.0, 40.0, 36.0, 25.0, true};
  const scene::Waypoints course{scene::waypoints_of(mower), 2.0, 0.0};
  scene.objects[0].mount.track = scene::track_of(scene::places_of(course), {});
  const double end_s = scene.objects[0].mount.track->places.back().time_s;

  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const test::ScratchFolder out;
  Survey survey(session->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  for (request.frame = 0; request.time_s < end_s; ++request.frame) {
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    ASSERT_TRUE(survey.add(result, request.frame, request.time_s).ok());
    request.time_s += 0.5;
  }
  ASSERT_TRUE(survey.write({}).ok());
  // A metre apart, on cells of a fiftieth of 35 m.
  EXPECT_NE(survey.hint().value_or("").find("--chart-cell 1"), std::string::npos);
  const auto folder = out / "track" / "multibeam";
  const auto error = read_json(folder / "bathymetry.json")["error"];
  EXPECT_GT(error["nadir_soundings"]["count"], 1000);
  // Half a range bin at nadir, and everywhere not much more.
  EXPECT_LT(error["nadir_soundings"]["rms_m"], 0.05);
  EXPECT_LT(error["grid_at_soundings"]["rms_m"], 0.10);
  EXPECT_GT(error["grid_at_soundings"]["coverage"], 0.5);
  for (const char* file : {"cloud.npy", "cloud.pcd", "bathymetry.npy", "bathymetry.png"})
    EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
}

// A box on a level floor is charted where it is, and takes no part in the error against the floor.
TEST_F(SurveyTest, WhatStandsOnTheBottomIsChartedAndCountedApart) {
  scene::Scene scene = scene_with_bottom(scene::make_plane(60.0, 60.0));
  scene.objects[1].mount.pose.position_m = {0.0, -20.0, 0.0};
  scene::Object box;
  box.name = "box";
  box.model = 1;
  box.class_id = 11;
  box.instance = 3;
  box.mount.pose.position_m = {0.0, -19.0, 0.0};
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({4.0, 2.0, 4.0})));
  scene.objects.push_back(box);
  scene.sonars = {multibeam(20.0, 181, 16)};  // bins of 5 cm
  const scene::Waypoints course{{Vec3(0, -10, 6), Vec3(0, -10, -6)}, 2.0, 0.0};
  scene.objects[0].mount.track = scene::track_of(scene::places_of(course), {});
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const test::ScratchFolder out;
  Survey survey(session->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  for (request.frame = 0; request.frame < 24; ++request.frame) {
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    ASSERT_TRUE(survey.add(result, request.frame, request.time_s).ok());
    request.time_s += 0.25;
  }
  ASSERT_TRUE(survey.write({}).ok());
  const auto folder = out / "track" / "multibeam";
  const auto json = read_json(folder / "bathymetry.json");
  const double all = json["soundings"], on_box = json["error"]["soundings_on_objects"];
  EXPECT_EQ(json["error"]["terrain_soundings"]["count"], all - on_box);
  EXPECT_LT(json["error"]["terrain_soundings"]["rms_m"], 0.05);
  EXPECT_LT(json["error"]["nadir_soundings"]["rms_m"], 0.025);
  EXPECT_LT(json["error"]["grid_at_soundings"]["rms_m"], 0.05);
  // Half a metre a ping over 4 m: 8 or 9 pings; 8 m above it the box is 28.1 degrees wide, 56
  // beams.
  EXPECT_NEAR(on_box, 8.5 * 56, 40);
  NERITIC_ASSERT_OK(const NpyArray chart, read_npy(folder / "bathymetry.npy"));
  double shallowest = 1e9;
  for (const double depth : chart.to_doubles())
    if (!std::isnan(depth)) shallowest = std::min(shallowest, depth);
  EXPECT_NEAR(shallowest, 18.0, 0.05);
}

// Beams that pass a floor narrower than the swath hear noise alone, and no bottom in it.
TEST_F(SurveyTest, NoiseIsNoBottom) {
  scene::Scene scene = scene_with_bottom(scene::make_plane(8.0, 8.0));
  scene::Sonar sonar;
  sonar.name = "multibeam";
  sonar.kind = scene::SonarKind::kProfiling;
  sonar.range_min_m = 1.0;
  sonar.range_max_m = 30.0;
  sonar.azimuth_rad = radians(90.0);
  sonar.elevation_rad = radians(1.0);
  sonar.bins_range = 400;
  sonar.bins_azimuth = 128;
  sonar.bins_elevation = 32;
  sonar.mount.pose = {Vec3(0.0, -10.0, 0.0), glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0))};
  sonar.terms.level = scene::SonarLevel{.source_level_db = 200.0, .tvg_log = 30.0};
  sonar.terms.noise = scene::SonarNoise{.level_db = 70.0};
  scene.objects[1].mount.pose.position_m = {0.0, -20.0, 0.0};
  scene.sonars = {sonar};
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const test::ScratchFolder out;
  Survey survey(session->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  double loudest_beyond = 0.0;
  for (request.frame = 0; request.frame < 20; ++request.frame) {
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    ASSERT_TRUE(survey.add(result, request.frame, request.time_s).ok());
    const auto& image = result.sonars[0].image.intensity;
    for (std::size_t i = 300 * 128; i < image.size(); ++i)
      loudest_beyond = std::max<double>(loudest_beyond, image[i]);
  }
  EXPECT_GT(loudest_beyond, 0.0);  // there is noise behind the floor
  ASSERT_TRUE(survey.write({}).ok());
  const auto json = read_json(out / "track" / "multibeam" / "bathymetry.json");
  // The floor spans 43.6 of the 90 degrees: 62 of 128 beams.
  EXPECT_NEAR(json["soundings"].get<double>() / 20, 62.0, 3.0);
  // A beam that hears the floor's end with a part of its width may look past it: one on each side.
  EXPECT_NEAR(json["error"]["terrain_soundings"]["count"].get<double>(),
              json["soundings"].get<double>(), 2.0 * 20.0);
  EXPECT_LT(json["error"]["terrain_soundings"]["max_abs_m"], 0.3);
}

TEST_F(SurveyTest, AnEchoSounderComesDownAtFiveMetresAMinute) {
  scene::Scene scene = scene_with_bottom(scene::make_plane(200.0, 200.0));
  scene.objects[1].mount.pose.position_m = {0.0, -60.0, 0.0};
  scene::Sonar sonar;
  sonar.name = "sounder";
  sonar.kind = scene::SonarKind::kEchoSounder;
  sonar.semi_angle_rad = radians(12.5);
  sonar.range_min_m = 0.3;
  sonar.range_max_m = 30.3;
  sonar.bins_range = 600;
  sonar.bins_azimuth = sonar.bins_elevation = 64;
  sonar.mount.object = 0;
  sonar.mount.pose.rotation = glm::angleAxis(-kPi / 2.0, Vec3(1, 0, 0));
  scene.sonars = {sonar};
  constexpr double kRate = 5.0 / 60.0;
  scene.objects[0].mount.track =
      scene::track_of(scene::places_of({{Vec3(0, -35.0, 0), Vec3(0, -55.0, 0)}, kRate, 0.0}), {});
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const test::ScratchFolder out;
  Survey survey(session->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  for (request.frame = 0; request.frame < 120; ++request.frame) {
    request.time_s = request.frame * 2.0;
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    ASSERT_TRUE(survey.add(result, request.frame, request.time_s).ok());
  }
  ASSERT_TRUE(survey.write({}).ok());
  NERITIC_ASSERT_OK(const auto table, read_text(out / "track" / "sounder" / "echo_trace.csv"));
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  EXPECT_EQ(line.rfind("ping,time_s,sonar_depth_m,first_range_m", 0), 0u) << line;
  int pings = 0;
  while (std::getline(lines, line)) {
    double time = 0, depth = 0, first = 0;
    ASSERT_EQ(std::sscanf(line.c_str(), "%*d,%lf,%lf,%lf", &time, &depth, &first), 3) << line;
    EXPECT_NEAR(first, 25.0 - kRate * time, 0.05) << "at " << time << " s";
    ++pings;
  }
  EXPECT_EQ(pings, 120);
  const auto facts = read_json(out / "track" / "sounder" / "echo_trace.json");
  EXPECT_NEAR(facts["first_return_fit"]["slope_m_s"].get<double>() / -kRate, 1.0, 0.005);
}

TEST_F(SurveyTest, ASideScanPassesAnObjectAndItsShadow) {
  scene::Scene scene = scene_with_bottom(scene::make_plane(200.0, 200.0));
  scene.objects[1].mount.pose.position_m = {0.0, -20.0, 0.0};
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box(Vec3(2.0, 2.0, 2.0))));
  scene::Object box;
  box.name = "box";
  box.model = 1;
  box.class_id = 12;
  box.instance = 3;
  box.mount.pose.position_m = {15.0, -19.0, 0.0};
  scene.objects.push_back(box);
  scene::Sonar sonar;
  sonar.name = "sidescan";
  sonar.kind = scene::SonarKind::kSideScan;
  sonar.azimuth_rad = radians(1.0);
  sonar.elevation_rad = radians(70.0);
  sonar.depression_rad = radians(40.0);
  sonar.range_min_m = 1.0;
  sonar.range_max_m = 41.0;
  sonar.bins_range = 800;
  sonar.bins_azimuth = 1;
  sonar.bins_elevation = 2048;
  sonar.mount.object = 0;
  scene.sonars = {sonar};
  scene.objects[0].mount.track =
      scene::track_of(scene::places_of({{Vec3(0, -10, 10), Vec3(0, -10, -10)}, 2.0, 0.0}), {});
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  const test::ScratchFolder out;
  Survey survey(session->scene(), out.path());
  FrameRequest request;
  request.sonars = {0};
  request.capture = request.capture.without_geometry();
  std::vector<float> abeam;
  for (request.frame = 0; request.frame < 40; ++request.frame) {
    request.time_s = request.frame * 0.25;
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    ASSERT_TRUE(survey.add(result, request.frame, request.time_s).ok());
    if (request.frame == 20) abeam = result.sonars[1].image.intensity;
  }
  // Abeam: bottom at 10 m below, the box's near face at hypot(14, 8..10) m, its shadow from its far
  // upper edge (16, 8 below) on to where that ray meets the bottom: 20 m off, slant hypot(20, 10).
  const auto at = [&](double range_m) {
    return abeam[static_cast<std::size_t>((range_m - 1.0) / 40.0 * 800)];
  };
  EXPECT_EQ(at(9.5), 0.0f);
  EXPECT_GT(at(12.0), 0.0f);
  EXPECT_GT(at(16.5), 3.0f * at(15.5));
  for (const double range : {18.5, 20.0, 21.5}) EXPECT_EQ(at(range), 0.0f) << range;
  EXPECT_GT(at(23.0), 0.0f);
  ASSERT_TRUE(survey.write({}).ok());
  EXPECT_TRUE(std::filesystem::exists(out / "track" / "sidescan" / "sidescan_slant.png"));
}

}  // namespace
}  // namespace neritic::testbed
