#include "engine/xr/desktop/mirrored_display.hpp"

#include <algorithm>
#include <cmath>

#include "engine/xr/compositor.hpp"

namespace neritic::xr {
namespace {

using graph::Access;
using graph::ImageHandle;

// Between two pictures of the window beside a worn headset.
constexpr TimeNs kMirrorPeriod_ns = 33'333'333;

// The texels of one side of a picture that lie between two tangents; at least one.
struct Texels {
  std::int32_t first = 0;
  std::uint32_t count = 1;
};
Texels texels_between(double from, double to, double first, double last, std::uint32_t size) {
  const auto texel = [&](double at) {
    return std::clamp(std::lround((at - first) / (last - first) * size), 0L,
                      static_cast<long>(size));
  };
  const long begin = std::min(texel(from), static_cast<long>(size) - 1);
  return {static_cast<std::int32_t>(begin),
          static_cast<std::uint32_t>(std::max(texel(to) - begin, 1L))};
}

// Adds the pass that copies a part of a picture's first layer.
ImageHandle cut(graph::FrameGraph& graph, ImageHandle picture, const FrustumTangents& whole,
                const FrustumTangents& part) {
  const graph::ResourceDecl& decl = graph.declaration().resources[picture.resource];
  const Texels across = texels_between(part.left, part.right, whole.left, whole.right, decl.width);
  const Texels down = texels_between(part.top, part.bottom, whole.top, whole.bottom, decl.height);
  const graph::TransientImage size{decl.format, across.count, down.count};
  struct Data {
    ImageHandle from, to;
  };
  return graph
      .add_pass<Data>(
          "mirror",
          [&](graph::PassBuilder& builder, Data& data) {
            data.from = picture.layer(0);
            builder.read(data.from, Access::kTransferRead);
            data.to = builder.write(builder.create_image("mirror", size), Access::kTransferWrite);
          },
          [across, down](const Data& data, graph::PassContext& context) {
            VkImageCopy region{};
            region.srcSubresource = region.dstSubresource = {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1};
            region.srcOffset = {across.first, down.first, 0};
            region.extent = {across.count, down.count, 1};
            vkCmdCopyImage(context.cmd(), context.image(data.from).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, context.image(data.to).handle(),
                           VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, 1, &region);
          })
      .to;
}

}  // namespace

FrustumTangents mirrored_part(const FrustumTangents& view, double aspect) {
  const double across = std::min(-view.left, view.right), down = std::min(-view.bottom, view.top);
  // A view may look aside: then all of it is shown, whatever its aspect.
  if (!(across > 0.0 && down > 0.0 && aspect > 0.0)) return view;
  const double high = std::min(down, across / aspect);
  return {-aspect * high, aspect * high, -high, high};
}

Result<DisplayFrame> MirroredDisplay::begin_frame(const Pose& world_from_stage) {
  in_window_ = false;
  NERITIC_TRY(DisplayFrame frame, headset_.begin_frame(world_from_stage));
  worn_ = frame.verdict == FrameVerdict::kDraw;
  if (frame.verdict == FrameVerdict::kQuit || (worn_ && now_ns() < next_ns_)) return frame;
  window_->set_waits(!worn_);
  NERITIC_TRY(DisplayFrame window, window_->begin_frame(world_from_stage));
  if (window.verdict == FrameVerdict::kQuit) {
    NERITIC_TRY_STATUS(headset_.end_frame(false));
    worn_ = false;
    return window;
  }
  in_window_ = window.verdict == FrameVerdict::kDraw;
  if (!worn_) return window;
  if (!in_window_) return frame;
  next_ns_ = now_ns() + kMirrorPeriod_ns;
  mirror_ = window.groups.front();
  show_middle(frame);
  return frame;
}

void MirroredDisplay::track(DisplayFrame& frame, const Pose& world_from_stage) {
  if (!worn_) return;
  headset_.track(frame, world_from_stage);
  if (in_window_) show_middle(frame);
}

// The window shows the middle of the first view, by where the head is.
void MirroredDisplay::show_middle(DisplayFrame& frame) {
  View view = frame.groups.front().views.front();
  whole_ = view.tangents;
  view.tangents = mirrored_part(whole_, static_cast<double>(mirror_.width) / mirror_.height);
  view.hidden.clear();
  window_->show(view);
  mirror_.views = {view};
  frame.mirror = mirror_;
}

Result<ShownPicture> MirroredDisplay::declare(graph::FrameGraph& graph, const Pose& world_from_head,
                                              std::span<const Layer> layers) {
  if (!worn_) return window_->declare(graph, world_from_head, layers);
  std::vector<Layer> worn, beside;
  for (const Layer& layer : layers) {
    const auto* panel = std::get_if<PanelLayer>(&layer);
    if (!panel || !panel->mirror_only) worn.push_back(layer);
    if (panel && panel->image) beside.push_back(layer);
  }
  NERITIC_TRY(const ShownPicture shown, headset_.declare(graph, world_from_head, worn));
  const ProjectionLayer* first = projection_of(layers, 0);
  if (!in_window_ || !first) {
    in_window_ = false;
    return shown;
  }
  const ImageHandle middle = cut(graph, first->color, whole_, mirror_.views.front().tangents);
  beside.insert(beside.begin(), ProjectionLayer{.group = 0, .color = middle});
  return window_->declare(graph, world_from_head, beside);
}

gpu::Frames::SubmitSync MirroredDisplay::sync() const {
  return in_window_ ? window_->sync() : headset_.sync();
}

Status MirroredDisplay::end_frame(bool submitted) {
  NERITIC_TRY_STATUS(headset_.end_frame(submitted && worn_));
  if (!in_window_) return {};
  in_window_ = false;
  return window_->end_frame(submitted);
}

ActionValues MirroredDisplay::take_actions(const InputClaims& claims) {
  ActionValues worn = headset_.take_actions({});
  return worn_ ? worn : window_->take_actions(claims);
}

ActionValues MirroredDisplay::take_mirror_actions(const InputClaims& claims) {
  return worn_ ? window_->take_actions(claims) : ActionValues();
}

}  // namespace neritic::xr
