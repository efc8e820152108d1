// What every picture reader accepts: larger sides or more pixels are a mistake or a forged header.
#pragma once

#include <cstdint>

namespace neritic::scene {

inline constexpr std::uint32_t kMaxImageSide = 32768;
inline constexpr std::uint64_t kMaxImagePixels = std::uint64_t{1} << 28;

}  // namespace neritic::scene
