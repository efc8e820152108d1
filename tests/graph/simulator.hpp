// An independent judge of plans: walks the orders and barriers of one or more runs over every byte
// of transient memory and every import, by the rules of Vulkan 1.3's synchronization chapter
// (section 7: execution dependency chains, availability, visibility, layout transitions as writes),
// and says what is not covered. It shares nothing with engine/graph/barriers.cpp but the table of
// accesses.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// One execution of a plan whose first barriers are set. objects, by resource: what is behind an
// import; classes, by memory class: which heap.
struct PlanRun {
  Plan plan;
  std::vector<std::uint64_t> objects, classes;
};

// One sentence a hazard; empty for sound plans that run one after the other.
std::vector<std::string> find_hazards(std::span<const PlanRun> runs);
// The hazards of a single plan, before which nothing ran.
std::vector<std::string> find_hazards(const Plan& plan);

}  // namespace neritic::graph
