// Renderer: depth of field, motion blur and rolling shutter, between the shaded picture and the
// lens.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {

static_assert(gpu::is_needed(kMotionFormat, gpu::kTexture));

template <class Params>
Result<graph::ImageHandle> Renderer::declare_exposure(
    graph::FrameGraph& graph, const std::string& prefix, const PictureFilter& filter,
    gpu::Pipeline& pipeline, graph::ImageHandle hdr, graph::ImageHandle other,
    const GBuffer& gbuffer, const Params& params) {
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = filter.name;
    desc.code = filter.code;
    desc.layout.bindings = {{shared::kExposureHdr, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kExposureOther, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kExposureOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kExposureData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + filter.name,
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(hdr, graph::Access::kSampledCompute);
        builder.read(other, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + filter.result,
                                 {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
      },
      [&pipeline, hdr, other, params, width = gbuffer.width, height = gbuffer.height,
       layers = gbuffer.layers](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {gpu::bound_texel_image(shared::kExposureHdr, context.image(hdr).view()),
             gpu::bound_texel_image(shared::kExposureOther, context.image(other).view()),
             gpu::bound_storage_image(shared::kExposureOut, context.image(data.out).view()),
             bound_slice(shared::kExposureData, commands.upload(&params, sizeof params))});
        commands.dispatch(groups(width), groups(height), layers);
      });
  return pass.out;
}

Result<graph::ImageHandle> Renderer::declare_focus(graph::FrameGraph& graph,
                                                   const std::string& prefix,
                                                   graph::ImageHandle hdr, const GBuffer& gbuffer,
                                                   const shared::FocusParams& params) {
  return declare_exposure(graph, prefix, {"focus", "focussed hdr", shaders::kFocusComp, {}}, focus_,
                          hdr, gbuffer.depth, gbuffer, params);
}

Result<graph::ImageHandle> Renderer::declare_shutter(graph::FrameGraph& graph,
                                                     const std::string& prefix,
                                                     graph::ImageHandle hdr, const GBuffer& gbuffer,
                                                     const shared::ShutterParams& params) {
  return declare_exposure(graph, prefix, {"shutter", "exposed hdr", shaders::kShutterComp, {}},
                          shutter_, hdr, gbuffer.motion, gbuffer, params);
}

}  // namespace neritic::render
