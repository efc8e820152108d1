#include "tests/fakes/openxr/vulkan.hpp"

#include <algorithm>
#include <cstring>

namespace neritic::fakes {
namespace {

// A wait of the fake's own copies: a minute is never needed, even by a software device.
constexpr std::uint64_t kWait_ns = 60'000'000'000;

VKAPI_ATTR VkBool32 VKAPI_CALL on_message(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                          VkDebugUtilsMessageTypeFlagsEXT,
                                          const VkDebugUtilsMessengerCallbackDataEXT* data,
                                          void* user) {
  static_cast<std::vector<std::string>*>(user)->push_back(data->pMessage);
  return VK_FALSE;
}

VkImageUsageFlags usage_of(XrSwapchainUsageFlags flags) {
  VkImageUsageFlags usage = VK_IMAGE_USAGE_TRANSFER_SRC_BIT;  // to compose
  const auto also = [&](XrSwapchainUsageFlags flag, VkImageUsageFlags bit) {
    if (flags & flag) usage |= bit;
  };
  also(XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT);
  also(XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
       VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT);
  also(XR_SWAPCHAIN_USAGE_UNORDERED_ACCESS_BIT, VK_IMAGE_USAGE_STORAGE_BIT);
  also(XR_SWAPCHAIN_USAGE_TRANSFER_SRC_BIT, VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  also(XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT, VK_IMAGE_USAGE_TRANSFER_DST_BIT);
  also(XR_SWAPCHAIN_USAGE_SAMPLED_BIT, VK_IMAGE_USAGE_SAMPLED_BIT);
  also(XR_SWAPCHAIN_USAGE_INPUT_ATTACHMENT_BIT_MND, VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT);
  return usage;
}

VkImageLayout client_layout(std::int64_t format) {
  return is_depth(format) ? VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL
                          : VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
}

void barrier(const Gpu& gpu, VkCommandBuffer commands, VkImage image, std::int64_t format,
             VkImageLayout from, VkImageLayout to) {
  VkImageMemoryBarrier one{VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER};
  one.srcAccessMask = VK_ACCESS_MEMORY_WRITE_BIT;
  one.dstAccessMask = VK_ACCESS_MEMORY_READ_BIT | VK_ACCESS_MEMORY_WRITE_BIT;
  one.oldLayout = from;
  one.newLayout = to;
  one.srcQueueFamilyIndex = one.dstQueueFamilyIndex = VK_QUEUE_FAMILY_IGNORED;
  one.image = image;
  one.subresourceRange = {aspects(format), 0, VK_REMAINING_MIP_LEVELS, 0,
                          VK_REMAINING_ARRAY_LAYERS};
  gpu.vk().vkCmdPipelineBarrier(commands, VK_PIPELINE_STAGE_ALL_COMMANDS_BIT,
                                VK_PIPELINE_STAGE_ALL_COMMANDS_BIT, 0, 0, nullptr, 0, nullptr, 1,
                                &one);
}

bool make_image(Gpu& gpu, const XrSwapchainCreateInfo& info, SwapchainImage& made) {
  VkImageCreateInfo create{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  if (info.usageFlags & XR_SWAPCHAIN_USAGE_MUTABLE_FORMAT_BIT) {
    create.flags = VK_IMAGE_CREATE_MUTABLE_FORMAT_BIT;
  }
  create.imageType = VK_IMAGE_TYPE_2D;
  create.format = static_cast<VkFormat>(info.format);
  create.extent = {info.width, info.height, 1};
  create.mipLevels = info.mipCount;
  create.arrayLayers = info.arraySize;
  create.samples = static_cast<VkSampleCountFlagBits>(info.sampleCount);
  create.usage = usage_of(info.usageFlags);
  const auto& vk = gpu.vk();
  if (vk.vkCreateImage(gpu.device(), &create, nullptr, &made.image) != VK_SUCCESS) return false;
  VkMemoryRequirements needs;
  vk.vkGetImageMemoryRequirements(gpu.device(), made.image, &needs);
  const auto type = gpu.memory_type(needs.memoryTypeBits, false);
  if (!type) return false;
  const VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                      *type};
  return vk.vkAllocateMemory(gpu.device(), &allocate, nullptr, &made.memory) == VK_SUCCESS &&
         vk.vkBindImageMemory(gpu.device(), made.image, made.memory, 0) == VK_SUCCESS;
}

// Host-visible memory for one copy.
struct Staging {
  Gpu& gpu;
  VkBuffer buffer = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;

  Staging(Gpu& gpu, VkDeviceSize bytes) : gpu(gpu) {
    const auto& vk = gpu.vk();
    VkBufferCreateInfo create{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
    create.size = bytes;
    create.usage = VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    if (vk.vkCreateBuffer(gpu.device(), &create, nullptr, &buffer) != VK_SUCCESS) return;
    VkMemoryRequirements needs;
    vk.vkGetBufferMemoryRequirements(gpu.device(), buffer, &needs);
    const auto type = gpu.memory_type(needs.memoryTypeBits, true);
    if (!type) return;
    const VkMemoryAllocateInfo allocate{VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, needs.size,
                                        *type};
    if (vk.vkAllocateMemory(gpu.device(), &allocate, nullptr, &memory) != VK_SUCCESS) return;
    vk.vkBindBufferMemory(gpu.device(), buffer, memory, 0);
  }
  ~Staging() {
    gpu.vk().vkDestroyBuffer(gpu.device(), buffer, nullptr);
    gpu.vk().vkFreeMemory(gpu.device(), memory, nullptr);
  }
};

}  // namespace

Gpu::Gpu(const VulkanObjects& objects, std::uint32_t family, std::uint32_t index)
    : functions_(new Functions), instance_(objects.instance), device_(objects.device) {
  Functions& vk = *functions_;
#define NERITIC_VK_LOAD(name) vk.name = reinterpret_cast<PFN_##name>(objects.get(instance_, #name));
  NERITIC_VK_INSTANCE(NERITIC_VK_LOAD)
#undef NERITIC_VK_LOAD
#define NERITIC_VK_LOAD(name) \
  vk.name = reinterpret_cast<PFN_##name>(vk.vkGetDeviceProcAddr(device_, #name));
  NERITIC_VK_DEVICE(NERITIC_VK_LOAD)
#undef NERITIC_VK_LOAD
  vk.vkGetPhysicalDeviceMemoryProperties(objects.physical, &memory_);
  vk.vkGetDeviceQueue(device_, family, index, &queue_);
  VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
  pool.queueFamilyIndex = family;
  vk.vkCreateCommandPool(device_, &pool, nullptr, &pool_);
  VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
  allocate.commandPool = pool_;
  allocate.commandBufferCount = 1;
  vk.vkAllocateCommandBuffers(device_, &allocate, &commands_);
  const VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
  vk.vkCreateFence(device_, &fence, nullptr, &fence_);
  listening_ = objects.debug_utils && vk.vkCreateDebugUtilsMessengerEXT;
}

Gpu::~Gpu() {
  const Functions& vk = *functions_;
  vk.vkDeviceWaitIdle(device_);
  vk.vkDestroyFence(device_, fence_, nullptr);
  vk.vkDestroyCommandPool(device_, pool_, nullptr);
  delete functions_;
}

std::optional<std::uint32_t> Gpu::memory_type(std::uint32_t bits, bool host) const {
  const VkMemoryPropertyFlags wanted =
      host ? VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT
           : VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
  for (std::uint32_t i = 0; i < memory_.memoryTypeCount; ++i) {
    if ((bits & (1u << i)) && (memory_.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  }
  return {};
}

VkCommandBuffer Gpu::begin() {
  functions_->vkResetCommandPool(device_, pool_, 0);
  VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
  info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
  functions_->vkBeginCommandBuffer(commands_, &info);
  return commands_;
}

bool Gpu::submit() {
  messages_.clear();
  const Functions& vk = *functions_;
  VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
  if (listening_) {
    VkDebugUtilsMessengerCreateInfoEXT create{
        VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
    create.messageSeverity = VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
    create.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
    create.pfnUserCallback = on_message;
    create.pUserData = &messages_;
    vk.vkCreateDebugUtilsMessengerEXT(instance_, &create, nullptr, &messenger);
  }
  VkSubmitInfo info{VK_STRUCTURE_TYPE_SUBMIT_INFO};
  info.commandBufferCount = 1;
  info.pCommandBuffers = &commands_;
  vk.vkEndCommandBuffer(commands_);
  const bool good = vk.vkQueueSubmit(queue_, 1, &info, fence_) == VK_SUCCESS &&
                    vk.vkWaitForFences(device_, 1, &fence_, VK_TRUE, kWait_ns) == VK_SUCCESS;
  vk.vkResetFences(device_, 1, &fence_);
  if (messenger) vk.vkDestroyDebugUtilsMessengerEXT(instance_, messenger, nullptr);
  return good;
}

bool is_depth(std::int64_t format) {
  return format >= VK_FORMAT_D16_UNORM && format <= VK_FORMAT_D32_SFLOAT_S8_UINT;
}

VkImageAspectFlags aspects(std::int64_t format) {
  if (!is_depth(format)) return VK_IMAGE_ASPECT_COLOR_BIT;
  const bool stencil = format >= VK_FORMAT_S8_UINT;
  return VK_IMAGE_ASPECT_DEPTH_BIT | (stencil ? VK_IMAGE_ASPECT_STENCIL_BIT : 0);
}

std::uint32_t texel_bytes(std::int64_t format) {
  switch (format) {
    case VK_FORMAT_R5G6B5_UNORM_PACK16:
    case VK_FORMAT_D16_UNORM:
      return 2;
    case VK_FORMAT_R16G16B16A16_SFLOAT:
      return 8;
    case VK_FORMAT_R8G8B8A8_SRGB:
    case VK_FORMAT_B8G8R8A8_SRGB:
    case VK_FORMAT_R8G8B8A8_UNORM:
    case VK_FORMAT_B8G8R8A8_UNORM:
    case VK_FORMAT_A2B10G10R10_UNORM_PACK32:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
    case VK_FORMAT_D32_SFLOAT:
      return 4;
    default:
      return 0;
  }
}

std::vector<SwapchainImage> make_images(Gpu& gpu, const XrSwapchainCreateInfo& info,
                                        std::uint32_t count) {
  std::vector<SwapchainImage> images(count);
  bool good = true;
  for (SwapchainImage& one : images) good = good && make_image(gpu, info, one);
  if (good) {
    const VkCommandBuffer commands = gpu.begin();
    for (const SwapchainImage& one : images) {
      barrier(gpu, commands, one.image, info.format, VK_IMAGE_LAYOUT_UNDEFINED,
              client_layout(info.format));
    }
    good = gpu.submit();
  }
  if (!good) destroy_images(gpu, images);
  return images;
}

void destroy_images(Gpu& gpu, std::vector<SwapchainImage>& images) {
  gpu.vk().vkDeviceWaitIdle(gpu.device());
  for (const SwapchainImage& one : images) {
    gpu.vk().vkDestroyImage(gpu.device(), one.image, nullptr);
    gpu.vk().vkFreeMemory(gpu.device(), one.memory, nullptr);
  }
  images.clear();
}

bool in_client_layout(Gpu& gpu, const XrSwapchainCreateInfo& info, VkImage image) {
  if (!gpu.listening()) return true;
  const VkImageLayout layout = client_layout(info.format);
  const VkCommandBuffer commands = gpu.begin();
  barrier(gpu, commands, image, info.format, layout, VK_IMAGE_LAYOUT_GENERAL);
  barrier(gpu, commands, image, info.format, VK_IMAGE_LAYOUT_GENERAL, layout);
  gpu.submit();
  const auto& messages = gpu.messages();
  return std::none_of(messages.begin(), messages.end(), [](const std::string& message) {
    return message.find("ayout") != std::string::npos;
  });
}

std::vector<std::uint8_t> read_back(Gpu& gpu, const XrSwapchainCreateInfo& info, VkImage image,
                                    std::uint32_t array_index) {
  const VkDeviceSize bytes = VkDeviceSize{info.width} * info.height * texel_bytes(info.format);
  Staging staging(gpu, bytes);
  if (!staging.memory) return {};
  const VkCommandBuffer commands = gpu.begin();
  const VkImageLayout rest = client_layout(info.format);
  barrier(gpu, commands, image, info.format, rest, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL);
  VkBufferImageCopy copy{};
  copy.imageSubresource = {
      is_depth(info.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0, array_index,
      1};
  copy.imageExtent = {info.width, info.height, 1};
  const auto& vk = gpu.vk();
  vk.vkCmdCopyImageToBuffer(commands, image, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, staging.buffer,
                            1, &copy);
  barrier(gpu, commands, image, info.format, VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, rest);
  void* mapped = nullptr;
  if (!gpu.submit() || vk.vkMapMemory(gpu.device(), staging.memory, 0, VK_WHOLE_SIZE, 0, &mapped)) {
    return {};
  }
  std::vector<std::uint8_t> read(bytes);
  std::memcpy(read.data(), mapped, bytes);
  vk.vkUnmapMemory(gpu.device(), staging.memory);
  return read;
}

}  // namespace neritic::fakes
