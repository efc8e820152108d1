// Pictures in few bands of the spectrum: the error of a white card's colour and the cost.
#pragma once

#include <string>

#include "engine/gpu/device.hpp"
#include "tools/tradeoff/optics_tradeoff.hpp"

namespace neritic::tools {

inline constexpr std::uint32_t kBandCounts[] = {3, 9, 12, 15};

// The largest CIEDE2000 of a white card from 1 to 20 m in types I, III and 5C against every
// nanometre; ms: a megapixel of open water, all its passes.
Result<OpticsPoint> bands_point(gpu::Device& device, std::uint32_t bands, bool quick);

// The card's errors by water, depth and bands, as a table in Markdown.
Result<std::string> card_table();

}  // namespace neritic::tools
