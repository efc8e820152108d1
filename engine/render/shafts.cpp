// Renderer: light shafts, the sun's light that water scatters through waves and past solids.
#include "shared/shafts.h"

#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

constexpr VkFormat kShaftFormat = VK_FORMAT_R32_SFLOAT;  // shaders/shared/shaft_texel.glsl
static_assert(gpu::is_needed(kShaftFormat, gpu::kTexture | gpu::kStorageImage));
constexpr auto kShaftTexels = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
               kShaftUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
               kShaftStorage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

}  // namespace

Result<graph::ImageHandle> Renderer::declare_shafts(graph::FrameGraph& graph,
                                                    const std::string& prefix,
                                                    const GBuffer& gbuffer, const ViewSet& views,
                                                    const shared::Lighting& lighting,
                                                    const ShaftInputs& inputs) {
  gpu::Pipeline& pipeline = shafts_[{lighting.terms, inputs.cascade_count, inputs.samples}];
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "shafts";
    desc.code = shaders::kShaftsComp;
    desc.layout.bindings = {{shared::kShaftViews, kShaftUniform},
                            {shared::kShaftLighting, kShaftUniform},
                            {shared::kShaftVisibility, kShaftUniform},
                            {shared::kShaftData, kShaftUniform},
                            {shared::kShaftDepth, kShaftTexels},
                            {shared::kShaftCascades, kShaftTexels},
                            {shared::kShaftCaustics, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER},
                            {shared::kShaftOut, kShaftStorage}};
    desc.constants = {{shared::kSpecShaftTerms, lighting.terms},
                      {shared::kSpecShaftCascades, inputs.cascade_count},
                      {shared::kSpecShaftSamples, inputs.samples}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  if (!shafts_blur_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "shafts blur";
    desc.code = shaders::kShaftsBlurComp;
    desc.layout.bindings = {{shared::kShaftBlurIn, kShaftTexels},
                            {shared::kShaftBlurOut, kShaftStorage}};
    NERITIC_TRY(shafts_blur_, gpu::Pipeline::create(device_, desc));
  }
  const std::uint32_t width = (gbuffer.width + shared::kShaftStep - 1) / shared::kShaftStep,
                      height = (gbuffer.height + shared::kShaftStep - 1) / shared::kShaftStep;
  struct Data {
    graph::ImageHandle out;
  };
  const Data& taken = graph.add_pass<Data>(
      prefix + "shafts",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms("light shafts");
        for (const graph::ImageHandle handle :
             {gbuffer.depth, gbuffer.normal, inputs.cascades, inputs.caustics})
          if (handle) builder.read(handle, graph::Access::kSampledCompute);
        data.out =
            builder.write(builder.create_image(prefix + "shaft samples",
                                               {kShaftFormat, width, height, gbuffer.layers}),
                          graph::Access::kStorageWriteCompute);
      },
      [this, &pipeline, gbuffer, inputs, lighting, width, height, &views](
          const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        // The shader's constants keep it from reading what is bound in the place of others.
        const auto image = [&](graph::ImageHandle handle, graph::ImageHandle other) {
          return context.image(handle ? handle : other).view();
        };
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {bound_slice(shared::kShaftViews,
                         commands.upload(std::span<const shared::View>(gpu_views(views)))),
             bound_slice(shared::kShaftLighting, commands.upload(&lighting, sizeof lighting)),
             bound_slice(shared::kShaftVisibility, commands.upload(&inputs.sun, sizeof inputs.sun)),
             bound_slice(shared::kShaftData, commands.upload(&inputs.params, sizeof inputs.params)),
             gpu::bound_texel_image(shared::kShaftDepth, image(gbuffer.depth, gbuffer.depth)),
             gpu::bound_texel_image(shared::kShaftCascades, image(inputs.cascades, gbuffer.depth)),
             gpu::bound_texture(shared::kShaftCaustics, image(inputs.caustics, gbuffer.normal),
                                tile_sampler_.handle()),
             gpu::bound_storage_image(shared::kShaftOut, context.image(data.out).view())});
        commands.dispatch(groups(width), groups(height), gbuffer.layers);
      });
  const Data& blurred = graph.add_pass<Data>(
      prefix + "shafts blur",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(taken.out, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + "shafts", {kShaftFormat, width, height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
      },
      [this, in = taken.out, width, height, layers = gbuffer.layers](const Data& data,
                                                                     graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(shafts_blur_);
        commands.bind(
            shafts_blur_,
            {gpu::bound_texel_image(shared::kShaftBlurIn, context.image(in).view()),
             gpu::bound_storage_image(shared::kShaftBlurOut, context.image(data.out).view())});
        commands.dispatch(groups(width), groups(height), layers);
      });
  return blurred.out;
}

}  // namespace neritic::render
