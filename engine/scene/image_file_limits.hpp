// Limits of every picture reader: larger sides or more pixels are a mistake or a forged header.
#pragma once

#include <cstdint>
#include <string>

#include "engine/core/log.hpp"

namespace neritic::scene {

inline constexpr std::uint32_t kMaxImageSide = 32768;
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28;
// More take seconds to decode: said, not refused, since 16384 x 16384 is a texture that devices
// take.
inline constexpr std::uint64_t kHeavyImagePixels = std::uint64_t{1} << 26;

inline void note_if_heavy(const std::string& name, std::uint64_t width, std::uint64_t height) {
  if (width * height > kHeavyImagePixels)
    log_warn("{}: {} x {} pixels, which take seconds to read", name, width, height);
}

}  // namespace neritic::scene
