// Images and their views; see resources.hpp.
#include <algorithm>
#include <bit>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/resources.hpp"

namespace neritic::gpu {
namespace {

VkImageCreateInfo image_info(const ImageDesc& desc) {
  VkImageCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO};
  info.imageType = VK_IMAGE_TYPE_2D;
  info.format = desc.format;
  info.extent = {desc.width, desc.height, 1};
  info.mipLevels = desc.mips;
  info.arrayLayers = desc.layers;
  info.samples = VK_SAMPLE_COUNT_1_BIT;
  info.tiling = VK_IMAGE_TILING_OPTIMAL;
  info.usage = desc.usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  info.initialLayout = VK_IMAGE_LAYOUT_UNDEFINED;
  return info;
}

// Sizes come from files and flags, so what the device cannot do is an Error.
Status check_image(const Device& device, const ImageDesc& desc) {
  const VkPhysicalDeviceLimits& limits = device.limits();
  if (desc.width == 0 || desc.height == 0 || desc.layers == 0 || desc.mips == 0)
    return failure(ErrorCode::kUnsupported,
                   "image {}: {} x {}, {} layers, {} mips: each is at least 1", desc.name,
                   desc.width, desc.height, desc.layers, desc.mips);
  if (desc.width > limits.maxImageDimension2D || desc.height > limits.maxImageDimension2D ||
      desc.layers > limits.maxImageArrayLayers)
    return failure(
        ErrorCode::kUnsupported,
        "image {}: {} x {} with {} layers; this device takes up to {} texels and {} layers",
        desc.name, desc.width, desc.height, desc.layers, limits.maxImageDimension2D,
        limits.maxImageArrayLayers);
  VkImageFormatProperties properties{};
  const VkResult result =
      vkGetPhysicalDeviceImageFormatProperties(device.physical(), desc.format, VK_IMAGE_TYPE_2D,
                                               VK_IMAGE_TILING_OPTIMAL, desc.usage, 0, &properties);
  if (result != VK_SUCCESS)
    return vulkan_error(result, fmt::format("image {} of format {} and usage {:#x}", desc.name,
                                            static_cast<int>(desc.format), desc.usage));
  const auto full_chain =
      static_cast<std::uint32_t>(std::bit_width(std::max(desc.width, desc.height)));
  const std::uint32_t most_mips = std::min(properties.maxMipLevels, full_chain);
  if (desc.mips > most_mips)
    return failure(ErrorCode::kUnsupported, "image {}: {} mips, {} x {} takes up to {}", desc.name,
                   desc.mips, desc.width, desc.height, most_mips);
  return {};
}

ImageRange all_of(const ImageDesc& desc) {
  return {0, desc.mips, 0, desc.layers};
}

bool can_have_view(VkImageUsageFlags usage) {
  return (usage &
          (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
           VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT)) != 0;
}

Result<VkImageView> make_view(const Device& device, VkImage image, const ImageDesc& desc,
                              const ImageRange& range) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image;
  info.viewType =
      desc.array_view || desc.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  info.format = desc.format;
  info.subresourceRange = {
      is_depth_format(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT,
      range.mip, range.mips, range.layer, range.layers};
  VkImageView view = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateImageView (" + desc.name + ")",
                 vkCreateImageView(device.handle(), &info, nullptr, &view));
  device.name_object(VK_OBJECT_TYPE_IMAGE_VIEW, view, desc.name);
  return view;
}

}  // namespace

Result<Image> Image::create(const Device& device, const ImageDesc& desc) {
  NERITIC_TRY_STATUS(check_image(device, desc));
  const VkMemoryRequirements needs = image_requirements(device, desc);
  // lavapipe answers 0 for an image that is more than it can hold.
  if (needs.size == 0)
    return failure(ErrorCode::kOutOfMemory,
                   "image {}: {} x {} with {} layers is more than {} holds", desc.name, desc.width,
                   desc.height, desc.layers, device.info().name);
  auto allocation = device.allocator().allocate(needs, MemoryUse::kDevice, false);
  if (!allocation.ok())
    return Error{allocation.error().code, "image " + desc.name + ": " + allocation.error().message};
  NERITIC_TRY(Image image, create_at(device, desc, allocation->memory(), allocation->offset()));
  image.allocation_ = std::move(*allocation);
  return image;
}

Result<Image> Image::create_at(const Device& device, const ImageDesc& desc, VkDeviceMemory memory,
                               VkDeviceSize offset) {
  NERITIC_TRY_STATUS(check_image(device, desc));
  const VkImageCreateInfo info = image_info(desc);
  Image image;
  image.device_ = &device;
  image.desc_ = desc;
  NERITIC_TRY_VK("vkCreateImage (" + desc.name + ")",
                 vkCreateImage(device.handle(), &info, nullptr, &image.handle_));
  device.name_object(VK_OBJECT_TYPE_IMAGE, image.handle_, desc.name);
  NERITIC_TRY_VK("vkBindImageMemory (" + desc.name + ")",
                 vkBindImageMemory(device.handle(), image.handle_, memory, offset));
  if (can_have_view(desc.usage)) {
    NERITIC_TRY(image.view_, make_view(device, image.handle_, desc, all_of(desc)));
  }
  return image;
}

Result<Image> Image::borrow(const Device& device, const ImageDesc& desc, VkImage handle) {
  Image image;
  image.device_ = &device;
  image.desc_ = desc;
  image.borrowed_ = true;
  image.handle_ = handle;
  device.name_object(VK_OBJECT_TYPE_IMAGE, handle, desc.name);
  NERITIC_TRY(image.view_, make_view(device, handle, desc, all_of(desc)));
  return image;
}

Image::Image(Image&& other) noexcept {
  *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(view_, other.view_);
  std::swap(part_views_, other.part_views_);
  std::swap(desc_, other.desc_);
  std::swap(borrowed_, other.borrowed_);
  std::swap(allocation_, other.allocation_);
  return *this;
}

Image::~Image() {
  if (!device_) return;
  for (const PartView& part : part_views_)
    vkDestroyImageView(device_->handle(), part.view, nullptr);
  if (view_ != VK_NULL_HANDLE) vkDestroyImageView(device_->handle(), view_, nullptr);
  if (handle_ != VK_NULL_HANDLE && !borrowed_) vkDestroyImage(device_->handle(), handle_, nullptr);
}

Result<VkImageView> Image::view_of(const ImageRange& range) const {
  const ImageRange part = range.within(desc_.mips, desc_.layers);
  NERITIC_CHECK(
      all_of(desc_).contains(part) && part.mips > 0 && part.layers > 0 && view_ != VK_NULL_HANDLE,
      "{}: a view of mips {}+{}, layers {}+{}", desc_.name, part.mip, part.mips, part.layer,
      part.layers);
  if (part == all_of(desc_)) return view_;
  for (const PartView& known : part_views_)
    if (known.range == part) return known.view;
  NERITIC_TRY(const VkImageView view, make_view(*device_, handle_, desc_, part));
  part_views_.push_back({part, view});
  return view;
}

VkImageAspectFlags Image::aspect() const {
  switch (desc_.format) {
    case VK_FORMAT_D16_UNORM_S8_UINT:
    case VK_FORMAT_D24_UNORM_S8_UINT:
    case VK_FORMAT_D32_SFLOAT_S8_UINT:
      return VK_IMAGE_ASPECT_DEPTH_BIT | VK_IMAGE_ASPECT_STENCIL_BIT;
    default:
      return is_depth_format(desc_.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT;
  }
}

VkMemoryRequirements image_requirements(const Device& device, const ImageDesc& desc) {
  const VkImageCreateInfo info = image_info(desc);
  VkDeviceImageMemoryRequirements query{VK_STRUCTURE_TYPE_DEVICE_IMAGE_MEMORY_REQUIREMENTS};
  query.pCreateInfo = &info;
  VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceImageMemoryRequirements(device.handle(), &query, &needs);
  return needs.memoryRequirements;
}

}  // namespace neritic::gpu
