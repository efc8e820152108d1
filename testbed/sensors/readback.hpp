// Brings images of a frame graph to the host: a transfer pass copies each into a mapped buffer that
// is kept from frame to frame. Rendering thread only.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"

namespace neritic::testbed {

class ReadbackPool {
 public:
  // Declares the copy of an image (all layers, rows without padding). The buffer is valid on the
  // host once the frame is done. name must be unique in the frame.
  Result<const gpu::Buffer*> declare(graph::FrameGraph& graph, gpu::Device& device,
                                     const std::string& name, graph::ImageHandle image,
                                     VkFormat format, std::uint32_t width, std::uint32_t height,
                                     std::uint32_t layers);

 private:
  std::map<std::string, std::unique_ptr<gpu::Buffer>> buffers_;
};

}  // namespace neritic::testbed
