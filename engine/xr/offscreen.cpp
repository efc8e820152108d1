#include "engine/xr/offscreen.hpp"

#include <algorithm>
#include <cmath>
#include <thread>

namespace neritic::xr {

Result<std::unique_ptr<OffscreenDisplay>> OffscreenDisplay::create(
    gpu::Device& device, const OffscreenOptions& options) {
  std::unique_ptr<OffscreenDisplay> display(new OffscreenDisplay(options));
  NERITIC_TRY(display->target_,
              gpu::Image::create(device, {.name = "display",
                                          .format = VK_FORMAT_R8G8B8A8_UNORM,
                                          .width = options.width,
                                          .height = options.height,
                                          .usage = VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT |
                                                   VK_IMAGE_USAGE_TRANSFER_SRC_BIT}));
  return display;
}

Result<DisplayFrame> OffscreenDisplay::begin_frame() {
  const auto period_ns = static_cast<TimeNs>(std::llround(1e9 / options_.rate_hz));
  if (frame_ == 0) start_ns_ = next_ns_ = now_ns();
  DisplayFrame frame;
  frame.verdict = FrameVerdict::kDraw;
  if (options_.fast) {
    frame.predicted_display_ns = start_ns_ + static_cast<TimeNs>(frame_) * period_ns;
  } else {
    const TimeNs now = now_ns();
    if (next_ns_ > now) std::this_thread::sleep_for(std::chrono::nanoseconds(next_ns_ - now));
    // A frame that came late does not make the next ones hurry.
    next_ns_ = std::max(next_ns_, now) + period_ns;
    frame.predicted_display_ns = next_ns_;
  }
  ++frame_;
  frame.width = options_.width;
  frame.height = options_.height;
  frame.eyes = {
      {Pose{}, tangents_from_fov(vertical_fov_rad_, double(options_.width) / options_.height)}};
  return frame;
}

}  // namespace neritic::xr
