// The desktop window of a device that is a processor, on an X server of the same machine: the host
// composes the device's pictures in memory that it shares with the server. Where panels do not lie
// texel on pixel, and for screenshots, the device composes them. Rendering thread, which is the
// main thread.
#pragma once

#include <memory>
#include <vector>

#include "engine/draw2d/upscale.hpp"
#include "engine/gpu/resources.hpp"
#include "engine/xr/compositor.hpp"
#include "engine/xr/desktop/shared_pictures.hpp"
#include "engine/xr/desktop/window.hpp"
#include "engine/xr/desktop/window_display.hpp"

namespace neritic::xr {

class SharedDisplay final : public WindowDisplay {
 public:
  // window and device must outlive it. kUnsupported, with the reason, where nothing can be shared.
  static Result<std::unique_ptr<SharedDisplay>> create(gpu::Device& device, Window& window,
                                                       const DesktopOptions& options);
  ~SharedDisplay() override;
  Result<DisplayFrame> begin_frame(const Pose& world_from_stage) override;
  Result<ShownPicture> declare(graph::FrameGraph& graph, const Pose& world_from_head,
                               std::span<const Layer> layers) override;
  gpu::Frames::SubmitSync sync() const override;
  // Waits for the device.
  Status end_frame(bool submitted) override;
  ActionValues take_actions(const InputClaims& claims) override {
    return window_.take_actions(claims);
  }

 private:
  SharedDisplay(gpu::Device& device, Window& window, const DesktopOptions& options)
      : device_(device), window_(window), options_(options) {}
  Status fit(std::uint32_t width, std::uint32_t height);
  Status await_device() const;
  // An image of this frame that the host composes.
  struct Part {
    gpu::Buffer texels;
    std::uint32_t width = 0, height = 0;
    PanelCorner corner;
    std::vector<draw2d::PixelRect> drawn;
  };
  Result<bool> declare_parts(graph::FrameGraph& graph, const Pose& world_from_head,
                             std::span<const Layer> layers);
  Status bring(graph::FrameGraph& graph, graph::ImageHandle image, std::size_t index);
  void compose(std::span<std::byte> picture) const;

  gpu::Device& device_;
  Window& window_;
  DesktopOptions options_;
  std::unique_ptr<SharedPictures> pictures_;
  std::unique_ptr<Compositor> compositor_;
  VkSemaphore drawn_ = VK_NULL_HANDLE;  // a timeline
  std::uint64_t drawing_ = 1;           // its value when this frame is drawn
  gpu::Image image_;
  std::vector<Part> parts_;  // the view's picture, then the panels
  std::size_t used_ = 0;     // of them, in this frame
  TimeNs begun_ns_ = 0;      // the last frame
};

}  // namespace neritic::xr
