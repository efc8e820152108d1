// See declaration_hash.hpp.
#include "engine/graph/declaration_hash.hpp"

#include "engine/core/hash.hpp"

namespace neritic::graph {
namespace {

void add_text(Hash64& hash, const std::string& text) {
  hash.add(text.size());
  hash.add_bytes(text.data(), text.size());
}

void add_uses(Hash64& hash, const std::vector<Use>& uses) {
  hash.add(uses.size());
  for (const Use& use : uses) {
    hash.add(std::uint64_t{use.resource} << 32 | use.version);
    hash.add(static_cast<std::uint64_t>(use.access));
    hash.add(std::uint64_t{use.range.mip} << 32 | use.range.mips);
    hash.add(std::uint64_t{use.range.layer} << 32 | use.range.layers);
  }
}

}  // namespace

std::uint64_t hash_of(const GraphDecl& graph) {
  Hash64 hash;
  for (const ResourceDecl& r : graph.resources) {
    add_text(hash, r.name);
    const std::uint64_t facts[] = {
        static_cast<std::uint64_t>(r.kind),
        std::uint64_t{r.imported} << 8 | static_cast<std::uint64_t>(r.history),
        static_cast<std::uint64_t>(r.format),
        std::uint64_t{r.width} << 32 | r.height,
        std::uint64_t{r.layers} << 32 | r.mips,
        r.image_usage,
        r.size_bytes,
        r.buffer_usage,
        r.initial_stages,
        r.initial_access,
        static_cast<std::uint64_t>(r.initial_layout)};
    hash.add_bytes(facts, sizeof facts);
  }
  for (const PassDecl& pass : graph.passes) {
    add_text(hash, pass.name);
    add_uses(hash, pass.uses);
    hash.add(pass.side_effect);
    add_text(hash, pass.terms);
  }
  add_uses(hash, graph.outputs);
  return hash.value();
}

}  // namespace neritic::graph
