// An independent judge of plans: walks order and barriers over every byte of transient memory and
// every import, by the rules of Vulkan 1.3's synchronization chapter (section 7: execution
// dependency chains, availability, visibility, layout transitions as writes), and says what is not
// covered. It shares nothing with engine/graph/barriers.cpp but the table of accesses.
#pragma once

#include <string>
#include <vector>

#include "engine/graph/plan.hpp"

namespace neritic::graph {

// One sentence a hazard; empty for a sound plan.
std::vector<std::string> find_hazards(const Plan& plan);

}  // namespace neritic::graph
