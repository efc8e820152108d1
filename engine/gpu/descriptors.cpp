// Set layouts, persistent descriptor sets, and writing them. Rendering thread.
#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/pipeline.hpp"

namespace neritic::gpu {
namespace {

// One pool: sets and descriptors of each type. A set that needs more than a fresh pool holds is
// refused with kOutOfMemory.
constexpr std::uint32_t kSetsPerPool = 256;
constexpr std::array kPoolSizes{
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_BUFFER, 8 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER, 4 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER, 8 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE, 8 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_IMAGE, 4 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER, 3 * kSetsPerPool},
    VkDescriptorPoolSize{VK_DESCRIPTOR_TYPE_SAMPLER, 2 * kSetsPerPool},
};

enum class Kind { kBuffer, kTexels, kImage };

Kind kind_of(VkDescriptorType type) {
  if (type == VK_DESCRIPTOR_TYPE_STORAGE_BUFFER || type == VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER)
    return Kind::kBuffer;
  return type == VK_DESCRIPTOR_TYPE_STORAGE_TEXEL_BUFFER ? Kind::kTexels : Kind::kImage;
}

Kind kind_of(const BoundResource& resource) {
  if (resource.buffer.buffer != VK_NULL_HANDLE) return Kind::kBuffer;
  return resource.texels != VK_NULL_HANDLE ? Kind::kTexels : Kind::kImage;
}

Result<VkDescriptorPool> make_pool(const Device& device, const std::string& name) {
  VkDescriptorPoolCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_POOL_CREATE_INFO};
  info.maxSets = kSetsPerPool;
  info.poolSizeCount = kPoolSizes.size();
  info.pPoolSizes = kPoolSizes.data();
  VkDescriptorPool pool = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateDescriptorPool (" + name + ")",
                 vkCreateDescriptorPool(device.handle(), &info, nullptr, &pool));
  device.name_object(VK_OBJECT_TYPE_DESCRIPTOR_POOL, pool, name);
  return pool;
}

}  // namespace

Result<SetLayout> SetLayout::create(const Device& device, const std::string& name,
                                    std::span<const BindingDesc> bindings,
                                    VkShaderStageFlags stages) {
  std::vector<VkDescriptorSetLayoutBinding> rows;
  for (const BindingDesc& binding : bindings)
    rows.push_back({binding.binding, binding.type, binding.count, stages, nullptr});
  VkDescriptorSetLayoutCreateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_LAYOUT_CREATE_INFO};
  info.bindingCount = static_cast<std::uint32_t>(rows.size());
  info.pBindings = rows.data();
  SetLayout layout;
  layout.device_ = device.handle();
  layout.bindings_.assign(bindings.begin(), bindings.end());
  layout.stages_ = stages;
  NERITIC_TRY_VK("vkCreateDescriptorSetLayout (" + name + ")",
                 vkCreateDescriptorSetLayout(device.handle(), &info, nullptr, &layout.handle_));
  device.name_object(VK_OBJECT_TYPE_DESCRIPTOR_SET_LAYOUT, layout.handle_, name);
  return layout;
}

SetLayout::SetLayout(SetLayout&& other) noexcept {
  *this = std::move(other);
}

SetLayout& SetLayout::operator=(SetLayout&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(handle_, other.handle_);
  std::swap(bindings_, other.bindings_);
  std::swap(stages_, other.stages_);
  return *this;
}

SetLayout::~SetLayout() {
  if (handle_ != VK_NULL_HANDLE) vkDestroyDescriptorSetLayout(device_, handle_, nullptr);
}

// --- DescriptorArena --------------------------------------------------------------------------

DescriptorArena::DescriptorArena(const Device& device, std::string name)
    : device_(&device), name_(std::move(name)) {}

DescriptorArena::DescriptorArena(DescriptorArena&& other) noexcept {
  *this = std::move(other);
}

DescriptorArena& DescriptorArena::operator=(DescriptorArena&& other) noexcept {
  std::swap(device_, other.device_);
  std::swap(name_, other.name_);
  std::swap(pools_, other.pools_);
  std::swap(current_, other.current_);
  return *this;
}

DescriptorArena::~DescriptorArena() {
  for (const VkDescriptorPool pool : pools_)
    vkDestroyDescriptorPool(device_->handle(), pool, nullptr);
}

Result<VkDescriptorSet> DescriptorArena::allocate(VkDescriptorSetLayout layout,
                                                  const std::string& name) {
  VkDescriptorSetAllocateInfo info{VK_STRUCTURE_TYPE_DESCRIPTOR_SET_ALLOCATE_INFO};
  info.descriptorSetCount = 1;
  info.pSetLayouts = &layout;
  while (true) {
    const bool fresh = current_ == pools_.size();
    if (fresh) {
      NERITIC_TRY(const VkDescriptorPool pool,
                  make_pool(*device_, fmt::format("{}, descriptors {}", name_, current_)));
      pools_.push_back(pool);
    }
    // Drivers may hand out more sets than the pool was made for, or fail; ours to count is neither.
    info.descriptorPool = pools_[current_];
    VkDescriptorSet set = VK_NULL_HANDLE;
    const VkResult result = vkAllocateDescriptorSets(device_->handle(), &info, &set);
    if (result == VK_SUCCESS) {
      device_->name_object(VK_OBJECT_TYPE_DESCRIPTOR_SET, set, name);
      return set;
    }
    const bool full = result == VK_ERROR_OUT_OF_POOL_MEMORY || result == VK_ERROR_FRAGMENTED_POOL;
    if (!full || fresh) return vulkan_error(result, "vkAllocateDescriptorSets");
    ++current_;
  }
}

void DescriptorArena::reset() {
  for (const VkDescriptorPool pool : pools_)
    (void)vkResetDescriptorPool(device_->handle(), pool, 0);
  current_ = 0;
}

// --- Binding ----------------------------------------------------------------------------------

BoundResource bound_buffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset,
                           VkDeviceSize size) {
  return {binding, {buffer, offset, size}, {}, VK_NULL_HANDLE};
}

BoundResource bound_texel_buffer(std::uint32_t binding, VkBufferView texels) {
  return {binding, {}, {}, texels};
}

BoundResource bound_storage_image(std::uint32_t binding, VkImageView view) {
  return {binding, {}, {VK_NULL_HANDLE, view, VK_IMAGE_LAYOUT_GENERAL}, VK_NULL_HANDLE};
}

BoundResource bound_texture(std::uint32_t binding, VkImageView view, VkSampler sampler) {
  return {binding, {}, {sampler, view, VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL}, VK_NULL_HANDLE};
}

BoundResource bound_texel_image(std::uint32_t binding, VkImageView view, VkImageLayout layout) {
  return {binding, {}, {VK_NULL_HANDLE, view, layout}, VK_NULL_HANDLE};
}

void write_descriptors(const Device& device, VkDescriptorSet set,
                       std::span<const BindingDesc> bindings,
                       std::span<const BoundResource> resources) {
  std::vector<VkWriteDescriptorSet> writes;
  writes.reserve(resources.size());
  std::vector<std::uint32_t> given(bindings.size(), 0);
  for (const BoundResource& resource : resources) {
    const auto at = std::find_if(bindings.begin(), bindings.end(), [&](const BindingDesc& b) {
      return b.binding == resource.binding;
    });
    NERITIC_CHECK(at != bindings.end(), "binding {} is not declared", resource.binding);
    std::uint32_t& element = given[static_cast<std::size_t>(at - bindings.begin())];
    NERITIC_CHECK(kind_of(resource) == kind_of(at->type),
                  "binding {} of type {} is given the wrong kind of resource", at->binding,
                  static_cast<int>(at->type));
    NERITIC_CHECK(element < at->count, "binding {} is given more than {} times", at->binding,
                  at->count);
    VkWriteDescriptorSet write{VK_STRUCTURE_TYPE_WRITE_DESCRIPTOR_SET};
    write.dstSet = set;
    write.dstBinding = at->binding;
    write.dstArrayElement = element++;
    write.descriptorCount = 1;
    write.descriptorType = at->type;
    write.pBufferInfo = &resource.buffer;
    write.pImageInfo = &resource.image;
    write.pTexelBufferView = &resource.texels;
    writes.push_back(write);
  }
  for (std::size_t i = 0; i < bindings.size(); ++i)
    NERITIC_CHECK(given[i] == bindings[i].count, "binding {} is given {} of {} times",
                  bindings[i].binding, given[i], bindings[i].count);
  vkUpdateDescriptorSets(device.handle(), static_cast<std::uint32_t>(writes.size()), writes.data(),
                         0, nullptr);
}

}  // namespace neritic::gpu
