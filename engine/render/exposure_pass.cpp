// Renderer: depth of field, motion blur and rolling shutter, between the shaded picture and the
// lens.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {

static_assert(gpu::is_needed(kMotionFormat, gpu::kTexture));

namespace {

constexpr VkFormat kTileFormat = VK_FORMAT_R32G32B32A32_SFLOAT;  // two motions
static_assert(gpu::is_needed(kTileFormat, gpu::kTexture | gpu::kStorageImage));

}  // namespace

template <class Params>
Result<graph::ImageHandle> Renderer::declare_exposure(graph::FrameGraph& graph,
                                                      const std::string& prefix,
                                                      const ExposurePass& exposure,
                                                      gpu::Pipeline& pipeline,
                                                      const Params& params) {
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = exposure.name;
    desc.code = exposure.code;
    for (const auto& [binding, image] : exposure.reads)
      desc.layout.bindings.push_back({binding, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE});
    desc.layout.bindings.push_back({shared::kExposureOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
    desc.layout.bindings.push_back({shared::kExposureData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER});
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + exposure.name,
      [&](graph::PassBuilder& builder, Data& data) {
        for (const auto& [binding, image] : exposure.reads)
          builder.read(image, graph::Access::kSampledCompute);
        data.out = builder.write(builder.create_image(prefix + exposure.result, exposure.out),
                                 graph::Access::kStorageWriteCompute);
      },
      [&pipeline, reads = exposure.reads, params, width = exposure.width, height = exposure.height,
       layers = exposure.out.layers](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        std::vector<gpu::BoundResource> bound;
        for (const auto& [binding, image] : reads)
          bound.push_back(gpu::bound_texel_image(binding, context.image(image).view()));
        bound.push_back(
            gpu::bound_storage_image(shared::kExposureOut, context.image(data.out).view()));
        bound.push_back(
            bound_slice(shared::kExposureData, commands.upload(&params, sizeof params)));
        commands.bind_pipeline(pipeline);
        commands.bind(pipeline, bound);
        commands.dispatch(groups(width), groups(height), layers);
      });
  return pass.out;
}

Result<graph::ImageHandle> Renderer::declare_focus(graph::FrameGraph& graph,
                                                   const std::string& prefix,
                                                   graph::ImageHandle hdr, const GBuffer& gbuffer,
                                                   const shared::FocusParams& params) {
  return declare_exposure(
      graph, prefix,
      {.name = "focus",
       .result = "focussed hdr",
       .code = shaders::kFocusComp,
       .reads = {{shared::kExposureHdr, hdr}, {shared::kExposureDepth, gbuffer.depth}},
       .out = {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers},
       .width = gbuffer.width,
       .height = gbuffer.height},
      focus_, params);
}

Result<graph::ImageHandle> Renderer::declare_shutter(graph::FrameGraph& graph,
                                                     const std::string& prefix,
                                                     graph::ImageHandle hdr, const GBuffer& gbuffer,
                                                     const shared::ShutterParams& given) {
  shared::ShutterParams params = given;
  params.tiles = Vec2f(gbuffer.width, gbuffer.height) / float(shared::kShutterTile);
  const auto tiles_along = [](std::uint32_t size) {
    return (size + shared::kShutterTile - 1) / shared::kShutterTile;
  };
  const std::uint32_t wide = tiles_along(gbuffer.width), high = tiles_along(gbuffer.height);
  NERITIC_TRY(const graph::ImageHandle tiles,
              declare_exposure(graph, prefix,
                               {.name = "shutter tiles",
                                .result = "tile motions",
                                .code = shaders::kShutterTilesComp,
                                .reads = {{shared::kExposureMotion, gbuffer.motion}},
                                .out = {kTileFormat, wide, high, gbuffer.layers},
                                .width = wide,
                                .height = high},
                               shutter_tiles_, params));
  NERITIC_TRY(const graph::ImageHandle reach,
              declare_exposure(graph, prefix,
                               {.name = "shutter reach",
                                .result = "motions that pass",
                                .code = shaders::kShutterReachComp,
                                .reads = {{shared::kExposureTiles, tiles}},
                                .out = {kTileFormat, 2 * wide, high, gbuffer.layers},
                                .width = wide,
                                .height = high},
                               shutter_reach_, params));
  return declare_exposure(graph, prefix,
                          {.name = "shutter",
                           .result = "exposed hdr",
                           .code = shaders::kShutterComp,
                           .reads = {{shared::kExposureHdr, hdr},
                                     {shared::kExposureMotion, gbuffer.motion},
                                     {shared::kExposureDepth, gbuffer.depth},
                                     {shared::kExposureTiles, reach}},
                           .out = {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers},
                           .width = gbuffer.width,
                           .height = gbuffer.height},
                          shutter_, params);
}

}  // namespace neritic::render
