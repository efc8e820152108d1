// The GPU sonar on images from anywhere (files, tests): uploads them once, runs the gather as a
// frame graph of its own, reads the result back. Rendering thread.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "sonar/gather.hpp"
#include "sonar/reference.hpp"

namespace neritic::sonar {

class ImageGather {
 public:
  // Inputs: one view, or the sectors that plan_sectors(grid) gives, all of one size and pinhole.
  static Result<std::unique_ptr<ImageGather>> create(gpu::Device& device, const BeamGrid& grid,
                                                     std::span<const SonarInput> inputs,
                                                     Gather gather,
                                                     std::optional<bool> atomics = {});
  ~ImageGather();
  // One frame: gather, wait, read back. The same bits every time.
  Result<SonarImage> run();
  // GPU times of the newest finished run, and the wall time of the last run with its waiting.
  const std::vector<gpu::PassTime>& pass_times() const { return frames_->pass_times(); }
  double wall_ms() const { return wall_ms_; }

 private:
  ImageGather() = default;
  Status upload(std::span<const SonarInput> inputs);
  gpu::Device* device_ = nullptr;
  std::unique_ptr<SonarGather> gather_;
  bool labels_ = false, reflect_ = false;
  gpu::Image depth_image_, normal_image_, label_image_;
  gpu::Buffer reflectivity_, sums_, keys_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  double wall_ms_ = 0.0;
};

}  // namespace neritic::sonar
