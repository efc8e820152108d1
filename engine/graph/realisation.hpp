// Inside engine/graph: the real images and buffers of one plan's transients. They lie in the heap
// of their memory class (transient_heaps.hpp) where the plan placed them. Move-only; rendering
// thread. Destroy only when the GPU is done with it (Frames::retire), and before the heaps.
#pragma once

#include <vector>

#include "engine/gpu/resources.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {

// Resources that may share memory: same kind (buffers and optimal images must not meet within
// bufferImageGranularity) and same memory types.
struct MemoryClass {
  ResourceKind kind = ResourceKind::kImage;
  std::uint32_t memory_type_bits = 0;
  VkDeviceSize alignment = 1;    // the largest of its members
  VkDeviceSize block_bytes = 0;  // most that the device gives of it in one piece
};

// The memory that each transient needs on this device; the graph's usage flags must be gathered.
// Fills classes; MemoryNeed::memory_class indexes them.
std::vector<MemoryNeed> memory_needs(const gpu::Device& device, const GraphDecl& graph,
                                     std::vector<MemoryClass>& classes);

class TransientHeaps;

class Realisation {
 public:
  // Precondition: the heaps fit the plan.
  static Result<Realisation> create(const gpu::Device& device, const Plan& plan,
                                    const std::vector<MemoryClass>& classes,
                                    const TransientHeaps& heaps);
  // By resource; empty ones for imports and unused transients.
  const std::vector<gpu::Image>& images() const { return images_; }
  const std::vector<gpu::Buffer>& buffers() const { return buffers_; }

 private:
  std::vector<gpu::Image> images_;
  std::vector<gpu::Buffer> buffers_;
};

}  // namespace neritic::graph
