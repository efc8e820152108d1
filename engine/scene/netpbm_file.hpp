// Grey Netpbm files and their floats: .pgm (P5, P2; 8 and 16 bit) and .pfm (Pf, PF), as depth and
// disparity maps are kept in. Pure; any thread. Source: netpbm.sourceforge.net (pgm, pfm).
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "engine/core/result.hpp"

namespace neritic::scene {

struct NetpbmMap {
  std::uint32_t width = 0, height = 0, channels = 1;
  int bits = 0;                // of whole numbers, 8 or 16; 0: floats
  std::vector<double> values;  // [height][width][channels], row 0 on top
};

// Errors begin with name.
Result<NetpbmMap> parse_netpbm(std::span<const std::byte> bytes, const std::string& name);

}  // namespace neritic::scene
