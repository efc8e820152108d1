// Buffers and samplers; see resources.hpp. Images are in images.cpp.
#include "engine/gpu/resources.hpp"

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
  auto allocation = device.allocator().allocate(needs, desc.memory, true);
  if (!allocation.ok())
    return Error{allocation.error().code,
                 "buffer " + desc.name + ": " + allocation.error().message};
  NERITIC_TRY(Buffer buffer, create_at(device, desc, allocation->memory(), allocation->offset()));
  buffer.allocation_ = std::move(*allocation);
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
