// Renderer: creation, and the compute passes on the G-buffer: shade and tonemap.
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

constexpr std::uint32_t groups(std::uint32_t size) { return (size + shared::kShadeGroup - 1) / shared::kShadeGroup; }

}  // namespace

Result<std::unique_ptr<Renderer>> Renderer::create(gpu::Device& device) {
  std::unique_ptr<Renderer> renderer(new Renderer(device));
  NERITIC_TRY(renderer->material_layout_, create_material_layout(device));
  NERITIC_TRY(renderer->nothing_, gpu::Buffer::create(device, {"nothing", 256, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT}));
  return renderer;
}

Result<graph::ImageHandle> Renderer::declare_shade(graph::FrameGraph& graph, const std::string& prefix, const GBuffer& gbuffer,
                                                   const ViewSet& views, const shared::Lighting& lighting) {
  if (!shade_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "shade";
    desc.code = shaders::kShadeComp;
    desc.layout.bindings = {{shared::kShadeViews, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {shared::kShadeLighting, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER},
                            {shared::kShadeDepth, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeNormal, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeAlbedo, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeMaterial, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeEmissive, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kShadeHdr, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    NERITIC_TRY(shade_, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle hdr;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "shade",
      [&](graph::PassBuilder& builder, Data& data) {
        for (const graph::ImageHandle handle : {gbuffer.depth, gbuffer.normal, gbuffer.albedo, gbuffer.material, gbuffer.emissive})
          if (handle) builder.read(handle, graph::Access::kSampledCompute);
        data.hdr = builder.write(builder.create_image(prefix + "hdr", {kHdrFormat, gbuffer.width, gbuffer.height, gbuffer.layers}),
                                 graph::Access::kStorageWriteCompute);
      },
      [this, gbuffer, lighting, &views](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::UploadSlice view_data = commands.upload(std::span<const shared::View>(gpu_views(views)));
        const gpu::UploadSlice light_data = commands.upload(&lighting, sizeof lighting);
        const auto texels = [&](std::uint32_t binding, graph::ImageHandle handle) {
          return gpu::bound_texel_image(binding, context.image(handle).view());
        };
        commands.bind_pipeline(shade_);
        commands.bind(shade_, {gpu::bound_buffer(shared::kShadeViews, view_data.buffer, view_data.offset, view_data.size),
                               gpu::bound_buffer(shared::kShadeLighting, light_data.buffer, light_data.offset, light_data.size),
                               texels(shared::kShadeDepth, gbuffer.depth), texels(shared::kShadeNormal, gbuffer.normal),
                               texels(shared::kShadeAlbedo, gbuffer.albedo), texels(shared::kShadeMaterial, gbuffer.material),
                               // Without emission the shader's flag keeps it from reading what is bound here.
                               texels(shared::kShadeEmissive, gbuffer.emissive ? gbuffer.emissive : gbuffer.albedo),
                               gpu::bound_storage_image(shared::kShadeHdr, context.image(data.hdr).view())});
        commands.dispatch(groups(gbuffer.width), groups(gbuffer.height), gbuffer.layers);
      });
  return pass.hdr;
}

Result<graph::ImageHandle> Renderer::declare_tonemap(graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
                                                     std::uint32_t width, std::uint32_t height, std::uint32_t layers) {
  if (!tonemap_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "tonemap";
    desc.code = shaders::kTonemapComp;
    desc.layout.bindings = {{shared::kTonemapHdr, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kTonemapOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE}};
    NERITIC_TRY(tonemap_, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle color;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "tonemap",
      [&](graph::PassBuilder& builder, Data& data) {
        builder.read(hdr, graph::Access::kSampledCompute);
        data.color = builder.write(builder.create_image(prefix + "color", {kColorFormat, width, height, layers}),
                                   graph::Access::kStorageWriteCompute);
      },
      [this, hdr, width, height, layers](const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        commands.bind_pipeline(tonemap_);
        commands.bind(tonemap_, {gpu::bound_texel_image(shared::kTonemapHdr, context.image(hdr).view()),
                                 gpu::bound_storage_image(shared::kTonemapOut, context.image(data.color).view())});
        commands.dispatch(groups(width), groups(height), layers);
      });
  return pass.color;
}

}  // namespace neritic::render
