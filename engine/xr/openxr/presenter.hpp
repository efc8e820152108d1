// Inside engine/xr/openxr only: draws a picture into an image of the runtime, in whatever format
// that has. Rendering thread.
#pragma once

#include <map>
#include <memory>
#include <tuple>

#include "engine/gpu/pipeline.hpp"
#include "engine/graph/frame_graph.hpp"

namespace neritic::xr::openxr {

class Presenter {
 public:
  // The device must outlive it.
  static Result<std::unique_ptr<Presenter>> create(gpu::Device& device);
  // Makes a pipeline before the frame that needs it.
  Status make_ready(VkFormat format, std::uint32_t layers, bool opaque);
  // from: sRGB-encoded, colour multiplied by alpha, as many layers as target, scaled to the left
  // upper part of it; the rest becomes undefined. opaque: alpha counts as 1. Adds a pass of that
  // name; the image ends as the runtime wants it.
  Status declare(graph::FrameGraph& graph, const std::string& pass, graph::ImageHandle from,
                 const gpu::Image& target, VkExtent2D part, bool opaque);

 private:
  explicit Presenter(gpu::Device& device) : device_(device) {}
  Result<const gpu::Pipeline*> pipeline_for(VkFormat format, std::uint32_t layers, bool opaque);
  gpu::Device& device_;
  gpu::Sampler sampler_;
  std::map<std::tuple<VkFormat, std::uint32_t, bool>, gpu::Pipeline> pipelines_;
};

}  // namespace neritic::xr::openxr
