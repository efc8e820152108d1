// A headset and a window beside it, in which others watch its wearer and work the program. While it
// is worn the window shows the middle of the wearer's first view, with the panels that he sees and
// those for the watchers alone, at most 30 times a second. While it is not, the window is the
// display, as without a headset. The headset paces the frames. Rendering thread, which is the main
// thread.
#pragma once

#include <memory>

#include "engine/xr/desktop/window_display.hpp"

namespace neritic::xr {

// The part of a view that a picture of that aspect (width over height) shows: as large as fits,
// with what is straight ahead in its middle.
FrustumTangents mirrored_part(const FrustumTangents& view, double aspect);

class MirroredDisplay final : public Display {
 public:
  // headset outlives it. Its frames need no semaphores.
  MirroredDisplay(Display& headset, std::unique_ptr<WindowDisplay> window)
      : headset_(headset), window_(std::move(window)) {}

  std::vector<ViewGroup> groups_ahead() const override { return headset_.groups_ahead(); }
  // kQuit where either is closed.
  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override;
  bool paces_device() const override { return worn_ && headset_.paces_device(); }
  void track(DisplayFrame& frame, const Pose& world_from_stage) override;
  // Gives the window's picture where it takes one, else the headset's.
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override;
  gpu::Frames::SubmitSync sync() const override;
  Status end_frame(bool submitted) override;
  // The wearer's; those at the window are the watchers' then.
  ActionValues take_actions(const InputClaims& claims) override;
  ActionValues take_mirror_actions(const InputClaims& claims) override;

 private:
  void show_middle(DisplayFrame& frame);
  Display& headset_;
  std::unique_ptr<WindowDisplay> window_;
  bool worn_ = false;       // the headset shows this frame
  bool in_window_ = false;  // the window does
  TimeNs next_ns_ = 0;      // of the window, while the headset is worn
  ViewGroup mirror_;        // the window's, in this frame
  FrustumTangents whole_;   // of the first view
};

}  // namespace neritic::xr
