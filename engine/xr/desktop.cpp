#include "engine/xr/desktop.hpp"

#include <cmath>
#include <thread>

namespace neritic::xr {
namespace {

// Before the next try where the surface gave no image: no busy loop.
constexpr std::chrono::milliseconds kRetry{5};

}  // namespace

Result<std::unique_ptr<DesktopDisplay>> DesktopDisplay::create(gpu::Device& device, Window& window,
                                                               std::uint32_t frames_in_flight) {
  NERITIC_TRY(const VkSurfaceKHR surface, window.create_surface(device.instance()));
  // Not named: see Device::create_device.
  NERITIC_TRY(Swapchain swapchain, Swapchain::create(device, surface, frames_in_flight));
  return std::unique_ptr<DesktopDisplay>(new DesktopDisplay(window, std::move(swapchain)));
}

// Acquires an image of the window's size; the surface may change under our hands, so twice.
Result<AcquireOutcome> DesktopDisplay::acquire() {
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (stale_ || made_for_width_ != window_.width() || made_for_height_ != window_.height()) {
      NERITIC_TRY(const bool made, swapchain_.recreate(window_.width(), window_.height()));
      if (!made) return AcquireOutcome::kNotYet;
      stale_ = false;
      made_for_width_ = window_.width();
      made_for_height_ = window_.height();
    }
    NERITIC_TRY(const AcquireOutcome outcome, swapchain_.acquire());
    if (outcome != AcquireOutcome::kOutOfDate) return outcome;
    stale_ = true;
  }
  return AcquireOutcome::kOutOfDate;
}

Result<DisplayFrame> DesktopDisplay::begin_frame() {
  DisplayFrame frame;
  switch (window_.poll()) {
    case WindowState::kClosed:
      frame.verdict = FrameVerdict::kQuit;
      return frame;
    case WindowState::kHidden:
      return frame;
    case WindowState::kVisible:
      break;
  }
  NERITIC_TRY(const AcquireOutcome outcome, acquire());
  if (outcome != AcquireOutcome::kReady) {
    std::this_thread::sleep_for(kRetry);
    return frame;
  }
  frame.verdict = FrameVerdict::kDraw;
  // The next refresh at the earliest; one period is the best guess without present timing.
  frame.predicted_display_ns =
      now_ns() + static_cast<TimeNs>(std::llround(1e9 / window_.refresh_hz()));
  frame.width = swapchain_.width();
  frame.height = swapchain_.height();
  frame.eyes = {{Pose{}, tangents_from_fov(vertical_fov_rad_, double(frame.width) / frame.height)}};
  return frame;
}

gpu::Frames::SubmitSync DesktopDisplay::sync() const {
  return {.wait = swapchain_.image_ready(), .signal = swapchain_.drawn()};
}

Status DesktopDisplay::end_frame() {
  NERITIC_TRY(const PresentOutcome outcome, swapchain_.present());
  if (outcome == PresentOutcome::kOutOfDate) stale_ = true;
  return {};
}

}  // namespace neritic::xr
