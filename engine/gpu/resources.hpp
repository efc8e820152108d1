// Buffers, images and samplers: move-only owners, all named. The Device must outlive them.
// Destruction is immediate: the caller knows that the GPU is done (Frames::retire defers it).
#pragma once

#include <volk.h>

#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/image_range.hpp"
#include "engine/gpu/memory.hpp"

namespace neritic::gpu {

class Device;

struct BufferDesc {
  std::string name;
  VkDeviceSize size = 0;  // bytes; 0 becomes 16 so that an empty scene still has something to bind
  VkBufferUsageFlags usage = 0;  // with STORAGE_TEXEL_BUFFER it has a view of 32-bit integers too
  MemoryUse memory = MemoryUse::kDevice;
};

class Buffer {
 public:
  static Result<Buffer> create(const Device& device, const BufferDesc& desc);
  // In memory that someone else owns (aliased transient memory): device memory at an offset.
  static Result<Buffer> create_at(const Device& device, const BufferDesc& desc,
                                  VkDeviceMemory memory, VkDeviceSize offset);
  Buffer() = default;
  Buffer(Buffer&& other) noexcept;
  Buffer& operator=(Buffer&& other) noexcept;
  ~Buffer();

  VkBuffer handle() const { return handle_; }
  VkBufferView texels() const { return texels_; }  // R32_UINT, all of it; null without the usage
  VkDeviceSize size() const { return size_; }
  VkBufferUsageFlags usage() const { return usage_; }
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }
  // Host-visible memory as elements; empty for MemoryUse::kDevice.
  template <class T>
  std::span<T> mapped() const {
    auto* p = allocation_.mapped();
    return p ? std::span<T>(reinterpret_cast<T*>(p), size_ / sizeof(T)) : std::span<T>();
  }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkBuffer handle_ = VK_NULL_HANDLE;
  VkBufferView texels_ = VK_NULL_HANDLE;
  VkDeviceSize size_ = 0;
  VkBufferUsageFlags usage_ = 0;
  Allocation allocation_;
};

struct ImageDesc {
  std::string name;
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 1, height = 1;
  std::uint32_t layers = 1, mips = 1;
  VkImageUsageFlags usage = 0;
  bool array_view = false;  // the view is 2D_ARRAY (frame graph images always are), else 2D
};

class Image {
 public:
  static Result<Image> create(const Device& device, const ImageDesc& desc);
  static Result<Image> create_at(const Device& device, const ImageDesc& desc, VkDeviceMemory memory,
                                 VkDeviceSize offset);
  // Somebody else's image (a swapchain's), with a view of our own: only the view dies with this.
  static Result<Image> borrow(const Device& device, const ImageDesc& desc, VkImage image);
  Image() = default;
  Image(Image&& other) noexcept;
  Image& operator=(Image&& other) noexcept;
  ~Image();

  VkImage handle() const { return handle_; }
  VkImageView view() const { return view_; }  // all mips and layers
  // A view of some mips and layers, of the same type as view(). Made at the first call, then kept
  // as long as the image. The image's usage must allow views. Rendering thread only.
  Result<VkImageView> view_of(const ImageRange& range) const;
  const ImageDesc& desc() const { return desc_; }
  VkImageAspectFlags aspect() const;
  explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

 private:
  struct PartView {
    ImageRange range;
    VkImageView view;
  };
  const Device* device_ = nullptr;
  VkImage handle_ = VK_NULL_HANDLE;
  VkImageView view_ = VK_NULL_HANDLE;
  mutable std::vector<PartView> part_views_;  // a cache: what view_of gave
  ImageDesc desc_;
  bool borrowed_ = false;
  Allocation allocation_;
};

// Memory that vkCreateImage / vkCreateBuffer would need; creates nothing (to plan aliased memory).
VkMemoryRequirements image_requirements(const Device& device, const ImageDesc& desc);
VkMemoryRequirements buffer_requirements(const Device& device, const BufferDesc& desc);

// Bytes of one texel; CHECKs on formats the engine does not use.
std::uint32_t texel_bytes(VkFormat format);
bool is_depth_format(VkFormat format);

struct SamplerDesc {
  std::string name;
  VkFilter mag = VK_FILTER_LINEAR, min = VK_FILTER_LINEAR;
  VkSamplerMipmapMode mip = VK_SAMPLER_MIPMAP_MODE_LINEAR;
  VkSamplerAddressMode u = VK_SAMPLER_ADDRESS_MODE_REPEAT, v = VK_SAMPLER_ADDRESS_MODE_REPEAT;
  bool mipmapped = true;
};

class Sampler {
 public:
  static Result<Sampler> create(const Device& device, const SamplerDesc& desc);
  Sampler() = default;
  Sampler(Sampler&& other) noexcept;
  Sampler& operator=(Sampler&& other) noexcept;
  ~Sampler();
  VkSampler handle() const { return handle_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkSampler handle_ = VK_NULL_HANDLE;
};

}  // namespace neritic::gpu
