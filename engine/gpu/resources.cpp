#include "engine/gpu/resources.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"

namespace neritic::gpu {
namespace {

constexpr VkDeviceSize kSmallestBuffer = 16;  // bytes: an empty buffer can still be bound

VkBufferCreateInfo buffer_info(const BufferDesc& desc) {
  VkBufferCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO};
  info.size = desc.size == 0 ? kSmallestBuffer : desc.size;
  info.usage = desc.usage;
  info.sharingMode = VK_SHARING_MODE_EXCLUSIVE;
  return info;
}

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

bool can_have_view(VkImageUsageFlags usage) {
  return (usage &
          (VK_IMAGE_USAGE_SAMPLED_BIT | VK_IMAGE_USAGE_STORAGE_BIT |
           VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT |
           VK_IMAGE_USAGE_INPUT_ATTACHMENT_BIT)) != 0;
}

Result<VkImageView> make_view(const Device& device, VkImage image, const ImageDesc& desc) {
  VkImageViewCreateInfo info{VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO};
  info.image = image;
  info.viewType =
      desc.array_view || desc.layers > 1 ? VK_IMAGE_VIEW_TYPE_2D_ARRAY : VK_IMAGE_VIEW_TYPE_2D;
  info.format = desc.format;
  info.subresourceRange = {
      is_depth_format(desc.format) ? VK_IMAGE_ASPECT_DEPTH_BIT : VK_IMAGE_ASPECT_COLOR_BIT, 0,
      desc.mips, 0, desc.layers};
  VkImageView view = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateImageView (" + desc.name + ")",
                 vkCreateImageView(device.handle(), &info, nullptr, &view));
  device.name_object(VK_OBJECT_TYPE_IMAGE_VIEW, view, desc.name);
  return view;
}

Result<VkBufferView> make_texel_view(const Device& device, const Buffer& buffer,
                                     const BufferDesc& desc) {
  VkBufferViewCreateInfo info{VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO};
  info.buffer = buffer.handle();
  info.format = VK_FORMAT_R32_UINT;
  info.range = VK_WHOLE_SIZE;
  VkBufferView view = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateBufferView (" + desc.name + ")",
                 vkCreateBufferView(device.handle(), &info, nullptr, &view));
  device.name_object(VK_OBJECT_TYPE_BUFFER_VIEW, view, desc.name);
  return view;
}

Result<Allocation> memory_for(const Device& device, const std::string& name,
                              const VkMemoryRequirements& needs, MemoryUse use, bool linear) {
  auto allocation = device.allocator().allocate(needs, use, linear);
  if (!allocation.ok())
    return Error{allocation.error().code, name + ": " + allocation.error().message};
  return allocation;
}

}  // namespace

// --- Buffer -----------------------------------------------------------------------------------

Result<Buffer> Buffer::create(const Device& device, const BufferDesc& desc) {
  if (desc.size > device.max_buffer_bytes())
    return failure(ErrorCode::kOutOfMemory, "buffer {}: {} bytes, this device takes up to {}",
                   desc.name, desc.size, device.max_buffer_bytes());
  const VkDeviceSize texels = desc.size / sizeof(std::uint32_t);
  const std::uint32_t most_texels = device.limits().maxTexelBufferElements;
  if ((desc.usage & VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT) != 0 && texels > most_texels)
    return failure(ErrorCode::kUnsupported, "buffer {}: {} texels, this device takes up to {}",
                   desc.name, texels, most_texels);
  const VkMemoryRequirements needs = buffer_requirements(device, desc);
  NERITIC_TRY(Allocation allocation,
              memory_for(device, "buffer " + desc.name, needs, desc.memory, true));
  NERITIC_TRY(Buffer buffer, create_at(device, desc, allocation.memory(), allocation.offset()));
  buffer.allocation_ = std::move(allocation);
  return buffer;
}

Result<Buffer> Buffer::create_at(const Device& device, const BufferDesc& desc,
                                 VkDeviceMemory memory, VkDeviceSize offset) {
  const VkBufferCreateInfo info = buffer_info(desc);
  Buffer buffer;
  buffer.device_ = device.handle();
  buffer.size_ = info.size;
  buffer.usage_ = info.usage;
  NERITIC_TRY_VK("vkCreateBuffer (" + desc.name + ")",
                 vkCreateBuffer(device.handle(), &info, nullptr, &buffer.handle_));
  device.name_object(VK_OBJECT_TYPE_BUFFER, buffer.handle_, desc.name);
  NERITIC_TRY_VK("vkBindBufferMemory (" + desc.name + ")",
                 vkBindBufferMemory(device.handle(), buffer.handle_, memory, offset));
  if (desc.usage & VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT) {
    NERITIC_TRY(buffer.texels_, make_texel_view(device, buffer, desc));
  }
  return buffer;
}

Buffer::Buffer(Buffer&& other) noexcept {
  *this = std::move(other);
}

Buffer& Buffer::operator=(Buffer&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(texels_, other.texels_);
  std::swap(size_, other.size_);
  std::swap(usage_, other.usage_);
  std::swap(allocation_, other.allocation_);
  return *this;
}

Buffer::~Buffer() {
  if (texels_ != VK_NULL_HANDLE) vkDestroyBufferView(device_, texels_, nullptr);
  if (handle_ != VK_NULL_HANDLE) vkDestroyBuffer(device_, handle_, nullptr);
}

VkMemoryRequirements buffer_requirements(const Device& device, const BufferDesc& desc) {
  const VkBufferCreateInfo info = buffer_info(desc);
  VkDeviceBufferMemoryRequirements query{VK_STRUCTURE_TYPE_DEVICE_BUFFER_MEMORY_REQUIREMENTS};
  query.pCreateInfo = &info;
  VkMemoryRequirements2 needs{VK_STRUCTURE_TYPE_MEMORY_REQUIREMENTS_2};
  vkGetDeviceBufferMemoryRequirements(device.handle(), &query, &needs);
  return needs.memoryRequirements;
}

// --- Image ------------------------------------------------------------------------------------

Result<Image> Image::create(const Device& device, const ImageDesc& desc) {
  NERITIC_TRY_STATUS(check_image(device, desc));
  const VkMemoryRequirements needs = image_requirements(device, desc);
  // lavapipe answers 0 for an image that is more than it can hold.
  if (needs.size == 0)
    return failure(ErrorCode::kOutOfMemory,
                   "image {}: {} x {} with {} layers is more than {} holds", desc.name, desc.width,
                   desc.height, desc.layers, device.info().name);
  NERITIC_TRY(Allocation allocation,
              memory_for(device, "image " + desc.name, needs, MemoryUse::kDevice, false));
  NERITIC_TRY(Image image, create_at(device, desc, allocation.memory(), allocation.offset()));
  image.allocation_ = std::move(allocation);
  return image;
}

Result<Image> Image::create_at(const Device& device, const ImageDesc& desc, VkDeviceMemory memory,
                               VkDeviceSize offset) {
  NERITIC_TRY_STATUS(check_image(device, desc));
  const VkImageCreateInfo info = image_info(desc);
  Image image;
  image.device_ = device.handle();
  image.desc_ = desc;
  NERITIC_TRY_VK("vkCreateImage (" + desc.name + ")",
                 vkCreateImage(device.handle(), &info, nullptr, &image.handle_));
  device.name_object(VK_OBJECT_TYPE_IMAGE, image.handle_, desc.name);
  NERITIC_TRY_VK("vkBindImageMemory (" + desc.name + ")",
                 vkBindImageMemory(device.handle(), image.handle_, memory, offset));
  if (can_have_view(desc.usage)) {
    NERITIC_TRY(image.view_, make_view(device, image.handle_, desc));
  }
  return image;
}

Result<Image> Image::borrow(const Device& device, const ImageDesc& desc, VkImage handle) {
  Image image;
  image.device_ = device.handle();
  image.desc_ = desc;
  image.borrowed_ = true;
  image.handle_ = handle;
  device.name_object(VK_OBJECT_TYPE_IMAGE, handle, desc.name);
  NERITIC_TRY(image.view_, make_view(device, handle, desc));
  return image;
}

Image::Image(Image&& other) noexcept {
  *this = std::move(other);
}

Image& Image::operator=(Image&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(view_, other.view_);
  std::swap(desc_, other.desc_);
  std::swap(borrowed_, other.borrowed_);
  std::swap(allocation_, other.allocation_);
  return *this;
}

Image::~Image() {
  if (view_ != VK_NULL_HANDLE) vkDestroyImageView(device_, view_, nullptr);
  if (handle_ != VK_NULL_HANDLE && !borrowed_) vkDestroyImage(device_, handle_, nullptr);
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

// --- Sampler ----------------------------------------------------------------------------------

Result<Sampler> Sampler::create(const Device& device, const SamplerDesc& desc) {
  VkSamplerCreateInfo info{VK_STRUCTURE_TYPE_SAMPLER_CREATE_INFO};
  info.magFilter = desc.mag;
  info.minFilter = desc.min;
  // Without mips the level of detail must still tell magnified from minified, since each has its
  // filter: up to a quarter, which rounds to the first mip (Vulkan specification,
  // VkSamplerCreateInfo, on OpenGL's filters without mips).
  info.mipmapMode = desc.mipmapped ? desc.mip : VK_SAMPLER_MIPMAP_MODE_NEAREST;
  info.addressModeU = desc.u;
  info.addressModeV = desc.v;
  info.addressModeW = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE;
  info.maxLod = desc.mipmapped ? VK_LOD_CLAMP_NONE : 0.25f;
  Sampler sampler;
  sampler.device_ = device.handle();
  NERITIC_TRY_VK("vkCreateSampler (" + desc.name + ")",
                 vkCreateSampler(device.handle(), &info, nullptr, &sampler.handle_));
  device.name_object(VK_OBJECT_TYPE_SAMPLER, sampler.handle_, desc.name);
  return sampler;
}

Sampler::Sampler(Sampler&& other) noexcept {
  *this = std::move(other);
}

Sampler& Sampler::operator=(Sampler&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  return *this;
}

Sampler::~Sampler() {
  if (handle_ != VK_NULL_HANDLE) vkDestroySampler(device_, handle_, nullptr);
}

}  // namespace neritic::gpu
