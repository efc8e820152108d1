// Renderer: the light that waves throw on levels below a tile of the surface.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
Result<graph::ImageHandle> Renderer::declare_caustics(graph::FrameGraph& graph,
                                                      const shared::CausticsParams& params,
                                                      const std::string& name) {
  constexpr auto kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER,
                 kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
  if (!caustics_) {
    gpu::ComputePipelineDesc desc;
    desc.name = "caustics";
    desc.code = shaders::kCausticsComp;
    desc.layout.bindings = {{shared::kCausticsParams, kUniform}, {shared::kCausticsSums, kStorage}};
    NERITIC_TRY(caustics_, gpu::Pipeline::create(device_, desc));
    desc.name = "caustics resolve";
    desc.code = shaders::kCausticsResolveComp;
    desc.layout.bindings.push_back({shared::kCausticsOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE});
    NERITIC_TRY(caustics_resolve_, gpu::Pipeline::create(device_, desc));
  }
  const std::uint32_t n = params.texels;
  struct Data {
    graph::BufferHandle sums;
    graph::ImageHandle out;
  };
  const Data& cleared = graph.add_pass<Data>(
      name + " clear",
      [&](graph::PassBuilder& builder, Data& data) {
        data.sums =
            builder.write(builder.create_buffer(name + " sums",
                                                std::uint64_t{4} * shared::kCausticLevels * n * n),
                          graph::Access::kTransferWrite);
      },
      [&params, n](const Data& data, graph::PassContext& context) {
        const VkDeviceSize level_bytes = VkDeviceSize{4} * n * n;
        vkCmdFillBuffer(context.cmd(), context.buffer(data.sums).handle(),
                        params.first_level * level_bytes,
                        (params.end_level - params.first_level) * level_bytes, 0);
      });
  const Data& thrown = graph.add_pass<Data>(
      name,
      [&](graph::PassBuilder& builder, Data& data) {
        data.sums = builder.write(cleared.sums, graph::Access::kStorageWriteCompute);
      },
      [this, &params, n](const Data& data, graph::PassContext& context) {
        context.commands.bind_pipeline(caustics_);
        context.commands.bind(
            caustics_,
            {bound_slice(shared::kCausticsParams, context.commands.upload(&params, sizeof params)),
             gpu::bound_buffer(shared::kCausticsSums, context.buffer(data.sums).handle())});
        context.commands.dispatch(groups(n), groups(n), 1);
      });
  const Data& resolved = graph.add_pass<Data>(
      name + " resolve",
      [&](graph::PassBuilder& builder, Data& data) {
        data.sums = thrown.sums;
        builder.read(thrown.sums, graph::Access::kStorageReadCompute);
        data.out =
            builder.write(builder.create_image(name, {kHdrFormat, n, n, shared::kCausticLayers}),
                          graph::Access::kStorageWriteCompute);
      },
      [this, &params, n](const Data& data, graph::PassContext& context) {
        context.commands.bind_pipeline(caustics_resolve_);
        context.commands.bind(
            caustics_resolve_,
            {bound_slice(shared::kCausticsParams, context.commands.upload(&params, sizeof params)),
             gpu::bound_buffer(shared::kCausticsSums, context.buffer(data.sums).handle()),
             gpu::bound_storage_image(shared::kCausticsOut, context.image(data.out).view())});
        // Layers of other levels are read by nobody.
        const std::uint32_t first = params.first_level / shared::kCausticLayerStep,
                            last = (params.end_level - 2) / shared::kCausticLayerStep;
        constexpr std::uint32_t kRows = shared::kCausticRows;
        context.commands.dispatch(groups(n), groups((n + kRows - 1) / kRows), last - first + 1);
      });
  return resolved.out;
}

}  // namespace neritic::render
