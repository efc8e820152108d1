#include "tests/fakes/client.hpp"

#include <algorithm>
#include <cstring>

#include "engine/gpu/frames.hpp"
#include "engine/gpu/resources.hpp"

namespace neritic::fakes {
namespace {

#define NERITIC_EXPECT_XR(call) EXPECT_EQ(call, XR_SUCCESS) << #call

VkImageMemoryBarrier2 transition(VkImage image, VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier2 one{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER_2};
  one.srcStageMask = one.dstStageMask = VK_PIPELINE_STAGE_2_ALL_COMMANDS_BIT;
  one.srcAccessMask = one.dstAccessMask =
      VK_ACCESS_2_MEMORY_WRITE_BIT | VK_ACCESS_2_MEMORY_READ_BIT;
  one.oldLayout = from;
  one.newLayout = to;
  one.srcQueueFamilyIndex = one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  one.image = image;
  one.subresourceRange = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, VK_REMAINING_ARRAY_LAYERS};
  return one;
}

void record(VkCommandBuffer commands, const VkImageMemoryBarrier2& barrier) {
  VkDependencyInfo info{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
  info.imageMemoryBarrierCount = 1;
  info.pImageMemoryBarriers = &barrier;
  vkCmdPipelineBarrier2(commands, &info);
}

}  // namespace

Client::~Client() {
  destroy();
}

void Client::destroy() {
  if (session) {
    NERITIC_EXPECT_XR(xrDestroySession(session));
  }
  session = XR_NULL_HANDLE;
  if (device) {
    for (const auto& message : device->validation_log().messages) validation.push_back(message);
  }
  device.reset();
  if (instance) {
    NERITIC_EXPECT_XR(xrDestroyInstance(instance));
  }
  instance = XR_NULL_HANDLE;
}

void Client::start(std::vector<const char*> extensions) {
  make_instance(std::move(extensions));
  get_system();
  make_device();
  make_session();
  make_space();
  begin_session();
  make_swapchain();
  begin_frame();
  end_frame();
  poll();
}

void Client::make_instance(std::vector<const char*> extensions) {
  extensions.push_back(XR_KHR_VULKAN_ENABLE2_EXTENSION_NAME);
  XrInstanceCreateInfo info{XR_TYPE_INSTANCE_CREATE_INFO};
  std::strcpy(info.applicationInfo.applicationName, "test");
  info.applicationInfo.apiVersion = XR_MAKE_VERSION(1, 0, 0);
  info.enabledExtensionCount = static_cast<std::uint32_t>(extensions.size());
  info.enabledExtensionNames = extensions.data();
  NERITIC_EXPECT_XR(xrCreateInstance(&info, &instance));
}

void Client::get_system() {
  const XrSystemGetInfo info{XR_TYPE_SYSTEM_GET_INFO, nullptr, XR_FORM_FACTOR_HEAD_MOUNTED_DISPLAY};
  NERITIC_EXPECT_XR(xrGetSystem(instance, &info, &system));
  std::uint32_t count = 0;
  NERITIC_EXPECT_XR(xrEnumerateViewConfigurations(instance, system, 1, &count, &configuration) ==
                            XR_ERROR_SIZE_INSUFFICIENT
                        ? xrEnumerateViewConfigurations(instance, system, 0, &count, nullptr)
                        : XR_SUCCESS);
  std::vector<XrViewConfigurationType> types(count);
  NERITIC_EXPECT_XR(xrEnumerateViewConfigurations(instance, system, count, &count, types.data()));
  configuration = types.at(0);
}

void Client::make_device() {
  XrGraphicsRequirementsVulkan2KHR needs{XR_TYPE_GRAPHICS_REQUIREMENTS_VULKAN2_KHR};
  NERITIC_EXPECT_XR(function<PFN_xrGetVulkanGraphicsRequirements2KHR>(
      "xrGetVulkanGraphicsRequirements2KHR")(instance, system, &needs));
  gpu::DeviceOptions options;
  options.validation = true;
  options.maker.instance = [this](const VkInstanceCreateInfo& create, VkInstance* made) {
    XrVulkanInstanceCreateInfoKHR info{XR_TYPE_VULKAN_INSTANCE_CREATE_INFO_KHR};
    info.systemId = system;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanCreateInfo = &create;
    VkResult result = VK_ERROR_UNKNOWN;
    NERITIC_EXPECT_XR(function<PFN_xrCreateVulkanInstanceKHR>("xrCreateVulkanInstanceKHR")(
        instance, &info, made, &result));
    return result;
  };
  options.maker.physical = [this](VkInstance vulkan, VkPhysicalDevice* found) {
    XrVulkanGraphicsDeviceGetInfoKHR info{XR_TYPE_VULKAN_GRAPHICS_DEVICE_GET_INFO_KHR};
    info.systemId = system;
    info.vulkanInstance = vulkan;
    NERITIC_EXPECT_XR(function<PFN_xrGetVulkanGraphicsDevice2KHR>("xrGetVulkanGraphicsDevice2KHR")(
        instance, &info, found));
    return VK_SUCCESS;
  };
  options.maker.device = [this](VkPhysicalDevice physical, const VkDeviceCreateInfo& create,
                                VkDevice* made) {
    XrVulkanDeviceCreateInfoKHR info{XR_TYPE_VULKAN_DEVICE_CREATE_INFO_KHR};
    info.systemId = system;
    info.pfnGetInstanceProcAddr = vkGetInstanceProcAddr;
    info.vulkanPhysicalDevice = physical;
    info.vulkanCreateInfo = &create;
    VkResult result = VK_ERROR_UNKNOWN;
    NERITIC_EXPECT_XR(function<PFN_xrCreateVulkanDeviceKHR>("xrCreateVulkanDeviceKHR")(
        instance, &info, made, &result));
    return result;
  };
  auto made = gpu::Device::create(options);
  ASSERT_TRUE(made.ok()) << made.error().message;
  device = std::move(made).value();
}

void Client::make_session(const void* next) {
  XrGraphicsBindingVulkan2KHR binding{XR_TYPE_GRAPHICS_BINDING_VULKAN2_KHR, next};
  binding.instance = device->instance();
  binding.physicalDevice = device->physical();
  binding.device = device->handle();
  binding.queueFamilyIndex = device->queue_family();
  const XrSessionCreateInfo info{XR_TYPE_SESSION_CREATE_INFO, &binding, 0, system};
  NERITIC_EXPECT_XR(xrCreateSession(instance, &info, &session));
}

void Client::make_space(XrReferenceSpaceType type) {
  const XrReferenceSpaceCreateInfo info{
      XR_TYPE_REFERENCE_SPACE_CREATE_INFO, nullptr, type, {{0, 0, 0, 1}, {0, 0, 0}}};
  NERITIC_EXPECT_XR(xrCreateReferenceSpace(session, &info, &space));
}

ClientImages Client::make_images(std::int64_t format, std::uint32_t width, std::uint32_t height,
                                 std::uint32_t layers) {
  ClientImages made;
  made.width = width;
  made.height = height;
  made.layers = layers;
  XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
  info.usageFlags = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT | XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT;
  info.format = format;
  info.sampleCount = info.faceCount = info.mipCount = 1;
  info.width = width;
  info.height = height;
  info.arraySize = layers;
  NERITIC_EXPECT_XR(xrCreateSwapchain(session, &info, &made.swapchain));
  std::uint32_t count = 0;
  NERITIC_EXPECT_XR(xrEnumerateSwapchainImages(made.swapchain, 0, &count, nullptr));
  std::vector<XrSwapchainImageVulkan2KHR> images(count, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR});
  NERITIC_EXPECT_XR(xrEnumerateSwapchainImages(
      made.swapchain, count, &count, reinterpret_cast<XrSwapchainImageBaseHeader*>(images.data())));
  for (const auto& image : images) made.images.push_back(image.image);
  return made;
}

void Client::make_swapchain(std::int64_t format, std::uint32_t layers) {
  std::uint32_t count = 0;
  NERITIC_EXPECT_XR(
      xrEnumerateViewConfigurationViews(instance, system, configuration, 0, &count, nullptr));
  std::vector<XrViewConfigurationView> sizes(count, {XR_TYPE_VIEW_CONFIGURATION_VIEW});
  NERITIC_EXPECT_XR(xrEnumerateViewConfigurationViews(instance, system, configuration, count,
                                                      &count, sizes.data()));
  views_.assign(count, {XR_TYPE_VIEW});
  color = make_images(format, sizes[0].recommendedImageRectWidth,
                      sizes[0].recommendedImageRectHeight, std::max(layers, count));
}

void Client::begin_session() {
  poll();
  EXPECT_TRUE(running);
}

void Client::poll() {
  XrEventDataBuffer event{XR_TYPE_EVENT_DATA_BUFFER};
  while (xrPollEvent(instance, &event) == XR_SUCCESS) {
    if (event.type == XR_TYPE_EVENT_DATA_SESSION_STATE_CHANGED) {
      session_state = reinterpret_cast<const XrEventDataSessionStateChanged&>(event).state;
      states.push_back(session_state);
      const XrSessionBeginInfo info{XR_TYPE_SESSION_BEGIN_INFO, nullptr, configuration};
      if (session_state == XR_SESSION_STATE_READY) {
        NERITIC_EXPECT_XR(xrBeginSession(session, &info));
        running = true;
      }
      if (session_state == XR_SESSION_STATE_STOPPING) {
        NERITIC_EXPECT_XR(xrEndSession(session));
        running = false;
      }
    }
    event = {XR_TYPE_EVENT_DATA_BUFFER};
  }
}

XrFrameState Client::begin_frame() {
  state = {XR_TYPE_FRAME_STATE};
  NERITIC_EXPECT_XR(xrWaitFrame(session, nullptr, &state));
  NERITIC_EXPECT_XR(xrBeginFrame(session, nullptr));
  return state;
}

void Client::end_frame(const std::vector<const void*>& layers) {
  XrFrameEndInfo info{XR_TYPE_FRAME_END_INFO};
  info.displayTime = state.predictedDisplayTime;
  info.environmentBlendMode = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  info.layerCount = static_cast<std::uint32_t>(layers.size());
  info.layers = reinterpret_cast<const XrCompositionLayerBaseHeader* const*>(layers.data());
  NERITIC_EXPECT_XR(xrEndFrame(session, &info));
}

void Client::paint(ClientImages& to, const std::vector<glm::u8vec4>& texels) {
  std::uint32_t index = 0;
  NERITIC_EXPECT_XR(xrAcquireSwapchainImage(to.swapchain, nullptr, &index));
  const XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO, nullptr,
                                      XR_INFINITE_DURATION};
  NERITIC_EXPECT_XR(xrWaitSwapchainImage(to.swapchain, &wait));
  const std::size_t area = std::size_t{to.width} * to.height;
  std::vector<glm::u8vec4> all(area * to.layers);
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i] = texels.size() == 1 ? texels[0] : texels.at(i % area);
  }
  auto staging = gpu::Buffer::create(
      *device,
      {"texels", all.size() * 4, VK_BUFFER_USAGE_TRANSFER_SRC_BIT, gpu::MemoryUse::kUpload});
  ASSERT_TRUE(staging.ok()) << staging.error().message;
  std::ranges::copy(all, staging->mapped<glm::u8vec4>().begin());
  const VkImage image = to.images.at(index);
  const auto status = gpu::run_once(*device, [&](VkCommandBuffer commands) {
    record(commands, transition(image, VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                                VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL));
    VkBufferImageCopy copy{};
    copy.imageSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, to.layers};
    copy.imageExtent = {to.width, to.height, 1};
    vkCmdCopyBufferToImage(commands, staging->handle(), image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                           1, &copy);
    record(commands, transition(image, VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL,
                                VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL));
  });
  ASSERT_TRUE(status.ok()) << status.error().message;
  NERITIC_EXPECT_XR(xrReleaseSwapchainImage(to.swapchain, nullptr));
}

const XrCompositionLayerProjection& Client::projection() {
  const XrViewLocateInfo info{XR_TYPE_VIEW_LOCATE_INFO, nullptr, configuration,
                              state.predictedDisplayTime, space};
  XrViewState view_state{XR_TYPE_VIEW_STATE};
  auto count = static_cast<std::uint32_t>(views_.size());
  NERITIC_EXPECT_XR(xrLocateViews(session, &info, &view_state, count, &count, views_.data()));
  projection_views_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    XrCompositionLayerProjectionView view{XR_TYPE_COMPOSITION_LAYER_PROJECTION_VIEW};
    view.pose = views_[i].pose;
    view.fov = views_[i].fov;
    view.subImage.swapchain = color.swapchain;
    view.subImage.imageRect.extent = {static_cast<std::int32_t>(color.width),
                                      static_cast<std::int32_t>(color.height)};
    view.subImage.imageArrayIndex = i;
    projection_views_.push_back(view);
  }
  projection_ = {XR_TYPE_COMPOSITION_LAYER_PROJECTION};
  projection_.space = space;
  projection_.viewCount = count;
  projection_.views = projection_views_.data();
  return projection_;
}

void Client::frame(glm::u8vec4 texel) {
  begin_frame();
  paint(color, {texel});
  end_frame({&projection()});
  poll();
}

}  // namespace neritic::fakes
