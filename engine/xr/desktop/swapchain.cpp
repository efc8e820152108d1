#include "engine/xr/desktop/swapchain.hpp"

#include <algorithm>
#include <utility>

#include "engine/core/check.hpp"

namespace neritic::xr {
namespace {

constexpr std::uint64_t kAcquireTimeoutNs = 500'000'000;
constexpr std::uint32_t kImagesWanted = 3;  // one shown, one waiting, one drawn to

template <class T, class Function, class... Args>
Result<std::vector<T>> enumerate(const char* what, Function function, Args... args) {
  std::uint32_t count = 0;
  VkResult result = function(args..., &count, nullptr);
  std::vector<T> items(count);
  if (result == VK_SUCCESS && count > 0) result = function(args..., &count, items.data());
  if (result < VK_SUCCESS) return gpu::vulkan_error(result, what);
  items.resize(count);
  return items;
}

VkExtent2D clamped(const VkSurfaceCapabilitiesKHR& caps, std::uint32_t width,
                   std::uint32_t height) {
  if (caps.currentExtent.width != ~0u) return caps.currentExtent;  // else the surface follows us
  return {std::clamp(width, caps.minImageExtent.width, caps.maxImageExtent.width),
          std::clamp(height, caps.minImageExtent.height, caps.maxImageExtent.height)};
}

VkCompositeAlphaFlagBitsKHR composite_alpha(const VkSurfaceCapabilitiesKHR& caps) {
  const VkCompositeAlphaFlagsKHR bits = caps.supportedCompositeAlpha;
  if (bits & VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR) return VK_COMPOSITE_ALPHA_OPAQUE_BIT_KHR;
  return static_cast<VkCompositeAlphaFlagBitsKHR>(bits & ~(bits - 1));  // the lowest there is
}

}  // namespace

Result<Swapchain> Swapchain::create(gpu::Device& device, VkSurfaceKHR surface,
                                    std::uint32_t frames_in_flight) {
  Swapchain swapchain(device, surface);
  VkBool32 supported = VK_FALSE;
  const VkResult result = vkGetPhysicalDeviceSurfaceSupportKHR(
      device.physical(), device.queue_family(), surface, &supported);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkGetPhysicalDeviceSurfaceSupport");
  if (!supported)
    return failure(ErrorCode::kUnsupported, "device {} cannot show pictures in this window",
                   device.info().name);
  NERITIC_TRY_STATUS(swapchain.choose_format());
  for (std::uint32_t i = 0; i <= frames_in_flight; ++i) {
    NERITIC_TRY(const VkSemaphore ready,
                swapchain.create_semaphore(fmt::format("window image ready {}", i)));
    swapchain.ready_.push_back(ready);
  }
  return swapchain;
}

// The picture is sRGB-encoded by the tonemap pass, so the images store it as it is (UNORM).
Status Swapchain::choose_format() {
  NERITIC_TRY(const auto formats,
              enumerate<VkSurfaceFormatKHR>("vkGetPhysicalDeviceSurfaceFormatsKHR",
                                            vkGetPhysicalDeviceSurfaceFormatsKHR,
                                            device_->physical(), surface_));
  for (const VkFormat wanted : {VK_FORMAT_B8G8R8A8_UNORM, VK_FORMAT_R8G8B8A8_UNORM})
    for (const VkSurfaceFormatKHR& format : formats)
      if (format.format == wanted && format.colorSpace == VK_COLOR_SPACE_SRGB_NONLINEAR_KHR) {
        format_ = format;
        return {};
      }
  return failure(ErrorCode::kUnsupported,
                 "device {} has no 8-bit sRGB format for windows among its {} formats",
                 device_->info().name, formats.size());
}

Result<VkSemaphore> Swapchain::create_semaphore(const std::string& name) const {
  const VkSemaphoreCreateInfo info{VK_STRUCTURE_TYPE_SEMAPHORE_CREATE_INFO};
  VkSemaphore semaphore = VK_NULL_HANDLE;
  const VkResult result = vkCreateSemaphore(device_->handle(), &info, nullptr, &semaphore);
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateSemaphore");
  device_->name_object(VK_OBJECT_TYPE_SEMAPHORE, semaphore, name);
  return semaphore;
}

Result<bool> Swapchain::recreate(std::uint32_t wanted_width, std::uint32_t wanted_height) {
  VkSurfaceCapabilitiesKHR caps{};
  VkResult result = vkGetPhysicalDeviceSurfaceCapabilitiesKHR(device_->physical(), surface_, &caps);
  if (result != VK_SUCCESS)
    return gpu::vulkan_error(result, "vkGetPhysicalDeviceSurfaceCapabilitiesKHR");
  const VkExtent2D extent = clamped(caps, wanted_width, wanted_height);
  if (extent.width == 0 || extent.height == 0) return false;
  device_->wait_idle();  // nothing may still draw to or show the old images
  extent_ = extent;
  // Pictures are copied to it; only a screenshot reads it.
  if (!(caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_DST_BIT))
    return failure(ErrorCode::kUnsupported, "device {} cannot copy pictures to this window",
                   device_->info().name);
  usage_ = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_TRANSFER_DST_BIT |
           (caps.supportedUsageFlags & VK_IMAGE_USAGE_TRANSFER_SRC_BIT);
  VkSwapchainCreateInfoKHR info{VK_STRUCTURE_TYPE_SWAPCHAIN_CREATE_INFO_KHR};
  info.surface = surface_;
  info.minImageCount = std::max(caps.minImageCount, kImagesWanted);
  if (caps.maxImageCount > 0) info.minImageCount = std::min(info.minImageCount, caps.maxImageCount);
  info.imageFormat = format_.format;
  info.imageColorSpace = format_.colorSpace;
  info.imageExtent = extent_;
  info.imageArrayLayers = 1;
  info.imageUsage = usage_;
  info.imageSharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.preTransform = caps.currentTransform;
  info.compositeAlpha = composite_alpha(caps);
  info.presentMode = VK_PRESENT_MODE_FIFO_KHR;  // every device has it
  info.clipped = VK_TRUE;
  info.oldSwapchain = swapchain_;
  VkSwapchainKHR fresh = VK_NULL_HANDLE;
  result = vkCreateSwapchainKHR(device_->handle(), &info, nullptr, &fresh);
  destroy_images();
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
  swapchain_ = result == VK_SUCCESS ? fresh : VK_NULL_HANDLE;
  if (result != VK_SUCCESS) return gpu::vulkan_error(result, "vkCreateSwapchainKHR");
  device_->name_object(VK_OBJECT_TYPE_SWAPCHAIN_KHR, swapchain_, "window");
  NERITIC_TRY_STATUS(create_images());
  return true;
}

Status Swapchain::create_images() {
  NERITIC_TRY(const auto handles,
              enumerate<VkImage>("vkGetSwapchainImagesKHR", vkGetSwapchainImagesKHR,
                                 device_->handle(), swapchain_));
  for (const VkImage handle : handles) {
    // One name for all: the frame graph's plan is the same whichever image it draws to.
    NERITIC_TRY(gpu::Image image, gpu::Image::borrow(*device_,
                                                     {.name = "display",
                                                      .format = format_.format,
                                                      .width = extent_.width,
                                                      .height = extent_.height,
                                                      .usage = usage_},
                                                     handle));
    images_.push_back(std::move(image));
    NERITIC_TRY(const VkSemaphore drawn,
                create_semaphore(fmt::format("window image {} drawn", images_.size() - 1)));
    drawn_.push_back(drawn);
  }
  return {};
}

Result<AcquireOutcome> Swapchain::acquire(bool may_wait) {
  NERITIC_CHECK(exists(), "acquire without a swapchain");
  const std::size_t next = (ready_at_ + 1) % ready_.size();
  const VkResult result =
      vkAcquireNextImageKHR(device_->handle(), swapchain_, may_wait ? kAcquireTimeoutNs : 0,
                            ready_[next], VK_NULL_HANDLE, &current_);
  switch (result) {
    case VK_SUCCESS:
    case VK_SUBOPTIMAL_KHR:  // still drawable; present says it again
      ready_at_ = next;
      return AcquireOutcome::kReady;
    case VK_ERROR_OUT_OF_DATE_KHR:
      return AcquireOutcome::kOutOfDate;
    case VK_TIMEOUT:
    case VK_NOT_READY:
      return AcquireOutcome::kNotYet;
    default:
      return gpu::vulkan_error(result, "vkAcquireNextImageKHR");
  }
}

Result<PresentOutcome> Swapchain::present() {
  VkPresentInfoKHR info{VK_STRUCTURE_TYPE_PRESENT_INFO_KHR};
  info.waitSemaphoreCount = 1;
  info.pWaitSemaphores = &drawn_[current_];
  info.swapchainCount = 1;
  info.pSwapchains = &swapchain_;
  info.pImageIndices = &current_;
  const VkResult result = vkQueuePresentKHR(device_->queue(), &info);
  switch (result) {
    case VK_SUCCESS:
      return PresentOutcome::kShown;
    case VK_SUBOPTIMAL_KHR:
    case VK_ERROR_OUT_OF_DATE_KHR:
      return PresentOutcome::kOutOfDate;
    default:
      return gpu::vulkan_error(result, "vkQueuePresentKHR");
  }
}

void Swapchain::destroy_images() {
  images_.clear();
  for (const VkSemaphore semaphore : drawn_)
    vkDestroySemaphore(device_->handle(), semaphore, nullptr);
  drawn_.clear();
}

Swapchain::Swapchain(Swapchain&& other) noexcept
    : device_(other.device_),
      surface_(std::exchange(other.surface_, VK_NULL_HANDLE)),
      format_(other.format_),
      swapchain_(std::exchange(other.swapchain_, VK_NULL_HANDLE)),
      extent_(other.extent_),
      usage_(other.usage_),
      images_(std::move(other.images_)),
      drawn_(std::exchange(other.drawn_, {})),
      ready_(std::exchange(other.ready_, {})),
      current_(other.current_),
      ready_at_(other.ready_at_) {}

Swapchain::~Swapchain() {
  if (surface_ == VK_NULL_HANDLE) return;
  device_->wait_idle();
  destroy_images();
  for (const VkSemaphore semaphore : ready_)
    vkDestroySemaphore(device_->handle(), semaphore, nullptr);
  if (swapchain_ != VK_NULL_HANDLE) vkDestroySwapchainKHR(device_->handle(), swapchain_, nullptr);
  vkDestroySurfaceKHR(device_->instance(), surface_, nullptr);
}

}  // namespace neritic::xr
