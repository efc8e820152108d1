// Groups of inputs in words for an operator: which authority acts, whose samples are not used. Pure
// functions; any thread.
#pragma once

#include <string>
#include <vector>

#include "testbed/samples/authority.hpp"

namespace neritic::testbed {

// "live from suit", "autopilot": the authority that the group has now.
std::string authority_words(const GroupState& state, const std::vector<std::string>& sources);

// The troubles of the group, a clause each: its source is silent or was never heard, and what acts
// instead; samples of other sources are not used. Empty: none.
std::string trouble_words(const GroupState& state, const std::vector<std::string>& sources);

// A line a group in trouble, "diver: body: suit is silent, autopilot acts". Group: DiverGroup,
// VehicleGroup or ObjectGroup.
template <class Group, class Groups>
void add_trouble(const std::string& name, const Groups& groups,
                 const std::vector<std::string>& sources, std::vector<std::string>& lines) {
  for (std::size_t i = 0; i < groups.size(); ++i)
    if (const std::string words = trouble_words(groups[i], sources); !words.empty())
      lines.push_back(fmt::format("{}: {}: {}", name, name_of(static_cast<Group>(i)), words));
}

}  // namespace neritic::testbed
