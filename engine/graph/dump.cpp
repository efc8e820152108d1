// A plan as text for a person: passes in order with what they read and write, culled passes,
// barriers, transients with their place in memory, totals. Pure; any thread.
#include <fmt/format.h>

#include <iterator>

#include "engine/graph/access.hpp"
#include "engine/graph/names.hpp"
#include "engine/graph/plan.hpp"

namespace neritic::graph {
namespace {

using Out = std::back_insert_iterator<std::string>;

// "depth", or "depth [mip 1, layer 0]" for a part.
std::string name_of(const GraphDecl& graph, std::uint32_t r, const ImageRange& range) {
  const ResourceDecl& resource = graph.resources[r];
  const ImageRange part = range.within(resource.mips, resource.layers);
  if (part == ImageRange{0, resource.mips, 0, resource.layers}) return resource.name;
  return fmt::format("{} [{}]", resource.name, range_name(part));
}

void dump_uses(Out out, const GraphDecl& graph, const PassDecl& pass) {
  for (const Use& use : pass.uses) {
    const AccessInfo& info = access_info(use.access);
    const std::string name = name_of(graph, use.resource, use.range);
    if (info.write) {
      fmt::format_to(out, "      writes {} {}->{} ({})\n", name, use.version, use.version + 1,
                     info.name);
    } else {
      fmt::format_to(out, "      reads  {} {} ({})\n", name, use.version, info.name);
    }
  }
}

void dump_barrier(Out out, const GraphDecl& graph, const Barrier& barrier) {
  fmt::format_to(out, "      barrier {}: {} -> {}", name_of(graph, barrier.resource, barrier.range),
                 stage_names(barrier.src_stages), stage_names(barrier.dst_stages));
  if (barrier.old_layout != barrier.new_layout) {
    fmt::format_to(out, ", layout {} -> {}", layout_name(barrier.old_layout),
                   layout_name(barrier.new_layout));
  }
  fmt::format_to(out, ", access {} -> {}{}{}\n", access_names(barrier.src_access),
                 access_names(barrier.dst_access), barrier.discards ? ", discards" : "",
                 barrier.earlier ? ", after an earlier run" : "");
}

std::string shape(const ResourceDecl& resource) {
  if (resource.kind == ResourceKind::kBuffer) return "buffer";
  return fmt::format("{} {}x{}{}{}", format_name(resource.format), resource.width, resource.height,
                     resource.layers > 1 ? fmt::format("x{}", resource.layers) : "",
                     resource.mips > 1 ? fmt::format(", {} mips", resource.mips) : "");
}

void dump_transients(Out out, const Plan& plan) {
  fmt::format_to(out, "transients (positions first..last, class:offset)\n");
  for (std::size_t r = 0; r < plan.graph.resources.size(); ++r) {
    const ResourceDecl& resource = plan.graph.resources[r];
    if (resource.imported) continue;
    const Lifetime& life = plan.lifetimes[r];
    if (!life.used()) {
      fmt::format_to(out, "  {:<28} {:<28} unused\n", resource.name, shape(resource));
      continue;
    }
    fmt::format_to(out, "  {:<28} {:<28} {:>12} bytes  {:>2}..{:<2}  {}:{}\n", resource.name,
                   shape(resource), plan.needs[r].size, life.first, life.last,
                   plan.needs[r].memory_class, plan.placement.offset[r]);
  }
}

struct BarrierCount {
  std::size_t all = 0, earlier = 0;
};
BarrierCount count_barriers(const Plan& plan) {
  BarrierCount count;
  for (const auto& list : plan.barriers.before) count.all += list.size();
  for (const auto& list : plan.barriers.first) {
    count.all += list.size();
    for (const Barrier& barrier : list) count.earlier += barrier.earlier;
  }
  return count;
}

void dump_barriers(Out out, const Plan& plan, std::size_t position) {
  for (const Barrier& barrier : plan.barriers.first[position])
    dump_barrier(out, plan.graph, barrier);
  for (const Barrier& barrier : plan.barriers.before[position])
    dump_barrier(out, plan.graph, barrier);
}

}  // namespace

std::string dump_text(const Plan& plan) {
  const GraphDecl& graph = plan.graph;
  std::string text;
  const Out out = std::back_inserter(text);
  const BarrierCount count = count_barriers(plan);
  fmt::format_to(
      out, "frame graph: {} passes kept, {} culled, {} barriers ({} after an earlier run)\n",
      plan.order.size(), graph.passes.size() - plan.order.size(), count.all, count.earlier);
  fmt::format_to(out, "passes in order\n");
  for (std::size_t position = 0; position < plan.order.size(); ++position) {
    const PassDecl& pass = graph.passes[plan.order[position]];
    fmt::format_to(out, "  {:>2}  {}{}\n", position, pass.name,
                   pass.side_effect ? " (side effect)" : "");
    if (!pass.terms.empty()) fmt::format_to(out, "      terms  {}\n", pass.terms);
    dump_barriers(out, plan, position);
    dump_uses(out, graph, pass);
  }
  fmt::format_to(out, "at the end\n");
  dump_barriers(out, plan, plan.order.size());
  for (const Use& output : graph.outputs)
    fmt::format_to(out, "      output {} {} ({})\n", name_of(graph, output.resource, output.range),
                   output.version, access_info(output.access).name);
  fmt::format_to(out, "culled\n");
  for (std::size_t p = 0; p < graph.passes.size(); ++p)
    if (!plan.kept[p]) fmt::format_to(out, "  {}\n", graph.passes[p].name);
  dump_transients(out, plan);
  const auto mib = [](std::uint64_t bytes) { return static_cast<double>(bytes) / 1048576.0; };
  fmt::format_to(
      out, "transient memory: {} bytes ({:.2f} MiB) with aliasing, {} bytes ({:.2f} MiB) without\n",
      plan.placement.bytes_with_aliasing, mib(plan.placement.bytes_with_aliasing),
      plan.placement.bytes_without, mib(plan.placement.bytes_without));
  return text;
}

}  // namespace neritic::graph
