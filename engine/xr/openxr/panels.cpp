#include "engine/xr/openxr/panels.hpp"

namespace neritic::xr::openxr {

Result<std::unique_ptr<Panels>> Panels::create(Runtime& runtime, const Session& session,
                                               gpu::Device& device, Presenter& presenter) {
  std::unique_ptr<Panels> panels(new Panels(runtime, session, device, presenter));
  NERITIC_TRY(const auto formats, swapchain_formats(runtime, session.handle()));
  NERITIC_TRY(panels->format_, choose_color(formats));
  return panels;
}

Status Panels::declare(graph::FrameGraph& graph, const PanelLayer& panel) {
  Kept& kept = chains_[panel.name];
  if (panel.image) {
    const graph::ResourceDecl& image = graph.declaration().resources[panel.image.resource];
    if (!kept.chain || kept.chain->desc().width != image.width ||
        kept.chain->desc().height != image.height) {
      if (kept.chain) device_.wait_idle();  // sizes change seldom
      kept = {};
      NERITIC_TRY(kept.chain, Swapchain::create(runtime_, session_.handle(), device_,
                                                {.name = "headset panel " + panel.name,
                                                 .format = format_,
                                                 .usage = XR_SWAPCHAIN_USAGE_COLOR_ATTACHMENT_BIT |
                                                          XR_SWAPCHAIN_USAGE_SAMPLED_BIT,
                                                 .width = image.width,
                                                 .height = image.height}));
    }
    NERITIC_TRY(const gpu::Image* const target, kept.chain->acquire());
    NERITIC_TRY_STATUS(
        presenter_.declare(graph, "headset panel " + panel.name, panel.image, *target, false));
    kept.drawn = true;
  }
  if (kept.drawn) shown_.push_back({panel, kept.chain.get()});
  return {};
}

const XrCompositionLayerBaseHeader* Panels::flat(const Shown& shown, XrSpace space,
                                                 const Pose& pose) {
  XrCompositionLayerQuad quad{XR_TYPE_COMPOSITION_LAYER_QUAD};
  quad.layerFlags = XR_COMPOSITION_LAYER_BLEND_TEXTURE_SOURCE_ALPHA_BIT;
  quad.space = space;
  quad.eyeVisibility = XR_EYE_VISIBILITY_BOTH;
  quad.subImage = shown.chain->sub_image(0);
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
  cylinder.subImage = shown.chain->sub_image(0);
  cylinder.pose = to_xr(pose * Pose{{0.0, 0.0, panel.radius_m}});
  cylinder.radius = static_cast<float>(panel.radius_m);
  cylinder.centralAngle = static_cast<float>(panel.size_m.x / panel.radius_m);
  cylinder.aspectRatio = static_cast<float>(panel.size_m.x / panel.size_m.y);
  return reinterpret_cast<const XrCompositionLayerBaseHeader*>(&cylinders_.emplace_back(cylinder));
}

Result<std::vector<const XrCompositionLayerBaseHeader*>> Panels::finish(
    const Pose& world_from_stage) {
  quads_.clear();
  cylinders_.clear();
  std::vector<const XrCompositionLayerBaseHeader*> layers;
  for (const Shown& shown : shown_) {
    NERITIC_TRY_STATUS(shown.chain->release());
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
