// Inside engine/graph: the uses of each part of each resource, in order, as epochs: one write, or a
// run of reads in one layout. A part is a set of mips and layers that every use of the frame takes
// whole or not at all; most images and all buffers have one. Pure; any thread.
#pragma once

#include <span>
#include <vector>

#include "engine/graph/access.hpp"

namespace neritic::graph {

struct Epoch {
  std::uint32_t position = 0;  // of its first use; the order's size for outputs
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // UNDEFINED for buffers
  bool write = false;
  VkAccessFlags2 written() const { return write ? access & kWriteAccess : 0; }
};

struct Part {
  std::uint32_t resource = 0;
  ImageRange range;           // concrete counts
  std::vector<Epoch> epochs;  // empty: no kept pass uses it
};

// The parts of all resources, those of one resource in a row. The graph must be valid.
std::vector<Part> find_parts(const GraphDecl& graph, std::span<const std::uint32_t> order);

}  // namespace neritic::graph
