// Inside engine/graph: rules about accesses that the stages share. See plan.hpp for the accesses.
// Pure functions on plain data; any thread.
#pragma once

#include <span>
#include <vector>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// The access bits that change memory; only these need to be made available by a barrier.
inline constexpr VkAccessFlags2 kWriteAccess =
    VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

// Whether a resource of that kind can be used so at all (no image is a vertex buffer).
bool access_fits(Access access, ResourceKind kind);
// Accesses that happen after the frame: no pass can declare them.
bool only_as_output(Access access);
// Whether a pass may read by `read` the very resource that it writes by `write`: the write's
// stages, access and layout include the read's.
bool subsumes(Access write, Access read);

// All uses of one resource by one pass as one.
struct CombinedUse {
  std::uint32_t resource = 0;
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // UNDEFINED for buffers
  bool write = false;
};
// Replaces out by the combined uses, in the order of first mention. The uses must be valid.
void combine_uses(const GraphDecl& graph, std::span<const Use> uses, std::vector<CombinedUse>& out);

}  // namespace neritic::graph
