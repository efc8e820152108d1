// WaterPasses: particles over the shaded picture, one instance each: bubbles, then all others.
#include <algorithm>

#include "engine/render/lighting.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/water_passes.hpp"
#include "shaders.hpp"
#include "shared/bubble.h"

namespace neritic::render {
namespace {

// A view mask has six bits at most. cascades: of the sun's maps, where there are shafts.
std::uint32_t pipeline_key(std::uint32_t view_mask, bool of_bubbles, const ShaftInputs* shafts) {
  static_assert(shared::kMaxViews < 24 && shared::kMaxCascades < 8);
  return view_mask | (of_bubbles ? 1u << 31 : 0u) |
         (shafts ? 1u << 30 | shafts->cascade_count << 24 : 0u);
}

}  // namespace

Result<graph::ImageHandle> WaterPasses::declare_particles(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    const GBuffer& gbuffer, const ViewSet& views, const shared::Lighting& lighting,
    const std::vector<shared::Particle>& particles, float shutter, const ShaftInputs* shafts) {
  if (particles.empty()) return hdr;
  if (shafts && !tile_sampler_.handle()) {
    NERITIC_TRY(tile_sampler_,
                gpu::Sampler::create(device_, {.name = "particles' net", .mipmapped = false}));
  }
  const std::vector<std::uint32_t> masks = view_masks_of(gbuffer.layers, device_);
  const auto bubbles = static_cast<std::uint32_t>(
      std::ranges::find_if(particles,
                           [](const shared::Particle& p) {
                             return (p.kind & shared::kParticleKindMask) != shared::kParticleBubble;
                           }) -
      particles.begin());
  const std::uint32_t others = static_cast<std::uint32_t>(particles.size()) - bubbles;
  for (const std::uint32_t mask : masks)
    for (const bool of_bubbles : {true, false}) {
      gpu::Pipeline& pipeline = particles_[pipeline_key(mask, of_bubbles, shafts)];
      if (pipeline || (of_bubbles ? bubbles : others) == 0) continue;
      gpu::GraphicsPipelineDesc desc;
      desc.name = "particles";
      desc.vertex_code = shaders::kParticlesVert;
      desc.fragment_code = shafts ? shaders::kParticlesLitFrag : shaders::kParticlesFrag;
      desc.layout.bindings = {{shared::kParticleViews, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                              {shared::kParticleLighting, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                              {shared::kParticleDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}};
      if (shafts)
        for (const auto& [binding, type] :
             {std::pair{shared::kParticleSun, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
              std::pair{shared::kParticleCascades, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
              std::pair{shared::kParticleCaustics, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}})
          desc.layout.bindings.push_back({binding, type});
      desc.layout.push_constant_bytes = sizeof(shared::ParticlePush);
      desc.constants = {{shared::kSpecBubbles, of_bubbles},
                        {shared::kSpecParticleMultiview, mask != 0}};
      if (shafts) desc.constants.push_back({shared::kSpecParticleCascades, shafts->cascade_count});
      desc.streams = {
          {sizeof(shared::Particle),
           {{shared::kParticlePosition, VK_FORMAT_R32G32B32A32_SFLOAT,
             offsetof(shared::Particle, position)},
            {shared::kParticleMoved, VK_FORMAT_R32G32B32A32_SFLOAT,
             offsetof(shared::Particle, moved)},
            {shared::kParticleKind, VK_FORMAT_R32G32_UINT, offsetof(shared::Particle, kind)}},
           true}};
      desc.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
      desc.color_formats = {kHdrFormat};
      desc.depth_format = kDepthFormat;
      desc.depth_write = false;
      desc.blend = gpu::Blend::kAlphaOver;
      desc.view_mask = mask;
      NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
    }
  struct Data {
    graph::ImageHandle hdr;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "particles",
      [&](graph::PassBuilder& builder, Data& data) {
        // Without their number, which changes with each frame: each would have a plan of its own.
        builder.terms(shafts ? "particles in shafts" : "particles");
        data.hdr = builder.write(hdr, graph::Access::kColorAttachment);
        builder.read(gbuffer.depth, graph::Access::kDepthTestAndSampled);
        if (shafts)
          for (const graph::ImageHandle image :
               {shafts->cascades, shafts->caustics ? shafts->caustics : gbuffer.normal})
            if (image) builder.read(image, graph::Access::kSampledFragment);
      },
      [this, masks, gbuffer, lighting, shutter, bubbles, others, &views, &particles,
       inputs = shafts ? std::optional(*shafts) : std::nullopt](const Data& data,
                                                                graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const VkImageLayout depth_layout =
            graph::access_info(graph::Access::kDepthTestAndSampled).layout;
        std::vector<gpu::BoundResource> set0 = {
            bound_slice(shared::kParticleViews,
                        commands.upload(std::span<const shared::View>(gpu_views(views)))),
            bound_slice(shared::kParticleLighting, commands.upload(&lighting, sizeof lighting)),
            gpu::bound_texel_image(shared::kParticleDepth, context.image(gbuffer.depth).view(),
                                   depth_layout)};
        const ShaftInputs* const lit = inputs ? &*inputs : nullptr;
        if (lit) {
          // The shader's constants keep it from reading what is bound in the place of others.
          const bool maps = bool(lit->cascades);
          set0.push_back(
              bound_slice(shared::kParticleSun, commands.upload(&lit->sun, sizeof lit->sun)));
          set0.push_back(gpu::bound_texel_image(
              shared::kParticleCascades, context.image(maps ? lit->cascades : gbuffer.depth).view(),
              maps ? graph::access_info(graph::Access::kSampledFragment).layout : depth_layout));
          set0.push_back(gpu::bound_texture(
              shared::kParticleCaustics,
              context.image(lit->caustics ? lit->caustics : gbuffer.normal).view(),
              tile_sampler_.handle()));
        }
        const VkRenderingAttachmentInfo color =
            attachment(context.image(data.hdr), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD);
        VkRenderingAttachmentInfo depth =
            attachment(context.image(gbuffer.depth), depth_layout, VK_ATTACHMENT_LOAD_OP_LOAD);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
        const gpu::UploadSlice stream =
            commands.upload(std::span<const shared::Particle>(particles));
        const shared::ParticlePush push{Vec2f(gbuffer.width, gbuffer.height), shutter};
        for (const std::uint32_t mask : masks) {
          begin_rendering(context.cmd(), gbuffer, mask, std::span(&color, 1), depth);
          vkCmdSetCullMode(context.cmd(), VK_CULL_MODE_NONE);
          vkCmdSetFrontFace(context.cmd(), VK_FRONT_FACE_COUNTER_CLOCKWISE);
          vkCmdBindVertexBuffers(context.cmd(), 0, 1, &stream.buffer, &stream.offset);
          for (const bool of_bubbles : {true, false}) {
            const std::uint32_t count = of_bubbles ? bubbles : others;
            if (count == 0) continue;
            const gpu::Pipeline& pipeline = particles_.at(pipeline_key(mask, of_bubbles, lit));
            commands.bind_pipeline(pipeline);
            commands.bind(pipeline, set0);
            commands.push(pipeline, push);
            vkCmdDraw(context.cmd(), 4, count, 0, of_bubbles ? 0 : bubbles);
          }
          vkCmdEndRendering(context.cmd());
        }
      });
  return pass.hdr;
}

}  // namespace neritic::render
