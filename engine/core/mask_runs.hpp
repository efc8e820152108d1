// A mask of a picture as COCO stores it (cocodataset.org, "Data format"): uncompressed run lengths,
// column by column from the top, outside first, with its box and area. A plain value.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace neritic {

// Pixels are added in a walk down the columns, from left to right.
struct MaskRuns {
  std::uint32_t left = ~0u, top = ~0u, right = 0, bottom = 0;  // inclusive
  std::uint64_t area = 0;
  std::vector<std::uint32_t> runs{0};  // ends with a run inside the mask, once there is any
  std::uint64_t covered = 0;           // pixels that the runs span

  void add(std::uint32_t x, std::uint32_t y, std::uint32_t height) {
    const std::uint64_t at = std::uint64_t{x} * height + y;
    if (at == covered && area > 0) {
      ++runs.back();
    } else {
      if (area > 0) runs.push_back(0);
      runs.back() = static_cast<std::uint32_t>(at - covered);
      runs.push_back(1);
    }
    covered = at + 1;
    ++area;
    left = std::min(left, x);
    right = std::max(right, x);
    top = std::min(top, y);
    bottom = std::max(bottom, y);
  }
  // After the last pixel. pixels: of the picture.
  void close(std::uint64_t pixels) {
    if (covered < pixels) {
      if (area > 0) runs.push_back(0);
      runs.back() = static_cast<std::uint32_t>(pixels - covered);
    }
  }
};

}  // namespace neritic
