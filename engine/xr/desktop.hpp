// The desktop window as a display: one eye, vertical sync, resized and minimised as the user likes.
// Rendering thread, which is the main thread.
#pragma once

#include <memory>

#include "engine/xr/display.hpp"
#include "engine/xr/swapchain.hpp"
#include "engine/xr/window.hpp"

namespace neritic::xr {

class DesktopDisplay final : public Display {
 public:
  // window and device must outlive it.
  static Result<std::unique_ptr<DesktopDisplay>> create(gpu::Device& device, Window& window,
                                                        std::uint32_t frames_in_flight);
  Result<DisplayFrame> begin_frame() override;
  const gpu::Image& target() const override { return swapchain_.image(); }
  graph::Access target_access() const override { return graph::Access::kPresent; }
  gpu::Frames::SubmitSync sync() const override;
  Status end_frame() override;
  VkFormat format() const { return swapchain_.format(); }
  void set_vertical_fov(double rad) override { vertical_fov_rad_ = rad; }

 private:
  DesktopDisplay(Window& window, Swapchain swapchain)
      : window_(window), swapchain_(std::move(swapchain)) {}
  Result<AcquireOutcome> acquire();
  Window& window_;
  Swapchain swapchain_;
  bool stale_ = true;  // the swapchain no longer fits the surface
  std::uint32_t made_for_width_ = 0, made_for_height_ = 0;  // the window's size back then
  double vertical_fov_rad_ = radians(60.0);
};

}  // namespace neritic::xr
