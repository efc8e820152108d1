// The picture of one kind's sweeps: error over milliseconds for every knob, the levels found, and
// what each term costs and buys. Pure functions; any thread.
#pragma once

#include "engine/core/image.hpp"
#include "tools/tradeoff/kind_sweep.hpp"

namespace neritic::tools {

// levels: false where the sweep was too coarse to tell them.
ImageU8 draw_kind(const KindResult& result, const std::string& device, const std::string& scene,
                  bool levels);

}  // namespace neritic::tools
