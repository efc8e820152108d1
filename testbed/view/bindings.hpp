// The user's own bindings of the actions of `dive`: a TOML file with an [actions] table, each key
// an action with its list of controls instead of ours. Pure function; any thread.
#pragma once

#include <filesystem>
#include <vector>

#include "engine/xr/actions.hpp"

namespace neritic::testbed {

// kBadInput names file, line and what is accepted.
Result<std::vector<xr::ActionDesc>> bound_actions(std::vector<xr::ActionDesc> actions,
                                                  const std::filesystem::path& file);

}  // namespace neritic::testbed
