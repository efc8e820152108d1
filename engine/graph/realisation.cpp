// See realisation.hpp.
#include "engine/graph/realisation.hpp"

#include <algorithm>

#include "engine/gpu/device.hpp"
#include "engine/graph/transient_heaps.hpp"

namespace neritic::graph {
namespace {

gpu::ImageDesc image_desc(const ResourceDecl& resource) {
  gpu::ImageDesc desc;
  desc.name = resource.name;
  desc.format = resource.format;
  desc.width = resource.width;
  desc.height = resource.height;
  desc.layers = resource.layers;
  desc.mips = resource.mips;
  desc.usage = resource.image_usage;
  desc.array_view = true;
  return desc;
}

gpu::BufferDesc buffer_desc(const ResourceDecl& resource) {
  gpu::BufferDesc desc;
  desc.name = resource.name;
  desc.size = resource.size_bytes;
  desc.usage = resource.buffer_usage;
  return desc;
}

// The largest allocation that the device allows, rounded down to a multiple of every alignment.
VkDeviceSize block_bytes_of(const gpu::Device& device, std::uint32_t memory_type_bits) {
  constexpr VkDeviceSize kUnit = VkDeviceSize{16} << 20;
  const VkDeviceSize most =
      device.allocator().largest_piece(memory_type_bits, gpu::MemoryUse::kDevice);
  return std::max(most / kUnit * kUnit, kUnit);
}

std::uint32_t class_of(const gpu::Device& device, ResourceKind kind,
                       const VkMemoryRequirements& needs, std::vector<MemoryClass>& classes) {
  for (std::uint32_t c = 0; c < classes.size(); ++c) {
    MemoryClass& known = classes[c];
    if (known.kind != kind || known.memory_type_bits != needs.memoryTypeBits) continue;
    known.alignment = std::max(known.alignment, needs.alignment);
    return c;
  }
  classes.push_back(
      {kind, needs.memoryTypeBits, needs.alignment, block_bytes_of(device, needs.memoryTypeBits)});
  return static_cast<std::uint32_t>(classes.size() - 1);
}

// A transient that only a culled pass mentions may have no usage at all; it is never made.
bool has_usage(const ResourceDecl& resource) {
  return resource.image_usage != 0 || resource.buffer_usage != 0;
}

}  // namespace

std::vector<MemoryNeed> memory_needs(const gpu::Device& device, const GraphDecl& graph,
                                     std::vector<MemoryClass>& classes) {
  classes.clear();
  std::vector<MemoryNeed> needs(graph.resources.size());
  for (std::size_t r = 0; r < graph.resources.size(); ++r) {
    const ResourceDecl& resource = graph.resources[r];
    if (resource.imported || !has_usage(resource)) continue;
    const VkMemoryRequirements wanted =
        resource.kind == ResourceKind::kImage
            ? gpu::image_requirements(device, image_desc(resource))
            : gpu::buffer_requirements(device, buffer_desc(resource));
    const std::uint32_t c = class_of(device, resource.kind, wanted, classes);
    needs[r] = {wanted.size, wanted.alignment, c, classes[c].block_bytes};
  }
  return needs;
}

Result<Realisation> Realisation::create(const gpu::Device& device, const Plan& plan,
                                        const std::vector<MemoryClass>& classes,
                                        const TransientHeaps& heaps) {
  Realisation made;
  const std::size_t count = plan.graph.resources.size();
  made.images_.resize(count);
  made.buffers_.resize(count);
  for (std::size_t r = 0; r < count; ++r) {
    const ResourceDecl& resource = plan.graph.resources[r];
    if (resource.imported || !plan.lifetimes[r].used()) continue;
    const auto [memory, offset] =
        heaps.at(classes[plan.needs[r].memory_class], plan.placement.offset[r]);
    if (resource.kind == ResourceKind::kImage) {
      NERITIC_TRY(made.images_[r],
                  gpu::Image::create_at(device, image_desc(resource), memory, offset));
    } else {
      NERITIC_TRY(made.buffers_[r],
                  gpu::Buffer::create_at(device, buffer_desc(resource), memory, offset));
    }
  }
  return made;
}

}  // namespace neritic::graph
