// The skylight's grid against rays to the sky by brute force, in double.
#pragma once

#include "tools/tradeoff/optics_tradeoff.hpp"

namespace neritic::tools {

// A hold of 6 x 3 x 8 m with a door and a hatch, and the water about it: the root mean square of
// the error of the share of the sky's light at places at least 0.5 m from any wall; ms: of the
// host, once, while the grid is made.
OpticsPoint skylight_point(std::uint32_t cell_cm, bool quick);

}  // namespace neritic::tools
