// Brings images of a frame graph to the host: a transfer pass copies each into a mapped buffer.
// The buffers come from rings, one a name, and are used again in later frames. Rendering thread
// only.
#pragma once

#include <map>
#include <string>

#include "engine/gpu/device.hpp"
#include "engine/graph/frame_graph.hpp"
#include "testbed/sensors/ring.hpp"

namespace neritic::testbed {

// Keeps its buffer from other frames. The host may read the buffer once its frame is done.
using Readback = Pin<gpu::Buffer>;

class ReadbackPool {
 public:
  // Declares the copy of an image (all layers, rows without padding).
  Result<Readback> declare(graph::FrameGraph& graph, gpu::Device& device, const std::string& name,
                           graph::ImageHandle image, VkFormat format, std::uint32_t width,
                           std::uint32_t height, std::uint32_t layers);

 private:
  std::map<std::string, Ring<gpu::Buffer>> buffers_;
};

}  // namespace neritic::testbed
