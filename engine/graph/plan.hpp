// The frame graph as plain data, and its compilation: validate, cull, order, barriers, lifetimes,
// aliasing. Each stage is a pure function, so that tests reach it without a GPU. Nothing here calls
// Vulkan; only its enums are used. frame_graph.hpp declares passes into a GraphDecl and executes a
// Plan.
#pragma once

#include <volk.h>

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"
#include "engine/gpu/image_range.hpp"

namespace neritic::graph {

// How a pass uses a resource. Each access has one stage mask, access mask and image layout
// (access_info, table in access.cpp). Attachments and descriptors take their layout from there:
// access_info(Access::kDepthTest).layout. A read-only depth attachment needs storeOp NONE, because
// STORE counts as a write.
enum class Access {
  kColorAttachment,      // write
  kDepthAttachment,      // write (and test)
  kDepthTest,            // read-only depth attachment
  kDepthTestAndSampled,  // read-only depth attachment that the fragment shader also samples
  kSampledVertex,        // read by texture or texelFetch
  kSampledFragment,
  kSampledCompute,
  kStorageReadCompute,   // buffer or image
  kStorageWriteCompute,  // write; earlier contents may be read (atomics)
  kTexelWriteCompute,    // the same of a buffer's texels (gpu::Buffer::texels)
  kStorageReadVertex,    // buffers in vertex shaders
  kStorageReadFragment,
  kVertexBuffer,
  kIndexBuffer,
  kIndirectBuffer,
  kTransferRead,
  kTransferWrite,  // write
  kHostRead,       // after the frame
  kPresent,        // after the frame
};

struct AccessInfo {
  VkPipelineStageFlags2 stages;
  VkAccessFlags2 access;
  VkImageLayout layout;  // UNDEFINED for buffers-only uses
  VkImageUsageFlags image_usage;
  VkBufferUsageFlags buffer_usage;
  bool write;
  const char* name;
};
const AccessInfo& access_info(Access access);

enum class ResourceKind { kImage, kBuffer };

// An image that keeps its content from frame to frame is two: the one that the last frame wrote,
// which this frame reads, and the one that this frame writes for the next.
enum class History { kNone, kLast, kNext };

// The access bits that change memory; only these need to be made available by a barrier.
inline constexpr VkAccessFlags2 kWriteAccess =
    VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT |
    VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT |
    VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_HOST_WRITE_BIT | VK_ACCESS_2_MEMORY_WRITE_BIT;

// The mips and layers of an image that a use touches; all by default, and always of a buffer.
using gpu::ImageRange;

struct ResourceDecl {
  std::string name;
  ResourceKind kind = ResourceKind::kImage;
  bool imported = false;             // lives outside the frame; contents defined at its start
  History history = History::kNone;  // not kNone: imported, and the executor keeps it
  // Images. gather_usage collects the usage flags of both kinds from the declared accesses.
  VkFormat format = VK_FORMAT_UNDEFINED;
  std::uint32_t width = 0, height = 0, layers = 1, mips = 1;
  VkImageUsageFlags image_usage = 0;
  // Buffers.
  std::uint64_t size_bytes = 0;
  VkBufferUsageFlags buffer_usage = 0;
  // Imported: what is pending on it outside of graphs, and its layout.
  VkPipelineStageFlags2 initial_stages = VK_PIPELINE_STAGE_2_NONE;
  VkAccessFlags2 initial_access = VK_ACCESS_2_NONE;
  VkImageLayout initial_layout = VK_IMAGE_LAYOUT_UNDEFINED;

  bool operator==(const ResourceDecl&) const = default;
};

// A use of one version of a resource, or of a part of an image. A write of version v makes v + 1 of
// the whole resource: the named part changes, the rest stays. A read of a part at version v needs
// the last writers of that part up to v, and stays valid until a later write touches the part.
struct Use {
  std::uint32_t resource = 0;
  std::uint32_t version = 0;  // the version read, or the version that the write replaces
  Access access = Access::kSampledCompute;
  ImageRange range;

  bool operator==(const Use&) const = default;
};

struct PassDecl {
  std::string name;
  std::vector<Use> uses;
  bool side_effect = false;  // kept although nobody reads what it writes
  std::string terms;         // what of its options it computes, for who reads a dump

  bool operator==(const PassDecl&) const = default;
};

struct GraphDecl {
  std::vector<ResourceDecl> resources;
  std::vector<PassDecl> passes;
  std::vector<Use> outputs;  // versions that must be there at the end, and in which access

  bool operator==(const GraphDecl&) const = default;
};

// --- The stages -------------------------------------------------------------------------------

// An inconsistency is our own bug, returned as kInternal so that its message, which names pass and
// resource, reaches the user: stale handle (a version that a later write replaced before this pass
// was declared), read before write, two writers of one version, a resource used in two ways that
// one pass cannot combine, an index out of range.
Status validate(const GraphDecl& graph);

// True for the passes that an output or a side effect needs, directly or through others.
std::vector<bool> cull(const GraphDecl& graph);

// Kept passes in an order that respects every dependency (declaration order where free).
std::vector<std::uint32_t> order(const GraphDecl& graph, const std::vector<bool>& kept);

// First and last position in the order that touches each resource; first > last: unused.
struct Lifetime {
  std::uint32_t first = 1, last = 0;
  bool used() const { return first <= last; }
};
std::vector<Lifetime> lifetimes(const GraphDecl& graph, std::span<const std::uint32_t> order);

struct MemoryNeed {
  std::uint64_t size = 0, alignment = 1;
  std::uint32_t memory_class = 0;  // only resources of one class may share memory (type bits, kind)
  // The largest allocation of this class that the device allows, a multiple of every alignment. The
  // class's heap consists of blocks of this size, the last as long as needed. 0: one block.
  std::uint64_t block_bytes = 0;
};
// Where each transient resource lies in its class's heap. Two whose lifetimes overlap never overlap
// in memory, and none lies in two blocks.
struct Placement {
  std::vector<std::uint64_t> offset;     // a resource; only meaningful for used transients
  std::vector<std::uint64_t> heap_size;  // a memory class
  std::uint64_t bytes_with_aliasing = 0, bytes_without = 0;
};
Placement place(const GraphDecl& graph, std::span<const Lifetime> lifetimes,
                std::span<const MemoryNeed> needs);

// The uses of a part of a resource between two barriers: one write, or a run of reads in one
// layout.
struct Epoch {
  std::uint32_t position = 0;  // of its first use; the order's size for outputs
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  VkImageLayout layout = VK_IMAGE_LAYOUT_UNDEFINED;  // UNDEFINED for buffers
  bool write = false;
  VkAccessFlags2 written() const { return write ? access & kWriteAccess : 0; }
};
// Mips and layers that every use of the frame takes together or not at all. Most images and all
// buffers have one part.
struct Part {
  std::uint32_t resource = 0;
  ImageRange range;           // concrete counts
  std::vector<Epoch> epochs;  // empty: no kept pass uses it
  bool is_whole(const ResourceDecl& r) const { return range == ImageRange{0, r.mips, 0, r.layers}; }
};

// The stages and writes that a later use of the same memory waits for. access 0: only reads.
struct Pending {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  void add(const Pending& other) { stages |= other.stages, access |= other.access; }
};
// Pending accesses of each resource's memory after its last use.
std::vector<Pending> left_pending(const GraphDecl& graph, std::span<const Part> parts);
// Accesses of the transients that had the same memory earlier in the frame, for each to wait for.
std::vector<Pending> taken_over(const GraphDecl& graph, std::span<const Lifetime> lifetimes,
                                std::span<const MemoryNeed> needs, const Placement& placement,
                                std::span<const Pending> left);

struct Barrier {
  std::uint32_t resource = 0;
  ImageRange range;  // concrete: counts are those of the resource
  VkPipelineStageFlags2 src_stages = 0, dst_stages = 0;
  VkAccessFlags2 src_access = 0, dst_access = 0;
  VkImageLayout old_layout = VK_IMAGE_LAYOUT_UNDEFINED, new_layout = VK_IMAGE_LAYOUT_UNDEFINED;
  bool discards = false;  // contents are not kept (first use, or memory taken over from another)
  bool earlier = false;   // waits for an earlier run

  bool operator==(const Barrier&) const = default;
};
// One list a position in the order, and one at the end for the outputs' accesses. A run records
// first[p] and before[p] together.
struct BarrierPlan {
  std::vector<std::vector<Barrier>> first;   // before first uses: after what earlier runs left
  std::vector<std::vector<Barrier>> before;  // between uses of this frame
};
// Read after read in the same layout gives none. Leaves first empty.
BarrierPlan barriers(const GraphDecl& graph, std::span<const std::uint32_t> order,
                     std::span<const Part> parts);

struct Plan {
  GraphDecl graph;
  std::vector<bool> kept;
  std::vector<std::uint32_t> order;
  std::vector<Lifetime> lifetimes;
  std::vector<MemoryNeed> needs;
  Placement placement;
  std::vector<Part> parts;              // those of one resource in a row
  std::vector<Pending> left, takeover;  // by resource
  BarrierPlan barriers;  // first: as if nothing had run before, until the plan has run
};

// Fills usage flags of every resource from the accesses declared on it.
void gather_usage(GraphDecl& graph);

// The memory that each resource of a valid graph needs; usage flags must be gathered. The device
// gives the numbers; tests invent them.
using NeedsOf = std::function<std::vector<MemoryNeed>(const GraphDecl& graph)>;

// All stages. kOutOfMemory names a transient that is larger than a block.
Result<Plan> compile(GraphDecl graph, const NeedsOf& needs_of);

// --- Looking at it ----------------------------------------------------------------------------
std::string dump_text(const Plan& plan);
std::string dump_graphviz(const Plan& plan);

}  // namespace neritic::graph
