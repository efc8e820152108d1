// Renderer: the deform pass, the G-buffer pass and the forward pass.
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

VkRenderingAttachmentInfo attachment(const gpu::Image& image, VkImageLayout layout,
                                     VkAttachmentLoadOp load) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = image.view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

// With one layer multiview is off (mask 0): some devices draw plain views faster.
std::uint32_t view_mask_of(std::uint32_t layers) {
  return layers > 1 ? (1u << layers) - 1u : 0u;
}

// The view masks that a set of layers is drawn with, one rendering each: all at once, except on
// llvmpipe, which (Mesa 22.3) draws triangles that need clipping into the wrong view of a multiview
// rendering.
std::vector<std::uint32_t> view_masks_of(std::uint32_t layers, const gpu::Device& device) {
  if (layers == 1 || !device.info().driver.starts_with("llvmpipe")) return {view_mask_of(layers)};
  std::vector<std::uint32_t> masks;
  for (std::uint32_t i = 0; i < layers; ++i) masks.push_back(1u << i);
  return masks;
}

void begin_rendering(VkCommandBuffer cmd, const GBuffer& gbuffer, std::uint32_t view_mask,
                     std::span<const VkRenderingAttachmentInfo> colors,
                     const VkRenderingAttachmentInfo& depth) {
  VkRenderingInfo info{VK_STRUCTURE_TYPE_RENDERING_INFO};
  info.renderArea.extent = {gbuffer.width, gbuffer.height};
  info.layerCount = 1;
  info.viewMask = view_mask;
  info.colorAttachmentCount = static_cast<std::uint32_t>(colors.size());
  info.pColorAttachments = colors.data();
  info.pDepthAttachment = &depth;
  vkCmdBeginRendering(cmd, &info);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(gbuffer.width), static_cast<float>(gbuffer.height),
      0.0f, 1.0f};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetScissor(cmd, 0, 1, &info.renderArea);
}

gpu::BoundResource bound_slice(std::uint32_t binding, const gpu::UploadSlice& slice) {
  return gpu::bound_buffer(binding, slice.buffer, slice.offset, slice.size);
}

template <class T>
gpu::BoundResource uploaded(gpu::Commands& commands, std::uint32_t binding,
                            const std::vector<T>& values, const gpu::Buffer& nothing) {
  if (values.empty()) return gpu::bound_buffer(binding, nothing.handle());
  return bound_slice(binding, commands.upload(std::span<const T>(values)));
}

}  // namespace

Renderer::InstanceStreams Renderer::upload_instances(gpu::Commands& commands, const DrawList& draws,
                                                     bool motion) {
  const gpu::UploadSlice now = commands.upload(std::span<const shared::Instance>(draws.instances));
  if (!motion) return {now, now};
  return {now, commands.upload(std::span<const shared::NextInstance>(draws.next_instances))};
}

Result<DeformedGeometry> Renderer::declare_deform(graph::FrameGraph& graph, const GpuScene& scene,
                                                  const FrameState& state) {
  if (state.deforms.empty()) return DeformedGeometry{};
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
      [this, &scene, &state](const DeformedGeometry& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::BoundResource resources[] = {
            gpu::bound_buffer(shared::kDeformPositions, scene.positions().handle()),
            gpu::bound_buffer(shared::kDeformSkin, scene.skin().handle()),
            uploaded(commands, shared::kDeformJoints, state.joints, nothing_),
            gpu::bound_buffer(shared::kDeformMorphs, scene.morphs().handle()),
            uploaded(commands, shared::kDeformWeights, state.weights, nothing_),
            gpu::bound_buffer(shared::kDeformOut, context.buffer(data.positions).handle()),
            gpu::bound_buffer(
                shared::kDeformNextOut,
                // Without motion nothing is written there; a buffer of no other pass stands in.
                context.buffer(data.next_positions ? data.next_positions : data.positions)
                    .handle())};
        commands.bind_pipeline(deform_);
        commands.bind(deform_, resources);
        for (const DeformJob& job : state.deforms) {
          commands.push(deform_, job.push);
          commands.dispatch((job.push.vertex_count + shared::kDeformGroup - 1) /
                            shared::kDeformGroup);
        }
      });
}

Result<GBuffer> Renderer::declare_gbuffer(graph::FrameGraph& graph, const std::string& prefix,
                                          GBufferKind kind, const GpuScene& scene,
                                          const FrameState& state, const DeformedGeometry& deformed,
                                          const ViewSet& views, const DrawList& draws) {
  const bool surface = kind == GBufferKind::kSurface;
  const bool motion = surface && state.motion;
  const bool emissive = surface && scene.has_emission();
  const std::uint32_t layers = views.layers();
  std::vector<MaskedDraws> masked;
  for (const std::uint32_t mask : view_masks_of(layers, device_)) {
    NERITIC_TRY(PreparedDraws prepared,
                prepare(scene, draws.opaque, kind, false, motion, emissive, mask));
    // A sonar hears blended surfaces as solid ones; a camera draws them in the forward pass.
    if (!surface) {
      NERITIC_TRY(PreparedDraws more,
                  prepare(scene, draws.blended, kind, false, false, false, mask));
      prepared.draws.insert(prepared.draws.end(), more.draws.begin(), more.draws.end());
    }
    masked.push_back({mask, std::move(prepared)});
  }
  return graph.add_pass<GBuffer>(
      prefix + "gbuffer",
      [&](graph::PassBuilder& builder, GBuffer& g) {
        g.width = views.width;
        g.height = views.height;
        g.layers = layers;
        const auto target = [&](const char* name, VkFormat format, graph::Access access) {
          return builder.write(
              builder.create_image(prefix + name, {format, g.width, g.height, layers}), access);
        };
        g.depth = target("depth", kDepthFormat, graph::Access::kDepthAttachment);
        g.normal = target("normal", kNormalFormat, graph::Access::kColorAttachment);
        g.label = target("label", kLabelFormat, graph::Access::kColorAttachment);
        if (surface) {
          g.albedo = target("albedo", kAlbedoFormat, graph::Access::kColorAttachment);
          g.material = target("material", kMaterialFormat, graph::Access::kColorAttachment);
        }
        if (emissive)
          g.emissive = target("emissive", kEmissiveFormat, graph::Access::kColorAttachment);
        if (motion) g.motion = target("motion", kMotionFormat, graph::Access::kColorAttachment);
        if (deformed.positions) builder.read(deformed.positions, graph::Access::kVertexBuffer);
        if (motion && deformed.next_positions)
          builder.read(deformed.next_positions, graph::Access::kStorageReadVertex);
      },
      [this, motion, masked = std::move(masked), deformed, &scene, &views, &draws](
          const GBuffer& g, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::BoundResource set0[] = {
            bound_slice(shared::kRasterViews,
                        commands.upload(std::span<const shared::View>(gpu_views(views)))),
            gpu::bound_buffer(shared::kRasterNextPositions,
                              motion && deformed.next_positions
                                  ? context.buffer(deformed.next_positions).handle()
                                  : nothing_.handle())};
        constexpr auto kColor = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
        std::vector<VkRenderingAttachmentInfo> colors;
        for (const graph::ImageHandle handle :
             {g.normal, g.label, g.albedo, g.material, g.emissive, g.motion})
          if (handle)
            colors.push_back(
                attachment(context.image(handle), kColor, VK_ATTACHMENT_LOAD_OP_CLEAR));
        const VkRenderingAttachmentInfo depth =
            attachment(context.image(g.depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_CLEAR);
        const auto instances = upload_instances(commands, draws, motion);
        for (const MaskedDraws& m : masked) {
          begin_rendering(context.cmd(), g, m.view_mask, colors, depth);
          record_draws(m.prepared, scene,
                       deformed.positions ? &context.buffer(deformed.positions) : nullptr,
                       instances, Vec2f(g.width, g.height), set0, commands);
          vkCmdEndRendering(context.cmd());
        }
      });
}

Result<graph::ImageHandle> Renderer::declare_forward(
    graph::FrameGraph& graph, const std::string& prefix, graph::ImageHandle hdr,
    const GBuffer& gbuffer, const GpuScene& scene, const DeformedGeometry& deformed,
    const ViewSet& views, const DrawList& draws, const shared::Lighting& lighting) {
  if (draws.blended.empty()) return hdr;
  std::vector<MaskedDraws> masked;
  for (const std::uint32_t mask : view_masks_of(gbuffer.layers, device_)) {
    NERITIC_TRY(PreparedDraws prepared,
                prepare(scene, draws.blended, GBufferKind::kSurface, true, false, false, mask));
    masked.push_back({mask, std::move(prepared)});
  }
  struct Data {
    graph::ImageHandle hdr;
  };
  const Data& pass = graph.add_pass<Data>(
      prefix + "forward",
      [&](graph::PassBuilder& builder, Data& data) {
        data.hdr = builder.write(hdr, graph::Access::kColorAttachment);
        builder.read(gbuffer.depth, graph::Access::kDepthTest);
        if (deformed.positions) builder.read(deformed.positions, graph::Access::kVertexBuffer);
      },
      [this, gbuffer, masked = std::move(masked), deformed, lighting, &scene, &views, &draws](
          const Data& data, graph::PassContext& context) {
        gpu::Commands& commands = context.commands;
        const gpu::BoundResource set0[] = {
            bound_slice(shared::kRasterViews,
                        commands.upload(std::span<const shared::View>(gpu_views(views)))),
            gpu::bound_buffer(shared::kRasterNextPositions, nothing_.handle()),
            bound_slice(shared::kRasterLighting, commands.upload(&lighting, sizeof lighting))};
        const VkRenderingAttachmentInfo color =
            attachment(context.image(data.hdr), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL,
                       VK_ATTACHMENT_LOAD_OP_LOAD);
        VkRenderingAttachmentInfo depth = attachment(
            context.image(gbuffer.depth), graph::access_info(graph::Access::kDepthTest).layout,
            VK_ATTACHMENT_LOAD_OP_LOAD);
        depth.storeOp = VK_ATTACHMENT_STORE_OP_NONE;  // a store would count as a write
        const auto instances = upload_instances(commands, draws, false);
        for (const MaskedDraws& m : masked) {
          begin_rendering(context.cmd(), gbuffer, m.view_mask, std::span(&color, 1), depth);
          record_draws(m.prepared, scene,
                       deformed.positions ? &context.buffer(deformed.positions) : nullptr,
                       instances, Vec2f(gbuffer.width, gbuffer.height), set0, commands);
          vkCmdEndRendering(context.cmd());
        }
      });
  return pass.hdr;
}

}  // namespace neritic::render
