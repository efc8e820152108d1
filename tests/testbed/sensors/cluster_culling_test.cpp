// Culling by clusters changes no bit: depth, normals, labels, motion and colour with and without
// it, in the wreck scene, from where bounds are put to the test.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <ranges>

#include "engine/render/lighting.hpp"
#include "engine/render/renderer.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/readback.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

using render::GBufferKind;

struct Drawn {
  std::map<std::string, std::vector<std::byte>> images;
  std::uint64_t triangles = 0;
  std::ptrdiff_t solids = 0;  // draws without their back faces
};

// A scene on the device and what draws it, without a session between.
class Studio {
 public:
  static Result<std::unique_ptr<Studio>> create(gpu::Device& device, scene::Scene scene) {
    std::unique_ptr<Studio> studio(new Studio(device));
    studio->scene_ = std::move(scene);
    NERITIC_TRY(studio->frames_, gpu::Frames::create(device));
    studio->executor_ = std::make_unique<graph::Executor>(*studio->frames_);
    NERITIC_TRY(studio->renderer_, render::Renderer::create(device));
    NERITIC_TRY(studio->gpu_scene_, render::GpuScene::create(device, studio->scene_,
                                                             studio->renderer_->material_layout()));
    return studio;
  }
  ~Studio() { device_.wait_idle(); }
  scene::Scene& scene() { return scene_; }

  Result<Drawn> draw(const render::ViewSet& views, GBufferKind kind,
                     const render::DrawListOptions& options) {
    const bool surface = kind == GBufferKind::kSurface;
    const auto state = render::evaluate_frame(scene_, *gpu_scene_, 0.5, 0.6, surface);
    const auto draws = render::build_draw_list(scene_, *gpu_scene_, state, views, options);
    graph::FrameGraph graph;
    NERITIC_TRY(const auto deformed, renderer_->declare_deform(graph, *gpu_scene_, state));
    NERITIC_TRY(const auto g, renderer_->declare_gbuffer(graph, "", kind, *gpu_scene_, state,
                                                         deformed, views, draws));
    std::map<std::string, Readback> copies;
    const auto copy = [&](const std::string& name, graph::ImageHandle image,
                          VkFormat format) -> Status {
      NERITIC_TRY(copies[name], readback_.declare(graph, device_, name, image, format, views.width,
                                                  views.height, views.layers()));
      return {};
    };
    NERITIC_TRY_STATUS(copy("depth", g.depth, render::kDepthFormat));
    NERITIC_TRY_STATUS(copy("normal", g.normal, render::kNormalFormat));
    NERITIC_TRY_STATUS(copy("label", g.label, render::kLabelFormat));
    shared::Lighting lighting{};
    if (surface) {
      NERITIC_TRY_STATUS(copy("motion", g.motion, render::kMotionFormat));
      NERITIC_TRY(lighting, render::make_lighting(scene_, state, views.origin_m(), {},
                                                  gpu_scene_->has_emission()));
      NERITIC_TRY(auto hdr, renderer_->declare_shade(graph, "", {g, views, lighting}));
      NERITIC_TRY(hdr, renderer_->declare_forward(graph, "", hdr, g, *gpu_scene_, deformed, views,
                                                  draws, lighting));
      NERITIC_TRY(const auto color,
                  renderer_->declare_picture(graph, "", hdr, views.width, views.height,
                                             views.layers(), false));
      NERITIC_TRY_STATUS(copy("color", color, render::kColorFormat));
    }
    NERITIC_TRY(gpu::Commands * commands, frames_->begin());
    NERITIC_TRY(const graph::Plan* plan, executor_->run(graph, *commands));
    (void)plan;
    NERITIC_TRY(const std::uint64_t done, frames_->submit());
    NERITIC_TRY_STATUS(frames_->wait(done));
    Drawn drawn;
    drawn.triangles = draws.triangles;
    drawn.solids = std::count_if(draws.opaque.begin(), draws.opaque.end(),
                                 [](const render::Draw& d) { return d.hides_back_faces; });
    for (const auto& [name, buffer] : copies) {
      const auto bytes = buffer->mapped<std::byte>();
      drawn.images[name].assign(bytes.begin(), bytes.end());
    }
    return drawn;
  }

 private:
  explicit Studio(gpu::Device& device) : device_(device) {}
  gpu::Device& device_;
  scene::Scene scene_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<render::GpuScene> gpu_scene_;
  ReadbackPool readback_;
};

class ClusterCullingTest : public test::GpuTest {
 protected:
  // The wreck, with the submarine three times: as it is, mirrored and stretched, turned and flat.
  // At the origin once for all tests.
  void open(const Vec3& offset_m) {
    if (studio_ && opened_at_m_ == offset_m) return;
    scene::SceneOptions options;
    options.offset_m = offset_m;
    NERITIC_ASSERT_OK(scene::Scene scene,
                      scene::load_scene(test::source_dir() / "assets/scenes/wreck.toml", options));
    std::size_t submarine = 0;
    while (scene.objects[submarine].name != "submarine") ++submarine;
    scene::Object mirrored = scene.objects[submarine], flat = mirrored;
    mirrored.scale = {-1.0, 1.4, 0.7};
    mirrored.mount.pose.position_m += Vec3(-6.0, 0.0, 3.0);
    mirrored.instance = 60000;
    flat.scale = {0.3, 0.1, 0.5};
    flat.mount.pose.position_m += Vec3(5.0, 1.5, -8.0);
    flat.instance = 60001;
    scene.objects.push_back(mirrored);
    scene.objects.push_back(flat);
    scene.water->waves.reset();  // shading here knows no sea
    scene.cameras[0].width = 323;
    scene.cameras[0].height = 181;
    NERITIC_ASSERT_OK(studio_, Studio::create(device(), std::move(scene)));
    opened_at_m_ = offset_m;
  }
  static void TearDownTestSuite() { studio_.reset(); }

  // Bits with and without culling from there, as a camera and as a sonar sees. Returns the largest
  // share of triangles that were drawn.
  double expect_same_bits(const render::ViewSet& views) {
    double share = 0.0;
    for (const GBufferKind kind : {GBufferKind::kSurface, GBufferKind::kGeometry}) {
      const bool sonar = kind == GBufferKind::kGeometry;
      auto with = studio_->draw(views, kind, {.hide_back_faces = sonar}),
           without = studio_->draw(views, kind, {.clusters = false, .hide_back_faces = sonar});
      EXPECT_TRUE(with.ok() && without.ok());
      if (!with.ok() || !without.ok()) return 1.0;
      EXPECT_EQ(with->images.size(), kind == GBufferKind::kSurface ? 5u : 3u);
      for (const auto& [name, bytes] : without->images)
        EXPECT_TRUE(bytes == with->images[name]) << name;
      EXPECT_LE(with->triangles, without->triangles);
      share = std::max(share, double(with->triangles) / double(without->triangles));
    }
    return share;
  }

  render::ViewSet views_at(const Pose& pose, double baseline_m = 0.0) {
    scene::Camera camera = studio_->scene().cameras[0];
    camera.mount = {};
    camera.mount.pose = pose;
    camera.stereo_baseline_m = baseline_m;
    return camera_views(studio_->scene(), camera, 0.5, 0.6);
  }

  Pose overview() { return studio_->scene().world_from(studio_->scene().cameras[0].mount); }

  static inline std::unique_ptr<Studio> studio_;
  static inline Vec3 opened_at_m_{0.0};
};

TEST_F(ClusterCullingTest, ChangesNoBitFromAnywhere) {
  ASSERT_NO_FATAL_FAILURE(open(Vec3(0.0)));
  EXPECT_LT(expect_same_bits(views_at(overview())), 1.0);
  const Vec3 inside_hull{-0.2, -17.0, 0.0}, in_the_sand{3.0, -18.4, -6.0},
      over_the_sand{12.0, -17.95, -12.0};
  for (const Vec3& target :
       {Vec3(4.0, -17.0, -9.0), Vec3(-5.0, -17.0, 9.0), Vec3(-0.1, -30.0, 0.1)})
    expect_same_bits(views_at(look_at(inside_hull, target)));
  expect_same_bits(views_at(look_at(in_the_sand, {0.0, -17.0, 0.0})));
  expect_same_bits(views_at(look_at(over_the_sand, {0.0, -17.95, 0.0})));  // grazing
  EXPECT_LT(expect_same_bits(views_at(look_at({6.0, -14.0, -8.0}, {6.2, -18.0, -8.0}))), 0.8);
}

TEST_F(ClusterCullingTest, ChangesNoBitForBothEyes) {
  ASSERT_NO_FATAL_FAILURE(open(Vec3(0.0)));
  EXPECT_LT(expect_same_bits(views_at(overview(), 0.065)), 1.0);
  EXPECT_LT(expect_same_bits(views_at(look_at({-6.0, -16.0, 3.0}, {-6.0, -17.0, 9.0}), 3.0)), 1.0);
}

TEST_F(ClusterCullingTest, ChangesNoBitInANarrowView) {
  ASSERT_NO_FATAL_FAILURE(open(Vec3(0.0)));
  render::ViewSet views = views_at(look_at({4.0, -12.0, -8.0}, {2.0, -18.0, -4.0}));
  const double thin = std::tan(radians(0.25));
  views.views[0].tangents = {-thin, thin, -thin, thin};  // a profiler's beam
  EXPECT_LT(expect_same_bits(views), 0.5);
  views.views[0].tangents = {-thin, thin, -1.5, 0.5};  // a side-scan's slice
  EXPECT_LT(expect_same_bits(views), 0.6);
}

// Rounding may put a back before its front at an outline, so culling decides a few pixels there.
TEST_F(ClusterCullingTest, BackFacesOfSolidsAreSeenAtOutlinesAtMost) {
  ASSERT_NO_FATAL_FAILURE(open(Vec3(0.0)));
  for (const Vec3& eye : {Vec3(6.0, -15.0, -8.0), Vec3(-0.2, -17.0, 0.0), Vec3(3.0, -18.4, -6.0)}) {
    const auto views = views_at(look_at(eye, {1.0, -17.0, -2.0}));
    NERITIC_ASSERT_OK(auto with,
                      studio_->draw(views, GBufferKind::kGeometry, {.hide_back_faces = true}));
    NERITIC_ASSERT_OK(auto without, studio_->draw(views, GBufferKind::kGeometry, {}));
    const auto depths = [](const Drawn& d) {
      const std::vector<std::byte>& bytes = d.images.at("depth");
      std::vector<float> out(bytes.size() / sizeof(float));
      std::memcpy(out.data(), bytes.data(), bytes.size());
      return out;
    };
    const std::vector<float> a = depths(with), b = depths(without);
    EXPECT_GT(with.solids, 0);
    EXPECT_EQ(without.solids, 0);
    std::size_t differ = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
      EXPECT_NEAR(a[i], b[i], 1e-3f * b[i]) << "pixel " << i;
      differ += a[i] != b[i];
    }
    EXPECT_LT(double(differ), 1e-4 * double(a.size()));
  }
}

TEST_F(ClusterCullingTest, ChangesNoBitAHundredKilometresAway) {
  const Vec3 offset_m{1e5, 0.0, -1e5};
  ASSERT_NO_FATAL_FAILURE(open(offset_m));
  EXPECT_LT(expect_same_bits(views_at(overview())), 1.0);
  expect_same_bits(views_at(look_at(offset_m + Vec3(-0.2, -17.0, 0.0), offset_m)));
}

// Whether a sonar's G-buffer leaves out the back faces of a sphere of 1 m, seen from so far.
bool hides_backs(gpu::Device& device, double distance_m, double scale, bool flipped) {
  scene::Scene scene;
  scene.path = "test";
  scene::Model sphere = scene::make_sphere(1.0);
  if (flipped)
    for (auto& indices = sphere.meshes[0].primitives[0].indices;
         const std::size_t i : std::views::iota(std::size_t{0}, indices.size() / 3))
      std::swap(indices[3 * i], indices[3 * i + 1]);
  scene.models.push_back(std::make_shared<scene::Model>(std::move(sphere)));
  scene.objects.emplace_back().model = 0;
  scene.objects[0].scale = Vec3(scale);
  scene.sonars.emplace_back();
  auto studio = Studio::create(device, std::move(scene));
  EXPECT_TRUE(studio.ok());
  render::ViewSet views;
  views.width = views.height = 16;
  views.views.emplace_back();
  views.views[0].near_m = 0.1;
  views.views[0].world_from_view.position_m = {0.0, 0.0, distance_m};
  auto drawn = (*studio)->draw(views, GBufferKind::kGeometry, {.hide_back_faces = true});
  EXPECT_TRUE(drawn.ok());
  return drawn.ok() && drawn->solids == 1;
}

TEST_F(ClusterCullingTest, BackFacesAreLeftOutOnlyOutsideAndBeyondTheNearPlane) {
  EXPECT_TRUE(hides_backs(device(), 3.0, 1.0, false));
  // The near plane's corners are 0.173 m away; of how a matrix stretches a bound is taken, sqrt(3)
  // times.
  EXPECT_TRUE(hides_backs(device(), 1.31, 1.0, false));
  EXPECT_FALSE(hides_backs(device(), 1.17, 1.0, false));
  EXPECT_FALSE(hides_backs(device(), 0.5, 1.0, false));
  EXPECT_TRUE(hides_backs(device(), 0.6, 0.2, false));
  EXPECT_FALSE(hides_backs(device(), 3.0, 0.0, false));  // flattened to a point
  EXPECT_FALSE(hides_backs(device(), 3.0, 1.0, true));   // wound inwards
}

TEST_F(ClusterCullingTest, DeformingMoreThanTheDeviceTakesIsAnError) {
  NERITIC_ASSERT_OK(const auto renderer, render::Renderer::create(device()));
  NERITIC_ASSERT_OK(const auto gpu_scene, render::GpuScene::create(device(), scene::Scene{},
                                                                   renderer->material_layout()));
  graph::FrameGraph graph;
  render::FrameState state;
  state.deforms.emplace_back();
  state.deformed_vertices = ~0u;
  const auto bytes = renderer->declare_deform(graph, *gpu_scene, state);
  ASSERT_FALSE(bytes.ok());
  EXPECT_EQ(bytes.error().code, ErrorCode::kUnsupported);
  state.deformed_vertices = 1;
  state.deforms[0].push.vertex_count = ~0u;
  const std::uint64_t most =
      std::uint64_t{device().limits().maxComputeWorkGroupCount[0]} * shared::kDeformGroup;
  EXPECT_EQ(renderer->declare_deform(graph, *gpu_scene, state).ok(), most >= ~0u);
}

}  // namespace
}  // namespace neritic::testbed
