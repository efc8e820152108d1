// Pictures with coarser meshes against those of the meshes as they are.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

#include "engine/render/frame_state.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

class MeshLevelPictures : public test::GpuTest {
 protected:
  // Once for all tests.
  void open() {
    if (session_) return;
    NERITIC_ASSERT_OK(scene::Scene scene,
                      scene::load_scene(test::source_dir() / "assets/scenes/wreck.toml"));
    scene.sonars.clear();
    NERITIC_ASSERT_OK(session_, Session::create(device(), std::move(scene)));
  }

  ImageU8 show(double mesh_error, double back_m = 0.0, const Capture& capture = colour()) {
    render::ViewSet views = camera_views(session_->scene(), session_->scene().cameras.front());
    views.width = 320;
    views.height = 180;
    for (render::ViewDesc& view : views.views)
      view.world_from_view.position_m += view.world_from_view.rotation * Vec3(0.0, 0.0, back_m);
    FrameRequest request;
    request.views.push_back({.name = "view",
                             .views = views,
                             .exposure = session_->scene().cameras.front().exposure,
                             .detail = {.mesh_error = mesh_error},
                             .capture = capture});
    return std::move(session_->render(request).value().views[0].eyes[0].color);
  }

  static constexpr double kWhole = 0.0, kHalfAPixel = 0.5;
  static Capture colour() { return Capture{.motion = false}.without_geometry(); }

  static double difference(const ImageU8& a, const ImageU8& b) {
    double sum = 0.0;
    for (std::size_t i = 0; i < a.data.size(); ++i)
      sum += std::abs(double(a.data[i]) - double(b.data[i]));
    return sum / static_cast<double>(a.data.size());
  }

  static void TearDownTestSuite() { session_.reset(); }

  static inline std::unique_ptr<Session> session_;
};

TEST_F(MeshLevelPictures, HalfAPixelOfErrorIsHardlySeenAndArraysHaveNone) {
  open();
  const ImageU8 whole = show(kWhole);
  const double half_px = difference(whole, show(kHalfAPixel));
  RecordProperty("levels_of_255", fmt::format("{:.3f}", half_px));
  EXPECT_GT(half_px, 0.0);  // some mesh is coarser
  EXPECT_LT(half_px, 0.5);
  EXPECT_EQ(show(kHalfAPixel, 0.0, Capture{.motion = false}).data,
            show(kWhole, 0.0, Capture{.motion = false}).data);
}

TEST_F(MeshLevelPictures, NothingPopsWhileTheCameraDrawsNear) {
  open();
  // A step's change with coarser meshes over that of the meshes as they are: where a level changes
  // from one step to the next, no more than a small share comes to it.
  double worst = 0.0;
  ImageU8 whole = show(kWhole, 2.0), coarser = show(kHalfAPixel, 2.0);
  for (int i = 1; i <= 6; ++i) {
    const double back_m = 2.0 - 0.05 * i;
    ImageU8 next_whole = show(kWhole, back_m), next_coarser = show(kHalfAPixel, back_m);
    const double plain = difference(whole, next_whole);
    const double levels = difference(coarser, next_coarser);
    worst = std::max(worst, levels - plain);
    whole = std::move(next_whole), coarser = std::move(next_coarser);
  }
  RecordProperty("more_levels_of_255", fmt::format("{:.3f}", worst));
  EXPECT_LT(worst, 0.2);
}

TEST_F(MeshLevelPictures, SkinnedMeshesStayWithinTheirBallsAndBoxes) {
  open();
  const scene::Scene& scene = session_->scene();
  for (const double time_s : {0.0, 0.7, 13.3}) {
    const auto state =
        render::evaluate_frame(scene, session_->gpu_scene(), time_s, time_s + 0.1, false);
    ASSERT_FALSE(state.deforms.empty());
    for (const render::DeformJob& job : state.deforms) {
      ASSERT_GE(job.radius_m, 0.0);
      const scene::Object& object = scene.objects[job.object];
      const scene::Model& model = *scene.models[static_cast<std::size_t>(object.model)];
      const auto joints =
          scene::joint_matrices(model, state.poses[job.object], model.nodes[job.node].skin);
      // Skinned here in double, over all primitives of the mesh that have as many vertices.
      for (const scene::Primitive& p :
           model.meshes[static_cast<std::size_t>(model.nodes[job.node].mesh)].primitives) {
        if (p.positions.size() != job.push.vertex_count) continue;
        for (std::size_t v = 0; v < p.positions.size(); v += 7) {
          Vec3 at(0.0);
          for (int k = 0; k < 4; ++k)
            at += double(p.weights[v][k]) * Vec3(joints[p.joints[v][static_cast<std::size_t>(k)]] *
                                                 Vec4(Vec3(p.positions[v]), 1.0));
          EXPECT_LE(glm::distance(at, job.center_m), job.radius_m);
          EXPECT_TRUE(glm::all(glm::lessThanEqual(glm::abs(at - job.center_m), job.half_m)));
        }
      }
      EXPECT_LT(job.radius_m, 4.0);
    }
  }
}

// At 20 s the shark swims beside the picture: the ball round it reaches in, it does not.
TEST_F(MeshLevelPictures, AFishBesideThePictureIsNotDrawn) {
  open();
  const scene::Scene& scene = session_->scene();
  const auto shark = std::ranges::find(scene.objects, "shark", &scene::Object::name);
  ASSERT_NE(shark, scene.objects.end());
  const auto drawn_at = [&](double time_s) {
    const auto state =
        render::evaluate_frame(scene, session_->gpu_scene(), time_s, time_s + 0.1, false);
    const render::DrawList list = render::build_draw_list(
        scene, session_->gpu_scene(), state, camera_views(scene, scene.cameras.front()));
    return std::ranges::any_of(list.instances, [&](const shared::Instance& instance) {
      return (instance.label & 0xffffu) == shark->class_id;
    });
  };
  EXPECT_TRUE(drawn_at(0.0));
  EXPECT_FALSE(drawn_at(20.0));
}

}  // namespace
}  // namespace neritic::testbed
