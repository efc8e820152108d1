// Renderer: the G-buffer, in one pass or two. Glowing surfaces are drawn last, by a pass of their
// own that writes the emission image, so that triangles that do not glow do not pay for it.
#include "engine/core/check.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"

namespace neritic::render {

void Renderer::record_gbuffer(const GBuffer& g, GBufferLoads loads,
                              std::span<const MaskedDraws> masked, const RasterInputs& in,
                              graph::PassContext& context) const {
  gpu::Commands& commands = context.commands;
  const bool moved = g.motion && in.deformed.next_positions;
  const gpu::BoundResource set0[] = {
      bound_slice(shared::kRasterViews,
                  commands.upload(std::span<const shared::View>(gpu_views(in.views)))),
      gpu::bound_buffer(
          shared::kRasterNextPositions,
          moved ? context.buffer(in.deformed.next_positions).handle() : nothing_.handle())};
  std::vector<VkRenderingAttachmentInfo> colors;
  const auto add = [&](graph::ImageHandle handle, VkAttachmentLoadOp op) {
    if (handle)
      colors.push_back(
          attachment(context.image(handle), VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, op));
  };
  // The stages write to the first two by number: what is not kept leaves its place empty.
  for (const graph::ImageHandle handle : {g.normal, g.label}) {
    if (!handle) colors.push_back({VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO});
    add(handle, loads.colors);
  }
  for (const graph::ImageHandle handle : {g.albedo, g.material}) add(handle, loads.colors);
  add(g.emissive, VK_ATTACHMENT_LOAD_OP_CLEAR);
  add(g.motion, loads.colors);
  const VkRenderingAttachmentInfo depth = attachment(
      context.image(g.depth), VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL, loads.depth);
  const auto instances = upload_instances(commands, in.draws, bool(g.motion));
  for (const MaskedDraws& m : masked) {
    begin_rendering(context.cmd(), g, m.view_mask, colors, depth);
    record_draws(m.prepared, in.scene,
                 in.deformed.positions ? &context.buffer(in.deformed.positions) : nullptr,
                 instances, Vec2f(g.width, g.height), set0, commands);
    vkCmdEndRendering(context.cmd());
  }
}

Result<GBuffer> Renderer::declare_gbuffer(graph::FrameGraph& graph, const std::string& prefix,
                                          GBufferKind kind, const GpuScene& scene,
                                          const FrameState& state, const DeformedGeometry& deformed,
                                          const ViewSet& views, const DrawList& draws,
                                          const GBufferParts& parts, FramePictures* pictures) {
  const bool surface = kind == GBufferKind::kSurface;
  NERITIC_CHECK(!surface || parts == GBufferParts{}, "{}shading needs all parts", prefix);
  const bool motion = kind != GBufferKind::kGeometry && state.motion;
  const std::uint32_t layers = views.layers();
  std::vector<MaskedDraws> masked, glowing;
  for (const std::uint32_t mask : view_masks_of(layers, device_)) {
    NERITIC_TRY(PreparedDraws prepared,
                prepare(scene, draws, draws.opaque, kind, false, motion, false, mask, parts, {}));
    // A sonar hears blended surfaces as solid ones; a camera draws them in the forward pass.
    // Glowing surfaces come last even if nothing of the glow is kept: the same pixels win.
    if (!surface) {
      const bool shape = kind == GBufferKind::kShape;
      NERITIC_TRY(PreparedDraws more, prepare(scene, draws, shape ? draws.opaque : draws.blended,
                                              kind, false, motion, shape, mask, parts, {}));
      prepared.draws.insert(prepared.draws.end(), more.draws.begin(), more.draws.end());
    }
    masked.push_back({mask, std::move(prepared)});
    if (!surface || !scene.has_emission()) continue;
    NERITIC_TRY(prepared,
                prepare(scene, draws, draws.opaque, kind, false, motion, true, mask, {}, {}));
    glowing.push_back({mask, std::move(prepared)});
  }
  NERITIC_TRY(const graph::ImageHandle hidden, declare_hidden(graph, prefix, views));
  const GBufferLoads first{VK_ATTACHMENT_LOAD_OP_CLEAR,
                           hidden ? VK_ATTACHMENT_LOAD_OP_LOAD : VK_ATTACHMENT_LOAD_OP_CLEAR};
  const RasterInputs inputs{scene, views, draws, deformed};
  const auto read_deformed = [&](graph::PassBuilder& builder) {
    if (deformed.positions) builder.read(deformed.positions, graph::Access::kVertexBuffer);
    if (motion && deformed.next_positions)
      builder.read(deformed.next_positions, graph::Access::kStorageReadVertex);
  };
  constexpr auto kColor = graph::Access::kColorAttachment, kDepth = graph::Access::kDepthAttachment;
  const GBuffer plain = graph.add_pass<GBuffer>(
      prefix + "gbuffer",
      [&](graph::PassBuilder& builder, GBuffer& g) {
        g.width = views.width;
        g.height = views.height;
        g.layers = layers;
        const auto target = [&](const char* name, VkFormat format, graph::Access access) {
          return builder.write(
              builder.create_image(prefix + name, {format, g.width, g.height, layers}), access);
        };
        g.depth = hidden ? builder.write(hidden, kDepth) : target("depth", kDepthFormat, kDepth);
        if (parts.normal) g.normal = target("normal", kNormalFormat, kColor);
        if (parts.label) g.label = target("label", kLabelFormat, kColor);
        if (surface) {
          g.albedo = target("albedo", kAlbedoFormat, kColor);
          g.material = target("material", kMaterialFormat, kColor);
        }
        if (motion) g.motion = target("motion", kMotionFormat, kColor);
        read_deformed(builder);
      },
      [this, inputs, first, masked = std::move(masked)](const GBuffer& g,
                                                        graph::PassContext& context) {
        record_gbuffer(g, first, masked, inputs, context);
      });
  if (glowing.empty()) return plain;
  const std::vector<graph::ImageHandle> shown = pictures_in(scene, draws.opaque, pictures);
  return graph.add_pass<GBuffer>(
      prefix + "emission",
      [&](graph::PassBuilder& builder, GBuffer& g) {
        g = plain;
        g.depth = builder.write(plain.depth, kDepth);
        for (graph::ImageHandle* image : {&g.normal, &g.label, &g.albedo, &g.material, &g.motion})
          if (*image) *image = builder.write(*image, kColor);
        g.emissive = builder.write(
            builder.create_image(prefix + "emissive", {kEmissiveFormat, g.width, g.height, layers}),
            kColor);
        for (const graph::ImageHandle image : shown)
          builder.read(image, graph::Access::kSampledFragment);
        read_deformed(builder);
      },
      [this, inputs, glowing = std::move(glowing)](const GBuffer& g, graph::PassContext& context) {
        record_gbuffer(g, {VK_ATTACHMENT_LOAD_OP_LOAD, VK_ATTACHMENT_LOAD_OP_LOAD}, glowing, inputs,
                       context);
      });
}

}  // namespace neritic::render
