// A device without a format that the passes use is not chosen, and the error names the format.
#include "engine/gpu/needed_formats.hpp"

#include <gmock/gmock.h>

#include "engine/gpu/device_select.hpp"
#include "tests/support/gpu_fixture.hpp"

namespace neritic::gpu {
namespace {

using ::testing::HasSubstr;
using NeededFormats = test::GpuTest;

constexpr VkFormatFeatureFlags kEverything = ~VkFormatFeatureFlags{0};

TEST(MissingFormats, NothingWhereTheDeviceHasAll) {
  EXPECT_EQ(missing_formats([](VkFormat) { return kEverything; }), "");
}

TEST(MissingFormats, AreNamedWithTheirUses) {
  EXPECT_EQ(missing_formats([](VkFormat format) {
              return format == VK_FORMAT_R16G16_SNORM
                         ? kEverything & ~VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT
                         : kEverything;
            }),
            "format R16G16_SNORM as color attachment");
  EXPECT_EQ(missing_formats([](VkFormat format) {
              if (format == VK_FORMAT_R32_SFLOAT)
                return VkFormatFeatureFlags{VK_FORMAT_FEATURE_TRANSFER_SRC_BIT};
              return format == VK_FORMAT_D32_SFLOAT
                         ? kEverything & ~VK_FORMAT_FEATURE_SAMPLED_IMAGE_BIT
                         : kEverything;
            }),
            "format D32_SFLOAT as sampled image, format R32_SFLOAT as sampled image and storage "
            "image and target of copies");
}

// The driver's answer while it lives: R16G16_SNORM is no color attachment, which Vulkan
// leaves to the device.
class WithoutSnormTargets {
 public:
  WithoutSnormTargets() {
    real = vkGetPhysicalDeviceFormatProperties;
    vkGetPhysicalDeviceFormatProperties = answer;
  }
  ~WithoutSnormTargets() { vkGetPhysicalDeviceFormatProperties = real; }

 private:
  static VKAPI_ATTR void VKAPI_CALL answer(VkPhysicalDevice device, VkFormat format,
                                           VkFormatProperties* properties) {
    real(device, format, properties);
    if (format == VK_FORMAT_R16G16_SNORM)
      properties->optimalTilingFeatures &= ~VK_FORMAT_FEATURE_COLOR_ATTACHMENT_BIT;
  }
  static inline PFN_vkGetPhysicalDeviceFormatProperties real = nullptr;
};

TEST_F(NeededFormats, ListAndChoiceAgreeOnADeviceThatLacksOne) {
  const WithoutSnormTargets fake;
  NERITIC_ASSERT_OK(const auto devices, list_devices());
  for (const DeviceInfo& info : devices) {
    EXPECT_FALSE(info.usable) << info.name;
    EXPECT_THAT(info.missing, HasSubstr("format R16G16_SNORM as color attachment"));
  }
  DeviceOptions options;
  options.device = std::to_string(device().info().index);
  for (const std::string& wanted : {options.device, std::string()}) {
    options.device = wanted;
    const auto made = Device::create(options);
    const auto chosen = choose_device(devices, wanted);
    ASSERT_FALSE(made.ok());
    ASSERT_FALSE(chosen.ok());
    EXPECT_EQ(made.error().message, chosen.error().message);
    EXPECT_THAT(made.error().message, HasSubstr("R16G16_SNORM as color attachment"));
  }
}

}  // namespace
}  // namespace neritic::gpu
