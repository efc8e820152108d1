// Inside engine/graph: who wrote and who reads each version of each resource. Built once a stage
// from a valid graph; plain data, any thread.
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
  // The pass that made the version; kNoPass for version 0 and for versions nobody makes.
  std::uint32_t writer(std::uint32_t resource, std::uint32_t version) const {
    if (version == 0) return kNoPass;
    const std::uint32_t slot = first_[resource] + version - 1;
    return slot < first_[resource + 1] ? writers_[slot] : kNoPass;
  }

 private:
  std::vector<std::uint32_t> first_;    // by resource: where its writers start
  std::vector<std::uint32_t> writers_;  // of versions 1, 2, ... of resource 0, then of 1, ...
};

}  // namespace neritic::graph
