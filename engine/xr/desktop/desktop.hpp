// The desktop window as a display: one view, vertical sync, resized and minimised as the user
// likes. Rendering thread, which is the main thread.
#pragma once

#include <memory>

#include "engine/xr/compositor.hpp"
#include "engine/xr/desktop/swapchain.hpp"
#include "engine/xr/desktop/window.hpp"
#include "engine/xr/desktop/window_display.hpp"

namespace neritic::xr {

class DesktopDisplay final : public WindowDisplay {
 public:
  // window and device must outlive it.
  static Result<std::unique_ptr<DesktopDisplay>> create(gpu::Device& device, Window& window,
                                                        const DesktopOptions& options);
  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override;
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override;
  gpu::Frames::SubmitSync sync() const override;
  Status end_frame(bool submitted) override;
  ActionValues take_actions(const InputClaims& claims) override {
    return window_.take_actions(claims);
  }

 private:
  DesktopDisplay(Window& window, Swapchain swapchain, const DesktopOptions& options)
      : window_(window), swapchain_(std::move(swapchain)), options_(options) {}
  Result<AcquireOutcome> acquire();
  Window& window_;
  Swapchain swapchain_;
  DesktopOptions options_;
  std::unique_ptr<Compositor> compositor_;
  bool acquired_ = false;  // an image waits to be presented
  bool stale_ = true;      // the swapchain no longer fits the surface
  std::uint32_t made_for_width_ = 0, made_for_height_ = 0;  // the window's size back then
};

// The window's display on this device: a SharedDisplay where the device is a processor and can
// share memory with the server of the window, else a DesktopDisplay.
Result<std::unique_ptr<WindowDisplay>> make_desktop(gpu::Device& device, Window& window,
                                                    const DesktopOptions& options);

}  // namespace neritic::xr
