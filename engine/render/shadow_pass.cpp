// Renderer: depth maps as lights see the scene.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"

namespace neritic::render {

Result<graph::ImageHandle> Renderer::declare_shadow_maps(graph::FrameGraph& graph,
                                                         const std::string& name,
                                                         const GpuScene& scene,
                                                         const DeformedGeometry& deformed,
                                                         const std::vector<ShadowMap>& maps,
                                                         const ShadowTarget& target) {
  constexpr GBufferParts kDepthAlone{.normal = false, .label = false};
  std::vector<PreparedDraws> layers;
  for (const ShadowMap& map : maps) {
    NERITIC_TRY(PreparedDraws prepared,
                prepare(scene, map.draws, map.draws.opaque, GBufferKind::kGeometry, false, false,
                        false, 0, kDepthAlone, {}));
    layers.push_back(std::move(prepared));
  }
  struct Data {
    std::vector<graph::ImageHandle> layers;
    graph::ImageHandle depth;  // all of them
  };
  const Data& pass = graph.add_pass<Data>(
      name,
      [&](graph::PassBuilder& builder, Data& data) {
        const ViewSet& first = maps.front().views;
        data.depth = target.image
                         ? target.image
                         : builder.create_image(name, {kDepthFormat, first.width, first.height,
                                                       static_cast<std::uint32_t>(maps.size())});
        for (const ShadowMap& map : maps) {
          data.layers.push_back(
              builder.write(data.depth.layer(map.layer), graph::Access::kDepthAttachment));
          data.depth = data.layers.back().whole();
        }
        if (deformed.positions) builder.read(deformed.positions, graph::Access::kVertexBuffer);
      },
      [this, layers = std::move(layers), deformed, &scene, &maps, over = target.over,
       drawn = target.drawn](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        for (std::uint32_t i = 0; i < maps.size(); ++i) {
          const ShadowMap& map = maps[i];
          const gpu::BoundResource set0[] = {
              bound_slice(shared::kRasterViews,
                          commands.upload(std::span<const shared::View>(gpu_views(map.views)))),
              gpu::bound_buffer(shared::kRasterNextPositions, nothing_.handle())};
          VkRenderingAttachmentInfo depth = attachment(
              context.image(data.depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
              over ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR);
          depth.imageView = context.view(data.layers[i]);
          const VkRenderingAttachmentInfo none[2] = {{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO},
                                                     {VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO}};
          const GBuffer size{.width = map.views.width, .height = map.views.height};
          begin_rendering(context.cmd(), size, 0, none, depth);
          record_draws(layers[i], scene,
                       deformed.positions ? &context.buffer(deformed.positions) : nullptr,
                       upload_instances(commands, map.draws, false), Vec2f(size.width, size.height),
                       set0, commands);
          vkCmdEndRendering(context.cmd());
        }
        if (drawn) drawn();
      });
  return pass.depth;
}

graph::ImageHandle Renderer::declare_shadow_copy(graph::FrameGraph& graph, const std::string& name,
                                                 graph::ImageHandle maps, std::uint32_t size,
                                                 std::uint32_t layers) {
  struct Data {
    graph::ImageHandle copy;
  };
  const Data& pass = graph.add_pass<Data>(
      name,
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(maps, graph::Access::kTransferRead);
        data.copy = builder.write(builder.create_image(name, {kDepthFormat, size, size, layers}),
                                  graph::Access::kTransferWrite);
      },
      [maps, size, layers](const Data& data, graph::PassContext& context) {
        VkImageCopy region{};
        region.srcSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, layers};
        region.dstSubresource = region.srcSubresource;
        region.extent = {size, size, 1};
        vkCmdCopyImage(context.cmd(), context.image(maps).handle(),
                       VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.image(data.copy).handle(),
                       VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
      });
  return pass.copy;
}

}  // namespace neritic::render
