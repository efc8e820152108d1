// The client's Vulkan objects, called through its own loader, and the images of swapchains.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "tests/fakes/openxr/xr.hpp"

namespace neritic::fakes {

struct VulkanObjects {
  PFN_vkGetInstanceProcAddr get = nullptr;
  VkInstance instance = VK_NULL_HANDLE;
  VkPhysicalDevice physical = VK_NULL_HANDLE;  // as xrGetVulkanGraphicsDevice[2]KHR answered
  VkDevice device = VK_NULL_HANDLE;            // as xrCreateVulkanDeviceKHR made it
  std::vector<std::uint32_t> queue_families;   // that the device was made with
  std::set<std::string> instance_extensions, device_extensions;  // that were enabled
  bool debug_utils = false;
  bool by_client = false;  // made without this instance's help, as XR_KHR_vulkan_enable has it
};

// The calls of the runtime on the client's device. Made with a session, destroyed with it.
class Gpu {
 public:
  Gpu(const VulkanObjects& objects, std::uint32_t family, std::uint32_t index);
  ~Gpu();
  Gpu(const Gpu&) = delete;
  Gpu& operator=(const Gpu&) = delete;

  struct Functions;
  const Functions& vk() const { return *functions_; }
  VkDevice device() const { return device_; }
  // A type of memory that fits, visible to the host or not.
  std::optional<std::uint32_t> memory_type(std::uint32_t bits, bool host) const;
  // Begins commands; submit() ends them, runs them and waits. False: the device refused.
  VkCommandBuffer begin();
  bool submit();
  // Messages of Vulkan validation about the commands of the last submit(), if they are heard.
  const std::vector<std::string>& messages() const { return messages_; }
  bool listening() const { return listening_; }

 private:
  Functions* functions_;
  VkInstance instance_;
  VkDevice device_;
  VkQueue queue_ = VK_NULL_HANDLE;
  VkCommandPool pool_ = VK_NULL_HANDLE;
  VkCommandBuffer commands_ = VK_NULL_HANDLE;
  VkFence fence_ = VK_NULL_HANDLE;
  VkPhysicalDeviceMemoryProperties memory_{};
  std::vector<std::string> messages_;
  bool listening_ = false;
};

struct Gpu::Functions {
#define NERITIC_VK_INSTANCE(_)           \
  _(vkGetPhysicalDeviceMemoryProperties) \
  _(vkGetDeviceProcAddr) _(vkCreateDebugUtilsMessengerEXT) _(vkDestroyDebugUtilsMessengerEXT)
#define NERITIC_VK_DEVICE(_)        \
  _(vkGetDeviceQueue)               \
  _(vkCreateImage)                  \
  _(vkDestroyImage)                 \
  _(vkGetImageMemoryRequirements)   \
  _(vkCreateBuffer)                 \
  _(vkDestroyBuffer)                \
  _(vkGetBufferMemoryRequirements)  \
  _(vkAllocateMemory)               \
  _(vkFreeMemory)                   \
  _(vkBindImageMemory)              \
  _(vkBindBufferMemory)             \
  _(vkMapMemory)                    \
  _(vkUnmapMemory)                  \
  _(vkInvalidateMappedMemoryRanges) \
  _(vkCreateCommandPool)            \
  _(vkDestroyCommandPool)           \
  _(vkAllocateCommandBuffers)       \
  _(vkResetCommandPool)             \
  _(vkBeginCommandBuffer)           \
  _(vkEndCommandBuffer)             \
  _(vkCmdPipelineBarrier)           \
  _(vkCmdCopyImageToBuffer)         \
  _(vkCmdClearColorImage)           \
  _(vkCmdClearDepthStencilImage)    \
  _(vkQueueSubmit)                  \
  _(vkCreateFence)                  \
  _(vkDestroyFence)                 \
  _(vkWaitForFences)                \
  _(vkResetFences)                  \
  _(vkDeviceWaitIdle)
#define NERITIC_VK_MEMBER(name) PFN_##name name = nullptr;
  NERITIC_VK_INSTANCE(NERITIC_VK_MEMBER)
  NERITIC_VK_DEVICE(NERITIC_VK_MEMBER)
#undef NERITIC_VK_MEMBER
};

bool is_depth(std::int64_t format);
VkImageAspectFlags aspects(std::int64_t format);

// One image of a swapchain, in the layout in which a client gets and returns it.
struct SwapchainImage {
  VkImage image = VK_NULL_HANDLE;
  VkDeviceMemory memory = VK_NULL_HANDLE;
};
// Empty: the device refused.
std::vector<SwapchainImage> make_images(Gpu& gpu, const XrSwapchainCreateInfo& info,
                                        std::uint32_t count);
void destroy_images(Gpu& gpu, std::vector<SwapchainImage>& images);

// Whether Vulkan validation finds the image in the layout in which a client must return it. Always
// true on a device without validation.
bool in_client_layout(Gpu& gpu, const XrSwapchainCreateInfo& info, VkImage image);

// One array layer of a released image, rows from the top, as stored. Empty: the device refused.
std::vector<std::uint8_t> read_back(Gpu& gpu, const XrSwapchainCreateInfo& info, VkImage image,
                                    std::uint32_t array_index);
// Bytes of one texel of a format of a swapchain (of depth formats, of the depth aspect's copy); 0
// if the fake does not know it.
std::uint32_t texel_bytes(std::int64_t format);

}  // namespace neritic::fakes
