#include "engine/gpu/pipeline.hpp"

#include <algorithm>
#include <array>
#include <utility>

#include "engine/core/check.hpp"
#include "engine/core/clock.hpp"
#include "engine/core/log.hpp"
#include "engine/gpu/device.hpp"
#include "engine/gpu/error.hpp"
#include "engine/gpu/pipeline_shelf.hpp"

namespace neritic::gpu {
namespace {

constexpr std::uint32_t kMaxPushBytes = 128;  // what every Vulkan device guarantees
constexpr VkShaderStageFlags kGraphicsStages =
    VK_SHADER_STAGE_VERTEX_BIT | VK_SHADER_STAGE_FRAGMENT_BIT;

// Lives while a pipeline is made.
class ShaderModule {
 public:
  static Result<ShaderModule> create(const Device& device, const std::string& name,
                                     std::span<const std::uint32_t> code) {
    VkShaderModuleCreateInfo info{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    info.codeSize = code.size_bytes();
    info.pCode = code.data();
    ShaderModule module;
    module.device_ = device.handle();
    NERITIC_TRY_VK("vkCreateShaderModule (" + name + ")",
                   vkCreateShaderModule(device.handle(), &info, nullptr, &module.handle_));
    device.name_object(VK_OBJECT_TYPE_SHADER_MODULE, module.handle_, name);
    return module;
  }
  ShaderModule() = default;
  ShaderModule(ShaderModule&& other) noexcept
      : device_(other.device_), handle_(std::exchange(other.handle_, VK_NULL_HANDLE)) {}
  ShaderModule& operator=(ShaderModule&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(handle_, other.handle_);
    return *this;
  }
  ~ShaderModule() {
    if (handle_ != VK_NULL_HANDLE) vkDestroyShaderModule(device_, handle_, nullptr);
  }
  VkShaderModule handle() const { return handle_; }

 private:
  VkDevice device_ = VK_NULL_HANDLE;
  VkShaderModule handle_ = VK_NULL_HANDLE;
};

// Every stage that declares it learns whether the device is a processor (shaders/shared/even.glsl).
constexpr std::uint32_t kOnProcessorConstant = 31;

// Specialization constants in the form Vulkan reads; info points into the object.
struct Specialization {
  Specialization(const Device& device, std::span<const SpecConstant> constants) {
    for (const SpecConstant& constant : constants) add(constant);
    add({kOnProcessorConstant, device.info().kind == "CPU" ? 1u : 0u});
    info.mapEntryCount = static_cast<std::uint32_t>(entries.size());
    info.pMapEntries = entries.data();
    info.dataSize = values.size() * 4;
    info.pData = values.data();
  }
  Specialization(const Specialization&) = delete;
  Specialization& operator=(const Specialization&) = delete;
  void add(const SpecConstant& constant) {
    entries.push_back({constant.id, static_cast<std::uint32_t>(values.size() * 4), 4});
    values.push_back(constant.value);
  }
  std::vector<VkSpecializationMapEntry> entries;
  std::vector<std::uint32_t> values;
  VkSpecializationInfo info{};
};

VkPipelineShaderStageCreateInfo stage_info(VkShaderStageFlagBits stage, const ShaderModule& module,
                                           const Specialization& specialization) {
  VkPipelineShaderStageCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO};
  info.stage = stage;
  info.module = module.handle();
  info.pName = "main";
  info.pSpecializationInfo = &specialization.info;
  return info;
}

Result<VkPipelineLayout> make_layout(const Device& device, const std::string& name,
                                     const PipelineLayoutDesc& desc, VkDescriptorSetLayout set0,
                                     VkShaderStageFlags stages) {
  NERITIC_CHECK(desc.push_constant_bytes <= kMaxPushBytes && desc.push_constant_bytes % 4 == 0,
                "{}: {} bytes of push constants", name, desc.push_constant_bytes);
  std::vector<VkDescriptorSetLayout> sets{set0};
  for (const SetLayout* set : desc.other_sets) sets.push_back(set->handle());
  const VkPushConstantRange range{stages, 0, desc.push_constant_bytes};
  VkPipelineLayoutCreateInfo info{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
  info.setLayoutCount = static_cast<std::uint32_t>(sets.size());
  info.pSetLayouts = sets.data();
  info.pushConstantRangeCount = desc.push_constant_bytes > 0 ? 1 : 0;
  info.pPushConstantRanges = &range;
  VkPipelineLayout layout = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreatePipelineLayout (" + name + ")",
                 vkCreatePipelineLayout(device.handle(), &info, nullptr, &layout));
  device.name_object(VK_OBJECT_TYPE_PIPELINE_LAYOUT, layout, name);
  return layout;
}

// The vertex streams in the form Vulkan reads; info points into the object.
struct VertexInput {
  explicit VertexInput(std::span<const VertexStream> streams) {
    for (const VertexStream& stream : streams) {
      const auto binding = static_cast<std::uint32_t>(bindings.size());
      bindings.push_back(
          {binding, stream.stride,
           stream.per_instance ? VK_VERTEX_INPUT_RATE_INSTANCE : VK_VERTEX_INPUT_RATE_VERTEX});
      for (const VertexStream::Attribute& a : stream.attributes)
        attributes.push_back({a.location, binding, a.format, a.offset});
    }
    info.vertexBindingDescriptionCount = static_cast<std::uint32_t>(bindings.size());
    info.pVertexBindingDescriptions = bindings.data();
    info.vertexAttributeDescriptionCount = static_cast<std::uint32_t>(attributes.size());
    info.pVertexAttributeDescriptions = attributes.data();
  }
  VertexInput(const VertexInput&) = delete;
  VertexInput& operator=(const VertexInput&) = delete;
  std::vector<VkVertexInputBindingDescription> bindings;
  std::vector<VkVertexInputAttributeDescription> attributes;
  VkPipelineVertexInputStateCreateInfo info{
      VK_STRUCTURE_TYPE_PIPELINE_VERTEX_INPUT_STATE_CREATE_INFO};
};

std::vector<VkPipelineColorBlendAttachmentState> blend_states(const GraphicsPipelineDesc& desc) {
  VkPipelineColorBlendAttachmentState write_all{};
  write_all.colorWriteMask = VK_COLOR_COMPONENT_R_BIT | VK_COLOR_COMPONENT_G_BIT |
                             VK_COLOR_COMPONENT_B_BIT | VK_COLOR_COMPONENT_A_BIT;
  std::vector<VkPipelineColorBlendAttachmentState> states(desc.color_formats.size(), write_all);
  if (desc.blend != Blend::kNone && !states.empty()) {
    const bool tinted = desc.blend == Blend::kTinted;
    VkPipelineColorBlendAttachmentState& first = states.front();
    first.blendEnable = VK_TRUE;
    first.srcColorBlendFactor = VK_BLEND_FACTOR_ONE;
    first.dstColorBlendFactor =
        tinted ? VK_BLEND_FACTOR_SRC1_COLOR : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    first.colorBlendOp = VK_BLEND_OP_ADD;
    first.srcAlphaBlendFactor = VK_BLEND_FACTOR_ONE;
    first.dstAlphaBlendFactor =
        tinted ? VK_BLEND_FACTOR_SRC1_ALPHA : VK_BLEND_FACTOR_ONE_MINUS_SRC_ALPHA;
    first.alphaBlendOp = VK_BLEND_OP_ADD;
  }
  return states;
}

Status check_graphics(const Device& device, const GraphicsPipelineDesc& desc) {
  if (desc.view_mask >> std::min(device.max_views(), 31u) != 0)
    return failure(ErrorCode::kUnsupported, "pipeline {}: view mask {:#x}, the device has {} views",
                   desc.name, desc.view_mask, device.max_views());
  if (desc.blend != Blend::kNone && desc.color_formats.size() > 1 &&
      !device.features().independentBlend)
    return failure(ErrorCode::kUnsupported,
                   "pipeline {}: the device cannot blend one of several attachments", desc.name);
  return {};
}

Result<VkPipeline> make_graphics(const Device& device, const GraphicsPipelineDesc& desc,
                                 VkPipelineLayout layout) {
  NERITIC_TRY(const ShaderModule vertex,
              ShaderModule::create(device, desc.name + ".vert", desc.vertex_code));
  ShaderModule fragment;
  const Specialization specialization(device, desc.constants);
  std::vector<VkPipelineShaderStageCreateInfo> stages{
      stage_info(VK_SHADER_STAGE_VERTEX_BIT, vertex, specialization)};
  if (!desc.fragment_code.empty()) {
    NERITIC_TRY(fragment, ShaderModule::create(device, desc.name + ".frag", desc.fragment_code));
    stages.push_back(stage_info(VK_SHADER_STAGE_FRAGMENT_BIT, fragment, specialization));
  }
  const VertexInput vertex_input(desc.streams);
  VkPipelineInputAssemblyStateCreateInfo assembly{
      VK_STRUCTURE_TYPE_PIPELINE_INPUT_ASSEMBLY_STATE_CREATE_INFO};
  assembly.topology = desc.topology;
  VkPipelineViewportStateCreateInfo viewport{VK_STRUCTURE_TYPE_PIPELINE_VIEWPORT_STATE_CREATE_INFO};
  viewport.viewportCount = 1;
  viewport.scissorCount = 1;
  VkPipelineRasterizationStateCreateInfo raster{
      VK_STRUCTURE_TYPE_PIPELINE_RASTERIZATION_STATE_CREATE_INFO};
  raster.polygonMode = VK_POLYGON_MODE_FILL;
  raster.lineWidth = 1.0f;
  VkPipelineMultisampleStateCreateInfo samples{
      VK_STRUCTURE_TYPE_PIPELINE_MULTISAMPLE_STATE_CREATE_INFO};
  samples.rasterizationSamples = VK_SAMPLE_COUNT_1_BIT;
  const bool has_depth = desc.depth_format != VK_FORMAT_UNDEFINED;
  VkPipelineDepthStencilStateCreateInfo depth{
      VK_STRUCTURE_TYPE_PIPELINE_DEPTH_STENCIL_STATE_CREATE_INFO};
  depth.depthTestEnable = has_depth;
  depth.depthWriteEnable = has_depth && desc.depth_write;
  depth.depthCompareOp = desc.depth_compare;
  const auto attachments = blend_states(desc);
  VkPipelineColorBlendStateCreateInfo blend{
      VK_STRUCTURE_TYPE_PIPELINE_COLOR_BLEND_STATE_CREATE_INFO};
  blend.attachmentCount = static_cast<std::uint32_t>(attachments.size());
  blend.pAttachments = attachments.data();
  constexpr std::array kDynamic{VK_DYNAMIC_STATE_VIEWPORT, VK_DYNAMIC_STATE_SCISSOR,
                                VK_DYNAMIC_STATE_CULL_MODE, VK_DYNAMIC_STATE_FRONT_FACE};
  VkPipelineDynamicStateCreateInfo dynamic{VK_STRUCTURE_TYPE_PIPELINE_DYNAMIC_STATE_CREATE_INFO};
  dynamic.dynamicStateCount = kDynamic.size();
  dynamic.pDynamicStates = kDynamic.data();
  VkPipelineRenderingCreateInfo rendering{VK_STRUCTURE_TYPE_PIPELINE_RENDERING_CREATE_INFO};
  rendering.viewMask = desc.view_mask;
  rendering.colorAttachmentCount = static_cast<std::uint32_t>(desc.color_formats.size());
  rendering.pColorAttachmentFormats = desc.color_formats.data();
  rendering.depthAttachmentFormat = desc.depth_format;

  VkGraphicsPipelineCreateInfo info{VK_STRUCTURE_TYPE_GRAPHICS_PIPELINE_CREATE_INFO, &rendering};
  info.stageCount = static_cast<std::uint32_t>(stages.size());
  info.pStages = stages.data();
  info.pVertexInputState = &vertex_input.info;
  info.pInputAssemblyState = &assembly;
  info.pViewportState = &viewport;
  info.pRasterizationState = &raster;
  info.pMultisampleState = &samples;
  info.pDepthStencilState = &depth;
  info.pColorBlendState = &blend;
  info.pDynamicState = &dynamic;
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateGraphicsPipelines (" + desc.name + ")",
                 vkCreateGraphicsPipelines(device.handle(), device.pipeline_cache(), 1, &info,
                                           nullptr, &pipeline));
  return pipeline;
}

Result<VkPipeline> make_compute(const Device& device, const ComputePipelineDesc& desc,
                                VkPipelineLayout layout) {
  NERITIC_TRY(const ShaderModule module, ShaderModule::create(device, desc.name, desc.code));
  const Specialization specialization(device, desc.constants);
  VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
  info.stage = stage_info(VK_SHADER_STAGE_COMPUTE_BIT, module, specialization);
  info.layout = layout;
  VkPipeline pipeline = VK_NULL_HANDLE;
  NERITIC_TRY_VK("vkCreateComputePipelines (" + desc.name + ")",
                 vkCreateComputePipelines(device.handle(), device.pipeline_cache(), 1, &info,
                                          nullptr, &pipeline));
  return pipeline;
}

// A pipeline by `make` (the description and its layout to the driver's handle), timed and named.
template <class Desc, class Make>
Result<PipelineShelf::Made> made(const Device& device, const Desc& desc, VkShaderStageFlags stages,
                                 VkPipelineBindPoint bind_point, Make make) {
  auto out = std::make_shared<MadePipeline>();
  out->device = device.handle();
  out->name = desc.name;
  out->bind_point = bind_point;
  NERITIC_TRY(out->set0, SetLayout::create(device, desc.name, desc.layout.bindings, stages));
  NERITIC_TRY(out->layout, make_layout(device, desc.name, desc.layout, out->set0.handle(), stages));
  const TimeNs start = now_ns();
  NERITIC_TRY(out->handle, make(device, desc, out->layout));
  log_info("pipeline {} in {:.1f} ms", desc.name, to_ms(now_ns() - start));
  device.name_object(VK_OBJECT_TYPE_PIPELINE, out->handle, desc.name);
  return PipelineShelf::Made(std::move(out));
}

}  // namespace

Result<Pipeline> Pipeline::create(const Device& device, const ComputePipelineDesc& desc) {
  NERITIC_TRY(auto pipeline, device.pipelines().get(pipeline_key(desc), [&] {
    return made(device, desc, VK_SHADER_STAGE_COMPUTE_BIT, VK_PIPELINE_BIND_POINT_COMPUTE,
                make_compute);
  }));
  return Pipeline(std::move(pipeline));
}

Result<Pipeline> Pipeline::create(const Device& device, const GraphicsPipelineDesc& desc) {
  NERITIC_TRY_STATUS(check_graphics(device, desc));
  NERITIC_TRY(auto pipeline, device.pipelines().get(pipeline_key(desc), [&] {
    return made(device, desc, kGraphicsStages, VK_PIPELINE_BIND_POINT_GRAPHICS, make_graphics);
  }));
  return Pipeline(std::move(pipeline));
}

MadePipeline::~MadePipeline() {
  if (handle != VK_NULL_HANDLE) vkDestroyPipeline(device, handle, nullptr);
  if (layout != VK_NULL_HANDLE) vkDestroyPipelineLayout(device, layout, nullptr);
}

}  // namespace neritic::gpu
