#include "engine/xr/desktop/desktop.hpp"

#include <cmath>
#include <thread>

#include "engine/core/log.hpp"
#include "engine/xr/desktop/shared_display.hpp"
#include "engine/xr/offscreen.hpp"

namespace neritic::xr {
namespace {

// Pause before the next try if the surface gave no image, so that the loop is not busy.
constexpr std::chrono::milliseconds kRetry{5};

// The copy to the surface's image waits for it. All earlier passes may run before.
constexpr VkPipelineStageFlags2 kImageReadyStage = VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;

}  // namespace

Result<std::unique_ptr<DesktopDisplay>> DesktopDisplay::create(gpu::Device& device, Window& window,
                                                               const DesktopOptions& options) {
  NERITIC_TRY(const VkSurfaceKHR surface, window.create_surface(device.instance()));
  // Not named: see Device::create_device.
  NERITIC_TRY(Swapchain swapchain, Swapchain::create(device, surface, options.frames_in_flight));
  std::unique_ptr<DesktopDisplay> display(
      new DesktopDisplay(window, std::move(swapchain), options));
  NERITIC_TRY(display->compositor_, Compositor::create(device, display->swapchain_.format()));
  return display;
}

// Acquires an image of the window's size; tries twice, since the surface may change meanwhile.
Result<AcquireOutcome> DesktopDisplay::acquire() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (stale_ || made_for_width_ != window_.width() || made_for_height_ != window_.height()) {
      NERITIC_TRY(const bool made, swapchain_.recreate(window_.width(), window_.height()));
      if (!made) return AcquireOutcome::kNotYet;
      stale_ = false;
      made_for_width_ = window_.width();
      made_for_height_ = window_.height();
    }
    NERITIC_TRY(const AcquireOutcome outcome, swapchain_.acquire(waits_));
    if (outcome != AcquireOutcome::kOutOfDate) return outcome;
    stale_ = true;
  }
  return AcquireOutcome::kOutOfDate;
}

Result<DisplayFrame> DesktopDisplay::begin_frame(const Pose&) {
  DisplayFrame frame;
  switch (window_.poll(waits_)) {
    case WindowState::kClosed:
      frame.verdict = FrameVerdict::kQuit;
      return frame;
    case WindowState::kHidden:
      frame.display_at_ns = now_ns();
      return frame;
    case WindowState::kVisible:
      break;
  }
  // An image that no submission used is still acquired.
  if (!acquired_) {
    NERITIC_TRY(const AcquireOutcome outcome, acquire());
    acquired_ = outcome == AcquireOutcome::kReady;
  }
  // The next refresh at the earliest; one period is the best guess without present timing.
  frame.period_ns = std::llround(1e9 / window_.refresh_hz());
  frame.display_at_ns = now_ns() + *frame.period_ns;
  if (!acquired_) {
    if (waits_) std::this_thread::sleep_for(kRetry);
    return frame;
  }
  frame.verdict = FrameVerdict::kDraw;
  group_ = one_view(swapchain_.width(), swapchain_.height(), options_.vertical_fov_rad);
  frame.groups = {group_};
  return frame;
}

Result<ShownPicture> DesktopDisplay::declare(graph::FrameGraph& graph, const Pose& world_from_head,
                                             std::span<const Layer> layers) {
  const gpu::ImageDesc& desc = swapchain_.image().desc();
  const graph::ImageHandle target =
      graph.import_image(swapchain_.image(), {.stages = kImageReadyStage});
  NERITIC_TRY(const graph::ImageHandle composed,
              compositor_->declare(graph, "display", target, group_, 0, world_from_head, layers));
  graph.output(composed, graph::Access::kPresent);
  return ShownPicture{composed, desc.format, desc.width, desc.height,
                      (desc.usage & VK_IMAGE_USAGE_TRANSFER_SRC_BIT) != 0};
}

gpu::Frames::SubmitSync DesktopDisplay::sync() const {
  return {.wait = swapchain_.image_ready(),
          .wait_stage = kImageReadyStage,
          .signal = swapchain_.drawn()};
}

Status DesktopDisplay::end_frame(bool submitted) {
  if (!acquired_ || !submitted) return {};
  acquired_ = false;
  NERITIC_TRY(const PresentOutcome outcome, swapchain_.present());
  if (outcome == PresentOutcome::kOutOfDate) stale_ = true;
  return {};
}

Result<std::unique_ptr<WindowDisplay>> make_desktop(gpu::Device& device, Window& window,
                                                    const DesktopOptions& options) {
  if (device.info().kind == "CPU") {
    auto shared = SharedDisplay::create(device, window, options);
    if (shared.ok()) return std::unique_ptr<WindowDisplay>(std::move(*shared));
    if (shared.error().code != ErrorCode::kUnsupported) return shared.error();
    log_info("the window's pictures are not shared: {}", shared.error().message);
  }
  NERITIC_TRY(auto display, DesktopDisplay::create(device, window, options));
  return std::unique_ptr<WindowDisplay>(std::move(display));
}

}  // namespace neritic::xr
