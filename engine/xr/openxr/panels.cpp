#include "engine/xr/openxr/panels.hpp"

#include <algorithm>
#include <cmath>

#include "engine/core/log.hpp"

namespace neritic::xr::openxr {

Result<std::unique_ptr<Panels>> Panels::create(Runtime& runtime, const Session& session,
                                               gpu::Device& device, Presenter& presenter) {
  std::unique_ptr<Panels> panels(new Panels(runtime, session, device, presenter));
  NERITIC_TRY(const auto formats, swapchain_formats(runtime, session.handle()));
  NERITIC_TRY(panels->format_, choose_color(formats));
  NERITIC_TRY_STATUS(presenter.make_ready(panels->format_, 1, false));
  return panels;
}

Status Panels::declare(graph::FrameGraph& graph, const PanelLayer& panel) {
  Kept& kept = chains_[panel.name];
  if (panel.image) {
    const graph::ResourceDecl& image = graph.declaration().resources[panel.image.resource];
    const VkExtent2D size = fitted(panel.name, image.width, image.height, kept);
    if (!kept.chain || kept.chain->desc().width != size.width ||
        kept.chain->desc().height != size.height) {
      if (kept.chain) device_.wait_idle();  // sizes change seldom
      kept.chain.reset();
      kept.drawn = false;
      NERITIC_TRY(kept.chain, Swapchain::create(runtime_, session_.handle(), device_,
                                                {.name = "headset panel " + panel.name,
                                                 .format = format_,
                                                 .usage = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT |
                                                          XR_SWAPCHAIN_USAGE_SAMPLED_BIT,
                                                 .width = size.width,
                                                 .height = size.height}));
    }
    NERITIC_TRY(const gpu::Image* const target, kept.chain->acquire());
    NERITIC_TRY_STATUS(presenter_.declare(graph, "headset panel " + panel.name, panel.image,
                                          *target, {target->desc().width, target->desc().height},
                                          false));
  }
  if (panel.image || kept.drawn) shown_.push_back({panel, &kept});
  return {};
}

VkExtent2D Panels::fitted(const std::string& name, std::uint32_t width, std::uint32_t height,
                          Kept& kept) {
  const XrSystemGraphicsProperties& most = runtime_.properties().graphicsProperties;
  const double scale = std::min({1.0, static_cast<double>(most.maxSwapchainImageWidth) / width,
                                 static_cast<double>(most.maxSwapchainImageHeight) / height});
  if (!(scale < 1.0) || !(scale > 0.0)) return {width, height};
  const auto scaled = [&](std::uint32_t pixels) {
    return static_cast<std::uint32_t>(std::max(1.0, std::floor(scale * pixels)));
  };
  if (!std::exchange(kept.small, true))
    log_warn("panel {} of {} x {} pixels is shown coarser: {} has images of {} x {} at most", name,
             width, height, runtime_.info().runtime, most.maxSwapchainImageWidth,
             most.maxSwapchainImageHeight);
  return {scaled(width), scaled(height)};
}

// The last ones, which lie over the others: a program gives what it needs most first.
void Panels::leave_out(std::size_t before) {
  const std::size_t most = runtime_.properties().graphicsProperties.maxLayerCount;
  if (most == 0 || before + shown_.size() <= most) return;
  const std::size_t room = most - std::min(most, before);
  std::string names;
  for (std::size_t i = room; i < shown_.size(); ++i)
    names += (names.empty() ? "" : ", ") + shown_[i].panel.name;
  shown_.resize(room);
  if (names != left_out_)
    log_warn("{} shows {} layers at most: without {}", runtime_.info().runtime, most, names);
  left_out_ = names;
}

const XrCompositionLayerBaseHeader* Panels::flat(const Shown& shown, XrSpace space,
                                                 const Pose& pose) {
  XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
  quad.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  quad.space = space;
  quad.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  quad.subImage = shown.kept->chain->sub_image(0);
  quad.pose = to_xr(pose);
  quad.size = {static_cast<float>(shown.panel.size_m.x), static_cast<float>(shown.panel.size_m.y)};
  return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&quads_.emplace_back(quad));
}

// Its middle is where the flat one's is; the axis lies before it, towards the viewer.
const XrCompositionLayerBaseHeader* Panels::bent(const Shown& shown, XrSpace space,
                                                 const Pose& pose) {
  const PanelLayer& panel = shown.panel;
  XrCompositionLayerCylinderKHR cylinder{XR_TYPE_COMPOSITION_LAYER_CYLINDER_KHR};
  cylinder.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  cylinder.space = space;
  cylinder.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  cylinder.subImage = shown.kept->chain->sub_image(0);
  cylinder.pose = to_xr(pose * Pose{{0.0, 0.0, panel.radius_m}});
  cylinder.radius = static_cast<float>(panel.radius_m);
  cylinder.centralAngle = static_cast<float>(panel.size_m.x / panel.radius_m);
  cylinder.aspectRatio = static_cast<float>(panel.size_m.x / panel.size_m.y);
  return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&cylinders_.emplace_back(cylinder));
}

Result<std::vector<const XrCompositionLayerBaseHeader*>> Panels::finish(
    const Pose& world_from_stage, std::size_t before) {
  quads_.clear();
  cylinders_.clear();
  for (const Shown& shown : shown_) {
    // Without a picture in this frame an image may be acquired for one that was not submitted.
    if (!shown.panel.image) continue;
    NERITIC_TRY_STATUS(shown.kept->chain->release());
    shown.kept->drawn = true;
  }
  leave_out(before);
  std::vector<const XrCompositionLayerBaseHeader*> layers;
  for (const Shown& shown : shown_) {
    const bool head = shown.panel.lock == PanelLayer::Lock::kHead;
    const XrSpace space = head ? session_.head() : session_.stage();
    const Pose pose = head ? shown.panel.pose : inverse(world_from_stage) * shown.panel.pose;
    const bool bends = runtime_.has().cylinder && shown.panel.radius_m > 0.0;
    layers.push_back(bends ? bent(shown, space, pose) : flat(shown, space, pose));
  }
  shown_.clear();
  return layers;
}

}  // namespace neritic::xr::openxr
