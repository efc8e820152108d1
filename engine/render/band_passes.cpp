// Renderer: pictures of a spectrum's bands (bands.hpp), before shading and after it.
#include "engine/core/check.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"
#include "shared/bands.h"

namespace neritic::render {

Result<GBuffer> Renderer::declare_band_albedo(graph::FrameGraph& graph, const std::string& prefix,
                                              const GBuffer& gbuffer, const Mat3& bands_from_rgb) {
  if (!band_albedo_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "band albedo";
    desc.code = shaders::kBandAlbedoComp;
    desc.layout.bindings = {{shared::kBandOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kBandData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER},
                            {shared::kBandIn, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE}};
    NERITIC_TRY(band_albedo_, gpu::Pipeline::create(device_, desc));
  }
  shared::BandParams params{};
  for (int row = 0; row < 3; ++row) params.rows[row] = Vec3f(glm::transpose(bands_from_rgb)[row]);
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "band albedo",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(gbuffer.albedo, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + "reflectance",
                                 {kAlbedoFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
      },
      [this, gbuffer, params](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(band_albedo_);
        commands.bind(
            band_albedo_,
            {gpu::bound_storage_image(shared::kBandOut, context.image(data.out).view()),
             bound_slice(shared::kBandData, commands.upload(&params, sizeof params)),
             gpu::bound_texel_image(shared::kBandIn, context.image(gbuffer.albedo).view())});
        commands.dispatch(groups(gbuffer.width), groups(gbuffer.height), gbuffer.layers);
      });
  GBuffer out = gbuffer;
  out.albedo = pass.out;
  return out;
}

Result<graph::ImageHandle> Renderer::declare_merge(graph::FrameGraph& graph,
                                                   const std::string& prefix,
                                                   const std::vector<graph::ImageHandle>& bands,
                                                   const std::vector<Mat3>& rgb_from_bands,
                                                   const GBuffer& gbuffer) {
  NERITIC_CHECK(bands.size() >= 3 && bands.size() <= shared::kMaxBandPictures &&
                    bands.size() == rgb_from_bands.size(),
                "{} pictures of bands, {} matrices", bands.size(), rgb_from_bands.size());
  const auto count = static_cast<std::uint32_t>(bands.size());
  gpu::Pipeline& pipeline = merge_[count];
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "merge bands";
    desc.code = shaders::kMergeBandsComp;
    desc.layout.bindings = {{shared::kBandOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kBandData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    for (std::uint32_t i = 0; i < shared::kMaxBandPictures; ++i)
      desc.layout.bindings.push_back({shared::kBandIn + i, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE});
    desc.constants = {{shared::kSpecBandPictures, count}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  shared::BandParams params{};
  for (std::uint32_t i = 0; i < count; ++i)
    for (int row = 0; row < 3; ++row)
      params.rows[3 * i + static_cast<std::uint32_t>(row)] =
          Vec3f(glm::transpose(rgb_from_bands[i])[row]);
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "merge bands",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.terms(fmt::format("{} bands", 3 * count));
        for (const graph::ImageHandle picture : bands)
          builder.read(picture, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + "joined hdr",
                                 {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
            graph::Access::kStorageWriteCompute);
      },
      [&pipeline, bands, params, gbuffer](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        std::vector<gpu::BoundResource> bound{
            gpu::bound_storage_image(shared::kBandOut, context.image(data.out).view()),
            bound_slice(shared::kBandData, commands.upload(&params, sizeof params))};
        // The shader's constant keeps it from reading what is bound in the place of others.
        for (std::uint32_t i = 0; i < shared::kMaxBandPictures; ++i)
          bound.push_back(gpu::bound_texel_image(
              shared::kBandIn + i,
              context.image(bands[std::min<std::size_t>(i, bands.size() - 1)]).view()));
        commands.bind_pipeline(pipeline);
        commands.bind(pipeline, bound);
        commands.dispatch(groups(gbuffer.width), groups(gbuffer.height), gbuffer.layers);
      });
  return pass.out;
}

}  // namespace neritic::render
