// Vulkan objects of a session: every object has a name for debuggers, and every image a
// format that devices are chosen for.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/gpu/needed_formats.hpp"
#include "testbed/sensors/session.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"
#include "tests/testbed/sensors/vulkan_record.hpp"

namespace neritic::testbed {
namespace {

// A frame of all sensors of a scene on a device of its own, recorded.
class VulkanObjects : public test::GpuTest, public ::testing::WithParamInterface<const char*> {
 protected:
  Status render() {
    gpu::DeviceOptions options;
    options.device = std::to_string(device().info().index);
    NERITIC_TRY(const auto own, gpu::Device::create(options));
    NERITIC_TRY(scene::Scene scene,
                scene::load_scene(test::source_dir() / "assets/scenes" / GetParam()));
    FrameRequest request;
    for (scene::Camera& camera : scene.cameras) {
      camera.width = 64, camera.height = 36;
      camera.antialias = true;
      request.cameras.push_back(request.cameras.size());
    }
    for (std::size_t i = 0; i < scene.sonars.size(); ++i) request.sonars.push_back(i);
    NERITIC_TRY(const auto session, Session::create(*own, std::move(scene)));
    for (request.frame = 0; request.frame < 2; ++request.frame)
      NERITIC_TRY_STATUS([&]() -> Status {
        NERITIC_TRY(const FrameResult result, session->render(request));
        return {};
      }());
    return {};
  }
};
INSTANTIATE_TEST_SUITE_P(Scenes, VulkanObjects,
                         ::testing::Values("pool.toml", "wreck.toml", "sonars.toml"),
                         [](const auto& info) {
                           const std::string name = info.param;
                           return name.substr(0, name.find('.'));
                         });

VkFormatFeatureFlags features_of(VkImageUsageFlags usage) {
  constexpr std::pair<VkImageUsageFlags, VkFormatFeatureFlags> kRows[] = {
      {VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT},
      {VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, VK_FORMAT_FEATURE_DEPTH_STENCIL_ATTACHMENT_BIT},
      {VK_IMAGE_USAGE_SAMPLED_BIT, VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT},
      {VK_IMAGE_USAGE_STORAGE_BIT, VK_FORMAT_FEATURE_STORAGE_IMAGE_BIT},
      {VK_IMAGE_USAGE_TRANSFER_SRC_BIT, VK_FORMAT_FEATURE_TRANSFER_SRC_BIT},
      {VK_IMAGE_USAGE_TRANSFER_DST_BIT, VK_FORMAT_FEATURE_TRANSFER_DST_BIT}};
  VkFormatFeatureFlags features = 0;
  for (const auto& [bit, feature] : kRows)
    if (usage & bit) features |= feature;
  return features;
}

// One session shows both, since making it costs most of the test.
TEST_P(VulkanObjects, AreAllNamedAndImagesHaveFormatsThatDevicesAreChosenFor) {
  const test::VulkanRecord record;
  NERITIC_ASSERT_STATUS(render());
  EXPECT_THAT(record.unnamed(), ::testing::IsEmpty());
  for (const VkObjectType type :
       {VK_OBJECT_TYPE_DEVICE, VK_OBJECT_TYPE_DEVICE_MEMORY, VK_OBJECT_TYPE_BUFFER,
        VK_OBJECT_TYPE_IMAGE, VK_OBJECT_TYPE_IMAGE_VIEW, VK_OBJECT_TYPE_SAMPLER,
        VK_OBJECT_TYPE_SHADER_MODULE, VK_OBJECT_TYPE_PIPELINE_LAYOUT, VK_OBJECT_TYPE_PIPELINE_CACHE,
        VK_OBJECT_TYPE_PIPELINE, VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT,
        VK_OBJECT_TYPE_DESCRIPTOR_POOL, VK_OBJECT_TYPE_DESCRIPTOR_SET, VK_OBJECT_TYPE_COMMAND_POOL,
        VK_OBJECT_TYPE_COMMAND_BUFFER, VK_OBJECT_TYPE_FENCE, VK_OBJECT_TYPE_SEMAPHORE,
        VK_OBJECT_TYPE_QUERY_POOL})
    EXPECT_GT(record.made(type), 0u) << "object type " << type;
  EXPECT_FALSE(record.images().empty());
  for (const auto& image : record.images())
    EXPECT_TRUE(gpu::is_needed(image.format, features_of(image.usage)))
        << "format " << image.format << ", usage " << image.usage;
}

}  // namespace
}  // namespace neritic::testbed
