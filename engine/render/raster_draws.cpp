// Renderer: draw lists with their pipelines looked up, and their recording.
#include "engine/render/raster_draws.hpp"

namespace neritic::render {
namespace {

VkPrimitiveTopology vk_topology(scene::Topology topology) {
  switch (topology) {
    case scene::Topology::kPoints:
      return VK_PRIMITIVE_TOPOLOGY_POINT_LIST;
    case scene::Topology::kLines:
      return VK_PRIMITIVE_TOPOLOGY_LINE_LIST;
    default:
      return VK_PRIMITIVE_TOPOLOGY_TRIANGLE_LIST;
  }
}

// With one layer multiview is off (mask 0): some devices draw plain views faster.
std::uint32_t view_mask_of(std::uint32_t layers) {
  return layers > 1 ? (1u << layers) - 1u : 0u;
}

}  // namespace

VkRenderingAttachmentInfo attachment(const gpu::Image& image, VkImageLayout layout,
                                     VkAttachmentLoadOp load) {
  VkRenderingAttachmentInfo info{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  info.imageView = image.view();
  info.imageLayout = layout;
  info.loadOp = load;
  info.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  return info;
}

std::vector<std::uint32_t> view_masks_of(std::uint32_t layers, const gpu::Device& device) {
  if (layers == 1 || !device.info().quirks.clips_into_wrong_view) return {view_mask_of(layers)};
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

Renderer::InstanceStreams Renderer::upload_instances(gpu::Commands& commands, const DrawList& draws,
                                                     bool motion) {
  const gpu::UploadSlice now = commands.upload(std::span<const shared::Instance>(draws.instances));
  const gpu::UploadSlice drawn =
      draws.drawn_instances.empty()
          ? now
          : commands.upload(std::span<const shared::NextInstance>(draws.drawn_instances));
  if (!motion) return {now, now, drawn};
  return {now, commands.upload(std::span<const shared::NextInstance>(draws.next_instances)), drawn};
}

std::vector<graph::ImageHandle> Renderer::pictures_in(const GpuScene& scene,
                                                      const std::vector<Draw>& draws,
                                                      FramePictures* pictures) {
  std::vector<graph::ImageHandle> out;
  if (!pictures) return out;
  for (const Draw& draw : draws) {
    const std::uint32_t picture = scene.materials()[draw.primitive->material].picture;
    if (picture != kNone) out.push_back(pictures->image(picture));
  }
  return out;
}

Result<Renderer::PreparedDraws> Renderer::prepare(const GpuScene& scene, const DrawList& list,
                                                  const std::vector<Draw>& draws, GBufferKind kind,
                                                  bool forward, bool motion, bool emissive,
                                                  std::uint32_t view_mask,
                                                  const GBufferParts& parts,
                                                  const ForwardLight& light) {
  PreparedDraws prepared;
  for (const Draw& draw : draws) {
    const GpuMaterial& material = scene.materials()[draw.primitive->material];
    const bool geometry = kind == GBufferKind::kGeometry;
    if (!geometry && !forward && material.emissive != emissive) continue;
    const bool larger = !list.drawn_instances.empty();
    RasterStage stage = forward                       ? RasterStage::kForward
                        : kind == GBufferKind::kShape ? RasterStage::kShape
                                                      : RasterStage::kSurface;
    if (geometry) stage = material.mask ? RasterStage::kGeometryMasked : RasterStage::kGeometry;
    const bool places = stage == RasterStage::kGeometry;
    if (places && !parts.normal && !parts.label && !larger && !list.clipped)
      stage = RasterStage::kDepth;
    NERITIC_TRY(
        const gpu::Pipeline* pipeline,
        raster_pipeline({stage, vk_topology(draw.primitive->topology), places ? larger : motion,
                         emissive && stage == RasterStage::kSurface, list.clipped, view_mask,
                         places ? 0u : material.flags, parts, light}));
    // A camera sees the sides that the material has. A sonar hears both sides of a sheet, but of a
    // solid with one side it needs no backs: see closed_surface.hpp.
    const bool both_sides = material.double_sided || (geometry && !draw.hides_back_faces);
    prepared.draws.push_back({draw,
                              std::span(list.ranges).subspan(draw.first_range, draw.range_count),
                              pipeline, places && larger, !places, both_sides, &material});
  }
  return prepared;
}

void Renderer::record_draws(const PreparedDraws& prepared, const GpuScene& scene,
                            const gpu::Buffer* deformed, const InstanceStreams& instances,
                            const Vec2f& target_size, std::span<const gpu::BoundResource> set0,
                            gpu::Commands& commands) {
  const VkCommandBuffer cmd = commands.handle();
  vkCmdBindIndexBuffer(cmd, scene.indices().handle(), 0, VK_INDEX_TYPE_UINT32);
  const gpu::Pipeline* bound = nullptr;
  for (const PreparedDraw& d : prepared.draws) {
    const GpuPrimitive& primitive = *d.draw.primitive;
    if (d.pipeline != bound) {
      bound = d.pipeline;
      commands.bind_pipeline(*bound);
      commands.bind(*bound, set0.first(bound->bindings().size()));
    }
    vkCmdSetCullMode(cmd, d.both_sides ? VK_CULL_MODE_NONE : VK_CULL_MODE_BACK_BIT);
    // Vulkan's y points down in clip space and the projection flips it, so glTF's counter-clockwise
    // front faces stay counter-clockwise as seen.
    vkCmdSetFrontFace(cmd,
                      d.draw.mirrored ? VK_FRONT_FACE_CLOCKWISE : VK_FRONT_FACE_COUNTER_CLOCKWISE);
    // Deformed vertices lie elsewhere than the surface stream's, so both are bound at their own
    // offsets.
    const bool own = d.draw.deformed == kNone;
    const VkBuffer third = d.larger ? instances.drawn.buffer : scene.surfaces().handle();
    const VkBuffer buffers[] = {own ? scene.positions().handle() : deformed->handle(),
                                instances.now.buffer, third, instances.next.buffer};
    const VkDeviceSize offsets[] = {
        (own ? primitive.first_vertex : d.draw.deformed) * sizeof(shared::VertexPosition),
        instances.now.offset,
        d.larger ? instances.drawn.offset : primitive.first_vertex * sizeof(shared::VertexSurface),
        instances.next.offset};
    vkCmdBindVertexBuffers(cmd, 0, d.surface ? 4 : d.larger ? 3 : 2, buffers, offsets);
    if (d.surface) {
      vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, bound->layout(), 1, 1,
                              &d.material->set, 0, nullptr);
      commands.push(*bound, shared::RasterPush{target_size});
    }
    for (const IndexRange& range : d.ranges)
      vkCmdDrawIndexed(cmd, range.index_count, d.draw.instance_count, range.first_index, 0,
                       d.draw.first_instance);
  }
}

}  // namespace neritic::render
