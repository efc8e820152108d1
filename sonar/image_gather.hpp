// The GPU sonar on images from anywhere (files, tests): uploads them, runs the passes as a frame
// graph of their own, reads the result back. Rendering thread.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/gpu/device.hpp"
#include "engine/gpu/frames.hpp"
#include "engine/graph/frame_graph.hpp"
#include "sonar/head_gather.hpp"

namespace neritic::sonar {

class ImageGather {
 public:
  // Inputs: one view, or the sectors that plan_sectors(grid) gives, all of one size and pinhole.
  static Result<std::unique_ptr<ImageGather>> create(gpu::Device& device, const BeamGrid& grid,
                                                     std::span<const SonarInput> inputs,
                                                     Gather gather, GatherThreads threads = {});
  // A sensor with its terms on one view whose axis is the sonar's. Reflectivities a pixel count as
  // strengths of strength_scale at 1 where the sensor has a level.
  static Result<std::unique_ptr<ImageGather>> create(gpu::Device& device, const scene::Sonar& sonar,
                                                     const Head& head, const SonarInput& input,
                                                     Gather gather, GatherThreads threads = {});
  ~ImageGather();
  // Other images of the same size, pinhole and kind (labels, reflectivities or none).
  Status upload(std::span<const SonarInput> inputs);
  // One frame: gather, wait, read back. The same bits every time. state: of a sensor with terms.
  Result<SonarImage> run(const PingState& state = {});
  // The last run's, where the sensor names labels by energy.
  const std::optional<LabelImage>& label_energy() const { return label_energy_; }
  // GPU times of the newest finished run, and the wall time of the last run with its waiting.
  const std::vector<gpu::PassTime>& pass_times() const { return frames_->pass_times(); }
  double wall_ms() const { return wall_ms_; }

 private:
  explicit ImageGather(gpu::Device& device) : device_(device) {}
  Status prepare(const scene::Sonar& sonar, const Head& head, std::span<const SonarInput> inputs,
                 GatherOptions options);
  Status make_images(const SonarInput& in, std::uint32_t layers);
  gpu::Device& device_;
  std::unique_ptr<HeadGather> head_;
  HeadBuffers buffers_;
  std::optional<LabelImage> label_energy_;
  bool labels_ = false, reflect_ = false;
  gpu::Image surface_image_, label_image_;
  gpu::Buffer reflectivity_;
  std::unique_ptr<gpu::Frames> frames_;
  std::unique_ptr<graph::Executor> executor_;
  double wall_ms_ = 0.0;
};

}  // namespace neritic::sonar
