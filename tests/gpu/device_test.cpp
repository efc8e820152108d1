// The device itself: creation, validation, what is said when it cannot be had.
#include "engine/gpu/device.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "engine/core/clock.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/memory.hpp"
#include "engine/gpu/pipeline.hpp"
#include "shaders.hpp"
#include "tests/support/gpu_fixture.hpp"
#include "tests/support/support.hpp"

namespace neritic::gpu {
namespace {

namespace fs = std::filesystem;
using test::GpuTest;
using ::testing::HasSubstr;
using DeviceTest = GpuTest;

TEST_F(DeviceTest, HasWhatTheEngineIsBuiltOn) {
  EXPECT_TRUE(device().validation());
  EXPECT_TRUE(device().info().usable);
  EXPECT_GE(device().info().api_version, VK_API_VERSION_1_3);
  EXPECT_GE(device().max_views(), 4u);  // later issues render four views in one pass
  EXPECT_GE(device().limits().maxImageDimension2D, 4096u);
  EXPECT_FALSE(device().info().name.empty());
  EXPECT_FALSE(device().info().driver.empty());
}

// Proof that the fixture's silence means something.
TEST_F(DeviceTest, ValidationHearsAWrongCall) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};  // size 0 and no usage: both wrong
  VkBuffer buffer = VK_NULL_HANDLE;
  if (vkCreateBuffer(device().handle(), &info, nullptr, &buffer) == VK_SUCCESS)
    vkDestroyBuffer(device().handle(), buffer, nullptr);
  EXPECT_FALSE(device().validation_log().messages.empty());
  device().clear_validation_log();
}

TEST_F(DeviceTest, SynchronizationValidationHearsAMissingBarrier) {
  BufferDesc desc;
  desc.name = "hazard";
  desc.size = 256;
  desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
  NERITIC_ASSERT_OK(const Buffer buffer, Buffer::create(device(), desc));
  NERITIC_ASSERT_STATUS(run_once(device(), [&](VkCommandBuffer commands) {
    vkCmdFillBuffer(commands, buffer.handle(), 0, 256, 1);
    vkCmdFillBuffer(commands, buffer.handle(), 0, 256, 2);  // no barrier between
  }));
  ASSERT_FALSE(device().validation_log().messages.empty());
  const std::string& message = device().validation_log().messages.front();
  EXPECT_THAT(message, HasSubstr("SYNC-HAZARD-WRITE-AFTER-WRITE"));
  EXPECT_THAT(message, HasSubstr("hazard")) << "objects are named";
  device().clear_validation_log();
}

TEST_F(DeviceTest, ALeakedObjectIsReportedToTheSinkAtTheEnd) {
  ValidationLog sink;
  DeviceOptions options;
  options.device = std::to_string(device().info().index);
  options.validation = true;
  options.validation_sink = &sink;
  NERITIC_ASSERT_OK(auto other, Device::create(options));
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  VkSampler sampler = VK_NULL_HANDLE;
  ASSERT_EQ(vkCreateSampler(other->handle(), &info, nullptr, &sampler), VK_SUCCESS);
  other->name_object(VK_OBJECT_TYPE_SAMPLER, sampler, "forgotten");
  EXPECT_TRUE(sink.messages.empty());
  other.reset();
  ASSERT_EQ(sink.messages.size(), 1u);
  EXPECT_THAT(sink.messages[0], HasSubstr("forgotten"));
}

// A device with the layer and one without it live in one process: calls must reach the right one.
TEST_F(DeviceTest, ADeviceWithoutValidationLivesBesideOneWithIt) {
  DeviceOptions options;
  options.device = std::to_string(device().info().index);
  NERITIC_ASSERT_OK(const auto plain, Device::create(options));
  EXPECT_FALSE(plain->validation());
  for (Device* each : {plain.get(), &device(), plain.get()}) {
    BufferDesc desc;
    desc.name = "either";
    desc.size = 64;
    desc.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    desc.memory = MemoryUse::kReadback;
    NERITIC_ASSERT_OK(const Buffer buffer, Buffer::create(*each, desc));
    NERITIC_ASSERT_STATUS(run_once(*each, [&](VkCommandBuffer commands) {
      vkCmdFillBuffer(commands, buffer.handle(), 0, 64, 0x01020304);
    }));
    EXPECT_EQ(buffer.mapped<std::uint32_t>()[15], 0x01020304u);
  }
}

TEST_F(DeviceTest, AnUnknownNameIsAnErrorThatListsTheDevices) {
  DeviceOptions options;
  options.device = "no such card";
  const auto made = Device::create(options);
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.error().code, ErrorCode::kBadInput);
  EXPECT_THAT(made.error().message, HasSubstr(device().info().name));
}

TEST_F(DeviceTest, IsChosenByIndexAndByPartOfItsName) {
  NERITIC_ASSERT_OK(const auto devices, list_devices());
  const DeviceInfo& info = device().info();
  ASSERT_LT(info.index, devices.size());
  EXPECT_EQ(devices[info.index].name, info.name);
  for (const std::string& wanted : {std::to_string(info.index), info.name.substr(0, 5)}) {
    DeviceOptions options;
    options.device = wanted;
    NERITIC_ASSERT_OK(const auto made, Device::create(options));
    EXPECT_EQ(made->info().name, info.name);
  }
}

TEST_F(DeviceTest, AMissingInstanceExtensionIsNamed) {
  DeviceOptions options;
  options.instance_extensions = {"VK_KHR_not_there"};
  const auto made = Device::create(options);
  ASSERT_FALSE(made.ok());
  EXPECT_THAT(made.error().message, HasSubstr("VK_KHR_not_there"));
}

// In a process of its own, begun anew: the environment decides what the loader finds, and a fork
// would lack the threads of a driver that another test has loaded.
TEST(DeviceDeathTest, WithoutADriverOneLineNamesThePackage) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        ::setenv("VK_ICD_FILENAMES", "/nonexistent.json", 1);
        ::setenv("VK_DRIVER_FILES", "/nonexistent.json", 1);
        const auto made = Device::create({});
        const auto listed = list_devices();
        if (made.ok() || listed.ok()) std::exit(3);
        std::fprintf(stderr, "%s\n", made.error().message.c_str());
        const bool one_line = made.error().message.find('\n') == std::string::npos;
        std::exit(one_line && made.error().code == ErrorCode::kNoDevice ? 0 : 4);
      },
      ::testing::ExitedWithCode(0), "mesa-vulkan-drivers");
}

TEST(VulkanError, MapsToACodeAndNamesTheCall) {
  EXPECT_EQ(vulkan_error(VK_ERROR_OUT_OF_DEVICE_MEMORY, "x").code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(vulkan_error(VK_ERROR_OUT_OF_POOL_MEMORY, "x").code, ErrorCode::kOutOfMemory);
  EXPECT_EQ(vulkan_error(VK_ERROR_DEVICE_LOST, "x").code, ErrorCode::kDeviceLost);
  EXPECT_EQ(vulkan_error(VK_TIMEOUT, "x").code, ErrorCode::kDeviceLost);
  EXPECT_EQ(vulkan_error(VK_ERROR_INCOMPATIBLE_DRIVER, "x").code, ErrorCode::kNoDevice);
  EXPECT_EQ(vulkan_error(VK_ERROR_FORMAT_NOT_SUPPORTED, "x").code, ErrorCode::kUnsupported);
  EXPECT_EQ(vulkan_error(VK_ERROR_DEVICE_LOST, "vkQueueSubmit2").message,
            "vkQueueSubmit2: VK_ERROR_DEVICE_LOST");
  EXPECT_EQ(vulkan_error(static_cast<VkResult>(-77), "x").message, "x: VkResult -77");
}

TEST(DefaultCacheFolder, FollowsXdgThenHome) {
  const auto with = [](const char* xdg, const char* home) {
    xdg ? ::setenv("XDG_CACHE_HOME", xdg, 1) : ::unsetenv("XDG_CACHE_HOME");
    home ? ::setenv("HOME", home, 1) : ::unsetenv("HOME");
    return default_cache_folder();
  };
  const char* home_before = std::getenv("HOME");
  const std::string home = home_before ? home_before : "";
  const char* xdg_before = std::getenv("XDG_CACHE_HOME");
  const std::string xdg = xdg_before ? xdg_before : "";
  EXPECT_EQ(with("/c", "/h"), fs::path("/c/neritic"));
  EXPECT_EQ(with("relative", "/h"), fs::path("/h/.cache/neritic"));
  EXPECT_EQ(with(nullptr, "/h"), fs::path("/h/.cache/neritic"));
  EXPECT_EQ(with(nullptr, nullptr), fs::path());
  with(xdg_before ? xdg.c_str() : nullptr, home_before ? home.c_str() : nullptr);
}

}  // namespace
}  // namespace neritic::gpu
