// Renderer: the camera pass, from a pinhole's exposed radiance to what a camera delivers.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {

Result<graph::ImageHandle> Renderer::declare_camera(graph::FrameGraph& graph,
                                                    const std::string& prefix,
                                                    graph::ImageHandle hdr,
                                                    const shared::CameraParams& params,
                                                    std::uint32_t terms, std::uint32_t width,
                                                    std::uint32_t height, std::uint32_t layers) {
  gpu::Pipeline& pipeline = camera_[terms];
  if (!pipeline) {
    gpu::ComputePipelineDesc desc;
    desc.name = "camera";
    desc.code = shaders::kCameraComp;
    desc.layout.bindings = {{shared::kCameraHdr, VK_DESCRIPTOR_TYPE_SAMPLED_IMAGE},
                            {shared::kCameraOut, VK_DESCRIPTOR_TYPE_STORAGE_IMAGE},
                            {shared::kCameraData, VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER}};
    desc.constants = {{shared::kSpecCameraTerms, terms}};
    NERITIC_TRY(pipeline, gpu::Pipeline::create(device_, desc));
  }
  struct Data {
    graph::ImageHandle out;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "camera",
      [&](graph::PassBuilder& builder, Data& data) {
        std::string names;
        for (const auto& [bit, name] : {std::pair{shared::kCameraLens, "lens"},
                                        std::pair{shared::kCameraVignette, "vignette"},
                                        std::pair{shared::kCameraNoise, "noise"},
                                        std::pair{shared::kCameraWhite, "white balance"}})
          if (terms & bit) names += (names.empty() ? "" : ", ") + std::string(name);
        builder.terms(names);
        builder.read(hdr, graph::Access::kSampledCompute);
        data.out = builder.write(
            builder.create_image(prefix + "camera hdr", {kHdrFormat, width, height, layers}),
            graph::Access::kStorageWriteCompute);
      },
      [&pipeline, hdr, params, width, height, layers](const Data& data,
                                                      graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::UploadSlice slice = commands.upload(&params, sizeof params);
        commands.bind_pipeline(pipeline);
        commands.bind(
            pipeline,
            {gpu::bound_texel_image(shared::kCameraHdr, context.image(hdr).view()),
             gpu::bound_storage_image(shared::kCameraOut, context.image(data.out).view()),
             gpu::bound_buffer(shared::kCameraData, slice.buffer, slice.offset, slice.size)});
        commands.dispatch(groups(width), groups(height), layers);
      });
  return pass.out;
}

}  // namespace neritic::render
