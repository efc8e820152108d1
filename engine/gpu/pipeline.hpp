// Pipelines and what they bind. Every pipeline declares its bindings in plain structs whose numbers
// come from the shared shader headers. Set 0 is written anew for each pass (Commands::bind);
// further sets are persistent (materials). Named; made on the rendering thread. Equal descriptions
// give one pipeline of the driver, which the device keeps for a while (pipeline_shelf.hpp).
#pragma once

#include <volk.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::gpu {

class Device;

struct BindingDesc {
  std::uint32_t binding = 0;
  VkDescriptorType type = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  std::uint32_t count = 1;
};

class SetLayout {
 public:
  static Result<SetLayout> create(const Device& device, const std::string& name,
                                  std::span<const BindingDesc> bindings, VkShaderStageFlags stages);
  SetLayout() = default;
  SetLayout(SetLayout&& other) noexcept;
  SetLayout& operator=(SetLayout&& other) noexcept;
  ~SetLayout();
  VkDescriptorSetLayout handle() const { return handle_; }
  const std::vector<BindingDesc>& bindings() const { return bindings_; }
  VkShaderStageFlags stages() const { return stages_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkDescriptorSetLayout handle_ = VK_NULL_HANDLE;
  std::vector<BindingDesc> bindings_;
  VkShaderStageFlags stages_ = 0;
};

struct SpecConstant {
  std::uint32_t id = 0;
  std::uint32_t value = 0;  // bit pattern: floats by std::bit_cast
};

struct PipelineLayoutDesc {
  std::vector<BindingDesc> bindings;         // set 0
  std::vector<const SetLayout*> other_sets;  // sets 1 and up, borrowed
  std::uint32_t push_constant_bytes = 0;     // at most 128
};

struct ComputePipelineDesc {
  std::string name;
  std::span<const std::uint32_t> code;
  PipelineLayoutDesc layout;
  std::vector<SpecConstant> constants;
};

struct VertexStream {
  std::uint32_t stride = 0;
  struct Attribute {
    std::uint32_t location = 0;
    VkFormat format = VK_FORMAT_R32G32B32_SFLOAT;
    std::uint32_t offset = 0;
  };
  std::vector<Attribute> attributes;
  bool per_instance = false;
};

// kAlphaOver: premultiplied source over destination. kTinted: source plus destination times the
// fragment stage's second output (where features().dualSrcBlend).
enum class Blend { kNone, kAlphaOver, kTinted };

struct GraphicsPipelineDesc {
  std::string name;
  std::span<const std::uint32_t> vertex_code, fragment_code;  // no fragment code: depth only
  PipelineLayoutDesc layout;
  std::vector<SpecConstant> constants;  // for both stages
  std::vector<VertexStream> streams;    // binding = position in this list
  VkPrimitiveTopology topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  std::vector<VkFormat> color_formats;
  VkFormat depth_format = VK_FORMAT_UNDEFINED;
  bool depth_write = true;
  VkCompareOp depth_compare = VK_COMPARE_OP_GREATER_OR_EQUAL;  // reversed-Z
  Blend blend = Blend::kNone;                                  // on the first colour attachment
  std::uint32_t view_mask = 0;                                 // multiview; 0: off
};
// Dynamic state of every graphics pipeline: viewport, scissor, cull mode, front face.

// A pipeline of the driver, made of a description, with the layouts that it stands on.
struct MadePipeline {
  MadePipeline() = default;
  MadePipeline(const MadePipeline&) = delete;
  MadePipeline& operator=(const MadePipeline&) = delete;
  ~MadePipeline();

  VkDevice device = VK_NULL_HANDLE;
  VkPipeline handle = VK_NULL_HANDLE;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  VkPipelineBindPoint bind_point = VK_PIPELINE_BIND_POINT_COMPUTE;
  SetLayout set0;
  std::string name;
};

// A share of a pipeline. Copies are the same pipeline; empty by default.
class Pipeline {
 public:
  static Result<Pipeline> create(const Device& device, const ComputePipelineDesc& desc);
  static Result<Pipeline> create(const Device& device, const GraphicsPipelineDesc& desc);
  Pipeline() = default;

  VkPipeline handle() const { return made_ ? made_->handle : VK_NULL_HANDLE; }
  // The rest only of a pipeline that is not empty.
  VkPipelineLayout layout() const { return made_->layout; }
  VkPipelineBindPoint bind_point() const { return made_->bind_point; }
  VkDescriptorSetLayout set0() const { return made_->set0.handle(); }
  const std::vector<BindingDesc>& bindings() const { return made_->set0.bindings(); }
  const std::string& name() const { return made_->name; }
  explicit operator bool() const { return made_ != nullptr; }

 private:
  explicit Pipeline(std::shared_ptr<const MadePipeline> made) : made_(std::move(made)) {}
  std::shared_ptr<const MadePipeline> made_;
};

// Persistent descriptor sets of one layout (materials): grows pool by pool, freed all at once.
class DescriptorArena {
 public:
  DescriptorArena(const Device& device, std::string name);
  DescriptorArena(DescriptorArena&& other) noexcept;
  DescriptorArena& operator=(DescriptorArena&& other) noexcept;
  ~DescriptorArena();
  Result<VkDescriptorSet> allocate(VkDescriptorSetLayout layout, const std::string& name);
  void reset();  // every set handed out becomes invalid

 private:
  const Device* device_ = nullptr;
  std::string name_;
  std::vector<VkDescriptorPool> pools_;
  std::size_t current_ = 0;
};

// The resource of one binding. The elements of a binding with count > 1 are given one by one, in
// order.
struct BoundResource {
  std::uint32_t binding = 0;
  VkDescriptorBufferInfo buffer{};
  VkDescriptorImageInfo image{};
  VkBufferView texels = VK_NULL_HANDLE;
};
BoundResource bound_buffer(std::uint32_t binding, VkBuffer buffer, VkDeviceSize offset = 0,
                           VkDeviceSize size = VK_WHOLE_SIZE);
BoundResource bound_texel_buffer(std::uint32_t binding, VkBufferView texels);
BoundResource bound_storage_image(std::uint32_t binding, VkImageView view);  // layout GENERAL
BoundResource bound_texture(std::uint32_t binding, VkImageView view,
                            VkSampler sampler);  // SHADER_READ_ONLY_OPTIMAL
// A SAMPLED_IMAGE. layout: how the image is while the shader reads it.
BoundResource bound_texel_image(std::uint32_t binding, VkImageView view,
                                VkImageLayout layout = VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL);

void write_descriptors(const Device& device, VkDescriptorSet set,
                       std::span<const BindingDesc> bindings,
                       std::span<const BoundResource> resources);

}  // namespace neritic::gpu
