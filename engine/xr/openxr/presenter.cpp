#include "engine/xr/openxr/presenter.hpp"

#include "shaders.hpp"
#include "shared/present.h"

namespace neritic::xr::openxr {
namespace {

struct PresentData {
  graph::ImageHandle from, to;
  VkExtent2D part{};
};

void record(const PresentData& data, const gpu::Pipeline& pipeline, VkSampler sampler,
            graph::PassContext& context) {
  const gpu::Image& image = context.image(data.to);
  const gpu::ImageDesc& desc = image.desc();
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  color.imageView = image.view();
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_DONT_CARE;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = data.part;
  rendering.layerCount = 1;
  rendering.viewMask = desc.layers > 1 ? (1u << desc.layers) - 1 : 0;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  const VkCommandBuffer cmd = context.cmd();
  vkCmdBeginRendering(cmd, &rendering);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(data.part.width), static_cast<float>(data.part.height),
      0.0f, 1.0f};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetScissor(cmd, 0, 1, &rendering.renderArea);
  vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
  vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  context.commands.bind_pipeline(pipeline);
  context.commands.bind(pipeline, {gpu::bound_texture(shared::kPresentPicture,
                                                      context.image(data.from).view(), sampler)});
  vkCmdDraw(cmd, 4, 1, 0, 0);
  vkCmdEndRendering(cmd);
}

}  // namespace

Result<std::unique_ptr<Presenter>> Presenter::create(gpu::Device& device) {
  std::unique_ptr<Presenter> made(new Presenter(device));
  NERITIC_TRY(made->sampler_,
              gpu::Sampler::create(device, {.name = "headset picture",
                                            .u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                            .v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                            .mipmapped = false}));
  return made;
}

Result<const gpu::Pipeline*> Presenter::pipeline_for(VkFormat format, std::uint32_t layers,
                                                     bool opaque) {
  const auto key = std::make_tuple(format, layers, opaque);
  const auto found = pipelines_.find(key);
  if (found != pipelines_.end()) return &found->second;
  gpu::GraphicsPipelineDesc desc;
  desc.name = fmt::format("headset picture, {} layers", layers);
  desc.vertex_code = shaders::kPresentVert;
  desc.fragment_code = shaders::kPresentFrag;
  desc.layout.bindings = {{shared::kPresentPicture, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
  desc.constants = {{shared::kSpecPresentOpaque, opaque ? 1u : 0u}};
  desc.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  desc.color_formats = {format};
  desc.view_mask = layers > 1 ? (1u << layers) - 1 : 0;
  NERITIC_TRY(gpu::Pipeline pipeline, gpu::Pipeline::create(device_, desc));
  return &pipelines_.emplace(key, std::move(pipeline)).first->second;
}

Status Presenter::make_ready(VkFormat format, std::uint32_t layers, bool opaque) {
  NERITIC_TRY_STATUS(pipeline_for(format, layers, opaque));
  return {};
}

Status Presenter::declare(graph::FrameGraph& graph, const std::string& pass,
                          graph::ImageHandle from, const gpu::Image& target, VkExtent2D part,
                          bool opaque) {
  NERITIC_TRY(const gpu::Pipeline* const pipeline,
              pipeline_for(target.desc().format, target.desc().layers, opaque));
  // The runtime has finished with it, and its old contents do not matter.
  const graph::ImageHandle to = graph.import_image(target, {});
  const PresentData data = graph.add_pass<PresentData>(
      pass,
      [&](graph::PassBuilder& builder, PresentData& d) {
        d.from = from;
        d.part = part;
        builder.read(from, graph::Access::kSampledFragment);
        d.to = builder.write(to, graph::Access::kColorAttachment);
      },
      [this, pipeline](const PresentData& d, graph::PassContext& context) {
        record(d, *pipeline, sampler_.handle(), context);
      });
  graph.output(data.to, graph::Access::kColorAttachment);
  return {};
}

}  // namespace neritic::xr::openxr
