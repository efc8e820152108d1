// Writes GraphDecls by hand in tests: no handles that keep us honest, so that wrong graphs can be
// written too. Versions are given in full: write(a, 0) makes version 1 of a.
#pragma once

#include <initializer_list>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// The uses of a resource in most test graphs.
inline constexpr Access kWrite = Access::kStorageWriteCompute;
inline constexpr Access kRead = Access::kStorageReadCompute;

inline Use use(std::uint32_t resource, std::uint32_t version, Access access,
               const ImageRange& range = {}) {
  return {resource, version, access, range};
}
inline ImageRange mip(std::uint32_t index) {
  return {.mip = index, .mips = 1};
}
inline ImageRange layer(std::uint32_t index) {
  return {.layer = index, .layers = 1};
}

// The plan on a device whose needs are these.
inline Result<Plan> plan_with(const GraphDecl& graph, const std::vector<MemoryNeed>& needs) {
  return compile(graph, [&](const GraphDecl&) { return needs; });
}

// The barriers of a plan before a position, those before first uses at first.
inline std::vector<Barrier> barriers_at(const Plan& plan, std::size_t position) {
  std::vector<Barrier> all = plan.barriers.first[position];
  const std::vector<Barrier>& more = plan.barriers.before[position];
  all.insert(all.end(), more.begin(), more.end());
  return all;
}
inline std::vector<Barrier> barriers_at_end(const Plan& plan) {
  return barriers_at(plan, plan.order.size());
}

struct GraphMaker {
  GraphDecl graph;

  std::uint32_t add(ResourceDecl resource) {
    graph.resources.push_back(std::move(resource));
    return static_cast<std::uint32_t>(graph.resources.size() - 1);
  }
  std::uint32_t image(const std::string& name, VkFormat format = VK_FORMAT_R8G8B8A8_UNORM) {
    ResourceDecl resource;
    resource.name = name;
    resource.format = format;
    resource.width = 64;
    resource.height = 32;
    return add(resource);
  }
  std::uint32_t buffer(const std::string& name, std::uint64_t size_bytes = 256) {
    ResourceDecl resource;
    resource.name = name;
    resource.kind = ResourceKind::kBuffer;
    resource.size_bytes = size_bytes;
    return add(resource);
  }
  std::uint32_t imported_image(const std::string& name, VkPipelineStageFlags2 stages,
                               VkAccessFlags2 access, VkImageLayout layout) {
    const std::uint32_t r = image(name);
    graph.resources[r].imported = true;
    graph.resources[r].initial_stages = stages;
    graph.resources[r].initial_access = access;
    graph.resources[r].initial_layout = layout;
    return r;
  }
  std::uint32_t imported_buffer(const std::string& name, VkPipelineStageFlags2 stages = 0,
                                VkAccessFlags2 access = 0) {
    const std::uint32_t r = buffer(name);
    graph.resources[r].imported = true;
    graph.resources[r].initial_stages = stages;
    graph.resources[r].initial_access = access;
    return r;
  }
  std::uint32_t pass(const std::string& name, std::initializer_list<Use> uses,
                     bool side_effect = false) {
    graph.passes.push_back({name, uses, side_effect});
    return static_cast<std::uint32_t>(graph.passes.size() - 1);
  }
  void output(std::uint32_t resource, std::uint32_t version, Access access) {
    graph.outputs.push_back({resource, version, access});
  }

  // The answers of an invented device: sizes from the declaration, one class a kind.
  std::vector<MemoryNeed> needs(std::uint64_t alignment = 1) const {
    std::vector<MemoryNeed> all;
    for (const ResourceDecl& r : graph.resources) {
      const bool is_image = r.kind == ResourceKind::kImage;
      const std::uint64_t texels = std::uint64_t{r.width} * r.height * r.layers;
      all.push_back({is_image ? texels * 4 : r.size_bytes, alignment, is_image ? 1u : 0u});
    }
    return all;
  }
  // The plan of a graph that must be valid.
  Plan plan() const {
    Result<Plan> result = plan_with(graph, needs());
    if (!result) throw std::runtime_error(result.error().message);
    return std::move(result).value();
  }
  // The sentence that says why the graph is invalid; empty where it is valid.
  std::string error() const {
    const Status status = validate(graph);
    return status ? "" : status.error().message;
  }
};

}  // namespace neritic::graph
