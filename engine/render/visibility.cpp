// Renderer: which share of sun, sky and surroundings surfaces see.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

constexpr auto kTexels = VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE,
               kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
               kStorageImage = VK_DESCRIPTOR_TYPE_STORAGE_IMAGE;

}  // namespace

Result<graph::ImageHandle> Renderer::declare_visibility(
    graph::FrameGraph& graph, const std::string& prefix, const GBuffer& gbuffer,
    const ViewSet& views, const shared::VisibilityParams& params, graph::ImageHandle cascades,
    const VisibilityKnobs& knobs) {
  gpu::Pipeline& pipeline = visibility_[knobs];
  const std::uint32_t scale = knobs.step;
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "visibility";
    desc.code = shaders::kVisibilityComp;
    desc.layout.bindings = {
        {shared::kVisibilityViews, kUniform},   {shared::kVisibilityParams, kUniform},
        {shared::kVisibilityDepth, kTexels},    {shared::kVisibilityNormal, kTexels},
        {shared::kVisibilityCascades, kTexels}, {shared::kVisibilityOut, kStorageImage}};
    desc.constants = {{shared::kSpecCascades, knobs.cascades},
                      {shared::kSpecOcclusionTaps, knobs.occlusion_taps},
                      {shared::kSpecVisibilityScale, scale},
                      {shared::kSpecShadowTaps, knobs.shadow_samples}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  const std::uint32_t width = (gbuffer.width + scale - 1) / scale,
                      height = (gbuffer.height + scale - 1) / scale;
  struct Data {
    graph::ImageHandle out;
  };
  const Data& taps = graph.add_pass<Data>(
      prefix + "visibility",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(fmt::format("{}{}{}", knobs.cascades ? "sun shadows" : "",
                                  knobs.cascades && knobs.occlusion_taps ? ", " : "",
                                  knobs.occlusion_taps ? "ambient occlusion" : ""));
        for (const graph::ImageHandle handle : {gbuffer.depth, gbuffer.normal, cascades})
          if (handle) builder.read(handle, graph::Access::kSampledCompute);
        data.out =
            builder.write(builder.create_image(prefix + "visibility taps",
                                               {kColorFormat, width, height, gbuffer.layers}),
                          graph::Access::kStorageWriteCompute);
      },
      [&pipeline, gbuffer, params, cascades, width, height, &views](const Data& data,
                                                                    graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const auto texels = [&](std::uint32_t binding, graph::ImageHandle handle) {
          return gpu::bound_texel_image(binding, context.image(handle).view());
        };
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {bound_slice(shared::kVisibilityViews,
                         commands.upload(std::span<const shared::View>(gpu_views(views)))),
             bound_slice(shared::kVisibilityParams, commands.upload(&params, sizeof params)),
             texels(shared::kVisibilityDepth, gbuffer.depth),
             texels(shared::kVisibilityNormal, gbuffer.normal),
             texels(shared::kVisibilityCascades, cascades ? cascades : gbuffer.depth),
             gpu::bound_storage_image(shared::kVisibilityOut, context.image(data.out).view())});
        commands.dispatch(groups(width), groups(height), gbuffer.layers);
      });
  return declare_visibility_blur(graph, prefix + "visibility", taps.out, width, height,
                                 gbuffer.layers);
}

Result<graph::ImageHandle> Renderer::declare_visibility_blur(
    graph::FrameGraph& graph, const std::string& name, graph::ImageHandle in, std::uint32_t width,
    std::uint32_t height, std::uint32_t layers) {
  if (!visibility_blur_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "visibility blur";
    desc.code = shaders::kVisibilityBlurComp;
    desc.layout.bindings = {{shared::kVisibilityBlurIn, kTexels},
                            {shared::kVisibilityBlurOut, kStorageImage}};
    NERITIC_TRY(visibility_blur_, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& blurred = graph.add_pass<Data>(
      name + " blur",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(in, graph::Access::kSampledCompute);
        data.out = builder.write(builder.create_image(name, {kColorFormat, width, height, layers}),
                                 graph::Access::kStorageWriteCompute);
      },
      [this, in, width, height, layers](const Data& data, graph::PassContext& context) {
        context.commands.bind_pipeline(visibility_blur_);
        context.commands.bind(
            visibility_blur_,
            {gpu::bound_texel_image(shared::kVisibilityBlurIn, context.image(in).view()),
             gpu::bound_storage_image(shared::kVisibilityBlurOut, context.image(data.out).view())});
        constexpr std::uint32_t kBlock = shared::kVisibilityBlurBlock;
        context.commands.dispatch(groups((width + kBlock - 1) / kBlock),
                                  groups((height + kBlock - 1) / kBlock), layers);
      });
  return blurred.out;
}

}  // namespace neritic::render
