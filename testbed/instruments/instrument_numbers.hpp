// A diver's instruments as numbers with names, for a HUD far away: "depth_m", "tissue_0". NaN is
// not known, infinite no limit. Pure functions; any thread.
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "hud/dive_data.hpp"

namespace neritic::testbed {

using NamedNumbers = std::vector<std::pair<std::string, double>>;

// All but the time, and but a message's words.
NamedNumbers numbers_of(const hud::DiveData& data);

// Takes one number, as if a stranger had sent it: what cannot be is not known. False: no such name,
// and nothing changed.
bool set_number(hud::DiveData& data, std::string_view name, double value);

}  // namespace neritic::testbed
