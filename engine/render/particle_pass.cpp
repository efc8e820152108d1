// WaterPasses: particles over the shaded picture, a triangle each, kind by kind.
#include <array>

#include "engine/render/lighting.hpp"
#include "engine/render/particles.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "engine/render/water_passes.hpp"
#include "shaders.hpp"
#include "shared/particles.h"

namespace neritic::render {
namespace {

// A view mask has six bits at most. cascades: of the sun's maps, where there are shafts.
std::uint32_t pipeline_key(std::uint32_t view_mask, std::uint32_t kind, const ShaftInputs* shafts) {
  static_assert(shared::kMaxViews < 24 && shared::kMaxCascades < 8);
  return view_mask | kind << 28 | (shafts ? 1u << 27 | shafts->cascade_count << 24 : 0u);
}

// The sun's maps and the net of light. In the place of one that is missing something is bound,
// which the shader's constants keep it from reading.
std::array<graph::ImageHandle, 2> shaft_images(const ShaftInputs& shafts, const GBuffer& gbuffer) {
  return {shafts.cascades ? shafts.cascades : gbuffer.normal,
          shafts.caustics ? shafts.caustics : gbuffer.normal};
}

std::span<const std::uint32_t> fragment_code_of(std::uint32_t kind) {
  switch (kind) {
    case shared::kParticleBubble:
      return shaders::kParticleBubbleFrag;
    case shared::kParticleBubbleSpot:
      return shaders::kParticleBubbleSpotFrag;
    case shared::kParticleSilt:
      return shaders::kParticleSiltFrag;
    default:
      return shaders::kParticleSnowFrag;
  }
}

// Particles of one kind in a row.
struct Run {
  std::uint32_t kind, first, count;
};

std::vector<Run> runs_of(std::span<const shared::Particle> particles) {
  std::vector<Run> runs;
  for (std::uint32_t i = 0; i < particles.size(); ++i) {
    const std::uint32_t kind = particles[i].kind & shared::kParticleKindMask;
    if (runs.empty() || runs.back().kind != kind) runs.push_back({kind, i, 0});
    ++runs.back().count;
  }
  return runs;
}

}  // namespace

Status WaterPasses::make_particle_pipeline(std::uint32_t view_mask, std::uint32_t kind,
                                           const ShaftInputs* shafts) {
  gpu::Pipeline& pipeline = particles_[pipeline_key(view_mask, kind, shafts)];
  if (pipeline) return {};
  gpu::GraphicsPipelineDesc desc;
  desc.name = "particles";
  desc.vertex_code = shafts ? shaders::kParticleLitVert : shaders::kParticleVert;
  desc.fragment_code = fragment_code_of(kind);
  desc.layout.bindings = {{shared::kParticleViews, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                          {shared::kParticleLighting, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                          {shared::kParticleDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                          {shared::kParticleStream, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  if (shafts)
    for (const auto& [binding, type] :
         {std::pair{shared::kParticleSun, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
          std::pair{shared::kParticleCascades, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
          std::pair{shared::kParticleCaustics, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}})
      desc.layout.bindings.push_back({binding, type});
  desc.layout.push_constant_bytes = sizeof(shared::ParticlePush);
  desc.constants = {{shared::kSpecParticleKind, kind},
                    {shared::kSpecParticleMultiview, view_mask != 0}};
  if (shafts) desc.constants.push_back({shared::kSpecParticleCascades, shafts->cascade_count});
  desc.color_formats = {kHdrFormat};
  desc.depth_format = kDepthFormat;
  desc.depth_write = false;
  desc.blend = gpu::Blend::kAlphaOver;
  desc.view_mask = view_mask;
  NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  return {};
}

Result<graph::ImageHandle> WaterPasses::declare_particles(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    const GBuffer& gbuffer, const ViewSet& views, const shared::Lighting& lighting,
    const ViewParticles& seen, float shutter, const ShaftInputs* shafts) {
  if (shafts && !tile_sampler_.handle()) {
    NERITIC_TRY(tile_sampler_,
                gpu::Sampler::create(device_, {.name = "particles' net", .mipmapped = false}));
  }
  const std::vector<std::uint32_t> masks = view_masks_of(gbuffer.layers, device_);
  for (const std::uint32_t mask : masks)
    for (const std::uint32_t kind : seen.kinds)
      NERITIC_TRY_STATUS(make_particle_pipeline(mask, kind, shafts));
  const std::vector<shared::Particle>& particles = seen.particles;
  if (particles.empty()) return hdr;
  const std::vector<Run> runs = runs_of(particles);
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
          for (const graph::ImageHandle image : shaft_images(*shafts, gbuffer))
            builder.read(image, graph::Access::kSampledVertex);
      },
      [this, masks, gbuffer, lighting, shutter, runs, &views, &particles,
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
                                   depth_layout),
            bound_slice(shared::kParticleStream,
                        commands.upload(std::span<const shared::Particle>(particles)))};
        const ShaftInputs* const lit = inputs ? &*inputs : nullptr;
        if (lit) {
          const auto [cascades, caustics] = shaft_images(*lit, gbuffer);
          set0.push_back(
              bound_slice(shared::kParticleSun, commands.upload(&lit->sun, sizeof lit->sun)));
          set0.push_back(
              gpu::bound_texel_image(shared::kParticleCascades, context.image(cascades).view(),
                                     graph::access_info(graph::Access::kSampledVertex).layout));
          set0.push_back(gpu::bound_texture(
              shared::kParticleCaustics, context.image(caustics).view(), tile_sampler_.handle()));
        }
        const VkRenderingAttachmentInfo color =
            attachment(context.image(data.hdr), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD);
        VkRenderingAttachmentInfo depth =
            attachment(context.image(gbuffer.depth), depth_layout, VK_ATTACHMENT_LOAD_OP_LOAD);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;
        const shared::ParticlePush push{Vec2f(gbuffer.width, gbuffer.height), shutter};
        for (const std::uint32_t mask : masks) {
          begin_rendering(context.cmd(), gbuffer, mask, std::span(&color, 1), depth);
          vkCmdSetCullMode(context.cmd(), VK_CULL_MODE_NONE);
          vkCmdSetFrontFace(context.cmd(), VK_FRONT_FACE_COUNTER_CLOCKWISE);
          for (const Run& run : runs) {
            const gpu::Pipeline& pipeline = particles_.at(pipeline_key(mask, run.kind, lit));
            commands.bind_pipeline(pipeline);
            commands.bind(pipeline, set0);
            commands.push(pipeline, push);
            vkCmdDraw(context.cmd(), 3 * run.count, 1, 3 * run.first, 0);
          }
          vkCmdEndRendering(context.cmd());
        }
      });
  return pass.hdr;
}

}  // namespace neritic::render
