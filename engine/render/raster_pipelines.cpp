// Renderer: the graphics pipelines of the raster passes, made when first needed, and the recording
// of draws with them.
#include <bit>
#include <utility>

#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

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

gpu::VertexStream position_stream() {
  return {sizeof(shared::VertexPosition),
          {{0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::VertexPosition, position)},
           {1, VK_FORMAT_R16G16_SNORM, offsetof(shared::VertexPosition, normal)}},
          false};
}

gpu::VertexStream surface_stream() {
  return {sizeof(shared::VertexSurface),
          {{2, VK_FORMAT_R32G32_SFLOAT, offsetof(shared::VertexSurface, uv0)},
           {3, VK_FORMAT_R32G32_SFLOAT, offsetof(shared::VertexSurface, uv1)},
           {4, VK_FORMAT_R32_UINT, offsetof(shared::VertexSurface, tangent)},
           {5, VK_FORMAT_R8G8B8A8_UNORM, offsetof(shared::VertexSurface, color)}},
          false};
}

gpu::VertexStream instance_stream() {
  return {sizeof(shared::Instance),
          {{shared::kInstanceRow0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row0)},
           {shared::kInstanceRow1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row1)},
           {shared::kInstanceRow2, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row2)},
           {shared::kInstanceLabel, VK_FORMAT_R32G32_UINT, offsetof(shared::Instance, label)}},
          true};
}

// Bound in every pipeline of the full vertex stage, since it declares the inputs; what feeds it
// without motion is the instance stream again, unread.
gpu::VertexStream next_instance_stream(bool motion) {
  return {
      static_cast<std::uint32_t>(motion ? sizeof(shared::NextInstance) : sizeof(shared::Instance)),
      {{shared::kNextInstanceRow0, VK_FORMAT_R32G32B32A32_SFLOAT,
        offsetof(shared::NextInstance, row0)},
       {shared::kNextInstanceRow1, VK_FORMAT_R32G32B32A32_SFLOAT,
        offsetof(shared::NextInstance, row1)},
       {shared::kNextInstanceRow2, VK_FORMAT_R32G32B32A32_SFLOAT,
        offsetof(shared::NextInstance, row2)}},
      true};
}

std::span<const std::uint32_t> gbuffer_fragment(bool emissive, bool motion) {
  if (emissive) return motion ? shaders::kGbufferEmissiveMotionFrag : shaders::kGbufferEmissiveFrag;
  return motion ? shaders::kGbufferMotionFrag : shaders::kGbufferFrag;
}

}  // namespace

Result<const gpu::Pipeline*> Renderer::raster_pipeline(const RasterKey& key) {
  if (const auto found = raster_.find(key); found != raster_.end()) return &found->second;
  const auto& [stage, topology, motion, emissive, view_mask, material_flags] = key;
  const bool forward = stage == RasterStage::kForward;
  const bool surface = stage == RasterStage::kSurface || stage == RasterStage::kSurfaceMasked;
  const bool plain = stage == RasterStage::kGeometry;
  gpu::GraphicsPipelineDesc desc;
  desc.name = plain                                   ? "geometry"
              : stage == RasterStage::kGeometryMasked ? "geometry masked"
              : surface                               ? "gbuffer"
                                                      : "forward";
  desc.vertex_code = plain ? shaders::kGeometryVert : shaders::kGbufferVert;
  desc.fragment_code = plain     ? shaders::kGeometryFrag
                       : surface ? gbuffer_fragment(emissive, motion)
                       : forward ? shaders::kForwardFrag
                                 : shaders::kGeometryMaskedFrag;
  constexpr auto kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                 kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  desc.layout.bindings = {{shared::kRasterViews, kUniform}};
  desc.streams = {position_stream(), instance_stream()};
  desc.constants = {{shared::kSpecMultiview, view_mask != 0}};
  if (!plain) {
    desc.layout.bindings.push_back({shared::kRasterNextPositions, kStorage});
    if (forward) desc.layout.bindings.push_back({shared::kRasterLighting, kUniform});
    desc.layout.other_sets = {material_layout_.handle()};
    desc.layout.push_constant_bytes = sizeof(shared::RasterPush);
    desc.streams.push_back(surface_stream());
    desc.streams.push_back(next_instance_stream(motion));
    desc.constants.push_back({shared::kSpecMotion, motion});
    desc.constants.push_back({shared::kSpecMaterial, material_flags});
    if (surface)
      desc.constants.push_back({shared::kSpecMask, stage == RasterStage::kSurfaceMasked});
  }
  desc.topology = topology;
  desc.depth_format = kDepthFormat;
  desc.view_mask = view_mask;
  if (forward) {
    desc.color_formats = {kHdrFormat};
    desc.depth_write = false;
    desc.blend = gpu::Blend::kAlphaOver;
  } else {
    desc.color_formats = {kNormalFormat, kLabelFormat};
    if (surface)
      desc.color_formats.insert(desc.color_formats.end(), {kAlbedoFormat, kMaterialFormat});
    if (surface && emissive) desc.color_formats.push_back(kEmissiveFormat);
    if (surface && motion) desc.color_formats.push_back(kMotionFormat);
  }
  NERITIC_TRY(auto pipeline, gpu::Pipeline::create(device_, desc));
  return &raster_.emplace(key, std::move(pipeline)).first->second;
}

Result<Renderer::PreparedDraws> Renderer::prepare(const GpuScene& scene,
                                                  const std::vector<Draw>& draws, GBufferKind kind,
                                                  bool forward, bool motion, bool emissive,
                                                  std::uint32_t view_mask) {
  PreparedDraws prepared;
  for (const Draw& draw : draws) {
    const GpuMaterial& material = scene.materials()[draw.primitive->material];
    RasterStage stage = RasterStage::kForward;
    if (!forward && kind == GBufferKind::kGeometry)
      stage = material.mask ? RasterStage::kGeometryMasked : RasterStage::kGeometry;
    else if (!forward)
      stage = material.mask ? RasterStage::kSurfaceMasked : RasterStage::kSurface;
    NERITIC_TRY(
        const gpu::Pipeline* pipeline,
        raster_pipeline(
            {stage, vk_topology(draw.primitive->topology),
             motion && stage != RasterStage::kGeometry,
             emissive && (stage == RasterStage::kSurface || stage == RasterStage::kSurfaceMasked),
             view_mask, stage == RasterStage::kGeometry ? 0u : material.flags}));
    // A sonar hears both sides of a sheet; a camera culls as the material says.
    const bool both_sides = kind == GBufferKind::kGeometry || material.double_sided;
    prepared.draws.push_back(
        {draw, pipeline, stage != RasterStage::kGeometry, both_sides, &material});
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
    const VkBuffer buffers[] = {own ? scene.positions().handle() : deformed->handle(),
                                instances.now.buffer, scene.surfaces().handle(),
                                instances.next.buffer};
    const VkDeviceSize offsets[] = {
        (own ? primitive.first_vertex : d.draw.deformed) * sizeof(shared::VertexPosition),
        instances.now.offset, primitive.first_vertex * sizeof(shared::VertexSurface),
        instances.next.offset};
    vkCmdBindVertexBuffers(cmd, 0, d.surface ? 4 : 2, buffers, offsets);
    if (d.surface) {
      vkCmdBindDescriptorSets(cmd, VK_PIPELINE_BIND_POINT_GRAPHICS, bound->layout(), 1, 1,
                              &d.material->set, 0, nullptr);
      commands.push(*bound, shared::RasterPush{target_size});
    }
    vkCmdDrawIndexed(cmd, primitive.index_count, d.draw.instance_count, primitive.first_index, 0,
                     d.draw.first_instance);
  }
}

}  // namespace neritic::render
