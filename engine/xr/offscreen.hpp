// A display without a screen: frames go to images of the program's own, as fast as they come. For
// machines without a screen, and for tests. Rendering thread.
#pragma once

#include <memory>

#include "engine/xr/compositor.hpp"

namespace neritic::xr {

struct OffscreenOptions {
  std::vector<ViewGroup> groups;  // see one_view
};

// A single view straight ahead, as of a window of that size.
ViewGroup one_view(std::uint32_t width, std::uint32_t height, double vertical_fov_rad);

class OffscreenDisplay final : public Display {
 public:
  static Result<std::unique_ptr<OffscreenDisplay>> create(gpu::Device& device,
                                                          const OffscreenOptions& options);
  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override;
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override;
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame(bool) override { return {}; }
  ActionValues take_actions(const InputClaims&) override { return {}; }
  // The composed picture of a group, an array layer a view, in TRANSFER_SRC_OPTIMAL once the frame
  // is done.
  const gpu::Image& picture(std::size_t group) const { return targets_[group]; }

 private:
  explicit OffscreenDisplay(const OffscreenOptions& options) : options_(options) {}
  OffscreenOptions options_;
  std::unique_ptr<Compositor> compositor_;
  std::vector<gpu::Image> targets_;  // by group
};

}  // namespace neritic::xr
