// A range of mip levels and array layers of an image. Plain data; any thread.
#pragma once

#include <algorithm>
#include <cstdint>

namespace neritic::gpu {

inline constexpr std::uint32_t kAllOfThem = ~0u;  // as VK_REMAINING_MIP_LEVELS

struct ImageRange {
  std::uint32_t mip = 0, mips = kAllOfThem;      // first, count
  std::uint32_t layer = 0, layers = kAllOfThem;  // first, count

  // Replaces kAllOfThem by the counts of an image with these mips and layers.
  constexpr ImageRange within(std::uint32_t all_mips, std::uint32_t all_layers) const {
    return {mip, mips == kAllOfThem ? all_mips - std::min(mip, all_mips) : mips, layer,
            layers == kAllOfThem ? all_layers - std::min(layer, all_layers) : layers};
  }
  // The following need concrete counts on both sides.
  constexpr bool contains(const ImageRange& other) const {
    return mip <= other.mip && other.mip + other.mips <= mip + mips && layer <= other.layer &&
           other.layer + other.layers <= layer + layers;
  }
  constexpr bool overlaps(const ImageRange& other) const {
    return mip < other.mip + other.mips && other.mip < mip + mips &&
           layer < other.layer + other.layers && other.layer < layer + layers;
  }

  bool operator==(const ImageRange&) const = default;
};

}  // namespace neritic::gpu
