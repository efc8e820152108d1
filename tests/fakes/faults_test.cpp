// Clients that break one rule each: the fake runtime answers with the right error and a sentence
// that names the rule.
#include <gmock/gmock.h>

#include <cstring>

#include "engine/gpu/frames.hpp"
#include "tests/fakes/client.hpp"
#include "tests/fakes/fake_headset.hpp"
#include "tests/support/device_gate.hpp"

namespace neritic::fakes {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

class WrongClient : public ::testing::Test {
 protected:
  void SetUp() override {
    if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
    headset_.expect_faults();
    client_.start();
    EXPECT_EQ(headset_.faults(), "");
  }
  // One more fault than before, with these words.
  void expect_fault(const std::string& words) {
    const std::string all = headset_.faults();
    const std::string added = all.substr(seen_);
    seen_ = all.size();
    EXPECT_THAT(added, HasSubstr(words));
    EXPECT_EQ(std::count(added.begin(), added.end(), '\n'), 1) << added;
  }
  XrResult end(const std::vector<const void*>& layers, XrTime time) {
    XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
    info.displayTime = time;
    info.environmentBlendMode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
    info.layerCount = static_cast<std::uint32_t>(layers.size());
    info.layers = reinterpret_cast<const XrCompositionLayerBaseHeader* const*>(layers.data());
    return xrEndFrame(client_.session, &info);
  }

  FakeHeadset headset_;
  Client client_;
  std::size_t seen_ = 0;
};

TEST_F(WrongClient, FramesOutOfOrder) {
  EXPECT_EQ(xrBeginFrame(client_.session, nullptr), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("xrBeginFrame: no xrWaitFrame came before it for this frame.");
  EXPECT_EQ(end({}, 1), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("xrEndFrame: no xrBeginFrame came before it for this frame.");
  client_.begin_frame();
  EXPECT_EQ(end({}, client_.state.predictedDisplayTime + 1), XR_ERROR_TIME_INVALID);
  expect_fault("it must be the frame's predictedDisplayTime");
}

TEST_F(WrongClient, ImagesOutOfOrder) {
  const XrSwapchain swapchain = client_.color.swapchain;
  const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr, 0};
  EXPECT_EQ(xrWaitSwapchainImage(swapchain, &wait), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("no image is acquired");
  std::uint32_t index = 0;
  EXPECT_EQ(xrAcquireSwapchainImage(swapchain, nullptr, &index), XR_SUCCESS);
  EXPECT_EQ(xrReleaseSwapchainImage(swapchain, nullptr), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("xrReleaseSwapchainImage: the image was not waited for");
  EXPECT_EQ(xrWaitSwapchainImage(swapchain, &wait), XR_SUCCESS);
  EXPECT_EQ(xrWaitSwapchainImage(swapchain, &wait), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("waited for already");
  EXPECT_EQ(xrAcquireSwapchainImage(swapchain, nullptr, &index), XR_SUCCESS);
  EXPECT_EQ(xrAcquireSwapchainImage(swapchain, nullptr, &index), XR_SUCCESS);
  EXPECT_EQ(xrAcquireSwapchainImage(swapchain, nullptr, &index), XR_ERROR_CALL_ORDER_INVALID);
  expect_fault("all images are acquired");
}

TEST_F(WrongClient, HandlesThatAreDestroyedUnknownOrOfAnotherKind) {
  const XrSpace space = client_.space;
  EXPECT_EQ(xrDestroySpace(space), XR_SUCCESS);
  XrSpaceLocation location{XR_TYPE_SPACE_LOCATION};
  EXPECT_EQ(xrLocateSpace(space, space, 1, &location), XR_ERROR_HANDLE_INVALID);
  expect_fault("XR_OBJECT_TYPE_SPACE was destroyed");
  const auto wrong_kind = reinterpret_cast<XrSpace>(client_.session);
  EXPECT_EQ(xrDestroySpace(wrong_kind), XR_ERROR_HANDLE_INVALID);
  expect_fault("a handle of XR_OBJECT_TYPE_SESSION was given where XR_OBJECT_TYPE_SPACE is wanted");
  EXPECT_EQ(xrDestroySpace(reinterpret_cast<XrSpace>(std::uint64_t{77})), XR_ERROR_HANDLE_INVALID);
  expect_fault("was never created");
  EXPECT_EQ(xrDestroySpace(XR_NULL_HANDLE), XR_ERROR_HANDLE_INVALID);
  expect_fault("is XR_NULL_HANDLE");
}

TEST_F(WrongClient, StructuresWithWrongTypesOrChains) {
  XrEventDataBuffer event{XR_TYPE_EVENT_DATA_INSTANCE_LOSS_PENDING};  // of the last poll
  EXPECT_EQ(xrPollEvent(client_.instance, &event), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("it must be XR_TYPE_EVENT_DATA_BUFFER");
  XrCompositionLayerDepthInfoKHR depth{XR_TYPE_COMPOSITION_LAYER_DEPTH_INFO_KHR};
  client_.begin_frame();
  client_.paint(client_.color, {{0, 0, 0, 255}});
  XrCompositionLayerProjection layer = client_.projection();
  std::vector<XrCompositionLayerProjectionView> views(layer.views, layer.views + layer.viewCount);
  layer.views = views.data();
  views[1].next = &depth;
  EXPECT_EQ(end({&layer}, client_.state.predictedDisplayTime), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("its extension XR_KHR_composition_layer_depth was not enabled");
  views[1].next = &layer;
  EXPECT_EQ(end({&layer}, client_.state.predictedDisplayTime), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("XR_TYPE_COMPOSITION_LAYER_PROJECTION may not stand in the next chain of");
}

TEST_F(WrongClient, LayersThatCannotBeShown) {
  client_.begin_frame();
  const XrTime time = client_.state.predictedDisplayTime;
  XrCompositionLayerProjection layer = client_.projection();
  EXPECT_EQ(end({&layer}, time), XR_ERROR_LAYER_INVALID);
  expect_fault("shows a swapchain of which no image was released yet");
  client_.paint(client_.color, {{0, 0, 0, 255}});
  std::vector<XrCompositionLayerProjectionView> views(layer.views, layer.views + layer.viewCount);
  layer.views = views.data();
  layer.viewCount = 1;
  EXPECT_EQ(end({&layer}, time), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("layer 0 has 1 views; the session's configuration has 2");
  layer.viewCount = 2;
  views[1].subImage.imageRect.offset.x = 1;
  EXPECT_EQ(end({&layer}, time), XR_ERROR_SWAPCHAIN_RECT_INVALID);
  expect_fault("which is not within 160 x 160");
  views[1].subImage.imageRect.offset.x = 0;
  views[1].subImage.imageArrayIndex = 2;
  EXPECT_EQ(end({&layer}, time), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("imageArrayIndex 2; the swapchain's arraySize is 2");
  views[1].subImage.imageArrayIndex = 1;
  views[1].pose.orientation = {0, 0, 0, 0};
  EXPECT_EQ(end({&layer}, time), XR_ERROR_POSE_INVALID);
  expect_fault("the orientation's quaternion has the length 0.0000");
  views[1].pose.orientation.w = 1;
  views[1].fov.angleRight = 1.6f;
  EXPECT_EQ(end({&layer}, time), XR_ERROR_VALIDATION_FAILURE);
  expect_fault("each angle must be within a right angle");
  views[1].fov.angleRight = 0.5f;
  layer.space = XR_NULL_HANDLE;
  EXPECT_EQ(end({&layer}, time), XR_ERROR_HANDLE_INVALID);
  expect_fault("the XR_OBJECT_TYPE_SPACE is XR_NULL_HANDLE");
}

TEST_F(WrongClient, ASessionThatIsBegunTwiceOrEndedUnasked) {
  const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, client_.configuration};
  EXPECT_EQ(xrBeginSession(client_.session, &info), XR_ERROR_SESSION_RUNNING);
  expect_fault("xrBeginSession: the session is running.");
  EXPECT_EQ(xrEndSession(client_.session), XR_ERROR_SESSION_NOT_STOPPING);
  expect_fault("it may end after the event of XR_SESSION_STATE_STOPPING");
}

TEST_F(WrongClient, AnExtensionsFunctionWithoutTheExtension) {
  PFN_xrVoidFunction function = nullptr;
  EXPECT_EQ(xrGetInstanceProcAddr(client_.instance, "xrGetVisibilityMaskKHR", &function),
            XR_ERROR_FUNCTION_UNSUPPORTED);
  EXPECT_EQ(function, nullptr);
}

TEST_F(WrongClient, AFormatThatIsNotOffered) {
  XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT;
  info.format = VK_FORMAT_R5G6B5_UNORM_PACK16;
  info.sampleCount = info.faceCount = info.mipCount = info.arraySize = 1;
  info.width = info.height = 8;
  XrSwapchain swapchain = XR_NULL_HANDLE;
  EXPECT_EQ(xrCreateSwapchain(client_.session, &info, &swapchain),
            XR_ERROR_SWAPCHAIN_FORMAT_UNSUPPORTED);
  expect_fault("is not among xrEnumerateSwapchainFormats");
}

TEST_F(WrongClient, AnImageReleasedInTheWrongLayout) {
  std::uint32_t index = 0;
  ClientImages& color = client_.color;
  EXPECT_EQ(xrAcquireSwapchainImage(color.swapchain, nullptr, &index), XR_SUCCESS);
  const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr,
                                      XR_INFINITE_DURATION};
  EXPECT_EQ(xrWaitSwapchainImage(color.swapchain, &wait), XR_SUCCESS);
  const auto status = gpu::run_once(*client_.device, [&](VkCommandBuffer commands) {
    VkImageMemoryBarrier2 one{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
    one.srcStageMask = one.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
    one.oldLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
    one.newLayout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL;
    one.srcQueueFamilyIndex = one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
    one.image = color.images[index];
    one.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
    VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    info.imageMemoryBarrierCount = 1;
    info.pImageMemoryBarriers = &one;
    vkCmdPipelineBarrier2(commands, &info);
  });
  ASSERT_TRUE(status.ok());
  EXPECT_EQ(xrReleaseSwapchainImage(color.swapchain, nullptr), XR_SUCCESS);
  expect_fault("the image is not in VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL");
}

TEST(WrongStart, AVulkanDeviceThatTheRuntimeDidNotMakeIsRefused) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  FakeHeadset headset;
  headset.expect_faults();
  Client client;
  client.make_instance();
  client.get_system();
  client.make_device();
  auto other = gpu::Device::create({});
  ASSERT_TRUE(other.ok());
  XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR};
  binding.instance = client.device->instance();
  binding.physicalDevice = client.device->physical();
  binding.device = other.value()->handle();
  const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding, 0, client.system};
  EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session),
            XR_ERROR_GRAPHICS_DEVICE_INVALID);
  EXPECT_THAT(headset.faults(), HasSubstr("is not the one that xrCreateVulkanDeviceKHR made"));
  client.session = XR_NULL_HANDLE;
  other.value().reset();
}

// XR_KHR_vulkan_enable: a client's own instance needs the extensions that the runtime names, and
// the device those of devices.
TEST(WrongVulkan, AnInstanceAndADeviceWithoutTheWantedExtensions) {
  if (test::may_skip_without_device()) GTEST_SKIP() << "no Vulkan device";
  FakeHeadset headset;
  headset.expect_faults();
  Client client;
  client.start({XR_KHR_VULKAN_ENABLE_EXTENSION_NAME});
  EXPECT_EQ(headset.faults(), "");
  const auto text = [&](const char* name) {
    const auto ask = client.function<PFN_xrGetVulkanInstanceExtensionsKHR>(name);
    std::uint32_t count = 0;
    EXPECT_EQ(ask(client.instance, client.system, 0, &count, nullptr), XR_SUCCESS);
    std::string found(count, '\0');
    EXPECT_EQ(ask(client.instance, client.system, count, &count, found.data()), XR_SUCCESS);
    return std::string(found.c_str());
  };
  EXPECT_EQ(text("xrGetVulkanInstanceExtensionsKHR"), "VK_KHR_external_memory_capabilities");
  EXPECT_EQ(text("xrGetVulkanDeviceExtensionsKHR"),
            "VK_KHR_dedicated_allocation VK_KHR_get_memory_requirements2");
  const auto device =
      client.function<PFN_xrGetVulkanGraphicsDeviceKHR>("xrGetVulkanGraphicsDeviceKHR");
  VkPhysicalDevice physical = VK_NULL_HANDLE;
  EXPECT_EQ(device(client.instance, client.system, client.device->instance(), &physical),
            XR_ERROR_VALIDATION_FAILURE);
  EXPECT_THAT(headset.faults(), HasSubstr("vkInstance lacks VK_KHR_external_memory_capabilities"));
  headset.write("vulkan_instance_extensions\n");
  EXPECT_EQ(device(client.instance, client.system, client.device->instance(), &physical),
            XR_SUCCESS);
  EXPECT_EQ(physical, client.device->physical());
  EXPECT_EQ(xrDestroySession(client.session), XR_SUCCESS);
  client.session = XR_NULL_HANDLE;
  XrGraphicsBindingVulkanKHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN_KHR};
  binding.instance = client.device->instance();
  binding.physicalDevice = client.device->physical();
  binding.device = client.device->handle();
  binding.queueFamilyIndex = client.device->queue_family();
  const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding, 0, client.system};
  EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session),
            XR_ERROR_GRAPHICS_REQUIREMENTS_CALL_MISSING);
  EXPECT_THAT(headset.faults(), HasSubstr("xrGetVulkanGraphicsRequirementsKHR was not called"));
  XrGraphicsRequirementsVulkanKHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN_KHR};
  EXPECT_EQ(client.function<PFN_xrGetVulkanGraphicsRequirementsKHR>(
                "xrGetVulkanGraphicsRequirementsKHR")(client.instance, client.system, &needs),
            XR_SUCCESS);
  EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session),
            XR_ERROR_GRAPHICS_DEVICE_INVALID);
  EXPECT_THAT(headset.faults(),
              HasSubstr("the binding's device lacks VK_KHR_dedicated_allocation"));
  headset.write("vulkan_device_extensions\n");
  EXPECT_EQ(xrCreateSession(client.instance, &info, &client.session), XR_SUCCESS);
}

}  // namespace
}  // namespace neritic::fakes
