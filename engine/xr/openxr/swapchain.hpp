// Inside engine/xr/openxr only: images of the runtime, in turn. acquire waits until the runtime no
// longer reads one; release hands it back, after the work that writes it was submitted. An image
// that no submission wrote stays acquired. Rendering thread.
#pragma once

#include <memory>
#include <span>

#include "engine/gpu/resources.hpp"
#include "engine/xr/openxr/runtime.hpp"

namespace neritic::xr::openxr {

struct SwapchainDesc {
  std::string name;
  VkFormat format = VK_FORMAT_UNDEFINED;
  XrSwapchainUsageFlags usage = 0;
  std::uint32_t width = 1, height = 1, layers = 1;
};

class Swapchain {
 public:
  // runtime and device must outlive it, and the session too.
  static Result<std::unique_ptr<Swapchain>> create(Runtime& runtime, XrSession session,
                                                   gpu::Device& device, const SwapchainDesc& desc);
  // The GPU must be done with its images.
  ~Swapchain();
  Swapchain(const Swapchain&) = delete;
  Swapchain& operator=(const Swapchain&) = delete;

  Result<const gpu::Image*> acquire();
  bool acquired() const { return acquired_; }
  Status release();
  const SwapchainDesc& desc() const { return desc_; }
  // All of one array layer, as a composition layer names it.
  XrSwapchainSubImage sub_image(std::uint32_t layer) const;

 private:
  Swapchain(Runtime& runtime, const SwapchainDesc& desc) : runtime_(runtime), desc_(desc) {}
  Runtime& runtime_;
  SwapchainDesc desc_;
  XrSwapchain handle_ = XR_NULL_HANDLE;
  std::vector<gpu::Image> images_;
  std::uint32_t current_ = 0;
  bool acquired_ = false;
  bool waits_ = false;  // acquired, but the runtime may still read it
};

// The formats that the runtime offers, best first as it says.
Result<std::vector<VkFormat>> swapchain_formats(Runtime& runtime, XrSession session);
// The best for pictures that this program can draw to; the runtime reads sRGB formats as encoded
// and all others as linear light. kUnsupported names what was offered and what is accepted.
Result<VkFormat> choose_color(std::span<const VkFormat> offered);
// D32_SFLOAT, or UNDEFINED: no depth goes to the runtime.
VkFormat choose_depth(std::span<const VkFormat> offered);

}  // namespace neritic::xr::openxr
