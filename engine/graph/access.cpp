// The table of accesses: what stage, access mask, layout and usage each Access stands for, and
// which accesses one pass can combine on one resource. Plain data; any thread.
#include "engine/graph/access.hpp"

#include <volk.h>

#include <array>

#include "engine/core/check.hpp"

namespace neritic::graph {
namespace {

constexpr VkPipelineStageFlags2 kDepthStages =
    VK_PIPELINE_STAGE_2_EARLY_FRAGMENT_TESTS_BIT | VK_PIPELINE_STAGE_2_LATE_FRAGMENT_TESTS_BIT;
constexpr VkAccessFlags2 kDepthReadWrite =
    VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_WRITE_BIT;
constexpr VkAccessFlags2 kColorReadWrite =
    VK_ACCESS_2_COLOR_ATTACHMENT_READ_BIT | VK_ACCESS_2_COLOR_ATTACHMENT_WRITE_BIT;
// Atomics and read-modify-write loops read what they write.
constexpr VkAccessFlags2 kStorageReadWrite =
    VK_ACCESS_2_SHADER_STORAGE_READ_BIT | VK_ACCESS_2_SHADER_STORAGE_WRITE_BIT;

// In the order of enum Access. Depth layouts are the combined ones: they are valid for depth-only
// formats and need no feature (separateDepthStencilLayouts).
constexpr std::array<AccessInfo, 19> kTable = {{
    {VK_PIPELINE_STAGE_2_COLOR_ATTACHMENT_OUTPUT_BIT, kColorReadWrite,
     VK_IMAGE_LAYOUT_COLOR_ATTACHMENT_OPTIMAL, VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT, 0, true,
     "color attachment"},
    {kDepthStages, kDepthReadWrite, VK_IMAGE_LAYOUT_DEPTH_STENCIL_ATTACHMENT_OPTIMAL,
     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT, 0, true, "depth attachment"},
    {kDepthStages, VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT,
     VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT,
     0, false, "depth test"},
    {kDepthStages | VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT,
     VK_ACCESS_2_DEPTH_STENCIL_ATTACHMENT_READ_BIT | VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_DEPTH_STENCIL_READ_ONLY_OPTIMAL,
     VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT | VK_IMAGE_USAGE_SAMPLED_BIT, 0, false,
     "depth test and sampled"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0, false,
     "sampled vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0, false,
     "sampled fragment"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_SAMPLED_READ_BIT,
     VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL, VK_IMAGE_USAGE_SAMPLED_BIT, 0, false,
     "sampled compute"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
     VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false,
     "storage read compute"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kStorageReadWrite, VK_IMAGE_LAYOUT_GENERAL,
     VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, true, "storage write compute"},
    {VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT, kStorageReadWrite, VK_IMAGE_LAYOUT_UNDEFINED, 0,
     VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT, true, "texel write compute"},
    {VK_PIPELINE_STAGE_2_VERTEX_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
     VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false,
     "storage read vertex"},
    {VK_PIPELINE_STAGE_2_FRAGMENT_SHADER_BIT, VK_ACCESS_2_SHADER_STORAGE_READ_BIT,
     VK_IMAGE_LAYOUT_GENERAL, VK_IMAGE_USAGE_STORAGE_BIT, VK_BUFFER_USAGE_STORAGE_BUFFER_BIT, false,
     "storage read fragment"},
    {VK_PIPELINE_STAGE_2_VERTEX_ATTRIBUTE_INPUT_BIT, VK_ACCESS_2_VERTEX_ATTRIBUTE_READ_BIT,
     VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_BUFFER_USAGE_VERTEX_BUFFER_BIT, false, "vertex buffer"},
    {VK_PIPELINE_STAGE_2_INDEX_INPUT_BIT, VK_ACCESS_2_INDEX_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, 0,
     VK_BUFFER_USAGE_INDEX_BUFFER_BIT, false, "index buffer"},
    {VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT, VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT,
     VK_IMAGE_LAYOUT_UNDEFINED, 0, VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT, false, "indirect buffer"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_READ_BIT,
     VK_IMAGE_LAYOUT_TRANSFER_SRC_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_SRC_BIT,
     VK_BUFFER_USAGE_TRANSFER_SRC_BIT, false, "transfer read"},
    {VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT, VK_ACCESS_2_TRANSFER_WRITE_BIT,
     VK_IMAGE_LAYOUT_TRANSFER_DST_OPTIMAL, VK_IMAGE_USAGE_TRANSFER_DST_BIT,
     VK_BUFFER_USAGE_TRANSFER_DST_BIT, true, "transfer write"},
    {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT, VK_IMAGE_LAYOUT_UNDEFINED, 0, 0,
     false, "host read"},
    // The semaphore that presentation waits for orders it; the barrier only changes the layout.
    {VK_PIPELINE_STAGE_2_NONE, VK_ACCESS_2_NONE, VK_IMAGE_LAYOUT_PRESENT_SRC_KHR, 0, 0, false,
     "present"},
}};
static_assert(static_cast<std::size_t>(Access::kPresent) + 1 == kTable.size());

}  // namespace

const AccessInfo& access_info(Access access) {
  const auto index = static_cast<std::size_t>(access);
  NERITIC_CHECK(index < kTable.size(), "access {}", index);
  return kTable[index];
}

bool access_fits(Access access, ResourceKind kind) {
  const AccessInfo& info = access_info(access);
  if (kind == ResourceKind::kImage) return info.layout != VK_IMAGE_LAYOUT_UNDEFINED;
  return info.buffer_usage != 0 || access == Access::kHostRead;
}

bool only_as_output(Access access) {
  return access == Access::kHostRead || access == Access::kPresent;
}

bool subsumes(Access write, Access read) {
  if (write == Access::kDepthAttachment && read == Access::kDepthTest) return true;
  const AccessInfo &w = access_info(write), &r = access_info(read);
  // Accesses that only buffers can have have no layout.
  const bool one_layout = w.layout == r.layout || w.layout == VK_IMAGE_LAYOUT_UNDEFINED ||
                          r.layout == VK_IMAGE_LAYOUT_UNDEFINED;
  return w.write && one_layout && (r.stages & ~w.stages) == 0 && (r.access & ~w.access) == 0;
}

ImageRange range_of(const GraphDecl& graph, const Use& use) {
  const ResourceDecl& resource = graph.resources[use.resource];
  return use.range.within(resource.mips, resource.layers);
}

bool uses_meet(const GraphDecl& graph, const Use& a, const Use& b) {
  return a.resource == b.resource && range_of(graph, a).overlaps(range_of(graph, b));
}

void gather_usage(GraphDecl& graph) {
  const auto add = [&graph](const Use& use) {
    ResourceDecl& resource = graph.resources[use.resource];
    if (resource.imported) return;  // made elsewhere: its usage is a fact, not a wish
    const AccessInfo& info = access_info(use.access);
    if (resource.kind == ResourceKind::kImage) {
      resource.image_usage |= info.image_usage;
    } else {
      resource.buffer_usage |= info.buffer_usage;
    }
  };
  for (const PassDecl& pass : graph.passes)
    for (const Use& use : pass.uses) add(use);
  for (const Use& use : graph.outputs) add(use);
}

}  // namespace neritic::graph
