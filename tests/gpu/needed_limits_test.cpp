// A device whose limits are too small for the passes is not chosen, and the error names the limit.
#include "engine/gpu/needed_limits.hpp"

#include <gmock/gmock.h>

#include "engine/gpu/device_select.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

using ::testing::HasSubstr;
using NeededLimits = test::GpuTest;

VkPhysicalDeviceLimits plenty() {
  VkPhysicalDeviceLimits limits{};
  limits.maxColorAttachments = limits.maxFragmentOutputAttachments =
      limits.maxFragmentCombinedOutputResources = limits.maxPerStageDescriptorStorageBuffers = 8;
  return limits;
}

TEST(MissingLimits, NothingWhereTheDeviceHasPlenty) {
  EXPECT_EQ(missing_limits(plenty()), "");
}

TEST(MissingLimits, AreNamedWithWhatIsThere) {
  VkPhysicalDeviceLimits limits = plenty();
  limits.maxColorAttachments = 4;
  EXPECT_EQ(missing_limits(limits), "maxColorAttachments of 6 (it has 4)");
  limits.maxPerStageDescriptorStorageBuffers = 6;
  EXPECT_EQ(missing_limits(limits),
            "maxColorAttachments of 6 (it has 4), maxPerStageDescriptorStorageBuffers of 7 (it has "
            "6)");
}

// The driver's answer while it lives: no more storage buffers than Vulkan promises.
class WithFewStorageBuffers {
 public:
  WithFewStorageBuffers() {
    real = vkGetPhysicalDeviceProperties;
    vkGetPhysicalDeviceProperties = answer;
  }
  ~WithFewStorageBuffers() { vkGetPhysicalDeviceProperties = real; }

 private:
  static VKAPI_ATTR void VKAPI_CALL answer(VkPhysicalDevice device,
                                           VkPhysicalDeviceProperties* properties) {
    real(device, properties);
    properties->limits.maxPerStageDescriptorStorageBuffers = 4;
  }
  static inline PFN_vkGetPhysicalDeviceProperties real = nullptr;
};

TEST_F(NeededLimits, ADeviceBelowOneIsNotUsable) {
  const WithFewStorageBuffers fake;
  NERITIC_ASSERT_OK(const auto devices, list_devices());
  for (const DeviceInfo& info : devices) {
    EXPECT_FALSE(info.usable) << info.name;
    EXPECT_THAT(info.missing, HasSubstr("maxPerStageDescriptorStorageBuffers of 7 (it has 4)"));
  }
}

}  // namespace
}  // namespace neritic::gpu
