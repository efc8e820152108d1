// A session's sonars follow their settings from frame to frame, keep their times apart, and say
// what they were made with.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <set>

#include "engine/core/files.hpp"
#include "engine/core/json.hpp"
#include "engine/scene/shapes.hpp"
#include "sonar/quality.hpp"
#include "testbed/output/output.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

using SonarSettings = test::GpuTest;

scene::Sonar small_named_sonar(const std::string& name) {
  scene::Sonar sonar;
  sonar.name = name;
  sonar.bins_range = 40;
  sonar.bins_azimuth = 24;
  sonar.bins_elevation = 16;
  return sonar;
}

// A sphere 3 m ahead of the sonars.
scene::Scene sphere_and_sonars(std::vector<scene::Sonar> sonars) {
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_sphere(1.0)));
  scene::Object object;
  object.name = "sphere";
  object.model = 0;
  object.mount.pose.position_m = {0.0, 0.0, -3.0};
  object.class_id = 12;
  object.instance = 1;
  scene.objects.push_back(object);
  scene.sonars = std::move(sonars);
  return scene;
}

FrameRequest all_sonars(const scene::Scene& scene) {
  FrameRequest request;
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) request.sonars.push_back(i);
  return request;
}

TEST_F(SonarSettings, ChangedBetweenFramesGiveTheImageOfANewSession) {
  scene::Scene scene = sphere_and_sonars({small_named_sonar("a")});
  const FrameRequest request = all_sonars(scene);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult before, session->render(request));
  scene::Sonar& sonar = scene.sonars[0];
  sonar.range_max_m = 8.0;
  sonar.bins_range = 60;
  sonar.gbuffer_scale = 2.0;
  sonar.near_m = 0.1;
  sonar.gather = "nearest";
  session->replace_sonar(0, sonar);
  NERITIC_ASSERT_OK(const FrameResult after, session->render(request));
  NERITIC_ASSERT_OK(const auto fresh, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult expected, fresh->render(request));
  EXPECT_EQ(before.sonars[0].image.n_range, 40u);
  EXPECT_EQ(after.sonars[0].image.n_range, 60u);
  EXPECT_EQ(after.sonars[0].gather, "nearest");
  EXPECT_EQ(after.sonars[0].image.intensity, expected.sonars[0].image.intensity);
  EXPECT_EQ(after.sonars[0].image.labels, expected.sonars[0].image.labels);
  EXPECT_GT(
      std::count(after.sonars[0].image.labels.begin(), after.sonars[0].image.labels.end(), 12), 0);
}

TEST_F(SonarSettings, TwoSonarsHavePassTimesOfTheirOwn) {
  const scene::Scene scene =
      sphere_and_sonars({small_named_sonar("port"), small_named_sonar("starboard")});
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(all_sonars(scene)));
  std::multiset<std::string> names;
  for (const gpu::PassTime& pass : result.passes) names.insert(pass.name);
  for (const char* name :
       {"port sonar clear", "port sonar gather", "starboard sonar clear", "starboard sonar gather"})
    EXPECT_EQ(names.count(name), 1u) << name;
}

TEST_F(SonarSettings, ReflectivityIsATableOnlyWhereAnObjectHasOne) {
  scene::Scene scene = sphere_and_sonars({small_named_sonar("a")});
  float full = 0.0f;
  for (const float reflectivity : {1.0f, 0.5f}) {
    scene.objects[0].reflectivity = reflectivity;
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
    session->keep_plan_dump(true);
    NERITIC_ASSERT_OK(const FrameResult result, session->render(all_sonars(scene)));
    EXPECT_EQ(session->plan_text().find("reflectivity") != std::string::npos, reflectivity != 1.0f);
    // A reader who gathers the frame's arrays again finds it here, by instance label.
    const std::vector<float>& table = result.sonars[0].reflectivity;
    ASSERT_EQ(table.empty(), reflectivity == 1.0f);
    if (!table.empty()) {
      EXPECT_EQ(table.at(scene.objects[0].instance), reflectivity);
    }
    const auto& image = result.sonars[0].image.intensity;
    const float most = *std::max_element(image.begin(), image.end());
    ASSERT_GT(most, 0.0f);
    if (reflectivity == 1.0f)
      full = most;
    else
      EXPECT_NEAR(most, full / 2.0f, 1e-5f);
  }
}

TEST_F(SonarSettings, FileSaysWhichPixelsACellWereAskedForAndUsed) {
  scene::Scene scene = sphere_and_sonars({small_named_sonar("a")});
  // Wider than any device's largest image, ten pixels high.
  scene.sonars[0].bins_azimuth = 4096;
  scene.sonars[0].bins_elevation = 1;
  scene.sonars[0].elevation_rad = radians(1.0);
  scene.sonars[0].gbuffer_scale = 10.0;
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(all_sonars(scene)));
  const test::ScratchFolder scratch;
  FrameFacts facts;
  facts.scene = "scene\xff.toml";  // a path need not be UTF-8
  ASSERT_TRUE(write_sonar_frame(scratch / "sonar", result.sonars[0], facts).ok());
  NERITIC_ASSERT_OK(const auto text, read_text(scratch / "sonar" / "sonar.json"));
  const auto gbuffer = parse_json(text).value()["model"]["gbuffer"];
  EXPECT_EQ(gbuffer["width"], result.sonars[0].gbuffer_width);
  EXPECT_EQ(gbuffer["pixels_per_cell"]["requested"], 10.0);
  EXPECT_LT(gbuffer["pixels_per_cell"]["used"][0].get<double>(), 9.0);
  EXPECT_NEAR(gbuffer["pixels_per_cell"]["used"][1].get<double>(), 10.0, 1.0);
}

TEST_F(SonarSettings, FileSaysWhichQualityTheSonarIsSampledBy) {
  scene::Scene scene = sphere_and_sonars(
      {small_named_sonar("named"), small_named_sonar("bounded"), small_named_sonar("plain")});
  scene.sonars[0].quality = "draft";
  scene.sonars[1].max_error = 0.02;
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(all_sonars(scene)));
  const test::ScratchFolder scratch;
  std::vector<nlohmann::json> said;
  for (const SonarFrame& frame : result.sonars) {
    ASSERT_TRUE(write_sonar_frame(scratch / frame.name, frame, FrameFacts{}).ok());
    NERITIC_ASSERT_OK(const auto text, read_text(scratch / frame.name / "sonar.json"));
    said.push_back(parse_json(text).value()["model"]);
  }
  const auto levels = sonar::quality_levels(scene::SonarKind::kImaging);
  EXPECT_EQ(said[0]["quality"]["level"], "draft");
  EXPECT_EQ(said[0]["quality"]["measured_error"], levels[0].error);
  EXPECT_FALSE(said[0]["quality"].contains("max_error"));
  EXPECT_EQ(said[1]["quality"]["level"], "standard");
  EXPECT_EQ(said[1]["quality"]["measured_error"], levels[1].error);
  EXPECT_EQ(said[1]["quality"]["max_error"], 0.02);
  EXPECT_FALSE(said[2].contains("quality"));
}

}  // namespace
}  // namespace neritic::testbed
