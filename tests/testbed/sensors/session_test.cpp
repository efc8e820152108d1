// Promises of a session: the same picture far from the origin, from one or two eyes, and nothing
// in the graph that the scene does not name.
#include "testbed/sensors/session.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <set>

#include "engine/core/hash.hpp"
#include "engine/scene/shapes.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

using SessionTest = test::GpuTest;

Result<scene::Scene> small_scene(const std::string& file, const Vec3& offset_m = Vec3(0.0)) {
  scene::SceneOptions options;
  options.offset_m = offset_m;
  auto scene = scene::load_scene(test::source_dir() / "assets/scenes" / file, options);
  if (scene.ok())
    for (scene::Camera& camera : scene->cameras)
      camera.width = 201, camera.height = 113;  // no multiple of a group
  return scene;
}

FrameRequest everything(const scene::Scene& scene) {
  FrameRequest request;
  for (std::size_t i = 0; i < scene.cameras.size(); ++i) request.cameras.push_back(i);
  for (std::size_t i = 0; i < scene.sonars.size(); ++i) request.sonars.push_back(i);
  return request;
}

std::string hash_of(const FrameResult& result) {
  Hash64 hash;
  for (const CameraFrame& camera : result.cameras)
    for (const ViewImages& eye : camera.eyes) {
      hash.add_span(std::span<const std::uint8_t>(eye.color.data));
      hash.add_span(std::span<const float>(eye.depth.data));
      hash.add_span(std::span<const float>(eye.normals.data));
      hash.add_span(std::span<const std::uint16_t>(eye.labels.data));
      hash.add_span(std::span<const std::uint16_t>(eye.instances.data));
      hash.add_span(std::span<const float>(eye.motion.data));
    }
  for (const SonarFrame& sonar : result.sonars) {
    hash.add_span(std::span<const float>(sonar.image.intensity));
    hash.add_span(std::span<const std::uint16_t>(sonar.image.labels));
  }
  return hash.hex();
}

// A scene that holds one sphere around (0, -5, 0).
scene::Scene sphere_scene(double radius_m) {
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_sphere(radius_m)));
  scene::Object object;
  object.name = "sphere";
  object.model = 0;
  object.mount.pose.position_m = {0.0, -5.0, 0.0};
  object.class_id = 12;
  object.instance = 1;
  scene.objects.push_back(object);
  scene.sun = scene::Sun{};
  scene::Camera camera;
  camera.name = "eye";
  camera.width = 160;
  camera.height = 90;
  camera.mount.pose.position_m = {0.0, -5.0, 4.0};
  scene.cameras.push_back(camera);
  return scene;
}

// The pool is the simplest scene; the wreck has skins, copies, lamps and scattering.
class SceneFiles : public test::GpuTest, public ::testing::WithParamInterface<const char*> {};
INSTANTIATE_TEST_SUITE_P(Scenes, SceneFiles, ::testing::Values("pool.toml", "wreck.toml"),
                         [](const auto& info) { return std::string(info.param).substr(0, 4); });

TEST_P(SceneFiles, RunsGiveTheSameBits) {
  NERITIC_ASSERT_OK(scene::Scene scene, small_scene(GetParam()));
  const FrameRequest request = everything(scene);
  std::string first;
  // Each from nothing, then more in the memory of the first; twenty in all where the test is
  // thorough.
  const int runs = test::is_thorough() ? 4 : 2, frames = test::is_thorough() ? 5 : 3;
  for (int run = 0; run < runs; ++run) {
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
    for (int frame = 0; frame < frames; ++frame) {
      NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
      if (first.empty()) first = hash_of(result);
      EXPECT_EQ(hash_of(result), first) << "run " << run << ", frame " << frame;
    }
  }
}

TEST_P(SceneFiles, HundredKilometresAwayLooksAndSoundsTheSame) {
  NERITIC_ASSERT_OK(scene::Scene here, small_scene(GetParam()));
  NERITIC_ASSERT_OK(scene::Scene there, small_scene(GetParam(), {1e5, 0.0, -1e5}));
  // Waves and snow belong to their place, so nets of light and flakes differ from place to place.
  for (scene::Scene* scene : {&here, &there}) {
    if (scene->sun) scene->sun->caustics.reset();
    if (scene->water) {
      scene->water->snow.reset();
      scene->water->waves.reset();
    }
  }
  // Texels of shadow maps lie on a lattice of the world, so the edges of shadows move by parts of
  // one.
  const bool shadows = here.sun && here.sun->shadows;
  const FrameRequest request = everything(here);
  NERITIC_ASSERT_OK(const auto near, Session::create(device(), std::move(here)));
  NERITIC_ASSERT_OK(const auto far, Session::create(device(), std::move(there)));
  NERITIC_ASSERT_OK(const FrameResult a, near->render(request));
  NERITIC_ASSERT_OK(const FrameResult b, far->render(request));
  const ImageU8 &x = a.cameras[0].eyes[0].color, &y = b.cameras[0].eyes[0].color;
  int worst = 0;
  double sum = 0.0;
  for (std::size_t i = 0; i < x.data.size(); ++i) {
    const int off = std::abs(int(x.data[i]) - int(y.data[i]));
    worst = std::max(worst, off);
    sum += off;
  }
  EXPECT_LE(worst, shadows ? 60 : 1);
  EXPECT_LT(sum, 0.3 * static_cast<double>(x.data.size()));
  double energy = 0.0, moved = 0.0;
  const sonar::SonarImage &s = a.sonars[0].image, &t = b.sonars[0].image;
  for (std::size_t i = 0; i < s.intensity.size(); ++i) {
    energy += s.intensity[i];
    moved += std::abs(s.intensity[i] - t.intensity[i]);
  }
  ASSERT_GT(energy, 0.0);
  EXPECT_LT(moved, 1e-3 * energy);
}

TEST_F(SessionTest, StereoPairOfOneMultiviewPassIsTwoSingleViews) {
  scene::Scene both = sphere_scene(1.0);
  both.cameras[0].stereo_baseline_m = 0.3;
  FrameRequest request;
  request.cameras = {0};
  NERITIC_ASSERT_OK(const auto stereo, Session::create(device(), both));
  stereo->keep_plan_dump(true);
  NERITIC_ASSERT_OK(const FrameResult pair, stereo->render(request));
  ASSERT_EQ(pair.cameras[0].eyes.size(), 2u);
  for (int e = 0; e < 2; ++e) {
    scene::Scene one = sphere_scene(1.0);
    one.cameras[0].mount.pose.position_m.x = e == 0 ? -0.15 : 0.15;
    NERITIC_ASSERT_OK(const auto single, Session::create(device(), one));
    NERITIC_ASSERT_OK(const FrameResult alone, single->render(request));
    const ViewImages &a = pair.cameras[0].eyes[e], &b = alone.cameras[0].eyes[0];
    std::size_t different = 0, depth_off = 0, normal_off = 0, color_off = 0;
    for (std::size_t i = 0; i < a.labels.data.size(); ++i) {
      different += a.labels.data[i] != b.labels.data[i];
      const float p = a.depth.data[i], q = b.depth.data[i];
      depth_off += p != q && !(std::abs(p - q) < 1e-3f);  // both infinite: equal
      double normal = 0.0;
      int color = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        normal = std::max<double>(normal,
                                  std::abs(a.normals.data[3 * i + k] - b.normals.data[3 * i + k]));
        const std::size_t at = i * a.color.channels + k;
        color = std::max(color, std::abs(int(a.color.data[at]) - int(b.color.data[at])));
      }
      normal_off += !(normal < 0.01);
      color_off += color > 2;
    }
    // Only pixels on the sphere's edge may fall to the other side by rounding.
    EXPECT_LE(different, 8u);
    EXPECT_LE(depth_off, 16u);
    EXPECT_LE(normal_off, 16u);
    EXPECT_LE(color_off, 16u);
    EXPECT_NE(std::count(a.labels.data.begin(), a.labels.data.end(), 12), 0);
  }
  // One pass for both eyes.
  const std::string& plan = stereo->plan_text();
  EXPECT_EQ(plan.find("eye gbuffer"), plan.rfind("eye gbuffer"));
}

TEST_F(SessionTest, SphereHasItsClosedFormDepthAndNormals) {
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), sphere_scene(1.0)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  const ViewImages& eye = result.cameras[0].eyes[0];
  int checked = 0;
  for (std::uint32_t y = 0; y < eye.height; ++y)
    for (std::uint32_t x = 0; x < eye.width; ++x) {
      const Vec3 ray{(x + 0.5 - eye.intrinsics.cx) / eye.intrinsics.fx,
                     -(y + 0.5 - eye.intrinsics.cy) / eye.intrinsics.fy, -1.0};
      // |t ray - center| = 1 with the centre 4 m ahead.
      const double a = glm::dot(ray, ray), b = -2.0 * 4.0, c = 16.0 - 1.0;
      const double under = b * b - 4.0 * a * c;
      if (under < 0.6) {
        if (under < -0.6) {
          EXPECT_TRUE(std::isinf(eye.depth.at(x, y)));
        }
        continue;  // the mesh's silhouette
      }
      const double t = (-b - std::sqrt(under)) / (2.0 * a);
      EXPECT_NEAR(eye.depth.at(x, y), t,
                  0.02);  // 48 segments: a facet lies up to 2 mm inside, more at the rim
      const Vec3 n = ray * t - Vec3(0, 0, -4);
      const Vec3 seen(eye.normals.at(x, y, 0), eye.normals.at(x, y, 1), eye.normals.at(x, y, 2));
      EXPECT_GT(glm::dot(n, seen), 0.995);
      ++checked;
    }
  EXPECT_GT(checked, 200);
}

TEST_F(SessionTest, GraphHoldsNothingThatTheSceneDoesNotName) {
  scene::Scene scene = sphere_scene(1.0);
  FrameRequest request;
  request.cameras = {0};
  request.capture.motion = false;
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), scene));
  session->keep_plan_dump(true);
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  for (const char* absent :
       {"sonar", "gather", "deform", "forward", "motion", "emissive", "reflectivity"})
    EXPECT_EQ(session->plan_text().find(absent), std::string::npos) << absent;
  for (const gpu::PassTime& pass : result.passes)
    for (const char* absent : {"sonar", "deform", "forward", "motion"})
      EXPECT_EQ(pass.name.find(absent), std::string::npos) << pass.name;
}

// A sonar where the camera is.
scene::Scene with_sonar(scene::Scene scene) {
  scene::Sonar sonar;
  sonar.name = "sonar";
  sonar.range_min_m = 0.1;
  sonar.mount.pose = scene.cameras[0].mount.pose;
  scene.sonars.push_back(sonar);
  return scene;
}

double sum_of(const sonar::SonarImage& image) {
  return std::accumulate(image.intensity.begin(), image.intensity.end(), 0.0);
}

TEST_F(SessionTest, AnEmptySceneIsWaterOnly) {
  scene::Scene scene = with_sonar(sphere_scene(1.0));
  scene.objects.clear();
  scene.models.clear();
  const FrameRequest request = everything(scene);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  const ViewImages& eye = result.cameras[0].eyes[0];
  ASSERT_FALSE(eye.color.empty());
  for (const float depth : eye.depth.data) ASSERT_EQ(depth, std::numeric_limits<float>::infinity());
  for (const std::uint16_t label : eye.labels.data) ASSERT_EQ(label, 0);
  EXPECT_EQ(sum_of(result.sonars[0].image), 0.0);
}

// A sonar hears the wall that it is inside of, from 1 m on all sides; a camera sees it where the
// material has two sides, and the water through it where it has one.
TEST_F(SessionTest, FromInsideAMesh) {
  for (const bool two_sided : {false, true}) {
    scene::Scene scene = sphere_scene(1.0);
    scene.cameras[0].mount.pose.position_m = {0.0, -5.0, 0.0};
    scene::Model model = *scene.models[0];
    model.materials.emplace_back().double_sided = two_sided;
    model.meshes[0].primitives[0].material = 0;
    scene.models[0] = std::make_shared<scene::Model>(std::move(model));
    scene = with_sonar(std::move(scene));
    const FrameRequest request = everything(scene);
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    const ViewImages& eye = result.cameras[0].eyes[0];
    const float middle = eye.depth.at(eye.width / 2, eye.height / 2);
    if (two_sided)
      EXPECT_NEAR(middle, 1.0, 0.01);
    else
      EXPECT_TRUE(std::isinf(middle));
    EXPECT_EQ(eye.labels.at(eye.width / 2, eye.height / 2), two_sided ? 12 : 0);
    const sonar::SonarImage& heard = result.sonars[0].image;
    const sonar::Limits& limits = result.sonars[0].grid.limits;
    double near_wall = 0.0;
    for (std::uint32_t row = 0; row < heard.n_range; ++row) {
      const double range_m = limits.range_min_m + (row + 0.5) *
                                                      (limits.range_max_m - limits.range_min_m) /
                                                      heard.n_range;
      if (std::abs(range_m - 1.0) > 0.03) continue;
      for (std::uint32_t column = 0; column < heard.n_azimuth; ++column)
        near_wall += heard.intensity[std::size_t{row} * heard.n_azimuth + column];
    }
    EXPECT_NEAR(near_wall, double(heard.n_azimuth), 0.01 * heard.n_azimuth);
    EXPECT_NEAR(sum_of(heard), near_wall, 1e-3 * near_wall);
  }
}

// Triangles that reach far outside the frustum are clipped: in every view of the set, not in one.
TEST_F(SessionTest, WallWiderThanThePictureFillsBothEyes) {
  scene::Scene scene = sphere_scene(1.0);
  scene.models[0] = std::make_shared<scene::Model>(scene::make_box({40.0, 40.0, 0.1}));
  scene.cameras[0].stereo_baseline_m = 0.1;
  FrameRequest request;
  request.cameras = {0};
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  for (const ViewImages& eye : result.cameras[0].eyes)
    for (const float depth : eye.depth.data) ASSERT_NEAR(depth, 3.95, 1e-3);
}

TEST_F(SessionTest, FiveThousandInstancesAreOneDraw) {
  scene::Scene scene = sphere_scene(0.4);
  for (int i = 0; i < 5000; ++i)
    scene.objects[0].copies.push_back(
        glm::translate(Mat4(1.0), Vec3(i % 100 - 50, i / 100 - 25, -60.0)));
  FrameRequest request;
  request.cameras = {0};
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  const render::FrameState state =
      render::evaluate_frame(session->scene(), session->gpu_scene(), 0.0, 0.1, false);
  const render::DrawList draws =
      render::build_draw_list(session->scene(), session->gpu_scene(), state,
                              camera_views(session->scene(), session->scene().cameras[0]));
  ASSERT_EQ(draws.opaque.size(), 1u);
  EXPECT_GT(draws.opaque[0].instance_count, 1000u);
  // Each once, front to back, whichever core looked at it.
  std::set<std::uint32_t> labels;
  double before_m = 0.0;
  for (const shared::Instance& instance : draws.instances) {
    EXPECT_TRUE(labels.insert(instance.label).second);
    const double away_m = glm::length(Vec3(instance.row0.w, instance.row1.w, instance.row2.w));
    EXPECT_GT(away_m, before_m - 1e-4);
    before_m = away_m;
  }
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  const auto& instances = result.cameras[0].eyes[0].instances.data;
  EXPECT_GT(std::set<std::uint16_t>(instances.begin(), instances.end()).size(), 1000u);
}

TEST_F(SessionTest, WideApertureTakesSeveralViewsInOnePass) {
  scene::Scene scene = sphere_scene(2.8);  // around the sonar
  scene.cameras.clear();
  scene::Sonar sonar;
  sonar.name = "wide";
  sonar.mount.pose.position_m = {0.0, -5.0, 0.0};
  sonar.azimuth_rad = radians(170.0);
  sonar.range_min_m = 0.0;
  sonar.range_max_m = 10.0;
  sonar.bins_range = 20;
  scene.sonars.push_back(sonar);
  FrameRequest request;
  request.sonars = {0};
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
  EXPECT_EQ(result.sonars[0].sectors.size(), 2u);
  // Facets reach inwards by some millimetres: all of it lies in row 5, 2.5 to 3 m.
  for (std::uint32_t column = 0; column < 500; ++column) {
    EXPECT_GT(result.sonars[0].image.intensity[5 * 500 + column], 0.999f) << column;
    for (std::uint32_t row = 0; row < 20; ++row)
      if (row != 5) {
        EXPECT_LT(result.sonars[0].image.intensity[row * 500 + column], 0.001f)
            << row << " " << column;
      }
  }
}

}  // namespace
}  // namespace neritic::testbed
