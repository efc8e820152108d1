// A stereo pair drawn at once by multiview is the pair drawn eye by eye, to the bit. Devices that
// clip into the wrong view are told to draw both ways too: what needs no clipping must agree there
// as well, so that the way of all other devices is tested on a machine without any.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

#include "engine/scene/gltf_loader.hpp"
#include "engine/scene/shapes.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::testbed {
namespace {

// The view masks of all renderings that are recorded while it lives.
class ViewMasks {
 public:
  ViewMasks() {
    seen().clear();
    real() = std::exchange(vkCmdBeginRendering, note);
  }
  ~ViewMasks() { vkCmdBeginRendering = real(); }
  static std::vector<std::uint32_t>& seen() {
    static std::vector<std::uint32_t> masks;
    return masks;
  }

 private:
  static PFN_vkCmdBeginRendering& real() {
    static PFN_vkCmdBeginRendering function = nullptr;
    return function;
  }
  static VKAPI_ATTR void VKAPI_CALL note(VkCommandBuffer commands, const VkRenderingInfo* info) {
    seen().push_back(info->viewMask);
    real()(commands, info);
  }
};

class MultiviewTest : public test::GpuTest {
 protected:
  // A frame of the scene's first camera on a device that draws views at once, or one by one.
  Result<std::vector<ViewImages>> pair(const scene::Scene& scene, bool at_once) {
    gpu::DeviceOptions options;
    options.device = std::to_string(device().info().index);
    options.validation = true;
    options.quirks = device().info().quirks;
    options.quirks->clips_into_wrong_view = !at_once;
    NERITIC_TRY(const auto own, gpu::Device::create(options));
    FrameRequest request;
    request.cameras = {0};
    request.time_s = 0.3;
    request.next_time_s = 0.4;
    const ViewMasks masks;
    Result<FrameResult> result = [&]() -> Result<FrameResult> {
      NERITIC_TRY(const auto session, Session::create(*own, scene));
      return session->render(request);
    }();
    if (!result.ok()) return result.error();
    EXPECT_THAT(own->validation_log().messages, ::testing::IsEmpty());
    EXPECT_FALSE(ViewMasks::seen().empty());
    for (std::size_t i = 0; i < ViewMasks::seen().size(); ++i)
      EXPECT_EQ(ViewMasks::seen()[i], at_once ? 3u : 1u << (i % 2));
    return std::move(result->cameras[0].eyes);
  }
};

scene::Object object_at(int model, const Vec3& position_m, std::uint16_t label) {
  scene::Object object;
  object.name = fmt::format("object {}", label);
  object.model = model;
  object.class_id = object.instance = label;
  object.mount.pose.position_m = position_m;
  return object;
}

// A stereo camera that looks along -z, 5 m deep.
scene::Scene stereo_scene() {
  scene::Scene scene;
  scene.path = "test";
  scene.sun = scene::Sun{};
  scene.water = scene::Water{.type = "II", .scattering = true, .surface = true};
  scene::Camera camera;
  camera.name = "eyes";
  camera.width = 203;
  camera.height = 117;
  camera.stereo_baseline_m = 0.2;
  camera.antialias = true;
  camera.mount.pose.position_m = {0.0, -5.0, 0.0};
  scene.cameras.push_back(camera);
  return scene;
}

// One of each way to be drawn: skinned and moving, rigid, glowing, blended, masked.
Result<scene::Scene> all_in_sight() {
  scene::Scene scene = stereo_scene();
  NERITIC_TRY(scene::Model diver, scene::load_gltf(test::source_dir() / "assets/models/diver.glb"));
  scene.models.push_back(std::make_shared<scene::Model>(std::move(diver)));
  scene.objects.push_back(object_at(0, {-0.8, -5.2, -4.5}, 1));
  scene.objects[0].clip = 0;
  for (int i = 0; i < 4; ++i) {
    scene::Model ball = scene::make_sphere(0.4, 32);
    scene::Material material;
    material.base_color = {0.8f, 0.5f, 0.3f, 0.6f};
    if (i == 1) material.emissive = {0.2f, 0.6f, 0.1f};
    if (i == 2) material.alpha_mode = scene::AlphaMode::kBlend;
    if (i == 3) material.alpha_mode = scene::AlphaMode::kMask;
    ball.materials = {material};
    ball.meshes[0].primitives[0].material = 0;
    scene.models.push_back(std::make_shared<scene::Model>(std::move(ball)));
    scene.objects.push_back(object_at(i + 1, {0.4 + 0.3 * i, -5.6 + 0.4 * i, -4.0 - 0.2 * i},
                                      static_cast<std::uint16_t>(2 + i)));
  }
  scene.lamps.push_back({"lamp", {0, {{0.2, 0.3, 1.0}, {1, 0, 0, 0}}}});
  return scene;
}

// In how many texels two images differ, in bits.
template <class Image>
std::size_t different(const Image& a, const Image& b) {
  if (a.data.empty() || a.data.size() != b.data.size()) return SIZE_MAX;
  std::size_t count = 0;
  for (std::size_t i = 0; i < a.data.size(); ++i) count += a.data[i] != b.data[i];
  return count;
}

TEST_F(MultiviewTest, PairsDrawnAtOnceArePairsDrawnEyeByEye) {
  NERITIC_ASSERT_OK(const scene::Scene scene, all_in_sight());
  NERITIC_ASSERT_OK(const auto together, pair(scene, true));
  NERITIC_ASSERT_OK(const auto apart, pair(scene, false));
  ASSERT_EQ(together.size(), 2u);
  for (int e = 0; e < 2; ++e) {
    const ViewImages &a = together[e], &b = apart[e];
    EXPECT_EQ(different(a.depth, b.depth), 0u);
    EXPECT_EQ(different(a.normals, b.normals), 0u);
    EXPECT_EQ(different(a.labels, b.labels), 0u);
    EXPECT_EQ(different(a.instances, b.instances), 0u);
    EXPECT_EQ(different(a.motion, b.motion), 0u);
    EXPECT_EQ(different(a.color, b.color), 0u);
    const std::set<std::uint16_t> seen(a.labels.data.begin(), a.labels.data.end());
    EXPECT_THAT(seen, ::testing::IsSupersetOf({0, 1, 2, 3, 5}));  // all but what is blended
    // Nothing reaches the picture's edge, so nothing was clipped.
    for (std::uint32_t x = 0; x < a.width; ++x)
      EXPECT_TRUE(a.labels.at(x, 0) == 0 && a.labels.at(x, a.height - 1) == 0);
    for (std::uint32_t y = 0; y < a.height; ++y)
      EXPECT_TRUE(a.labels.at(0, y) == 0 && a.labels.at(a.width - 1, y) == 0);
  }
  EXPECT_GT(different(together[0].depth, together[1].depth), 1000u);  // two eyes, not one twice
}

// Clipped triangles agree exactly if the device is not known to clip into the wrong view: the
// list of quirks says no more and no less than what is wrong.
TEST_F(MultiviewTest, ClippedTrianglesAgreeUnlessTheDeviceIsKnownForIt) {
  scene::Scene scene = stereo_scene();
  scene.models.push_back(std::make_shared<scene::Model>(scene::make_box({40.0, 40.0, 0.1})));
  scene.objects.push_back(object_at(0, {0.0, -5.0, -4.0}, 1));
  NERITIC_ASSERT_OK(const auto together, pair(scene, true));
  NERITIC_ASSERT_OK(const auto apart, pair(scene, false));
  std::size_t off = 0;
  for (int e = 0; e < 2; ++e) {
    off += different(together[e].depth, apart[e].depth);
    for (const float depth : apart[e].depth.data) ASSERT_NEAR(depth, 3.95, 1e-3);
  }
  EXPECT_EQ(off > 0, device().info().quirks.clips_into_wrong_view) << off << " pixels differ";
}

}  // namespace
}  // namespace neritic::testbed
