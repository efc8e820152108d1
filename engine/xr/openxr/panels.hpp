// Inside engine/xr/openxr only: panels as composition layers of their own, quads or, bent,
// cylinders, each with the runtime's images in the panel's own resolution. Rendering thread.
#pragma once

#include <deque>
#include <map>

#include "engine/xr/display.hpp"
#include "engine/xr/openxr/presenter.hpp"
#include "engine/xr/openxr/session.hpp"
#include "engine/xr/openxr/swapchain.hpp"

namespace neritic::xr::openxr {

class Panels {
 public:
  // All outlive it.
  static Result<std::unique_ptr<Panels>> create(Runtime& runtime, const Session& session,
                                                gpu::Device& device, Presenter& presenter);
  // Adds the pass that draws the panel's image, if it brings one.
  Status declare(graph::FrameGraph& graph, const PanelLayer& panel);
  // The frame was submitted: hands back the images of its panels, and gives their layers in the
  // order of declare. Valid until the next frame's declare. before: layers that the frame has
  // already; where the runtime composes no more, the last panels are left out.
  Result<std::vector<const XrCompositionLayerBaseHeader*>> finish(const Pose& world_from_stage,
                                                                  std::size_t before);
  // Forgets this frame's panels, whose images were not drawn.
  void drop() { shown_.clear(); }

 private:
  Panels(Runtime& runtime, const Session& session, gpu::Device& device, Presenter& presenter)
      : runtime_(runtime), session_(session), device_(device), presenter_(presenter) {}
  struct Kept {
    std::unique_ptr<Swapchain> chain;
    bool drawn = false;  // has content
    bool small = false;  // a note said that its picture is larger than the runtime's images
  };
  struct Shown {
    PanelLayer panel;
    Kept* kept = nullptr;
  };
  // The size of the runtime's image for a picture of that size.
  VkExtent2D fitted(const std::string& name, std::uint32_t width, std::uint32_t height, Kept& kept);
  void leave_out(std::size_t before);
  Runtime& runtime_;
  const Session& session_;
  gpu::Device& device_;
  Presenter& presenter_;
  VkFormat format_ = VK_FORMAT_UNDEFINED;
  std::map<std::string, Kept> chains_;  // by panel
  std::vector<Shown> shown_;            // of this frame
  std::string left_out_;                // as the last note named them
  const XrCompositionLayerBaseHeader* bent(const Shown& shown, XrSpace space, const Pose& pose);
  const XrCompositionLayerBaseHeader* flat(const Shown& shown, XrSpace space, const Pose& pose);
  // For this frame; their addresses are the runtime's until the frame has ended.
  std::deque<XrCompositionLayerQuad> quads_;
  std::deque<XrCompositionLayerCylinderKHR> cylinders_;
};

}  // namespace neritic::xr::openxr
