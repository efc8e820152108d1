#include "engine/xr/offscreen.hpp"

namespace neritic::xr {
namespace {

constexpr VkFormat kFormat = VK_FORMAT_R8G8B8A8_UNORM;

}  // namespace

ViewGroup one_view(std::uint32_t width, std::uint32_t height, double vertical_fov_rad) {
  return {width, height, {{Pose{}, tangents_from_fov(vertical_fov_rad, double(width) / height)}}};
}

Result<std::unique_ptr<OffscreenDisplay>> OffscreenDisplay::create(
    gpu::Device& device, const OffscreenOptions& options) {
  std::unique_ptr<OffscreenDisplay> display(new OffscreenDisplay(options));
  NERITIC_TRY(display->compositor_, Compositor::create(device, kFormat));
  for (std::size_t i = 0; i < options.groups.size(); ++i) {
    const ViewGroup& group = options.groups[i];
    NERITIC_TRY(
        gpu::Image target,
        gpu::Image::create(
            device, {.name = fmt::format("display {}", i),
                     .format = kFormat,
                     .width = group.width,
                     .height = group.height,
                     .layers = static_cast<std::uint32_t>(group.views.size()),
                     .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                              VK_IMAGE_USAGE_TRANSFER_DST_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
                     .array_view = true}));
    display->targets_.push_back(std::move(target));
  }
  return display;
}

Result<DisplayFrame> OffscreenDisplay::begin_frame(const Pose&) {
  DisplayFrame frame;
  frame.verdict = FrameVerdict::kDraw;
  frame.groups = options_.groups;
  return frame;
}

Result<ShownPicture> OffscreenDisplay::declare(graph::FrameGraph& graph,
                                               const Pose& world_from_head,
                                               std::span<const Layer> layers) {
  ShownPicture shown{{}, kFormat, options_.groups[0].width, options_.groups[0].height, true};
  for (std::size_t i = 0; i < targets_.size(); ++i) {
    const std::string name = i == 0 ? "display" : fmt::format("display {}", i);
    const graph::ImageHandle target = graph.import_image(targets_[i], {});  // overwritten
    NERITIC_TRY(
        const graph::ImageHandle composed,
        compositor_->declare(graph, name, target, options_.groups[i], i, world_from_head, layers));
    graph.output(composed, graph::Access::kTransferRead);
    if (i == 0) shown.image = composed;
  }
  return shown;
}

}  // namespace neritic::xr
