// Renderer: the forward pass, blended materials over the shaded picture.
#include "engine/render/lighting.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"

namespace neritic::render {

Result<graph::ImageHandle> Renderer::declare_forward(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    const GBuffer& gbuffer, const GpuScene& scene, const DeformedGeometry& deformed,
    const ViewSet& views, const DrawList& draws, const shared::Lighting& lighting,
    std::uint32_t inscatter_samples, FramePictures* pictures) {
  if (draws.blended.empty()) return hdr;
  std::vector<MaskedDraws> masked;
  for (const std::uint32_t mask : view_masks_of(gbuffer.layers, device_)) {
    NERITIC_TRY(PreparedDraws prepared, prepare(scene, draws, draws.blended, GBufferKind::kSurface,
                                                true, false, false, mask, {},
                                                {.terms = lighting.terms,
                                                 .lamps = lighting.lamp_count,
                                                 .inscatter_samples = inscatter_samples}));
    masked.push_back({mask, std::move(prepared)});
  }
  const std::vector<graph::ImageHandle> shown = pictures_in(scene, draws.blended, pictures);
  struct Data {
    graph::ImageHandle hdr;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "forward",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(names_of_terms(lighting));
        data.hdr = builder.write(hdr, graph::Access::kColorAttachment);
        builder.read(gbuffer.depth, graph::Access::kDepthTest);
        if (deformed.positions) builder.read(deformed.positions, graph::Access::kVertexBuffer);
        for (const graph::ImageHandle image : shown)
          builder.read(image, graph::Access::kSampledFragment);
      },
      [this, gbuffer, masked = std::move(masked), deformed, lighting, &scene, &views, &draws](
          const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::BoundResource set0[] = {
            bound_slice(shared::kRasterViews,
                        commands.upload(std::span<const shared::View>(gpu_views(views)))),
            gpu::bound_buffer(shared::kRasterNextPositions, nothing_.handle()),
            bound_slice(shared::kRasterLighting, commands.upload(&lighting, sizeof lighting))};
        const VkRenderingAttachmentInfo color =
            attachment(context.image(data.hdr), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD);
        VkRenderingAttachmentInfo depth = attachment(
            context.image(gbuffer.depth), graph::access_info(graph::Access::kDepthTest).layout,
            VK_ATTACHMENT_LOAD_OP_LOAD);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;  // a store would count as a write
        const auto instances = upload_instances(commands, draws, false);
        for (const MaskedDraws& m : masked) {
          begin_rendering(context.cmd(), gbuffer, m.view_mask, std::span(&color, 1), depth);
          record_draws(m.prepared, scene,
                       deformed.positions ? &context.buffer(deformed.positions) : nullptr,
                       instances, Vec2f(gbuffer.width, gbuffer.height), set0, commands);
          vkCmdEndRendering(context.cmd());
        }
      });
  return pass.hdr;
}

}  // namespace neritic::render
