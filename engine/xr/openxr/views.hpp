// Inside engine/xr/openxr only: the views of a session (one, two or four), grouped by size, with
// the runtime's images of each group, and where they are at a frame's display time. Rendering
// thread.
#pragma once

#include "engine/xr/display.hpp"
#include "engine/xr/openxr/session.hpp"
#include "engine/xr/openxr/swapchain.hpp"

namespace neritic::xr::openxr {

class Views {
 public:
  // runtime, session and device must outlive it.
  // pictures: false: of an overlay, which has none.
  static Result<std::unique_ptr<Views>> create(Runtime& runtime, const Session& session,
                                               gpu::Device& device, bool pictures);
  // Reads the parts that the lenses hide; where that fails, nothing is hidden.
  void read_masks();
  XrViewConfigurationType configuration() const { return configuration_; }
  XrEnvironmentBlendMode blend_mode() const { return blend_mode_; }

  // Where head and views are at that time; where the runtime knows how the head is turned but not
  // where it is, at the last known place, else at that of a standing person. False: it does not
  // know how the head is turned.
  Result<bool> locate(XrTime at);
  const Pose& stage_from_head() const { return stage_from_head_; }
  // Sizes, poses and frusta of the newest locate.
  std::vector<ViewGroup> groups() const;

  struct Group {
    std::size_t first = 0, count = 0;         // of the configuration's views
    std::unique_ptr<Swapchain> color, depth;  // depth: nullptr where none goes to the runtime
  };
  std::vector<Group>& swapchains() { return groups_; }

  // A frame draws a group's views into the left upper parts of the runtime's images, so large.
  struct Drawn {
    VkExtent2D color{}, depth{};  // 0 x 0: no picture
    double near_m = 0.0;          // of the depth; 0: without
  };
  // The composition layer of what the newest locate found; valid until the next call. One item a
  // group.
  const XrCompositionLayerBaseHeader* layer(std::span<const Drawn> drawn);

 private:
  Views(Runtime& runtime, const Session& session) : runtime_(runtime), session_(session) {}
  Status choose_configuration();
  Status choose_blend_mode();
  Result<std::vector<XrViewConfigurationView>> sizes();
  VkExtent2D size_of_pair(std::span<const XrViewConfigurationView> sizes) const;
  Status make_swapchains(gpu::Device& device, std::span<const XrViewConfigurationView> sizes);
  Status make_eyes();
  Vec3 standing_eyes_m() const;
  Result<XrViewStateFlags> locate_in(XrSpace space, XrTime at, std::vector<XrView>& found) const;
  bool gaze_ready(XrTime at) const;
  Runtime& runtime_;
  const Session& session_;
  XrViewConfigurationType configuration_ = XR_VIEW_CONFIGURATION_TYPE_PRIMARY_STEREO;
  XrEnvironmentBlendMode blend_mode_ = XR_ENVIRONMENT_BLEND_MODE_OPAQUE;
  bool foveated_ = false;
  XrSpace eyes_ = XR_NULL_HANDLE;  // with foveated_
  std::vector<Group> groups_;
  std::vector<std::vector<Vec2f>> hidden_;  // by view (xr::View)
  std::vector<XrView> views_;
  Pose stage_from_head_;
  std::optional<Vec3> last_m_;  // of the head, as last known
  XrCompositionLayerProjection layer_{XR_TYPE_COMPOSITION_LAYER_PROJECTION};
  std::vector<XrCompositionLayerProjectionView> layer_views_;
  std::vector<XrCompositionLayerDepthInfoKHR> layer_depths_;
};

}  // namespace neritic::xr::openxr
