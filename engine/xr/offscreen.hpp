// A display that nobody looks at: frames go to an image of the program's own, paced by a rate or as
// fast as they come. For machines without a display, and for tests. Rendering thread.
#pragma once

#include <memory>

#include "engine/gpu/device.hpp"
#include "engine/xr/display.hpp"

namespace neritic::xr {

struct OffscreenOptions {
  std::uint32_t width = 1280, height = 720;
  double rate_hz = 30.0;  // frames a second of the scene's time
  // Frames follow each other without waiting, each 1 / rate_hz later in time than the last: the
  // same pictures on every machine.
  bool fast = false;
};

class OffscreenDisplay final : public Display {
 public:
  static Result<std::unique_ptr<OffscreenDisplay>> create(gpu::Device& device,
                                                          const OffscreenOptions& options);
  Result<DisplayFrame> begin_frame() override;
  const gpu::Image& target() const override { return target_; }
  graph::Access target_access() const override { return graph::Access::kTransferRead; }
  gpu::Frames::SubmitSync sync() const override { return {}; }
  Status end_frame() override { return {}; }
  void set_vertical_fov(double rad) override { vertical_fov_rad_ = rad; }

 private:
  explicit OffscreenDisplay(const OffscreenOptions& options) : options_(options) {}
  OffscreenOptions options_;
  double vertical_fov_rad_ = radians(60.0);
  gpu::Image target_;
  TimeNs start_ns_ = 0, next_ns_ = 0;
  std::uint64_t frame_ = 0;
};

}  // namespace neritic::xr
