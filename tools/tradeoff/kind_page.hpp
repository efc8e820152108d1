// The picture of one kind of sonar's tradeoff: error over cost and knobs, and its terms. Pure
// function; any thread.
#pragma once

#include <string>

#include "tools/common/curves.hpp"
#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {

// levels: whether the sweep is fine enough to name the cheapest settings within each error.
Page kind_page(const KindResult& result, const std::string& device, const std::string& scene,
               bool levels);

}  // namespace neritic::tools
