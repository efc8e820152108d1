#include "engine/xr/compositor.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/check.hpp"
#include "shaders.hpp"
#include "shared/panel.h"

namespace neritic::xr {
namespace {

using graph::Access;
using graph::ImageHandle;

// In front of the head; only panels that reach it are cut.
constexpr double kPanelNear_m = 0.01;

struct CopyData {
  ImageHandle from, to;
};

VkOffset3D far_corner(const gpu::ImageDesc& desc) {
  return {static_cast<std::int32_t>(desc.width), static_cast<std::int32_t>(desc.height), 1};
}

void record_blit(const gpu::Image& from, const gpu::Image& to, VkCommandBuffer cmd) {
  const gpu::ImageDesc &a = from.desc(), &b = to.desc();
  NERITIC_CHECK(a.layers == b.layers, "{} with {} layers to {} with {}", a.name, a.layers, b.name,
                b.layers);
  VkImageBlit region{};
  region.srcSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, a.layers};
  region.srcOffsets[1] = far_corner(a);
  region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, b.layers};
  region.dstOffsets[1] = far_corner(b);
  const bool same = a.width == b.width && a.height == b.height;
  vkCmdBlitImage(cmd, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(),
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region,
                 same ? VK_FILTER_NEAREST : VK_FILTER_LINEAR);
}

void record_depth_copy(const gpu::Image& from, const gpu::Image& to, VkCommandBuffer cmd) {
  const gpu::ImageDesc &a = from.desc(), &b = to.desc();
  NERITIC_CHECK(a.width <= b.width && a.height <= b.height && a.layers == b.layers,
                "depth {} of {}x{}x{} to {} of {}x{}x{}", a.name, a.width, a.height, a.layers,
                b.name, b.width, b.height, b.layers);
  VkImageCopy region{};
  region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_DEPTH_BIT, 0, 0, a.layers};
  region.extent = {a.width, a.height, 1};
  vkCmdCopyImage(cmd, from.handle(), VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, to.handle(),
                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
}

template <class RecordCopy>
ImageHandle add_copy(graph::FrameGraph& graph, const std::string& pass, ImageHandle from,
                     ImageHandle to, RecordCopy record) {
  return graph
      .add_pass<CopyData>(
          pass,
          [&](graph::PassBuilder& builder, CopyData& data) {
            data.from = from;
            builder.read(from, Access::kTransferRead);
            data.to = builder.write(to, Access::kTransferWrite);
          },
          [record](const CopyData& data, graph::PassContext& context) {
            record(context.image(data.from), context.image(data.to), context.cmd());
          })
      .to;
}

ImageHandle clear_image(graph::FrameGraph& graph, const std::string& pass, ImageHandle to) {
  struct Data {
    ImageHandle to;
  };
  return graph
      .add_pass<Data>(
          pass,
          [&](graph::PassBuilder& builder, Data& data) {
            data.to = builder.write(to, Access::kTransferWrite);
          },
          [](const Data& data, graph::PassContext& context) {
            const gpu::Image& image = context.image(data.to);
            const VkClearColorValue black{{0.0f, 0.0f, 0.0f, 1.0f}};
            const VkImageSubresourceRange all{VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0,
                                              image.desc().layers};
            vkCmdClearColorImage(context.cmd(), image.handle(),
                                 VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, &black, 1, &all);
          })
      .to;
}

using AllCorners = std::array<shared::PanelCorners, shared::kMaxPanelViews>;

// Clip coordinates of the panel in each view, computed in double.
AllCorners corners_of(const PanelLayer& panel, const ViewGroup& group,
                      const Pose& world_from_head) {
  AllCorners out{};
  for (std::size_t i = 0; i < group.views.size(); ++i) {
    const View& view = group.views[i];
    Pose view_from_panel = inverse(view.head_from_view);
    if (panel.lock == PanelLayer::Lock::kWorld)
      view_from_panel = view_from_panel * inverse(world_from_head);
    view_from_panel = view_from_panel * panel.pose;
    const Mat4 clip_from_panel =
        reversed_z_projection(view.tangents, kPanelNear_m) * to_matrix(view_from_panel);
    out[i] = {Vec4f(clip_from_panel[3]), Vec4f(clip_from_panel[0] * (0.5 * panel.size_m.x)),
              Vec4f(clip_from_panel[1] * (0.5 * panel.size_m.y)), Vec4f(0.0f)};
  }
  return out;
}

// Whether a panel fills the picture of the only view, to a hundredth of a pixel.
bool fills(const shared::PanelCorners& panel, const VkExtent2D& extent) {
  const float near =
      0.02f * panel.middle.w / static_cast<float>(std::max(extent.width, extent.height));
  const auto is = [near](const Vec4f& a, float x, float y, float w) {
    return std::abs(a.x - x) < near && std::abs(a.y - y) < near && std::abs(a.w - w) < near;
  };
  const float w = panel.middle.w;
  return w > 0.0f && is(panel.middle, 0.0f, 0.0f, w) && is(panel.right, w, 0.0f, 0.0f) &&
         is(panel.up, 0.0f, -w, 0.0f);
}

struct DrawnPanel {
  ImageHandle image;
  AllCorners corners;
  std::vector<PanelPart> parts;
};

struct PanelsData {
  ImageHandle target;
  std::vector<DrawnPanel> panels;
};

// texels: of panels that lie texel on pixel.
struct PanelPipelines {
  const gpu::Pipeline *filtered, *texels;
};

void record_panels(const PanelsData& data, const PanelPipelines& pipelines, VkSampler sampler,
                   std::uint32_t views, graph::PassContext& context) {
  const gpu::Image& image = context.image(data.target);
  VkRenderingAttachmentInfo color{VK_STRUCTURE_TYPE_RENDERING_ATTACHMENT_INFO};
  color.imageView = image.view();
  color.imageLayout = VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL;
  color.loadOp = VK_ATTACHMENT_LOAD_OP_LOAD;
  color.storeOp = VK_ATTACHMENT_STORE_OP_STORE;
  const VkExtent2D extent{image.desc().width, image.desc().height};
  VkRenderingInfo rendering{VK_STRUCTURE_TYPE_RENDERING_INFO};
  rendering.renderArea.extent = extent;
  rendering.layerCount = 1;
  rendering.viewMask = views > 1 ? (1u << views) - 1 : 0;
  rendering.colorAttachmentCount = 1;
  rendering.pColorAttachments = &color;
  const VkCommandBuffer cmd = context.cmd();
  vkCmdBeginRendering(cmd, &rendering);
  const VkViewport viewport{
      0.0f, 0.0f, static_cast<float>(extent.width), static_cast<float>(extent.height), 0.0f, 1.0f};
  const VkRect2D scissor{{0, 0}, extent};
  vkCmdSetViewport(cmd, 0, 1, &viewport);
  vkCmdSetScissor(cmd, 0, 1, &scissor);
  vkCmdSetCullMode(cmd, VK_CULL_MODE_NONE);
  vkCmdSetFrontFace(cmd, VK_FRONT_FACE_COUNTER_CLOCKWISE);
  for (const DrawnPanel& panel : data.panels) {
    const gpu::ImageDesc& desc = context.image(panel.image).desc();
    const bool texels = views == 1 && desc.width == extent.width && desc.height == extent.height &&
                        fills(panel.corners[0], extent);
    const gpu::Pipeline& pipeline = texels ? *pipelines.texels : *pipelines.filtered;
    context.commands.bind_pipeline(pipeline);
    for (const PanelPart& part : panel.parts) {
      AllCorners corners = panel.corners;
      for (shared::PanelCorners& view : corners)
        view.part = Vec4f(part.left, part.top, part.right, part.bottom);
      const gpu::UploadSlice slice =
          context.commands.upload(std::span<const shared::PanelCorners>(corners));
      context.commands.bind(
          pipeline,
          {gpu::bound_buffer(shared::kPanelCorners, slice.buffer, slice.offset, slice.size),
           gpu::bound_texture(shared::kPanelTexture, context.image(panel.image).view(), sampler)});
      vkCmdDraw(cmd, 4, 1, 0, 0);
    }
  }
  vkCmdEndRendering(cmd);
}

}  // namespace

ImageHandle copy_image(graph::FrameGraph& graph, const std::string& pass, ImageHandle from,
                       ImageHandle to) {
  return add_copy(graph, pass, from, to, record_blit);
}

ImageHandle copy_depth(graph::FrameGraph& graph, const std::string& pass, ImageHandle from,
                       ImageHandle to) {
  return add_copy(graph, pass, from, to, record_depth_copy);
}

const ProjectionLayer* projection_of(std::span<const Layer> layers, std::size_t group) {
  for (const Layer& layer : layers)
    if (const auto* projection = std::get_if<ProjectionLayer>(&layer);
        projection && projection->group == group)
      return projection;
  return nullptr;
}

std::optional<PanelCorner> texel_on_pixel(const PanelLayer& panel, const ViewGroup& group,
                                          const Pose& world_from_head, std::uint32_t width,
                                          std::uint32_t height) {
  if (group.views.size() != 1) return {};
  const shared::PanelCorners at = corners_of(panel, group, world_from_head)[0];
  const double w = at.middle.w;
  if (!(w > 0.0)) return {};
  constexpr double kNear_px = 0.01;
  const auto is = [](double a, double b) { return std::abs(a - b) < kNear_px; };
  // Half pictures to pixels.
  const double across = 0.5 * group.width / w, down = 0.5 * group.height / w;
  const bool straight = is(at.right.y * down, 0.0) && is(at.up.x * across, 0.0) &&
                        std::abs(at.right.w) < 1e-6 * w && std::abs(at.up.w) < 1e-6 * w;
  if (!straight || !is(2.0 * at.right.x * across, width) || !is(-2.0 * at.up.y * down, height))
    return {};
  const double left = (at.middle.x - at.right.x + w) * across,
               top = (at.middle.y + at.up.y + w) * down;
  if (!is(left, std::round(left)) || !is(top, std::round(top))) return {};
  return PanelCorner{static_cast<int>(std::lround(left)), static_cast<int>(std::lround(top))};
}

Result<std::unique_ptr<Compositor>> Compositor::create(gpu::Device& device, VkFormat format) {
  std::unique_ptr<Compositor> made(new Compositor(device, format));
  NERITIC_TRY(made->sampler_,
              gpu::Sampler::create(device, {.name = "display panels",
                                            .u = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                            .v = VK_SAMPLER_ADDRESS_MODE_CLAMP_TO_EDGE,
                                            .mipmapped = false}));
  return made;
}

Result<const gpu::Pipeline*> Compositor::pipeline_for(std::uint32_t views, bool texels) {
  const auto found = pipelines_.find({views, texels});
  if (found != pipelines_.end()) return &found->second;
  gpu::GraphicsPipelineDesc desc;
  desc.name = fmt::format("display panels, {} views", views);
  desc.vertex_code = shaders::kPanelVert;
  desc.fragment_code = shaders::kPanelFrag;
  desc.layout.bindings = {{shared::kPanelCorners},
                          {shared::kPanelTexture, VK_DESCRIPTOR_TYPE_COMBINED_IMAGE_SAMPLER}};
  desc.topology = VK_PRIMITIVE_TOPOLOGY_TRIANGLE_STRIP;
  desc.color_formats = {format_};
  desc.blend = gpu::Blend::kAlphaOver;
  desc.view_mask = views > 1 ? (1u << views) - 1 : 0;
  desc.constants = {{shared::kSpecPanelTexels, texels}};
  NERITIC_TRY(gpu::Pipeline pipeline, gpu::Pipeline::create(device_, desc));
  return &pipelines_.emplace(std::pair(views, texels), std::move(pipeline)).first->second;
}

Result<ImageHandle> Compositor::declare(graph::FrameGraph& graph, const std::string& name,
                                        ImageHandle target, const ViewGroup& group,
                                        std::size_t group_index, const Pose& world_from_head,
                                        std::span<const Layer> layers) {
  const auto views = static_cast<std::uint32_t>(group.views.size());
  NERITIC_CHECK(views >= 1 && views <= shared::kMaxPanelViews, "{} views in a group", views);
  const ProjectionLayer* projection = projection_of(layers, group_index);
  target = projection ? copy_image(graph, name + " copy", projection->color, target)
                      : clear_image(graph, name + " clear", target);
  std::vector<DrawnPanel> panels;
  for (const Layer& layer : layers)
    if (const auto* panel = std::get_if<PanelLayer>(&layer))
      panels.push_back({panel->image, corners_of(*panel, group, world_from_head), panel->parts});
  if (panels.empty()) return target;
  PanelPipelines pipelines{};
  NERITIC_TRY(pipelines.filtered, pipeline_for(views, false));
  NERITIC_TRY(pipelines.texels, pipeline_for(views, true));
  return graph
      .add_pass<PanelsData>(
          name + " panels",
          [&](graph::PassBuilder& builder, PanelsData& data) {
            for (const DrawnPanel& panel : panels)
              builder.read(panel.image, Access::kSampledFragment);
            data.panels = std::move(panels);
            data.target = builder.write(target, Access::kColorAttachment);
          },
          [this, pipelines, views](const PanelsData& data, graph::PassContext& context) {
            record_panels(data, pipelines, sampler_.handle(), views, context);
          })
      .target;
}

}  // namespace neritic::xr
