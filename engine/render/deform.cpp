// Renderer: the deform pass, which skins and morphs on the GPU once a frame.
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

template <class T>
gpu::BoundResource uploaded(gpu::Commands& commands, std::uint32_t binding,
                            const std::vector<T>& values, const gpu::Buffer& nothing) {
  if (values.empty()) return gpu::bound_buffer(binding, nothing.handle());
  const gpu::UploadSlice slice = commands.upload(std::span<const T>(values));
  return gpu::bound_buffer(binding, slice.buffer, slice.offset, slice.size);
}

// The deform pass writes one storage buffer, one dispatch per mesh.
Status check_deform(const gpu::Device& device, const FrameState& state) {
  const std::size_t bytes = state.deformed_vertices * sizeof(shared::VertexPosition);
  if (bytes > device.limits().maxStorageBufferRange)
    return failure(ErrorCode::kUnsupported,
                   "{} vertices of skinned or morphed objects take {} bytes; {} writes at most {}",
                   state.deformed_vertices, bytes, device.info().name,
                   device.limits().maxStorageBufferRange);
  const std::uint64_t most =
      std::uint64_t{device.limits().maxComputeWorkGroupCount[0]} * shared::kDeformGroup;
  for (const DeformJob& job : state.deforms)
    if (job.push.vertex_count > most)
      return failure(ErrorCode::kUnsupported,
                     "a skinned or morphed mesh of {} vertices; {} deforms at most {}",
                     job.push.vertex_count, device.info().name, most);
  return {};
}

}  // namespace

Result<DeformedGeometry> Renderer::declare_deform(graph::FrameGraph& graph, const GpuScene& scene,
                                                  const FrameState& state,
                                                  const std::vector<std::uint32_t>* need) {
  if (state.deforms.empty()) return DeformedGeometry{};
  NERITIC_TRY_STATUS(check_deform(device_, state));
  if (!deform_) {
    constexpr auto kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER;
    gpu::ComputePipelineDesc desc;
    desc.name = "deform";
    desc.code = shaders::kDeformComp;
    for (std::uint32_t b = shared::kDeformPositions; b <= shared::kDeformNextOut; ++b)
      desc.layout.bindings.push_back({b, kStorage});
    desc.layout.push_constant_bytes = sizeof(shared::DeformPush);
    NERITIC_TRY(deform_, gpu::Pipeline::create(device_, desc));
  }
  return graph.add_pass<DeformedGeometry>(
      "deform",
      [&](graph::PassBuilder& builder, DeformedGeometry& data) {
        data.positions = builder.create_buffer(
            "deformed positions", state.deformed_vertices * sizeof(shared::VertexPosition));
        data.positions = builder.write(data.positions, graph::Access::kStorageWriteCompute);
        if (!state.motion) return;
        data.next_positions =
            builder.create_buffer("next positions", state.deformed_vertices * sizeof(Vec3f));
        data.next_positions =
            builder.write(data.next_positions, graph::Access::kStorageWriteCompute);
      },
      [this, &scene, &state, need](const DeformedGeometry& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::BoundResource resources[] = {
            gpu::bound_buffer(shared::kDeformPositions, scene.positions().handle()),
            gpu::bound_buffer(shared::kDeformSkin, scene.skin().handle()),
            uploaded(commands, shared::kDeformJoints, state.joints, nothing_),
            gpu::bound_buffer(shared::kDeformMorphs, scene.morphs().handle()),
            uploaded(commands, shared::kDeformWeights, state.weights, nothing_),
            gpu::bound_buffer(shared::kDeformOut, context.buffer(data.positions).handle()),
            gpu::bound_buffer(shared::kDeformNextOut,
                              data.next_positions ? context.buffer(data.next_positions).handle()
                                                  : nowhere_.handle())};
        commands.bind_pipeline(deform_);
        commands.bind(deform_, resources);
        for (std::size_t i = 0; i < state.deforms.size(); ++i) {
          shared::DeformPush push = state.deforms[i].push;
          if (need) push.vertex_count = i < need->size() ? (*need)[i] : 0;
          if (push.vertex_count == 0) continue;
          commands.push(deform_, push);
          commands.dispatch((push.vertex_count + shared::kDeformGroup - 1) / shared::kDeformGroup);
        }
      });
}

}  // namespace neritic::render
