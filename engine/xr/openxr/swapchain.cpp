#include "engine/xr/openxr/swapchain.hpp"

#include <algorithm>

namespace neritic::xr::openxr {
namespace {

constexpr int kWaits = 1000;

// 8 bits of linear light show bands in dark water, so that they come last.
constexpr VkFormat kColors[] = {
    VK_FORMAT_R8G8B8A8_SRGB,       VK_FORMAT_B8G8R8A8_SRGB,
    VK_FORMAT_R16G16B16A16_SFLOAT, VK_FORMAT_A2B10G10R10_UNORM_PACK32,
    VK_FORMAT_R8G8B8A8_UNORM,      VK_FORMAT_B8G8R8A8_UNORM,
};

struct FormatName {
  VkFormat format;
  const char* name;
};
// The formats that a runtime may offer for colour or depth, each with its name without the prefix.
#define NERITIC_FORMAT(name) \
  { VK_FORMAT_##name, #name }
constexpr FormatName kNames[] = {
    NERITIC_FORMAT(R4G4B4A4_UNORM_PACK16),
    NERITIC_FORMAT(B4G4R4A4_UNORM_PACK16),
    NERITIC_FORMAT(R5G6B5_UNORM_PACK16),
    NERITIC_FORMAT(B5G6R5_UNORM_PACK16),
    NERITIC_FORMAT(R5G5B5A1_UNORM_PACK16),
    NERITIC_FORMAT(B5G5R5A1_UNORM_PACK16),
    NERITIC_FORMAT(A1R5G5B5_UNORM_PACK16),
    NERITIC_FORMAT(R8_UNORM),
    NERITIC_FORMAT(R8G8_UNORM),
    NERITIC_FORMAT(R8G8B8_UNORM),
    NERITIC_FORMAT(R8G8B8_SRGB),
    NERITIC_FORMAT(B8G8R8_UNORM),
    NERITIC_FORMAT(B8G8R8_SRGB),
    NERITIC_FORMAT(R8G8B8A8_UNORM),
    NERITIC_FORMAT(R8G8B8A8_SNORM),
    NERITIC_FORMAT(R8G8B8A8_UINT),
    NERITIC_FORMAT(R8G8B8A8_SRGB),
    NERITIC_FORMAT(B8G8R8A8_UNORM),
    NERITIC_FORMAT(B8G8R8A8_SRGB),
    NERITIC_FORMAT(A8B8G8R8_UNORM_PACK32),
    NERITIC_FORMAT(A8B8G8R8_SRGB_PACK32),
    NERITIC_FORMAT(A2R10G10B10_UNORM_PACK32),
    NERITIC_FORMAT(A2B10G10R10_UNORM_PACK32),
    NERITIC_FORMAT(R16_SFLOAT),
    NERITIC_FORMAT(R16G16_SFLOAT),
    NERITIC_FORMAT(R16G16B16_UNORM),
    NERITIC_FORMAT(R16G16B16_SFLOAT),
    NERITIC_FORMAT(R16G16B16A16_UNORM),
    NERITIC_FORMAT(R16G16B16A16_SNORM),
    NERITIC_FORMAT(R16G16B16A16_SFLOAT),
    NERITIC_FORMAT(R32_SFLOAT),
    NERITIC_FORMAT(R32G32_SFLOAT),
    NERITIC_FORMAT(R32G32B32_SFLOAT),
    NERITIC_FORMAT(R32G32B32A32_SFLOAT),
    NERITIC_FORMAT(B10G11R11_UFLOAT_PACK32),
    NERITIC_FORMAT(E5B9G9R9_UFLOAT_PACK32),
    NERITIC_FORMAT(D16_UNORM),
    NERITIC_FORMAT(X8_D24_UNORM_PACK32),
    NERITIC_FORMAT(D32_SFLOAT),
    NERITIC_FORMAT(S8_UINT),
    NERITIC_FORMAT(D16_UNORM_S8_UINT),
    NERITIC_FORMAT(D24_UNORM_S8_UINT),
    NERITIC_FORMAT(D32_SFLOAT_S8_UINT),
};
#undef NERITIC_FORMAT

// By its number where it is none of those.
std::string name_of_format(VkFormat format) {
  const auto found = std::ranges::find(kNames, format, &FormatName::format);
  return found != std::end(kNames) ? std::string(found->name)
                                   : fmt::format("VkFormat {}", static_cast<int>(format));
}

std::string names_of_formats(std::span<const VkFormat> formats) {
  std::string names;
  for (const VkFormat format : formats)
    names += (names.empty() ? "" : ", ") + name_of_format(format);
  return names.empty() ? "(none)" : names;
}

VkImageUsageFlags vulkan_usage(XrSwapchainUsageFlags usage) {
  VkImageUsageFlags out = 0;
  if (usage & XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT) out |= VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT;
  if (usage & XR_SWAPCHAIN_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT)
    out |= VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT;
  if (usage & XR_SWAPCHAIN_USAGE_TRANSFER_DST_BIT) out |= VK_IMAGE_USAGE_TRANSFER_DST_BIT;
  if (usage & XR_SWAPCHAIN_USAGE_SAMPLED_BIT) out |= VK_IMAGE_USAGE_SAMPLED_BIT;
  return out;
}

}  // namespace

Result<std::unique_ptr<Swapchain>> Swapchain::create(Runtime& runtime, XrSession session,
                                                     gpu::Device& device,
                                                     const SwapchainDesc& desc) {
  std::unique_ptr<Swapchain> chain(new Swapchain(runtime, desc));
  XrSwapchainCreateInfo info{XR_TYPE_SWAPCHAIN_CREATE_INFO};
  info.usageFlags = desc.usage;
  info.format = desc.format;
  info.sampleCount = info.faceCount = info.mipCount = 1;
  info.width = desc.width;
  info.height = desc.height;
  info.arraySize = desc.layers;
  NERITIC_TRY_STATUS(runtime.check(runtime.xr().CreateSwapchain(session, &info, &chain->handle_),
                                   "xrCreateSwapchain"));
  std::vector<XrSwapchainImageVulkan2KHR> images;
  const XrResult result = enumerate(
      images, {XR_TYPE_SWAPCHAIN_IMAGE_VULKAN2_KHR}, [&](auto capacity, auto count, auto items) {
        return runtime.xr().EnumerateSwapchainImages(
            chain->handle_, capacity, count, reinterpret_cast<XrSwapchainImageBaseHeader*>(items));
      });
  NERITIC_TRY_STATUS(runtime.check(result, "xrEnumerateSwapchainImages"));
  for (const XrSwapchainImageVulkan2KHR& image : images) {
    // One name for all: the frame graph's plan is the same whichever image it draws to.
    NERITIC_TRY(gpu::Image borrowed, gpu::Image::borrow(device,
                                                        {.name = desc.name,
                                                         .format = desc.format,
                                                         .width = desc.width,
                                                         .height = desc.height,
                                                         .layers = desc.layers,
                                                         .usage = vulkan_usage(desc.usage),
                                                         .array_view = true},
                                                        image.image));
    chain->images_.push_back(std::move(borrowed));
  }
  return chain;
}

Swapchain::~Swapchain() {
  images_.clear();
  if (handle_ != XR_NULL_HANDLE) (void)runtime_.xr().DestroySwapchain(handle_);
}

Result<const gpu::Image*> Swapchain::acquire() {
  if (acquired_) return &images_[current_];
  XrSwapchainImageAcquireInfo acquire{XR_TYPE_SWAPCHAIN_IMAGE_ACQUIRE_INFO};
  if (!waits_)
    NERITIC_TRY_STATUS(
        runtime_.check(runtime_.xr().AcquireSwapchainImage(handle_, &acquire, &current_),
                       "xrAcquireSwapchainImage"));
  waits_ = true;
  if (current_ >= images_.size())
    return failure(ErrorCode::kDeviceLost, "{}: xrAcquireSwapchainImage gave image {} of {}",
                   runtime_.info().runtime, current_, images_.size());
  XrSwapchainImageWaitInfo wait{XR_TYPE_SWAPCHAIN_IMAGE_WAIT_INFO};
  wait.timeout = XR_INFINITE_DURATION;
  // A runtime may give up sooner than it was told.
  XrResult waited = XR_TIMEOUT_EXPIRED;
  for (int attempt = 0; attempt < kWaits && waited == XR_TIMEOUT_EXPIRED; ++attempt)
    waited = runtime_.xr().WaitSwapchainImage(handle_, &wait);
  if (waited == XR_TIMEOUT_EXPIRED) waited = XR_ERROR_RUNTIME_FAILURE;
  NERITIC_TRY_STATUS(runtime_.check(waited, "xrWaitSwapchainImage"));
  waits_ = false;
  acquired_ = true;
  return &images_[current_];
}

Status Swapchain::release() {
  if (!acquired_) return {};
  XrSwapchainImageReleaseInfo info{XR_TYPE_SWAPCHAIN_IMAGE_RELEASE_INFO};
  NERITIC_TRY_STATUS(runtime_.check(runtime_.xr().ReleaseSwapchainImage(handle_, &info),
                                    "xrReleaseSwapchainImage"));
  acquired_ = false;
  return {};
}

XrSwapchainSubImage Swapchain::sub_image(std::uint32_t layer) const {
  return {
      handle_,
      {{0, 0}, {static_cast<std::int32_t>(desc_.width), static_cast<std::int32_t>(desc_.height)}},
      layer};
}

Result<std::vector<VkFormat>> swapchain_formats(Runtime& runtime, XrSession session) {
  std::vector<std::int64_t> numbers;
  const XrResult result =
      enumerate(numbers, std::int64_t{0}, [&](auto capacity, auto count, auto items) {
        return runtime.xr().EnumerateSwapchainFormats(session, capacity, count, items);
      });
  NERITIC_TRY_STATUS(runtime.check(result, "xrEnumerateSwapchainFormats"));
  std::vector<VkFormat> formats;
  for (const std::int64_t number : numbers) formats.push_back(static_cast<VkFormat>(number));
  return formats;
}

Result<VkFormat> choose_color(std::span<const VkFormat> offered) {
  for (const VkFormat format : kColors)
    if (std::find(offered.begin(), offered.end(), format) != offered.end()) return format;
  return failure(ErrorCode::kUnsupported,
                 "the OpenXR runtime takes pictures of the Vulkan formats {} only; accepted: {}",
                 names_of_formats(offered), names_of_formats(kColors));
}

VkFormat choose_depth(std::span<const VkFormat> offered) {
  return std::find(offered.begin(), offered.end(), VK_FORMAT_D32_SFLOAT) != offered.end()
             ? VK_FORMAT_D32_SFLOAT
             : VK_FORMAT_UNDEFINED;
}

}  // namespace neritic::xr::openxr
