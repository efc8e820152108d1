// Inside engine/graph: which pass wrote each version of each resource, and which part of it. Built
// once a stage from a valid graph; plain data, any thread.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

inline constexpr std::uint32_t kNoPass = ~0u;

class Versions {
 public:
  explicit Versions(const GraphDecl& graph);

  struct Writer {
    std::uint32_t pass = kNoPass;  // kNoPass: nobody makes this version
    ImageRange range;              // what it changes, with concrete counts
  };
  // The writers of versions 1, 2, ... of the resource.
  std::span<const Writer> writers(std::uint32_t resource) const {
    return std::span(writers_).subspan(first_[resource], first_[resource + 1] - first_[resource]);
  }

  // The passes that made what the use finds in its part: newest first, down to one that wrote all
  // of the part. Earlier ones follow from that pass's own use.
  template <class Visit>
  void visit_makers(const Use& use, const ImageRange& range, Visit&& visit) const {
    const std::span<const Writer> all = writers(use.resource);
    for (std::size_t v = std::min<std::size_t>(use.version, all.size()); v-- > 0;) {
      if (all[v].pass == kNoPass || !all[v].range.overlaps(range)) continue;
      visit(all[v].pass);
      if (all[v].range.contains(range)) return;
    }
  }
  // The passes that write over the use's part later: in order, up to one that writes all of it.
  template <class Visit>
  void visit_replacers(const Use& use, const ImageRange& range, Visit&& visit) const {
    const std::span<const Writer> all = writers(use.resource);
    for (std::size_t v = use.version; v < all.size(); ++v) {
      if (all[v].pass == kNoPass || !all[v].range.overlaps(range)) continue;
      visit(all[v].pass);
      if (all[v].range.contains(range)) return;
    }
  }

 private:
  std::vector<std::uint32_t> first_;  // by resource: where its writers start
  std::vector<Writer> writers_;       // of versions 1, 2, ... of resource 0, then of 1, ...
};

}  // namespace neritic::graph
