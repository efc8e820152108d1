// Renderer: how much of the light from above gets past what stands still.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"
#include "shared/skylight.h"

namespace neritic::render {

Result<graph::ImageHandle> Renderer::declare_skylight(graph::FrameGraph& graph,
                                                      const std::string& prefix,
                                                      const GBuffer& gbuffer, const ViewSet& views,
                                                      const shared::Lighting& lighting,
                                                      const SkylightInputs& inputs) {
  constexpr auto kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                 kTexels = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE;
  gpu::Pipeline& pipeline = skylight_[{lighting.terms, inputs.samples}];
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "skylight";
    desc.code = shaders::kSkylightComp;
    desc.layout.bindings = {{shared::kSkylightViews, kUniform},
                            {shared::kSkylightLighting, kUniform},
                            {shared::kSkylightParams, kUniform},
                            {shared::kSkylightDepth, kTexels},
                            {shared::kSkylightNormal, kTexels},
                            {shared::kSkylightGrid, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {shared::kSkylightOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    desc.constants = {{shared::kSpecSkylightTerms, lighting.terms},
                      {shared::kSpecSkylightSamples, inputs.samples}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  const std::uint32_t width = (gbuffer.width + shared::kSkylightStep - 1) / shared::kSkylightStep,
                      height = (gbuffer.height + shared::kSkylightStep - 1) / shared::kSkylightStep;
  struct Data {
    graph::ImageHandle out;
  };
  const Data& taken = graph.add_pass<Data>(
      prefix + "skylight",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms("skylight");
        builder.read(gbuffer.depth, graph::Access::kSampledCompute);
        builder.read(gbuffer.normal, graph::Access::kSampledCompute);
        data.out =
            builder.write(builder.create_image(prefix + "skylight samples",
                                               {kColorFormat, width, height, gbuffer.layers}),
                          graph::Access::kStorageWriteCompute);
      },
      [&pipeline, gbuffer, inputs, lighting, width, height, &views](const Data& data,
                                                                    graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {bound_slice(shared::kSkylightViews,
                         commands.upload(std::span<const shared::View>(gpu_views(views)))),
             bound_slice(shared::kSkylightLighting, commands.upload(&lighting, sizeof lighting)),
             bound_slice(shared::kSkylightParams,
                         commands.upload(&inputs.params, sizeof inputs.params)),
             gpu::bound_texel_image(shared::kSkylightDepth, context.image(gbuffer.depth).view()),
             gpu::bound_texel_image(shared::kSkylightNormal, context.image(gbuffer.normal).view()),
             gpu::bound_buffer(shared::kSkylightGrid, inputs.grid->handle()),
             gpu::bound_storage_image(shared::kSkylightOut, context.image(data.out).view())});
        commands.dispatch(groups(width), groups(height), gbuffer.layers);
      });
  return declare_visibility_blur(graph, prefix + "skylight", taken.out, width, height,
                                 gbuffer.layers);
}

}  // namespace neritic::render
