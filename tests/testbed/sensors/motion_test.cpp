// Motion images against the projected displacement in closed form: a body moved by an animation's
// node, a quad moved by a skin's joint, and a background that stands still.
#include <gtest/gtest.h>

#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::testbed {
namespace {

constexpr std::uint32_t kSize = 161;  // odd: the middle pixel's centre lies on the optical axis
const Vec3 kSpeed_m_s{1.0, 0.5, 0.0};

class MotionVectors : public test::GpuTest {
 protected:
  // Moves node with kSpeed_m_s for a second.
  static void animate(scene::Model& model, int node) {
    scene::Channel channel;
    channel.node = node;
    channel.times_s = {0.0f, 1.0f};
    channel.values = {
        0.0f, 0.0f, 0.0f, float(kSpeed_m_s.x), float(kSpeed_m_s.y), float(kSpeed_m_s.z)};
    model.clips.push_back({"move", 1.0, {channel}});
  }

  // The middle pixel of model at 4 m, its surface at surface_m, in front of a still wall.
  void expect_motion(scene::Model model, double surface_m) {
    scene::Scene scene;
    scene.path = "test";
    scene.sun = scene::Sun{};
    scene.models.push_back(std::make_shared<scene::Model>(std::move(model)));
    scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({40.0, 40.0, 1.0})));
    for (int i = 0; i < 2; ++i) {
      scene::Object object;
      object.name = i == 0 ? "mover" : "wall";
      object.model = i;
      object.mount.pose.position_m = {0.0, -5.0, i == 0 ? -4.0 : -12.0};
      object.class_id = object.instance = static_cast<std::uint16_t>(1 + i);
      object.clip = i == 0 ? 0 : -1;
      scene.objects.push_back(object);
    }
    scene::Camera camera;
    camera.name = "eye";
    camera.width = camera.height = kSize;
    camera.mount.pose.position_m = {0.0, -5.0, 0.0};
    scene.cameras.push_back(camera);
    FrameRequest request;
    request.time_s = 0.2;
    request.next_time_s = 0.3;
    // The mover has left the middle by then: look at where its centre is.
    scene.cameras[0].mount.pose.position_m += kSpeed_m_s * request.time_s;
    request.cameras = {0};
    NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    const ViewImages& eye = result.cameras[0].eyes[0];
    const std::uint32_t middle = kSize / 2;
    ASSERT_EQ(eye.labels.at(middle, middle), 1);
    EXPECT_NEAR(eye.depth.at(middle, middle), surface_m, 0.005);
    const Vec3 moved = kSpeed_m_s * (request.next_time_s - request.time_s);
    EXPECT_NEAR(eye.motion.at(middle, middle, 0), eye.intrinsics.fx * moved.x / surface_m, 0.05);
    EXPECT_NEAR(eye.motion.at(middle, middle, 1), -eye.intrinsics.fy * moved.y / surface_m, 0.05);
    std::size_t still = 0;
    for (std::uint32_t y = 0; y < kSize; ++y)
      for (std::uint32_t x = 0; x < kSize; ++x) {
        if (eye.labels.at(x, y) != 2) continue;
        ASSERT_NEAR(eye.motion.at(x, y, 0), 0.0, 1e-3);
        ASSERT_NEAR(eye.motion.at(x, y, 1), 0.0, 1e-3);
        ++still;
      }
    EXPECT_GT(still, kSize * kSize / 4u);
  }
};

TEST_F(MotionVectors, OfABodyMovedByAClipIsItsProjectedDisplacement) {
  scene::Model sphere = scene::make_sphere(1.0, 96);
  animate(sphere, 0);
  expect_motion(std::move(sphere), 3.0);
}

// A wall that passes the camera before the next frame is nowhere in the next picture.
TEST_F(MotionVectors, OfWhatWillBeBehindTheEyeIsNotANumber) {
  scene::Scene scene;
  scene.path = "test";
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({40.0, 40.0, 1.0})));
  scene::Object wall;
  wall.name = "wall";
  wall.model = 0;
  wall.class_id = wall.instance = 1;
  wall.mount.pose.position_m = {0.0, -5.0, -4.5};
  wall.mount.track = scene::Track{{{0.0, {0.0, -5.0, -4.5}}, {1.0, {0.0, -5.0, 45.5}}},
                                  {scene::Track::Attitude{}}};
  scene.objects.push_back(wall);
  scene::Camera camera;
  camera.name = "eye";
  camera.width = camera.height = 9;
  camera.mount.pose.position_m = {0.0, -5.0, 0.0};
  scene.cameras.push_back(camera);
  NERITIC_ASSERT_OK(const auto session, Session::create(device(), std::move(scene)));
  FrameRequest request;
  request.cameras = {0};
  for (const double next_s : {0.04, 0.2}) {  // at 2 m then, at 6 m behind
    request.next_time_s = next_s;
    NERITIC_ASSERT_OK(const FrameResult result, session->render(request));
    const ViewImages& eye = result.cameras[0].eyes[0];
    for (std::uint32_t y = 0; y < 9; ++y)
      for (std::uint32_t x = 0; x < 9; ++x)
        for (int axis = 0; axis < 2; ++axis)
          EXPECT_EQ(std::isnan(eye.motion.at(x, y, axis)), next_s > 0.1)
              << x << " " << y << ": " << eye.motion.at(x, y, axis);
  }
}

TEST_F(MotionVectors, OfASkinnedQuadIsItsJointsProjectedDisplacement) {
  scene::Primitive quad;
  for (const Vec3& corner : {Vec3(-1, -1, 0), Vec3(1, -1, 0), Vec3(1, 1, 0), Vec3(-1, 1, 0)}) {
    quad.positions.emplace_back(corner);
    quad.normals.emplace_back(0.0f, 0.0f, 1.0f);
    quad.uv0.emplace_back(0.0f, 0.0f);
    quad.joints.push_back({0, 0, 0, 0});
    quad.weights.emplace_back(1.0f, 0.0f, 0.0f, 0.0f);
    quad.bounds.add(corner);
  }
  quad.indices = {0, 1, 2, 0, 2, 3};
  scene::Model model = scene::model_of_primitive(std::move(quad), "quad");
  scene::Node joint;
  joint.name = "joint";
  model.roots.push_back(static_cast<int>(model.nodes.size()));
  model.nodes.push_back(joint);
  model.skins.push_back({"skin", {model.roots.back()}, {Mat4(1.0)}});
  model.nodes[0].skin = 0;
  animate(model, model.roots.back());
  expect_motion(std::move(model), 4.0);
}

}  // namespace
}  // namespace neritic::testbed
