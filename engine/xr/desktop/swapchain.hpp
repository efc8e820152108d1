// The images of a window's surface, in turn: acquire one, draw, present it. Vertical sync (FIFO).
// A changed window size is an outcome, not an error: call recreate() then. Rendering thread.
#pragma once

#include <volk.h>

#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/resources.hpp"

namespace neritic::xr {

enum class AcquireOutcome {
  kReady,
  kOutOfDate,  // the surface changed: recreate and try again
  kNotYet,     // no image came free in time (a compositor that holds them): skip the frame
};
enum class PresentOutcome {
  kShown,
  kOutOfDate,  // shown or not, the surface changed: recreate before the next frame
};

class Swapchain {
 public:
  // Takes the surface over. kUnsupported where the device cannot present to it.
  static Result<Swapchain> create(gpu::Device& device, VkSurfaceKHR surface,
                                  std::uint32_t frames_in_flight);
  Swapchain(Swapchain&& other) noexcept;
  Swapchain& operator=(Swapchain&&) = delete;
  ~Swapchain();

  // Makes the images anew at the surface's size (wanted: where the surface leaves it to us). False:
  // the surface has no size now (minimised). Waits for the GPU: sizes change seldom.
  Result<bool> recreate(std::uint32_t wanted_width, std::uint32_t wanted_height);
  // may_wait: up to half a second for an image; else kNotYet at once.
  Result<AcquireOutcome> acquire(bool may_wait = true);
  Result<PresentOutcome> present();

  // These belong to the acquired image.
  const gpu::Image& image() const { return images_[current_]; }
  VkSemaphore image_ready() const { return ready_[ready_at_]; }
  VkSemaphore drawn() const { return drawn_[current_]; }
  bool exists() const { return swapchain_ != VK_NULL_HANDLE; }
  VkFormat format() const { return format_.format; }
  std::uint32_t width() const { return extent_.width; }
  std::uint32_t height() const { return extent_.height; }

 private:
  Swapchain(gpu::Device& device, VkSurfaceKHR surface) : device_(&device), surface_(surface) {}
  Status choose_format();
  Status create_images();
  Result<VkSemaphore> create_semaphore(const std::string& name) const;
  void destroy_images();

  gpu::Device* device_;
  VkSurfaceKHR surface_ = VK_NULL_HANDLE;
  VkSurfaceFormatKHR format_{};
  VkSwapchainKHR swapchain_ = VK_NULL_HANDLE;
  VkExtent2D extent_{};
  VkImageUsageFlags usage_ = 0;
  std::vector<gpu::Image> images_;
  // drawn: one an image, since presentation holds it until the image comes back. ready: one more
  // than frames in flight, so that the frame that last waited for it is done when it is used again.
  std::vector<VkSemaphore> drawn_, ready_;
  std::uint32_t current_ = 0;
  std::size_t ready_at_ = 0;
};

}  // namespace neritic::xr
