// Inside engine/graph: the memory that the transients of all graphs lie in, one heap a memory class
// (realisation.hpp), each in as many blocks as the device makes it. Graphs take turns with it: a
// run waits for what earlier ones did to the same bytes (past.hpp), and leaves nothing that the
// next needs. Move-only; rendering thread.
#pragma once

#include <vector>

#include "engine/gpu/memory.hpp"
#include "engine/graph/realisation.hpp"

namespace neritic::graph {

class TransientHeaps {
 public:
  // Bytes of a memory class that one plan needs, or the largest of several plans.
  struct Need {
    MemoryClass memory_class;
    std::uint64_t size = 0;
  };
  // Every class once, with the most of both.
  static void add(std::vector<Need>& needs, const MemoryClass& memory_class, std::uint64_t size);

  // The heaps are neither too small for the needs nor, in sum, more than twice as large.
  bool fit(const std::vector<Need>& needs) const;
  // Takes the heaps out, for whoever waits until the GPU is done with them.
  std::vector<gpu::Allocation> take();
  // New heaps of just these sizes. Precondition: none there (take()).
  Status allocate(gpu::Allocator& allocator, const std::vector<Need>& needs);

  struct Place {
    VkDeviceMemory memory = VK_NULL_HANDLE;
    VkDeviceSize offset = 0;
  };
  // Where an offset in the class's heap lies. Precondition: of a need that the heaps fit.
  Place at(const MemoryClass& memory_class, std::uint64_t offset) const;
  std::uint64_t bytes() const;

 private:
  struct Heap {
    Need made_for;
    std::vector<gpu::Allocation> blocks;
  };
  const Heap* find(const MemoryClass& memory_class) const;
  std::vector<Heap> heaps_;
};

}  // namespace neritic::graph
