// Renderer: what a headset's lenses cannot show is nearest of all in the depth before anything else
// is drawn, so that no surface there is shaded.
#include "shared/hidden.h"

#include <algorithm>

#include "engine/core/check.hpp"
#include "engine/render/raster_draws.hpp"
#include "engine/render/renderer.hpp"
#include "shaders.hpp"

namespace neritic::render {
namespace {

// Where a view has fewer corners than another, its others are one point outside of the picture.
const Vec2f kOutside(2.0f, 2.0f);

// As the shader reads them.
std::vector<Vec2f> corners_of(const ViewSet& views) {
  std::size_t most = 0;
  for (const ViewDesc& view : views.views) most = std::max(most, view.hidden.size());
  NERITIC_CHECK(most <= kMostHidden, "{} corners", most);
  std::vector<Vec2f> out(most * shared::kMaxViews, kOutside);
  for (std::size_t v = 0; v < views.views.size(); ++v) {
    const FrustumTangents& t = views.views[v].tangents;
    const auto& hidden = views.views[v].hidden;
    for (std::size_t i = 0; i < hidden.size(); ++i)
      out[i * shared::kMaxViews + v] =
          Vec2f(2.0 * (hidden[i].x - t.left) / (t.right - t.left) - 1.0,
                1.0 - 2.0 * (hidden[i].y - t.bottom) / (t.top - t.bottom));
  }
  return out;
}

struct Hidden {
  graph::ImageHandle depth;
};

}  // namespace

Result<const gpu::Pipeline*> Renderer::hidden_pipeline(std::uint32_t view_mask) {
  const auto found = hidden_pipelines_.find(view_mask);
  if (found != hidden_pipelines_.end()) return &found->second;
  gpu::GraphicsPipelineDesc desc;
  desc.name = fmt::format("hidden area, views {}", view_mask);
  desc.vertex_code = shaders::kHiddenVert;
  desc.layout.bindings = {{shared::kHiddenCorners, VK_DESCRIPTOR_TYPE_STORAGE_BUFFER}};
  desc.depth_format = kDepthFormat;
  desc.view_mask = view_mask;
  NERITIC_TRY(gpu::Pipeline pipeline, gpu::Pipeline::create(device_, desc));
  return &hidden_pipelines_.emplace(view_mask, std::move(pipeline)).first->second;
}

Result<graph::ImageHandle> Renderer::declare_hidden(graph::FrameGraph& graph,
                                                    const std::string& prefix,
                                                    const ViewSet& views) {
  std::vector<Vec2f> corners = corners_of(views);
  if (corners.empty()) return graph::ImageHandle{};
  struct Drawn {
    std::uint32_t view_mask;
    const gpu::Pipeline* pipeline;
  };
  std::vector<Drawn> drawn;
  for (const std::uint32_t mask : view_masks_of(views.layers(), device_)) {
    NERITIC_TRY(const gpu::Pipeline* const pipeline, hidden_pipeline(mask));
    drawn.push_back({mask, pipeline});
  }
  const GBuffer size{.width = views.width, .height = views.height, .layers = views.layers()};
  return graph
      .add_pass<Hidden>(
          prefix + "hidden",
          [&](graph::PassBuilder& builder, Hidden& data) {
            data.depth = builder.write(
                builder.create_image(prefix + "depth",
                                     {kDepthFormat, size.width, size.height, size.layers}),
                graph::Access::kDepthAttachment);
          },
          [size, drawn = std::move(drawn), corners = std::move(corners)](
              const Hidden& data, graph::PassContext& context) {
            const auto at = context.commands.upload(std::span<const Vec2f>(corners));
            for (const Drawn& one : drawn) {
              begin_rendering(context.cmd(), size, one.view_mask, {},
                              attachment(context.image(data.depth),
                                         VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
                                         VK_ATTACHMENT_LOAD_OP_CLEAR));
              vkCmdSetCullMode(context.cmd(), VK_CULL_MODE_NONE);
              vkCmdSetFrontFace(context.cmd(), VK_FRONT_FACE_COUNTER_CLOCKWISE);
              context.commands.bind_pipeline(*one.pipeline);
              context.commands.bind(*one.pipeline, {bound_slice(shared::kHiddenCorners, at)});
              vkCmdDraw(context.cmd(),
                        static_cast<std::uint32_t>(corners.size() / shared::kMaxViews), 1, 0, 0);
              vkCmdEndRendering(context.cmd());
            }
          })
      .depth;
}

}  // namespace neritic::render
