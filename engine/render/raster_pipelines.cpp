// Renderer: the graphics pipelines of the raster passes, made when first needed.
#include <bit>
#include <utility>

#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

// The positions of vertices, which a depth map reads alone.
gpu::VertexStream place_stream() {
  return {sizeof(shared::VertexPosition),
          {{0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(shared::VertexPosition, position)}},
          false};
}

gpu::VertexStream position_stream() {
  gpu::VertexStream stream = place_stream();
  stream.attributes.push_back(
      {1, VK_FORMAT_R16G16_SNORM, offsetof(shared::VertexPosition, normal)});
  return stream;
}

gpu::VertexStream surface_stream() {
  return {sizeof(shared::VertexSurface),
          {{2, VK_FORMAT_R32G32_SFLOAT, offsetof(shared::VertexSurface, uv0)},
           {3, VK_FORMAT_R32G32_SFLOAT, offsetof(shared::VertexSurface, uv1)},
           {4, VK_FORMAT_R32_UINT, offsetof(shared::VertexSurface, tangent)},
           {5, VK_FORMAT_R16G16B16A16_UNORM, offsetof(shared::VertexSurface, color_rg)}},
          false};
}

gpu::VertexStream placing_stream() {
  return {
      sizeof(shared::Instance),
      {{shared::kInstanceRow0, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row0)},
       {shared::kInstanceRow1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row1)},
       {shared::kInstanceRow2, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(shared::Instance, row2)}},
      true};
}

gpu::VertexStream instance_stream() {
  gpu::VertexStream stream = placing_stream();
  stream.attributes.push_back(
      {shared::kInstanceLabel, VK_FORMAT_R32G32_UINT, offsetof(shared::Instance, label)});
  return stream;
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

std::span<const std::uint32_t> gbuffer_fragment(bool shape, bool emissive, bool motion) {
  if (shape) return motion ? shaders::kGbufferShapeMotionFrag : shaders::kGbufferShapeFrag;
  if (emissive) return motion ? shaders::kGbufferEmissiveMotionFrag : shaders::kGbufferEmissiveFrag;
  return motion ? shaders::kGbufferMotionFrag : shaders::kGbufferFrag;
}

std::span<const std::uint32_t> vertex_code(bool plain, bool clipped, bool larger) {
  if (larger) return clipped ? shaders::kGeometryLargerClippedVert : shaders::kGeometryLargerVert;
  if (plain) return clipped ? shaders::kGeometryClippedVert : shaders::kGeometryVert;
  return clipped ? shaders::kGbufferClippedVert : shaders::kGbufferVert;
}

}  // namespace

Result<const gpu::Pipeline*> Renderer::raster_pipeline(const RasterKey& key) {
  if (const auto found = raster_.find(key); found != raster_.end()) return &found->second;
  const auto& [stage, topology, motion, emissive, clipped, view_mask, material_flags, parts,
               light] = key;
  const bool forward = stage == RasterStage::kForward;
  const bool shape = stage == RasterStage::kShape;
  const bool surface = shape || stage == RasterStage::kSurface;
  const bool depth = stage == RasterStage::kDepth;
  const bool plain = depth || stage == RasterStage::kGeometry;
  const bool tinted = forward && (material_flags & shared::kMaterialTransmissive) &&
                      device_.features().dualSrcBlend;
  gpu::GraphicsPipelineDesc desc;
  desc.name = depth                                   ? "depth"
              : plain                                 ? "geometry"
              : stage == RasterStage::kGeometryMasked ? "geometry masked"
              : shape                                 ? "gbuffer shape"
              : surface                               ? "gbuffer"
                                                      : "forward";
  desc.vertex_code = depth ? shaders::kDepthVert : vertex_code(plain, clipped, plain && motion);
  desc.fragment_code = depth     ? std::span<const std::uint32_t>()
                       : plain   ? shaders::kGeometryFrag
                       : surface ? gbuffer_fragment(shape, emissive, motion)
                       : tinted  ? shaders::kForwardTintedFrag
                       : forward ? shaders::kForwardFrag
                                 : shaders::kGeometryMaskedFrag;
  constexpr auto kStorage = VK_DESCRIPTOR_TYPE_STORAGE_BUFFER,
                 kUniform = VK_DESCRIPTOR_TYPE_UNIFORM_BUFFER;
  desc.layout.bindings = {{shared::kRasterViews, kUniform}};
  if (depth)
    desc.streams = {place_stream(), placing_stream()};
  else
    desc.streams = {position_stream(), instance_stream()};
  desc.constants = {{shared::kSpecMultiview, view_mask != 0}};
  // In a geometry pass "motion" means that some things are drawn larger than they are.
  if (plain && motion) desc.streams.push_back(next_instance_stream(true));
  if (!plain) {
    desc.layout.bindings.push_back({shared::kRasterNextPositions, kStorage});
    if (forward) desc.layout.bindings.push_back({shared::kRasterLighting, kUniform});
    desc.layout.other_sets = {&material_layout_};
    desc.layout.push_constant_bytes = sizeof(shared::RasterPush);
    desc.streams.push_back(surface_stream());
    desc.streams.push_back(next_instance_stream(motion));
    desc.constants.push_back({shared::kSpecMotion, motion});
    desc.constants.push_back({shared::kSpecMaterial, material_flags});
  }
  if (forward)
    desc.constants.insert(desc.constants.end(),
                          {{shared::kSpecForwardGlow, light.inscatter_samples},
                           {shared::kSpecForwardTerms, light.terms},
                           {shared::kSpecForwardLamps, light.lamps}});
  desc.topology = topology;
  desc.depth_format = kDepthFormat;
  desc.view_mask = view_mask;
  if (forward) {
    desc.color_formats = {kHdrFormat};
    desc.depth_write = false;
    desc.blend = tinted ? gpu::Blend::kTinted : gpu::Blend::kAlphaOver;
  } else {
    desc.color_formats = {parts.normal ? kNormalFormat : VK_FORMAT_UNDEFINED,
                          parts.label ? kLabelFormat : VK_FORMAT_UNDEFINED};
    if (surface && !shape)
      desc.color_formats.insert(desc.color_formats.end(), {kAlbedoFormat, kMaterialFormat});
    if (surface && emissive) desc.color_formats.push_back(kEmissiveFormat);
    if (surface && motion) desc.color_formats.push_back(kMotionFormat);
  }
  NERITIC_TRY(auto pipeline, gpu::Pipeline::create(device_, desc));
  return &raster_.emplace(key, std::move(pipeline)).first->second;
}

}  // namespace neritic::render
